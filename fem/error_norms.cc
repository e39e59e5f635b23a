#include "fem/error_norms.h"

#include <cmath>

#include "fem/cell_integrals.h"

namespace smoothfem {

namespace {

/// Integrals over cells of squares: of a function's values and of its gradients.
struct SquareSums {
  double values = 0.0;
  double gradients = 0.0;

  void add(double weight, double value, const Vector2<double>& gradient) {
    values += weight * value * value;
    gradients += weight * squared_length(gradient);
  }
};

/// A finite element function's value and gradient at a mapped point.
struct FunctionAtPoint {
  double value = 0.0;
  Vector2<double> gradient{0.0, 0.0};

  template <std::size_t n_dofs>
  FunctionAtPoint(const std::array<double, n_dofs>& coefficients, const double* shape,
                  const double* shape_gradient, const MappedPoint<double>& mapped) {
    Vector2<double> reference{0.0, 0.0};
    for (std::size_t i = 0; i < n_dofs; ++i) {
      value += coefficients[i] * shape[i];
      reference.x += coefficients[i] * shape_gradient[2 * i];
      reference.y += coefficients[i] * shape_gradient[2 * i + 1];
    }
    const double components[2] = {reference.x, reference.y};
    gradient = mapped.gradient(components);
  }
};

}  // namespace

ErrorNorms error_norms(const FiniteElementSpace& space, const std::vector<Point<2>>& coordinates,
                       const ManufacturedSolution& solution, const Eigen::VectorXd& exact,
                       const Eigen::VectorXd& discrete) {
  ErrorNorms norms;
  for (const std::uint32_t dof : space.free_dofs) {
    const double error = std::abs(exact[dof] - discrete[dof]);
    norms.e_max = std::max(norms.e_max, error);
    norms.e_mean += error;
  }
  norms.e_mean /= static_cast<double>(space.n_free);

  SquareSums nodal, true_error;
  for_each_element(space, [&]<std::size_t n_dofs, std::size_t n_vertices>(
                              const ReferenceElement& element,
                              const std::vector<std::uint32_t>& cells) {
    const QuadratureTable& table = element.errors;
    for (const std::uint32_t cell : cells) {
      std::array<Vector2<double>, n_vertices> vertices;
      for (std::size_t v = 0; v < n_vertices; ++v)
        vertices[v] = vector_of(coordinates[space.cell_vertices[cell][v]]);
      std::array<double, n_dofs> difference, approximation;
      for (std::size_t i = 0; i < n_dofs; ++i) {
        const std::uint32_t dof = space.cell_dofs[cell][i];
        difference[i] = exact[dof] - discrete[dof];
        approximation[i] = discrete[dof];
      }
      for (std::size_t q = 0; q < table.n_points; ++q) {
        const auto mapped = map_point(table, q, vertices);
        const double* shape = &table.shape[q * n_dofs];
        const double* shape_gradient = &table.shape_gradient[2 * q * n_dofs];
        const FunctionAtPoint e_h(difference, shape, shape_gradient, mapped);
        const FunctionAtPoint u_h(approximation, shape, shape_gradient, mapped);
        const Point<2> place = point_of(mapped.place);
        const Vector2<double> gradient = vector_of(solution.gradient(place));
        nodal.add(mapped.weight, e_h.value, e_h.gradient);
        true_error.add(mapped.weight, solution.value(place) - u_h.value, gradient - u_h.gradient);
      }
    }
  });
  norms.e_l2 = std::sqrt(nodal.values);
  norms.e_h1 = std::sqrt(nodal.values + nodal.gradients);
  norms.l2_error = std::sqrt(true_error.values);
  norms.h1_error = std::sqrt(true_error.values + true_error.gradients);
  return norms;
}

}  // namespace smoothfem
