// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/quality/mesh_quality.h"

#include <algorithm>
#include <limits>
#include <sstream>

#include "smoothing/base/option_text.h"
#include "smoothing/base/parallel.h"
#include "smoothing/geometry/cell_size.h"
#include "smoothing/parts/exact_sum.h"
#include "smoothing/quality/mean_ratio.h"
#include "smoothing/quality/target_corners.h"
#include "smoothing/second_order/curved_quality.h"
#include "smoothing/second_order/raise_order.h"

namespace smoothfem {

namespace {

constexpr double none = std::numeric_limits<double>::infinity();

template <int dim, int spacedim>
void compute_cells(const Mesh<dim, spacedim>& mesh, const CellBlock& block, double* cell_quality) {
  const Point<spacedim>* const x = mesh.coordinates().data();
  const auto at = coordinates_at(x);
  for_each_batch<dim, spacedim>(
      mesh.topology(), block.first, block.last,
      [&]<std::size_t n>(const CellBatch<n>& batch) {
        const auto corners = target_corners<dim>(mesh.targets(), batch, at);
        const std::span<const Vector<dim, Lanes>, n> nodes(corners);
        batch.store(within_size_bound<dim>(mesh.targets(), nodes, mean_ratio(nodes)), cell_quality);
      },
      [&](CellIndex c) {
        with_target_corners(mesh, c, at, [&](auto corners) {
          cell_quality[c] = target_mean_ratio(mesh, c, corners);
        });
      });
}

}  // namespace

PartialQuality::PartialQuality(const Topology& topology, const std::vector<double>& cell_quality,
                               const CellBlock& block)
    : q_min(none), q_star_min(none) {
  for (CellIndex c = block.first; c < block.last; ++c) {
    const double q = cell_quality[c];
    q_min = q < q_min ? q : q_min;
    const double free_q = topology.has_free_node(c) ? q : none;
    q_star_min = free_q < q_star_min ? free_q : q_star_min;
    sum += q;
    n_invalid += q > 0.0 ? 0 : 1;
  }
}

MeshQuality mesh_quality(const std::vector<PartialQuality>& blocks, std::size_t n_cells) {
  double q_min = none, q_star_min = none, sum = 0.0;
  std::size_t n_invalid = 0;
  for (const PartialQuality& block : blocks) {
    q_min = std::min(q_min, block.q_min);
    q_star_min = std::min(q_star_min, block.q_star_min);
    sum += block.sum;
    n_invalid += block.n_invalid;
  }
  return {.q_min = q_min,
          .q_star_min = q_star_min == none ? q_min : q_star_min,
          .q_mean = sum / static_cast<double>(n_cells),
          .n_invalid = n_invalid};
}

namespace {

/// Returns the quality of the whole mesh, from the cells that each part owns. Its sums do not
/// depend on the parts.
MeshQuality quality_of_parts(const Topology& topology, const std::vector<double>& cell_quality) {
  const MeshPart& part = *topology.part();
  struct OfBlock {
    std::array<double, 2> least{none, none};  // of all cells, and of those with a free node
    ExactSum sum;
    std::size_t n_invalid = 0;
  };
  std::vector<OfBlock> blocks(topology.blocks().size());
  parallel_for(blocks.size(), [&](std::size_t b) {
    for (CellIndex c = topology.blocks()[b].first; c < topology.blocks()[b].last; ++c) {
      if (!part.owns_cell(c)) continue;
      auto& [least, sum, n_invalid] = blocks[b];
      const double q = cell_quality[c];
      least[0] = std::min(least[0], q);
      if (topology.has_free_node(c)) least[1] = std::min(least[1], q);
      sum.add(q);
      n_invalid += q > 0.0 ? 0 : 1;
    }
  });
  OfBlock all;
  for (const OfBlock& block : blocks) {
    for (std::size_t k = 0; k < 2; ++k) all.least[k] = std::min(all.least[k], block.least[k]);
    all.sum.add(block.sum);
    all.n_invalid += block.n_invalid;
  }
  part.min(all.least);
  return {.q_min = all.least[0],
          .q_star_min = all.least[1] == none ? all.least[0] : all.least[1],
          .q_mean = all.sum.total(part) / static_cast<double>(part.n_cells_of_whole()),
          .n_invalid = part.sum(all.n_invalid)};
}

}  // namespace

template <int dim, int spacedim>
std::vector<double> cell_mean_ratios(const Mesh<dim, spacedim>& mesh) {
  std::vector<double> quality;
  compute_cell_mean_ratios(mesh, quality);
  return quality;
}

template <int dim, int spacedim>
std::vector<double> corner_mean_ratios(const Mesh<dim, spacedim>& mesh) {
  std::vector<double> quality(mesh.n_cells());
  const auto& blocks = mesh.topology().blocks();
  parallel_for(blocks.size(),
               [&](std::size_t b) { compute_cells(mesh, blocks[b], quality.data()); });
  return quality;
}

template <int dim, int spacedim>
MeshQuality compute_cell_mean_ratios(const Mesh<dim, spacedim>& mesh,
                                     std::vector<double>& cell_quality) {
  const Topology& topology = mesh.topology();
  if (topology.midside()) {
    cell_quality = curved_mean_ratios(mesh);
    return mesh_quality(topology, cell_quality);
  }
  cell_quality.resize(mesh.n_cells());
  std::vector<PartialQuality> parts(topology.blocks().size());
  parallel_for(parts.size(), [&](std::size_t b) {
    compute_cells(mesh, topology.blocks()[b], cell_quality.data());
    parts[b] = PartialQuality(topology, cell_quality, topology.blocks()[b]);
  });
  if (topology.part()) return quality_of_parts(topology, cell_quality);
  return mesh_quality(parts, mesh.n_cells());
}

MeshQuality mesh_quality(const Topology& topology, const std::vector<double>& cell_quality) {
  if (topology.part()) return quality_of_parts(topology, cell_quality);
  std::vector<PartialQuality> parts(topology.blocks().size());
  parallel_for(parts.size(), [&](std::size_t b) {
    parts[b] = PartialQuality(topology, cell_quality, topology.blocks()[b]);
  });
  return mesh_quality(parts, cell_quality.size());
}

template <int dim, int spacedim>
MeshQuality mesh_quality(const Mesh<dim, spacedim>& mesh) {
  return mesh_quality(mesh.topology(), cell_mean_ratios(mesh));
}

std::vector<CellIndex> invalid_cells(std::span<const double> cell_quality) {
  std::vector<CellIndex> invalid;
  for (CellIndex c = 0; c < cell_quality.size(); ++c)
    if (!(cell_quality[c] > 0.0)) invalid.push_back(c);
  return invalid;
}

template <int dim, int spacedim>
std::vector<CellsBelow> count_cells_below(const Mesh<dim, spacedim>& mesh,
                                          std::span<const double> thresholds) {
  std::vector<CellsBelow> counts;
  if (thresholds.empty()) return counts;
  const auto quality = cell_mean_ratios(mesh);
  const MeshPart* const part = mesh.topology().part();
  for (const double threshold : thresholds) {
    auto& count = counts.emplace_back(CellsBelow{.threshold = threshold});
    for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
      if (!(quality[c] < threshold) || (part && !part->owns_cell(c))) continue;
      ++count.n;
      if (mesh.topology().has_free_node(c)) ++count.n_star;
    }
    if (part == nullptr) continue;
    count.n = part->sum(count.n);
    count.n_star = part->sum(count.n_star);
  }
  return counts;
}
template std::vector<CellsBelow> count_cells_below(const PlanarMesh&, std::span<const double>);
template std::vector<CellsBelow> count_cells_below(const VolumeMesh&, std::span<const double>);
template std::vector<CellsBelow> count_cells_below(const SurfaceMesh&, std::span<const double>);

std::vector<std::size_t> quality_histogram(std::span<const double> cell_quality,
                                           std::size_t n_bins) {
  std::vector<std::size_t> counts(n_bins, 0);
  for (const double q : cell_quality) {
    const double bin = std::clamp(q, 0.0, 1.0) * static_cast<double>(n_bins);
    ++counts[std::min(static_cast<std::size_t>(bin), n_bins - 1)];
  }
  return counts;
}

namespace {

/// Words for inverted cells and their repair in error messages.
template <int dim, int spacedim = dim>
struct Words;
template <>
struct Words<2> {
  static constexpr const char* inverted = "clockwise";
  static constexpr const char* all = "all cells run clockwise";
  static constexpr const char* fix = "list the nodes of every cell counterclockwise";
  static constexpr const char* fix_some = "reverse the clockwise cells' nodes";
  static constexpr const char* invalid = "not convex or degenerate";
};
template <>
struct Words<3> {
  static constexpr const char* inverted = "inverted";
  static constexpr const char* all = "all cells are inverted";
  static constexpr const char* fix = "mirror the node order of every cell";
  static constexpr const char* fix_some = "mirror the inverted cells' node order";
  static constexpr const char* invalid = "tangled or degenerate";
};
template <>
struct Words<2, 3> {
  static constexpr const char* inverted = "turned over";
  static constexpr const char* all = "all cells are turned over";
  static constexpr const char* fix = "list the nodes of every cell the other way round";
  static constexpr const char* fix_some = "reverse the nodes of the cells turned over";
  static constexpr const char* invalid = Words<2>::invalid;
};

/// A mesh that is seen from behind is one mistake, not n_cells mistakes.
template <class W>
std::string advice(std::size_t n_inverted, std::size_t n_cells, bool is_of_second_order) {
  if (n_inverted == n_cells) return std::string(W::all) + "; " + W::fix;
  if (is_of_second_order)
    return "their corners alone are invalid; repair them in the mesh generator, or save linear "
           "cells and untangle these (" +
           option_text("untangle") + ")";
  if (n_inverted > 0)
    return std::string(W::fix_some) + ", or untangle the mesh first (" + option_text("untangle") +
           ") if they are inverted";
  return "untangle the mesh first (" + option_text("untangle") + ")";
}

template <int dim>
void print_point(std::ostream& out, const Point<dim>& point) {
  for (int d = 0; d < dim; ++d)
    out << (d == 0 ? '(' : ' ') << point[d] << (d + 1 < dim ? "," : ")");
}

}  // namespace

template <int dim, int spacedim>
void require_valid(const Mesh<dim, spacedim>& mesh, const std::string& path,
                   std::span<const std::size_t> cell_lines) {
  using W = Words<dim, spacedim>;
  constexpr std::size_t n_named = 3;
  const auto& topology = mesh.topology();
  const auto invalid = invalid_cells(cell_mean_ratios(mesh));
  if (invalid.empty()) return;
  const auto n_inverted =
      static_cast<std::size_t>(std::count_if(invalid.begin(), invalid.end(), [&](CellIndex c) {
        return signed_cell_size(mesh, c) < 0.0;
      }));

  std::ostringstream message;
  if (!path.empty()) {
    message << path;
    if (!cell_lines.empty()) message << ':' << cell_lines[invalid.front()];
    message << ": ";
  }
  message << invalid.size() << " of " << mesh.n_cells()
          << (invalid.size() == 1 ? " cells is invalid: " : " cells are invalid: ");
  for (std::size_t i = 0; i < std::min(n_named, invalid.size()); ++i) {
    const CellIndex c = invalid[i];
    message << (i > 0 ? ", " : "") << "cell " << topology.labels().cell_number(c) << " at ";
    print_point<spacedim>(message, mesh.coordinates()[topology.cell_nodes(c)[0]]);
    message << " is " << (signed_cell_size(mesh, c) < 0.0 ? W::inverted : W::invalid);
  }
  if (invalid.size() > n_named) message << ", ...";
  const bool are_corners_valid =
      topology.midside() && mesh_quality(with_linear_cells(mesh)).n_invalid == 0;
  message << "; "
          << (are_corners_valid
                  ? "their corners are valid, but midside nodes bend them too much: 'smoothfem "
                    "smooth' moves these towards their straight places"
                  : advice<W>(n_inverted, mesh.n_cells(), topology.midside() != nullptr));
  throw InputError(message.str());
}

#define SMOOTHFEM_INSTANTIATE(MESH)                                                 \
  template std::vector<double> cell_mean_ratios(const MESH&);                       \
  template std::vector<double> corner_mean_ratios(const MESH&);                     \
  template MeshQuality compute_cell_mean_ratios(const MESH&, std::vector<double>&); \
  template MeshQuality mesh_quality(const MESH&);                                   \
  template void require_valid(const MESH&, const std::string&, std::span<const std::size_t>);
SMOOTHFEM_INSTANTIATE(PlanarMesh)
SMOOTHFEM_INSTANTIATE(VolumeMesh)
SMOOTHFEM_INSTANTIATE(SurfaceMesh)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
