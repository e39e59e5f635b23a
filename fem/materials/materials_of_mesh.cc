// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/materials/materials_of_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fem/materials/cell_kinds.h"
#include "fem/solutions/check_solution.h"
#include "smoothing/base/find_named.h"
#include "smoothing/mesh/interfaces.h"

namespace smoothfem {

namespace {

template <int dim>
Point<dim> mean_of_nodes(const Mesh<dim>& mesh, CellIndex cell) {
  Point<dim> sum = Point<dim>::Zero();
  const auto nodes = mesh.topology().cell_nodes(cell);
  for (const NodeIndex node : nodes) sum += mesh.coordinates()[node];
  return sum / static_cast<double>(nodes.size());
}

template <int dim>
class MaterialFinder {
 public:
  MaterialFinder(const ManufacturedSolution<dim>& solution, const Mesh<dim>& mesh)
      : solution_(solution),
        mesh_(mesh),
        kinds_(cell_kinds(mesh.topology())),
        groups_(groups_of_kinds(mesh.topology(), kinds_)) {}

  std::vector<std::uint32_t> find() const {
    return solution_.material_at ? by_position() : by_group();
  }

 private:
  static constexpr std::uint32_t none = UINT32_MAX;

  std::vector<std::uint32_t> by_position() const {
    std::vector<std::uint32_t> materials(groups_.size(), none);
    for (CellIndex c = 0; c < mesh_.n_cells(); ++c) {
      const Point<dim> centre = mean_of_nodes(mesh_, c);
      const auto here = static_cast<std::uint32_t>(solution_.material_at(centre));
      auto& known = materials[kinds_[c]];
      if (known != none && known != here)
        throw InputError(
            "the solution's diffusivity is 'piecewise by tag', but cells of " +
            text_of(groups_[kinds_[c]]) + " lie on both sides of its interface, one of them at " +
            point_text<dim>(centre) +
            ": give the cells of each side a group of their own, or leave 'diffusivity' out");
      known = here;
    }
    return materials;
  }

  std::vector<std::uint32_t> by_group() const {
    std::vector<std::uint32_t> materials(groups_.size(), none);
    for (std::uint32_t m = 0; m < solution_.materials.size(); ++m) {
      const std::string& group = solution_.materials[m].group;
      bool is_there = group.empty();
      for (std::size_t kind = 0; kind < groups_.size(); ++kind) {
        const auto& names = groups_[kind];
        if (std::find(names.begin(), names.end(), group) == names.end()) continue;
        is_there = true;
        if (materials[kind] != none)
          throw InputError("the solution has a diffusivity for the group '" + group +
                           "' and one for '" + solution_.materials[materials[kind]].group +
                           "', but cells of the mesh are in both: take one of them out");
        materials[kind] = m;
      }
      if (!is_there) refuse_group(group);
    }
    // The material without a group is the last one.
    std::replace(materials.begin(), materials.end(), none,
                 static_cast<std::uint32_t>(solution_.materials.size() - 1));
    return materials;
  }

  [[noreturn]] void refuse_group(const std::string& group) const {
    std::vector<std::string> known;
    for (const auto& names : groups_)
      for (const auto& name : names)
        if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
    throw InputError("the solution has a diffusivity for the group '" + group +
                     "', which no cell of the mesh has; " +
                     (known.empty() ? "its cells have no groups" : choose_one_of(known, group)));
  }

  static std::string text_of(const std::vector<std::string>& groups) {
    return groups.empty() ? "no group" : "the group '" + groups.back() + "'";
  }

  const ManufacturedSolution<dim>& solution_;
  const Mesh<dim>& mesh_;
  const std::vector<std::uint32_t> kinds_;
  const std::vector<std::vector<std::string>> groups_;
};

/// Checks a solution with materials on the mesh for which these were found.
template <int dim>
class MaterialCheck {
 public:
  MaterialCheck(const ManufacturedSolution<dim>& solution, const Mesh<dim>& mesh)
      : solution_(solution), mesh_(mesh), kinds_(cell_kinds(mesh.topology())) {}

  void run() const {
    check_interfaces();
    for (std::uint32_t m = 0; m < solution_.materials.size(); ++m) check_material(m);
  }

 private:
  const Material<dim>& material(CellIndex c) const {
    return solution_.materials[solution_.material_of_kind[kinds_[c]]];
  }

  /// Checks A and f of a material like those of a solution, at nodes of some of its cells.
  void check_material(std::uint32_t m) const {
    constexpr std::size_t n_samples = 20;
    std::vector<CellIndex> cells;
    for (CellIndex c = 0; c < mesh_.n_cells(); ++c)
      if (solution_.material_of_kind[kinds_[c]] == m) cells.push_back(c);
    std::vector<Point<dim>> sample;
    for (std::size_t k = 0; k < cells.size();
         k += std::max<std::size_t>(1, cells.size() / n_samples))
      sample.push_back(
          slightly_inside<dim>(mesh_.coordinates()[mesh_.topology().cell_nodes(cells[k])[0]],
                               mean_of_nodes(mesh_, cells[k])));
    ManufacturedSolution<dim> alone = solution_;
    alone.diffusivity = solution_.materials[m].diffusivity;
    alone.load = solution_.materials[m].load;
    check_solution<dim>(
        alone, {"'u'", "gradient, derived from 'u',", "load, derived from 'u',", true}, sample);
  }

  /// Checks at the nodes between two materials that u and the normal flux are the same on both
  /// sides.
  void check_interfaces() const {
    const Interfaces interfaces = inner_interfaces(mesh_.topology());
    double largest_value = 0.0, largest_flux = 0.0;
    for (CellIndex c = 0; c < mesh_.n_cells(); ++c) {
      const Point<dim> centre = mean_of_nodes(mesh_, c);
      largest_value = std::max(largest_value, std::abs(solution_.value(centre)));
      largest_flux = std::max(largest_flux, flux(c, centre).norm());
    }
    for (std::size_t f = 0; f < interfaces.facets.size(); ++f) {
      const auto facet = interfaces.facets[f];
      const auto cells = cells_of(facet);
      if (cells.size() != 2 || &material(cells[0]) == &material(cells[1])) continue;
      for (const NodeIndex node : facet) {
        const Point<dim>& p = mesh_.coordinates()[node];
        const Point<dim> a = slightly_inside<dim>(p, mean_of_nodes(mesh_, cells[0])),
                         b = slightly_inside<dim>(p, mean_of_nodes(mesh_, cells[1]));
        constexpr double allowed = 1e-4;
        if (std::abs(solution_.value(a) - solution_.value(b)) > allowed * largest_value)
          refuse("'u' jumps", p, "use pieces with equal values there");
        const double jump =
            std::abs((flux(cells[0], a) - flux(cells[1], b)).dot(normal(facet, p, a, b)));
        if (jump > allowed * largest_flux)
          refuse("normal flux, diffusivity times derivative, jumps by " + std::to_string(jump), p,
                 "use pieces with equal fluxes there, which meet where the groups do");
      }
    }
  }

  std::vector<CellIndex> cells_of(std::span<const NodeIndex> facet) const {
    std::vector<CellIndex> cells;
    for (const CellIndex c : mesh_.topology().node_cells(facet[0])) {
      const auto nodes = mesh_.topology().cell_nodes(c);
      if (std::all_of(facet.begin(), facet.end(), [&](NodeIndex node) {
            return std::find(nodes.begin(), nodes.end(), node) != nodes.end();
          }))
        cells.push_back(c);
    }
    return cells;
  }

  Point<dim> flux(CellIndex c, const Point<dim>& p) const {
    return material(c).diffusivity(p) * solution_.value_and_gradient(p).gradient;
  }

  /// Returns the unit normal of an interface at one of its nodes: of a condition of the formulas
  /// that changes there, because facets approximate a curved interface, otherwise of the facet.
  Point<dim> normal(std::span<const NodeIndex> facet, const Point<dim>& p, const Point<dim>& a,
                    const Point<dim>& b) const {
    const auto& x = mesh_.coordinates();
    const Point<dim> edge = x[facet[1]] - x[facet[0]];
    if (solution_.conditions) {
      const auto at_a = solution_.conditions(a), at_b = solution_.conditions(b);
      for (std::size_t k = 0; k < at_a.size(); ++k) {
        if ((at_a[k] < 0.0) == (at_b[k] < 0.0)) continue;
        Point<dim> slope;
        const double h = 1e-4 * edge.norm();
        for (int d = 0; d < dim; ++d) {
          const Point<dim> step = h * Point<dim>::Unit(d);
          slope[d] = solution_.conditions(p + step)[k] - solution_.conditions(p - step)[k];
        }
        if (slope.norm() > 0.0) return slope.normalized();
      }
    }
    if constexpr (dim == 2)
      return Point<2>(edge.y(), -edge.x()).normalized();
    else
      return edge.cross(x[facet[2]] - x[facet[0]]).normalized();
  }

  [[noreturn]] static void refuse(const std::string& what, const Point<dim>& p,
                                  const std::string& advice) {
    throw InputError("the solution's " + what + " at " + point_text<dim>(p) +
                     ", a node between two materials: " + advice);
  }

  const ManufacturedSolution<dim>& solution_;
  const Mesh<dim>& mesh_;
  const std::vector<std::uint32_t> kinds_;
};

}  // namespace

template <int dim>
ManufacturedSolution<dim> with_materials_of(ManufacturedSolution<dim> solution,
                                            const Mesh<dim>& mesh) {
  solution.material_of_kind = MaterialFinder<dim>(solution, mesh).find();
  MaterialCheck<dim>(solution, mesh).run();
  return solution;
}
template ManufacturedSolution<2> with_materials_of(ManufacturedSolution<2>, const Mesh<2>&);
template ManufacturedSolution<3> with_materials_of(ManufacturedSolution<3>, const Mesh<3>&);

}  // namespace smoothfem
