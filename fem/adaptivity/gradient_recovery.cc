// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/adaptivity/gradient_recovery.h"

#include <cmath>

#include "fem/assembly/cell_function.h"

namespace smoothfem {

namespace {

/// The linear function (linear like the mapping) on one cell with the same values at the nodes.
template <int dim, std::size_t n_vertices>
struct LinearInterpolant {
  std::array<Vector<dim, double>, n_vertices> vertices;
  std::array<double, n_vertices> values;

  LinearInterpolant(const FiniteElementSpace<dim>& space, const ElementCells& group,
                    std::size_t cell, const std::vector<Point<dim>>& x, const Eigen::VectorXd& u)
      : vertices(cell_vertices<dim, n_vertices>(group, cell, x)) {
    for (std::size_t v = 0; v < n_vertices; ++v)
      values[v] = u[space.vertex_dof[group.vertices[cell * n_vertices + v]]];
  }

  /// Calls visit(q, mapped point, gradient) for the points of a rule.
  template <class Visit>
  void for_each_point(const QuadratureTable& table, const Visit& visit) const {
    for (std::size_t q = 0; q < table.n_points; ++q) {
      const auto mapped = map_point<dim, double>(table, q, vertices);
      std::array<double, dim> reference{};
      for (std::size_t v = 0; v < n_vertices; ++v)
        for (std::size_t d = 0; d < dim; ++d)
          reference[d] += values[v] * table.geometry_gradient[dim * (q * n_vertices + v) + d];
      visit(q, mapped, point_of(mapped.jacobian.gradient(reference.data())));
    }
  }
};

}  // namespace

template <int dim>
GradientRecovery<dim>::GradientRecovery(const FiniteElementSpace<dim>& space,
                                        const std::vector<Point<dim>>& x, const Eigen::VectorXd& u,
                                        const ManufacturedSolution<dim>& solution)
    : space_(space), x_(x), u_(u), solution_(solution), recovered_(x.size(), Point<dim>::Zero()) {
  std::vector<double> sizes_at_nodes(x.size(), 0.0);
  for_each_smooth_group(space_, [&]<std::size_t n_dofs, std::size_t n_vertices>(
                                    const ElementCells& group, std::size_t) {
    for (std::size_t cell = 0; cell < group.n_cells(); ++cell) {
      Point<dim> integral = Point<dim>::Zero();
      double size = 0.0;
      LinearInterpolant<dim, n_vertices>(space_, group, cell, x, u)
          .for_each_point(group.element.matrices,
                          [&](std::size_t, const auto& mapped, const Point<dim>& gradient) {
                            integral += mapped.weight * gradient;
                            size += mapped.weight;
                          });
      for (std::size_t v = 0; v < n_vertices; ++v) {
        recovered_[group.vertices[cell * n_vertices + v]] += integral;
        sizes_at_nodes[group.vertices[cell * n_vertices + v]] += size;
      }
      sizes_.push_back(size);
    }
  });
  for (std::size_t i = 0; i < recovered_.size(); ++i)
    if (sizes_at_nodes[i] > 0.0) recovered_[i] /= sizes_at_nodes[i];
}

template <int dim>
template <class Value, class Square>
std::vector<Value> GradientRecovery<dim>::mean_squares(const Value& zero,
                                                       const Square& square) const {
  std::vector<Value> means;
  for_each_smooth_group(space_, [&]<std::size_t n_dofs, std::size_t n_vertices>(
                                    const ElementCells& group, std::size_t) {
    const QuadratureTable& table = group.element.matrices;
    for (std::size_t cell = 0; cell < group.n_cells(); ++cell) {
      Value sum = zero;
      LinearInterpolant<dim, n_vertices>(space_, group, cell, x_, u_)
          .for_each_point(table,
                          [&](std::size_t q, const auto& mapped, const Point<dim>& gradient) {
                            Point<dim> difference = -gradient;
                            for (std::size_t v = 0; v < n_vertices; ++v)
                              difference += table.geometry[q * n_vertices + v] *
                                            recovered_[group.vertices[cell * n_vertices + v]];
                            sum += mapped.weight * square(difference, point_of(mapped.position));
                          });
      means.push_back(sum / sizes_[means.size()]);
    }
  });
  return means;
}

template <int dim>
std::vector<double> GradientRecovery<dim>::differences() const {
  auto values = mean_squares(0.0, [&](const Point<dim>& d, const Point<dim>& position) {
    return solution_.energy_of(d, position);
  });
  for (double& value : values) value = std::sqrt(value);
  return values;
}

template <int dim>
std::vector<CellTensor<dim>> GradientRecovery<dim>::difference_tensors() const {
  const CellTensor<dim> zero = CellTensor<dim>::Zero();
  return mean_squares(
      zero, [&](const Point<dim>& d, const Point<dim>& position) -> CellTensor<dim> {
        const CellTensor<dim> square =
            d * d.transpose();  // exactly symmetric, while that times a weight may not be
        if (!solution_.diffusivity || !(square.trace() > 0.0)) return square;
        return solution_.energy_of(d, position) / square.trace() * square;
      });
}

template <int dim>
std::vector<CellTensor<dim>> GradientRecovery<dim>::hessians() const {
  const auto root_of_scale = [&](const auto& mapped) {
    return solution_.diffusivity
               ? std::sqrt(solution_.diffusivity(point_of(mapped.position)).trace() / dim)
               : 1.0;
  };
  std::vector<CellTensor<dim>> means;
  for_each_smooth_group(space_, [&]<std::size_t n_dofs, std::size_t n_vertices>(
                                    const ElementCells& group, std::size_t) {
    const QuadratureTable& table = group.element.matrices;
    for (std::size_t cell = 0; cell < group.n_cells(); ++cell) {
      CellTensor<dim> sum = CellTensor<dim>::Zero();
      LinearInterpolant<dim, n_vertices>(space_, group, cell, x_, u_)
          .for_each_point(table, [&](std::size_t q, const auto& mapped, const Point<dim>&) {
            const double weight = mapped.weight * root_of_scale(mapped);
            for (std::size_t v = 0; v < n_vertices; ++v) {
              const Point<dim> hat = point_of(
                  mapped.jacobian.gradient(&table.geometry_gradient[dim * (q * n_vertices + v)]));
              sum += weight * (recovered_[group.vertices[cell * n_vertices + v]] * hat.transpose());
            }
          });
      means.push_back((sum + sum.transpose()) / (2.0 * sizes_[means.size()]));
    }
  });
  return means;
}

template class GradientRecovery<2>;
template class GradientRecovery<3>;

}  // namespace smoothfem
