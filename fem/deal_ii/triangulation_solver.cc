// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/deal_ii/triangulation_solver.h"

#include <deal.II/lac/solver_control.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "fem/elements/single_threaded.h"
#include "fem/space/fill_triangulation.h"
#include "smoothing/base/text.h"
#include "smoothing/loop/plugin.h"

namespace smoothfem {

namespace {

/// Returns an id of deal.II for a tag.
unsigned int id_of(int tag) {
  if (tag < 0)
    throw InputError("the mesh has the tag " + std::to_string(tag) +
                     ", but deal.II has no ids below 0; give the group another tag");
  return static_cast<unsigned int>(tag);
}

/// Returns the tag of a labelled facet by its sorted nodes.
std::map<std::vector<NodeIndex>, int> facet_tags_of(const MeshLabels& labels) {
  std::map<std::vector<NodeIndex>, int> tags;
  for (std::size_t f = 0; f < labels.facets.size(); ++f) {
    std::vector<NodeIndex> nodes(labels.facets[f].begin(), labels.facets[f].end());
    std::sort(nodes.begin(), nodes.end());
    tags.emplace(std::move(nodes), labels.facet_tags[f]);
  }
  return tags;
}

template <int dim>
void set_boundary_ids(const MeshLabels& labels, dealii::Triangulation<dim>& triangulation) {
  const auto tags = facet_tags_of(labels);
  if (tags.empty()) return;
  std::vector<NodeIndex> nodes;
  for (const auto& face : triangulation.active_face_iterators()) {
    if (!face->at_boundary()) continue;
    nodes.clear();
    for (const unsigned int v : face->vertex_indices()) nodes.push_back(face->vertex_index(v));
    std::sort(nodes.begin(), nodes.end());
    if (const auto tag = tags.find(nodes); tag != tags.end())
      face->set_all_boundary_ids(id_of(tag->second));
  }
}

}  // namespace

static const RegisteredPluginKind deal_ii_of_plugins({.abi = deal_ii_abi});

void with_failures_of_deal_ii(const std::function<void()>& work) {
  try {
    work();
  } catch (const dealii::SolverControl::NoConvergence& failure) {
    throw SolverFailure("no convergence after " + std::to_string(failure.last_step) +
                        " iterations, residual " + number_text(failure.last_residual));
  } catch (const dealii::ExceptionBase& error) {
    std::ostringstream text;
    error.print_info(text);
    throw SolverFailure(std::string("deal.II: ") + error.get_exc_name() + " " +
                        in_one_line(text.str()));
  }
}

template <int dim>
std::unique_ptr<dealii::Triangulation<dim>> triangulation_of(const Mesh<dim>& mesh) {
  keep_deal_ii_single_threaded();
  const Topology& topology = mesh.topology();
  for (CellIndex c = 0; c < mesh.n_cells(); ++c)
    if (topology.cell_type(c) == ElementType::polygon)
      throw InputError("the mesh has a cell with " + std::to_string(topology.cell_nodes(c).size()) +
                       " nodes, but deal.II has triangles and quadrilaterals only");
  std::vector<unsigned int> materials;
  for (const int tag : topology.labels().cell_tags) materials.push_back(id_of(tag));
  auto triangulation = std::make_unique<dealii::Triangulation<dim>>();
  fill_triangulation(mesh, materials, *triangulation);
  set_boundary_ids(topology.labels(), *triangulation);
  return triangulation;
}

template <int dim>
void move_vertices(const Mesh<dim>& mesh, dealii::Triangulation<dim>& triangulation) {
  for (const auto& cell : triangulation.active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices())
      for (int d = 0; d < dim; ++d)
        cell->vertex(v)[d] = mesh.coordinates()[cell->vertex_index(v)][d];
}

template std::unique_ptr<dealii::Triangulation<2>> triangulation_of(const Mesh<2>&);
template std::unique_ptr<dealii::Triangulation<3>> triangulation_of(const Mesh<3>&);
template void move_vertices(const Mesh<2>&, dealii::Triangulation<2>&);
template void move_vertices(const Mesh<3>&, dealii::Triangulation<3>&);

}  // namespace smoothfem
