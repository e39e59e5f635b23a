// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Quality numbers of a mesh (thesis, Section 4.1), from the quality of its cells.
struct MeshQuality {
  double q_min = 0.0;         ///< lowest quality of all cells
  double q_star_min = 0.0;    ///< lowest quality of the cells with at least one free node
  double q_mean = 0.0;        ///< arithmetic mean over all cells
  std::size_t n_invalid = 0;  ///< cells with quality <= 0
};

/// Returns the mean ratio of every cell, in the order of the cells; 0 for invalid ones. Planar,
/// volume and surface meshes. Cells of second order have that of curved_mean_ratio().
template <int dim, int spacedim>
std::vector<double> cell_mean_ratios(const Mesh<dim, spacedim>& mesh);
/// Returns the mean ratio of the corners of every cell, as if all edges were straight.
template <int dim, int spacedim>
std::vector<double> corner_mean_ratios(const Mesh<dim, spacedim>& mesh);
/// Writes the mean ratios to a vector of n_cells numbers; returns the quality of the mesh.
template <int dim, int spacedim>
MeshQuality compute_cell_mean_ratios(const Mesh<dim, spacedim>& mesh,
                                     std::vector<double>& cell_quality);

/// Returns the quality of a mesh. cell_quality: one number for each cell of the topology. If no
/// cell has a free node, q_star_min = q_min. Of a part of a mesh, all functions that return a
/// MeshQuality compute that of the whole, and are collective.
MeshQuality mesh_quality(const Topology& topology, const std::vector<double>& cell_quality);
template <int dim, int spacedim>
MeshQuality mesh_quality(const Mesh<dim, spacedim>& mesh);

/// Contribution of one block of cells (topology.blocks()) to the quality of a mesh.
struct PartialQuality {
  double q_min = 0.0, q_star_min = 0.0, sum = 0.0;
  std::size_t n_invalid = 0;

  PartialQuality() = default;
  PartialQuality(const Topology& topology, const std::vector<double>& cell_quality,
                 const CellBlock& block);
};
/// Returns the quality of a mesh from all blocks, added in their order.
MeshQuality mesh_quality(const std::vector<PartialQuality>& blocks, std::size_t n_cells);

/// Returns the cells with quality <= 0, ascending.
std::vector<CellIndex> invalid_cells(std::span<const double> cell_quality);

/// Number of cells with a quality below a threshold, and of those with a free node.
struct CellsBelow {
  double threshold = 0.0;
  std::size_t n = 0, n_star = 0;
};
/// Returns these numbers for each threshold.
template <int dim, int spacedim>
std::vector<CellsBelow> count_cells_below(const Mesh<dim, spacedim>& mesh,
                                          std::span<const double> thresholds);

/// Returns the number of cells in each of the n_bins equal parts of [0, 1]. Quality 1 counts in the
/// last part.
std::vector<std::size_t> quality_histogram(std::span<const double> cell_quality,
                                           std::size_t n_bins);

/// Throws InputError if the mesh has invalid cells. The message counts them and names the first
/// ones with their coordinates. It also says if all cells are inverted (clockwise in the plane).
/// cell_lines, if not empty: the line of each cell in the file at `path`. Cells have the file's
/// numbers if the mesh has them.
template <int dim, int spacedim>
void require_valid(const Mesh<dim, spacedim>& mesh, const std::string& path = {},
                   std::span<const std::size_t> cell_lines = {});

}  // namespace smoothfem
