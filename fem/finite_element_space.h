#pragma once

#include <Eigen/SparseCore>
#include <cstdint>
#include <memory>
#include <vector>

#include "fem/reference_element.h"
#include "smoothing/mesh/mesh.h"

namespace smoothfem {

/// Rows compressed, columns ascending.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor, int>;

/// Everything about continuous Lagrange elements of degree 1 or 2 on a planar mesh that does not
/// depend on coordinates: made once, used for every mesh that smoothing produces.
struct FiniteElementSpace {
  static constexpr std::uint32_t absent = UINT32_MAX;

  int degree = 0;
  std::size_t n_dofs = 0;
  std::size_t n_free = 0;  ///< dofs that are not on the boundary

  ReferenceElement triangle, quadrilateral;
  std::vector<std::uint32_t> triangle_cells, quadrilateral_cells;  ///< which cells are which
  CompressedRows<NodeIndex> cell_vertices;  ///< mesh nodes in the element's order
  CompressedRows<std::uint32_t> cell_dofs;  ///< in the element's order

  /// Mesh nodes whose mean is a dof's place: a node, the two ends of an edge, or a cell's four
  /// nodes.
  CompressedRows<NodeIndex> dof_nodes;
  std::vector<std::uint32_t> free_number;  ///< of each dof; absent on the boundary
  std::vector<std::uint32_t> free_dofs;    ///< the dof of each free number
  std::vector<std::uint32_t> vertex_dof;   ///< the dof at each mesh node; absent at unused nodes

  SparseMatrix pattern;  ///< of the free dofs' matrix
  /// For each cell its n_dofs x n_dofs places in the values of `pattern`; absent for boundary dofs.
  CompressedRows<std::uint32_t> matrix_places;

  const ReferenceElement& element_of(std::size_t cell) const {
    return cell_vertices[cell].size() == 3 ? triangle : quadrilateral;
  }

  /// Where the dofs are on a mesh with these node coordinates.
  std::vector<Point<2>> dof_points(const std::vector<Point<2>>& coordinates) const;
};

/// degree: 1 or 2. n_quadrilateral_points: see make_reference_element. Dofs are numbered by deal.II
/// as cells come: CG's counts on badly conditioned matrices hang on rounding, hence on the order,
/// and this one comes closest to the thesis' counts. mesh: its coordinates need not be valid.
/// Throws InputError for cells with more than four nodes, naming the first, and if no dof is free.
std::shared_ptr<const FiniteElementSpace> make_finite_element_space(const PlanarMesh& mesh,
                                                                    int degree,
                                                                    int n_quadrilateral_points);

}  // namespace smoothfem
