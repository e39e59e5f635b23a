// SPDX-License-Identifier: GPL-3.0-or-later
#include <exception>

#include "fem/space/numbered_dofs.h"

namespace smoothfem {

template <int dim>
void require_finite_elements(const Topology& topology, int degree,
                             const std::vector<std::string>& natural_groups) {
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const ElementType type = topology.cell_type(c);
    if (type == ElementType::polygon)
      throw CellError(c, "has " + std::to_string(topology.cell_nodes(c).size()) +
                             " nodes; finite elements are solved on triangles and quadrilaterals "
                             "only, so split the polygons first");
    if (degree > 1 && (type == ElementType::pyramid || type == ElementType::prism))
      throw CellError(c, "is a " + std::string(name_of(type)) +
                             "; finite elements of degree 2 are solved on meshes of tetrahedra or "
                             "of hexahedra only, so use degree 1, or split the cells first");
    if (degree > 1 && dim == 3 && type != topology.cell_type(0))
      throw CellError(c, "is a " + std::string(name_of(type)) +
                             " among cells of another type; finite elements of degree 2 are solved "
                             "on meshes of tetrahedra or of hexahedra only, so use degree 1");
  }
  require_natural_groups(topology, natural_groups);
}

template void require_finite_elements<2>(const Topology&, int, const std::vector<std::string>&);
template void require_finite_elements<3>(const Topology&, int, const std::vector<std::string>&);

template <int dim>
void require_on_all_ranks(const Topology* topology, int degree,
                          const std::vector<std::string>& natural_groups, const Ranks& ranks) {
  const auto check = [&] { require_finite_elements<dim>(*topology, degree, natural_groups); };
  if (topology != nullptr && topology->part() != nullptr)
    ranks.together(check);
  else
    ranks.on_root(check);
}

template void require_on_all_ranks<2>(const Topology*, int, const std::vector<std::string>&,
                                      const Ranks&);
template void require_on_all_ranks<3>(const Topology*, int, const std::vector<std::string>&,
                                      const Ranks&);

}  // namespace smoothfem
