// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/member_study.h"

#include <array>
#include <cstdio>

#include "meshes/domains/catalogue.h"
#include "meshes/io/mesh_file.h"
#include "studies/framework/definition/check_study.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

/// Returns the elements of a mesh as domains name them, for meshes of cells of one type.
std::string elements_of(const Topology& topology) {
  std::string elements;
  for (CellIndex c = 0; c < topology.n_cells(); ++c) {
    const ElementType type = topology.cell_type(c);
    const std::string name = type == ElementType::triangle        ? "triangles"
                             : type == ElementType::quadrilateral ? "quadrilaterals"
                             : type == ElementType::tetrahedron   ? "tetrahedra"
                             : type == ElementType::hexahedron    ? "hexahedra"
                                                                  : "mixed";
    if (elements.empty()) elements = name;
    if (elements != name) return "mixed";
  }
  return elements;
}

template <int dim, int spacedim>
MeshOutline outline(const Mesh<dim, spacedim>& mesh) {
  // The outermost nodes of planar and volume meshes are on the boundary. Others may be outside of a
  // tangled mesh.
  const auto& on_boundary = mesh.topology().on_boundary();
  Eigen::AlignedBox3d box;
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i) {
    if (dim == spacedim && !on_boundary[i]) continue;
    Eigen::Vector3d in_space = Eigen::Vector3d::Zero();
    in_space.head<spacedim>() = mesh.coordinates()[i];
    box.extend(in_space);
  }
  return {{dim, spacedim}, elements_of(mesh.topology()), box};
}

AnyMesh undistorted_mesh(const Collection& collection, const StudyMesh& mesh) {
  if (mesh.domain.empty()) return read_mesh(mesh.file).mesh;
  const Domain& domain = find_domain(mesh.domain);
  const double edge_scale = collection.common.at(domain.dimension).edge_scale * mesh.edge_scale;
  return domain.generate(parameters_of(mesh, edge_scale));
}

/// Returns for example "((x - 0.5) / 2)". Six digits are enough, because any box near the mesh's
/// will do.
std::string scaled(char coordinate, double origin, double length) {
  char text[80];
  std::snprintf(text, sizeof(text), "((%c - (%.6g)) / %.6g)", coordinate, origin, length);
  return text;
}

const Study& common_study(const Collection& collection, MeshDimensions dimensions) {
  const auto found = collection.common.find(dimensions.cells);
  if (found == collection.common.end()) throw InputError(collection.refusals.at(dimensions.cells));
  if (dimensions.space > dimensions.cells)
    throw InputError("it is a surface mesh; collections have planar and volume meshes");
  return found->second;
}

StudySolution solution_of(const Collection& collection, const Member& member, const Study& common,
                          const MeshOutline& outline) {
  if (member.solution.empty()) return common.solution;
  StudySolution solution = collection.solutions.at(member.solution);
  solution.u = in_box(solution.u, outline.box);
  solution.diffusivity = in_box(solution.diffusivity, outline.box);
  for (auto& of_group : solution.of_groups)
    of_group.formula = in_box(of_group.formula, outline.box);
  return solution;
}

/// Returns the parameters for provenance.json that are the member's own.
StudyParameters own_parameters(const Study& study) {
  const StudyMesh& mesh = study.meshes.front();
  const std::string section = "mesh " + mesh.name + "/";
  char scale[32], eps[32];
  std::snprintf(scale, sizeof(scale), "%.17g", mesh.edge_scale);
  std::snprintf(eps, sizeof(eps), "%.17g", mesh.eps);
  StudyParameters parameters{{"dimension", std::to_string(study.dimensions.cells)},
                             {"meshes", mesh.name},
                             {section + "domain", mesh.domain},
                             {section + "elements", mesh.elements},
                             {section + "algorithm", mesh.algorithm},
                             {section + "edge scale", scale},
                             {section + "eps", eps},
                             {section + "untangle", mesh.untangle ? "true" : "false"},
                             {"solution/name", study.solution.name},
                             {"solution/u", study.solution.u},
                             {"solution/diffusivity", study.solution.diffusivity}};
  if (mesh.order > 1) parameters.emplace_back(section + "order", std::to_string(mesh.order));
  for (const auto& [group, formula] : study.solution.of_groups)
    parameters.emplace_back("solution/diffusivity group " + group, formula);
  return parameters;
}

}  // namespace

std::string in_box(const std::string& formula, const Eigen::AlignedBox3d& box) {
  const double length = box.sizes().maxCoeff();
  std::array<std::string, 3> by;
  for (int d = 0; d < 3; ++d)
    by[static_cast<std::size_t>(d)] =
        box.sizes()[d] > 0.0 ? scaled(static_cast<char>('x' + d), box.min()[d], length) : "0";
  std::string result, word;
  for (const char c : formula + " ") {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') {
      word += c;
      continue;
    }
    const bool is_coordinate = word == "X" || word == "Y" || word == "Z";
    result += is_coordinate ? by[static_cast<std::size_t>(word.front() - 'X')] : word;
    result += c;
    word.clear();
  }
  result.pop_back();
  return result;
}

MeshOutline outline_of(const Collection& collection, const Member& member, const fs::path& folder) {
  const fs::path initial = folder / "meshes" / (member.mesh.name + "_initial.mesh");
  const AnyMesh mesh = !folder.empty() && fs::exists(initial)
                           ? read_mesh(initial).mesh
                           : undistorted_mesh(collection, member.mesh);
  return std::visit([](const auto& m) { return outline(m); }, mesh);
}

Study member_study(const Collection& collection, const Member& member, const MeshOutline& outline) {
  Study study = common_study(collection, outline.dimensions);
  study.meshes = {member.mesh};
  study.meshes.front().distortion_candidates = default_candidates(outline.dimensions.cells);
  study.solution = solution_of(collection, member, study, outline);
  study.header.title += ", " + member.name;
  study.header.built_in = false;
  const auto own = own_parameters(study);
  for (auto* parameters : {&study.header.parameters, &study.header.file_parameters}) {
    std::erase_if(*parameters, [](const auto& entry) {
      return entry.first.starts_with("solution/") && entry.first != "solution/natural";
    });
    parameters->insert(parameters->end(), own.begin(), own.end());
  }
  check_study(study);
  return study;
}

}  // namespace smoothfem
