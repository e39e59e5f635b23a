// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/solutions/check_pieces.h"

#include <cmath>

#include "fem/solutions/check_solution.h"
#include "smoothing/mesh/volume_elements.h"

namespace smoothfem {

namespace {

template <int dim>
class PieceCheck {
 public:
  PieceCheck(const ManufacturedSolution<dim>& solution, const Mesh<dim>& mesh)
      : s_(solution), mesh_(mesh) {
    for (const auto& p : mesh.coordinates()) {
      conditions_.push_back(s_.conditions(p));
      const double u = std::abs(s_.value(p)), flux = flux_at(p).norm();
      if (std::isfinite(u)) largest_value_ = std::max(largest_value_, u);
      if (std::isfinite(flux)) largest_flux_ = std::max(largest_flux_, flux);
    }
  }

  void run() const {
    const Topology& topology = mesh_.topology();
    for (CellIndex c = 0; c < topology.n_cells(); ++c) {
      const auto nodes = topology.cell_nodes(c);
      for_each_edge(dim, nodes.size(), [&](std::size_t i, std::size_t j) {
        check_edge(nodes[i], nodes[j]);
        check_edge(nodes[j], nodes[i]);
      });
    }
  }

 private:
  /// Checks an edge from one node to the other. If pieces meet exactly at its end and the mesh
  /// continues there, checks a little further.
  void check_edge(NodeIndex from, NodeIndex to) const {
    const Point<dim> a = mesh_.coordinates()[from], b = mesh_.coordinates()[to];
    const Point<dim> behind = b + 1e-6 * (b - a);
    for (std::size_t k = 0; k < conditions_[from].size(); ++k) {
      const double here = conditions_[from][k], there = conditions_[to][k];
      if (here < 0.0 && there > 0.0)
        check_jumps(a, b, k);
      else if (here != 0.0 && there == 0.0 && !mesh_.topology().on_boundary()[to] &&
               here * s_.conditions(behind)[k] < 0.0)
        check_jumps(a, behind, k);
    }
  }

  Point<dim> flux_at(const Point<dim>& p) const {
    const Point<dim> gradient = s_.value_and_gradient(p).gradient;
    return s_.diffusivity ? Point<dim>(s_.diffusivity(p) * gradient) : gradient;
  }

  /// Compares two points on both sides of the k-th condition. They are so close to its change that
  /// crossing it changes the values by far less than the tolerance.
  void check_jumps(Point<dim> a, Point<dim> b, std::size_t k) const {
    constexpr double allowed = 1e-5;
    constexpr int n_halvings = 30;
    const double size = (b - a).norm();
    const bool a_is_below = s_.conditions(a)[k] < 0.0;
    for (int i = 0; i < n_halvings; ++i) {
      const Point<dim> middle = 0.5 * (a + b);
      ((s_.conditions(middle)[k] < 0.0) == a_is_below ? a : b) = middle;
    }
    const double u_jump = std::abs(s_.value(b) - s_.value(a));
    if (u_jump > allowed * largest_value_)
      refuse("'u' jumps by " + std::to_string(u_jump), a, "use pieces with equal values there");
    Point<dim> normal;
    const double h = 1e-4 * size;
    for (int d = 0; d < dim; ++d) {
      const Point<dim> step = h * Point<dim>::Unit(d);
      normal[d] = s_.conditions(a + step)[k] - s_.conditions(a - step)[k];
    }
    const double flux_jump = std::abs((flux_at(b) - flux_at(a)).dot(normal.normalized()));
    if (normal.norm() > 0.0 && flux_jump > allowed * largest_flux_)
      refuse("normal flux, diffusivity times derivative, jumps by " + std::to_string(flux_jump), a,
             "use pieces with equal fluxes there");
  }

  [[noreturn]] static void refuse(const std::string& what, const Point<dim>& p,
                                  const std::string& advice) {
    throw InputError("the solution's " + what + " at " + point_text<dim>(p) +
                     ", where a condition of its formulas changes: " + advice);
  }

  const ManufacturedSolution<dim>& s_;
  const Mesh<dim>& mesh_;
  std::vector<std::vector<double>> conditions_;  ///< at each node
  double largest_value_ = 0.0, largest_flux_ = 0.0;
};

}  // namespace

template <int dim>
void check_pieces(const ManufacturedSolution<dim>& solution, const Mesh<dim>& mesh) {
  if (solution.conditions) PieceCheck<dim>(solution, mesh).run();
}

template void check_pieces(const ManufacturedSolution<2>&, const Mesh<2>&);
template void check_pieces(const ManufacturedSolution<3>&, const Mesh<3>&);

}  // namespace smoothfem
