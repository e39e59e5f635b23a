// SPDX-License-Identifier: GPL-3.0-or-later
#include "fem/deal_ii/triangulation_solver.h"

#include <deal.II/lac/solver_control.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "fem/elements/single_threaded.h"
#include "fem/space/distributed_mesh.h"
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

/// Returns the id of each cell; empty without tags.
std::vector<unsigned int> cell_ids_of(const MeshLabels& labels) {
  std::vector<unsigned int> ids;
  for (const int tag : labels.cell_tags) ids.push_back(id_of(tag));
  return ids;
}

/// The ids of labelled facets by their sorted nodes.
using FacetIds = std::map<std::vector<NodeIndex>, unsigned int>;

FacetIds facet_ids_of(const MeshLabels& labels) {
  FacetIds ids;
  for (std::size_t f = 0; f < labels.facets.size(); ++f) {
    std::vector<NodeIndex> nodes(labels.facets[f].begin(), labels.facets[f].end());
    std::sort(nodes.begin(), nodes.end());
    ids.emplace(std::move(nodes), id_of(labels.facet_tags[f]));
  }
  return ids;
}

template <int dim>
void set_boundary_ids(const FacetIds& ids, dealii::Triangulation<dim>& triangulation) {
  if (ids.empty()) return;
  std::vector<NodeIndex> nodes;
  for (const auto& face : triangulation.active_face_iterators()) {
    if (!face->at_boundary()) continue;
    nodes.clear();
    for (const unsigned int v : face->vertex_indices()) nodes.push_back(face->vertex_index(v));
    std::sort(nodes.begin(), nodes.end());
    if (const auto id = ids.find(nodes); id != ids.end()) face->set_all_boundary_ids(id->second);
  }
}

void require_cells_of_deal_ii(const Topology& topology) {
  for (CellIndex c = 0; c < topology.n_cells(); ++c)
    if (topology.cell_type(c) == ElementType::polygon)
      throw InputError("the mesh has a cell with " + std::to_string(topology.cell_nodes(c).size()) +
                       " nodes, but deal.II has triangles and quadrilaterals only");
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
TriangulatedMesh<dim>::TriangulatedMesh(const Mesh<dim>& mesh, const Ranks& ranks) : ranks_(ranks) {
  keep_deal_ii_single_threaded();
  std::vector<unsigned int> cell_ids;
  FacetIds facet_ids;
  ranks.on_root([&] {
    require_cells_of_deal_ii(mesh.topology());
    cell_ids = cell_ids_of(mesh.topology().labels());
    facet_ids = facet_ids_of(mesh.topology().labels());
  });
  triangulation_ = distributed_triangulation<dim>(
      [&](dealii::Triangulation<dim>& whole) {
        fill_triangulation(mesh, cell_ids, whole);
        set_boundary_ids(facet_ids, whole);
      },
      ranks);
  std::vector<NodeIndex> nodes;
  for (const auto& vertex : triangulation_->get_vertices())
    nodes.push_back(static_cast<NodeIndex>(ranks.size() == 1 ? nodes.size() : vertex[0]));
  nodes_of_ranks_ = ranks.gather(nodes);
  move_vertices(mesh);
}

template <int dim>
void TriangulatedMesh<dim>::move_vertices(const Mesh<dim>& mesh) {
  std::vector<Point<dim>> x;
  x.reserve(nodes_of_ranks_.size());
  for (const NodeIndex node : nodes_of_ranks_) x.push_back(mesh.coordinates()[node]);
  x = ranks_.scatter(x, triangulation_->n_vertices());
  for (const auto& cell : triangulation_->active_cell_iterators())
    for (const unsigned int v : cell->vertex_indices())
      for (int d = 0; d < dim; ++d) cell->vertex(v)[d] = x[cell->vertex_index(v)][d];
}

template class TriangulatedMesh<2>;
template class TriangulatedMesh<3>;

}  // namespace smoothfem
