// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/doctor/examine_boundary.h"

#include "meshes/doctor/examinations/pieces.h"
#include "meshes/doctor/examinations/seams.h"

namespace smoothfem {

std::vector<bool> add_seams(Findings& findings, const Skin& skin) {
  const PlainCells& cells = findings.cells();
  const std::string facet = findings.facet_name();
  const auto hanging = find_hanging_nodes(cells, skin);
  if (!hanging.empty()) {
    auto finding = findings.at_node(FindingKind::hanging_nodes, hanging.size(), hanging[0].node);
    finding.cell = findings.numbers().cell(skin.cells[hanging[0].facet]);
    findings.add(finding,
                 "the mesh does not conform: " + count_of(hanging.size(), "hanging node") +
                     (hanging.size() == 1 ? " lies" : " lie") + " inside " +
                     (cells.dim == 2 ? "an edge" : "a face or an edge") + " of another cell",
                 "divide the larger cells in the mesh generator, so that cells meet in whole " +
                     facet + "s");
  }
  const CoincidentNodes coincident = find_coincident_nodes(cells, skin);
  if (coincident.count > 0) {
    NodeIndex node = 0;
    while (coincident.is_first(node)) ++node;
    const std::string joined = coincident.n_joined == 0
                                   ? ""
                                   : ", so that " + count_of(coincident.n_joined, "pair") + " of " +
                                         facet + "s form a seam that is not joined";
    findings.add(findings.at_node(FindingKind::coincident_nodes, coincident.count, node),
                 count_of(coincident.count, "coincident node") +
                     (coincident.count == 1 ? " lies" : " lie") + " where another node lies" +
                     joined,
                 "'smoothfem repair' or 'smoothfem smooth --merge' merges them");
  }
  const auto nodes = find_touching_nodes(cells, skin, hanging, coincident);
  if (!nodes.empty())
    findings.add(findings.at_node(FindingKind::touching_nodes, nodes.size(), nodes[0]),
                 "pieces of the mesh touch in nothing but " + count_of(nodes.size(), "node"),
                 "join the pieces there, or give each one its own node");
  const auto edges = find_touching_edges(cells, skin, hanging, coincident);
  if (!edges.empty())
    findings.add(findings.at_node(FindingKind::touching_edges, edges.size(), edges[0][0]),
                 "pieces of the mesh touch in nothing but " + count_of(edges.size(), "edge"),
                 "join the pieces there, or give each one its own edge");
  if (hanging.empty() && coincident.count == 0) return {};
  return seam_flags(cells, skin, hanging, coincident);
}

template <int dim, int spacedim>
BoundaryExamination examine_boundary(const Mesh<dim, spacedim>& mesh) {
  return with_plain_cells(mesh, [&](const PlainCells& cells) {
    Findings findings(cells);
    auto seam_nodes = add_seams(findings, skin_of(mesh.topology()));
    return BoundaryExamination{std::move(findings).take(), std::move(seam_nodes)};
  });
}

template <int dim, int spacedim>
std::vector<bool> require_conforming(const Mesh<dim, spacedim>& mesh, const std::string& path,
                                     bool hanging_is_constrained) {
  auto seen = examine_boundary(mesh);
  for (const Finding& finding : seen.findings) {
    const bool hangs = finding.kind == FindingKind::hanging_nodes;
    if ((hangs && !hanging_is_constrained) || finding.kind == FindingKind::coincident_nodes)
      throw InputError(
          path + ": " + finding.sentence + "; a study needs a mesh that conforms" +
          (hangs ? ", or 'set hanging nodes = constrain' with elements of degree 1" : ""));
  }
  return std::move(seen.seam_nodes);
}

#define SMOOTHFEM_INSTANTIATE(MESH)                           \
  template BoundaryExamination examine_boundary(const MESH&); \
  template std::vector<bool> require_conforming(const MESH&, const std::string&, bool);
SMOOTHFEM_INSTANTIATE(PlanarMesh)
SMOOTHFEM_INSTANTIATE(VolumeMesh)
SMOOTHFEM_INSTANTIATE(SurfaceMesh)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem