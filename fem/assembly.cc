#include "fem/assembly.h"

#include "fem/cell_integrals.h"

namespace smoothfem {

namespace {

constexpr auto absent = FiniteElementSpace::absent;

/// What a cell's matrices are added to.
struct Target {
  const FiniteElementSpace& space;
  const Eigen::VectorXd& nodal_load;  ///< f at all dofs; empty where the load comes by quadrature
  PoissonSystem& system;

  /// stiffness, mass: upper triangles; `lane`: which of the batch's cells.
  template <std::size_t n_dofs>
  void add(std::uint32_t cell, const CellMatrices<n_dofs, Lanes>& matrices, std::size_t lane) {
    const auto dofs = space.cell_dofs[cell];
    const auto places = space.matrix_places[cell];
    double* values = system.matrix.valuePtr();
    for (std::size_t i = 0, p = 0; i < n_dofs; ++i)
      for (std::size_t j = i; j < n_dofs; ++j, ++p) {
        const double stiffness = matrices.stiffness[p][lane], mass = matrices.mass[p][lane];
        add_entry(dofs[i], dofs[j], places[i * n_dofs + j], stiffness, mass, values);
        if (i != j) add_entry(dofs[j], dofs[i], places[j * n_dofs + i], stiffness, mass, values);
      }
  }

 private:
  void add_entry(std::uint32_t row, std::uint32_t column, std::uint32_t place, double stiffness,
                 double mass, double* values) {
    const std::uint32_t free_row = space.free_number[row];
    if (free_row == absent) return;
    double& b = system.right_hand_side[free_row];
    if (place != absent)
      values[place] += stiffness;
    else
      b -= stiffness * system.exact[column];
    if (nodal_load.size() > 0) b += mass * nodal_load[column];
  }
};

// One function an element: templates are not compiled for wider registers.
SMOOTHFEM_VECTOR_CLONES void compute_matrices(const QuadratureTable& table,
                                              const CellBatch<3>& batch,
                                              CellMatrices<3, Lanes>& matrices) {
  matrices.compute(table, batch.vertices);
}
SMOOTHFEM_VECTOR_CLONES void compute_matrices(const QuadratureTable& table,
                                              const CellBatch<3>& batch,
                                              CellMatrices<6, Lanes>& matrices) {
  matrices.compute(table, batch.vertices);
}
SMOOTHFEM_VECTOR_CLONES void compute_matrices(const QuadratureTable& table,
                                              const CellBatch<4>& batch,
                                              CellMatrices<4, Lanes>& matrices) {
  matrices.compute(table, batch.vertices);
}
SMOOTHFEM_VECTOR_CLONES void compute_matrices(const QuadratureTable& table,
                                              const CellBatch<4>& batch,
                                              CellMatrices<9, Lanes>& matrices) {
  matrices.compute(table, batch.vertices);
}

/// b_i += integral of f phi_i over the cells of one element.
template <std::size_t n_dofs, std::size_t n_vertices>
void add_quadrature_load(const FiniteElementSpace& space, const QuadratureTable& table,
                         const std::vector<std::uint32_t>& cells, const std::vector<Point<2>>& x,
                         const ManufacturedSolution& solution, Eigen::VectorXd& right_hand_side) {
  for (const std::uint32_t cell : cells) {
    std::array<Vector2<double>, n_vertices> vertices;
    for (std::size_t v = 0; v < n_vertices; ++v)
      vertices[v] = vector_of(x[space.cell_vertices[cell][v]]);
    for (std::size_t q = 0; q < table.n_points; ++q) {
      const auto mapped = map_point(table, q, vertices);
      const double f = solution.load(point_of(mapped.place)) * mapped.weight;
      for (std::size_t i = 0; i < n_dofs; ++i) {
        const std::uint32_t row = space.free_number[space.cell_dofs[cell][i]];
        if (row != absent) right_hand_side[row] += f * table.shape[q * n_dofs + i];
      }
    }
  }
}

}  // namespace

PoissonSystem make_system(const FiniteElementSpace& space) {
  return {.matrix = space.pattern,
          .right_hand_side = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.n_free)),
          .exact = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(space.n_dofs))};
}

void assemble(const FiniteElementSpace& space, const std::vector<Point<2>>& coordinates,
              const ManufacturedSolution& solution, Load load, PoissonSystem& system) {
  const auto points = space.dof_points(coordinates);
  Eigen::VectorXd nodal_load;
  if (load == Load::nodal) nodal_load.resize(static_cast<Eigen::Index>(space.n_dofs));
  for (std::size_t dof = 0; dof < space.n_dofs; ++dof) {
    const auto i = static_cast<Eigen::Index>(dof);
    system.exact[i] = solution.value(points[dof]);
    if (load == Load::nodal) nodal_load[i] = solution.load(points[dof]);
  }
  system.matrix.coeffs().setZero();
  system.right_hand_side.setZero();
  Target target{space, nodal_load, system};
  for_each_element(
      space, [&]<std::size_t n_dofs, std::size_t n_vertices>(
                 const ReferenceElement& element, const std::vector<std::uint32_t>& cells) {
        CellMatrices<n_dofs, Lanes> matrices;
        for (std::size_t c = 0; c < cells.size(); c += n_lanes) {
          const CellBatch<n_vertices> batch(space, coordinates, &cells[c],
                                            std::min(n_lanes, cells.size() - c));
          compute_matrices(element.matrices, batch, matrices);
          for (std::size_t l = 0; l < batch.size; ++l) target.add(batch.cells[l], matrices, l);
        }
        if (load == Load::quadrature)
          add_quadrature_load<n_dofs, n_vertices>(space, element.errors, cells, coordinates,
                                                  solution, system.right_hand_side);
      });
}

}  // namespace smoothfem
