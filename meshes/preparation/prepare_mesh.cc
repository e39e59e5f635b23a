// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/preparation/prepare_mesh.h"

#include <algorithm>

#include "meshes/doctor/examine_boundary.h"
#include "meshes/preparation/layer_rule.h"
#include "smoothing/base/option_text.h"
#include "smoothing/quality/bad_places.h"
#include "smoothing/quality/cell_targets.h"

namespace smoothfem {

namespace {

FeatureParameters features_of(const MeshOptions& options) {
  FeatureParameters features;
  if (options.feature_angle) features.angle_degrees = *options.feature_angle;
  return features;
}

InputError only_for(const std::string& option, const std::string& what) {
  return InputError(option_text(option) + " is for " + what + "; leave it out");
}

/// Returns the mesh with the constraints that the options ask for.
template <int dim, int spacedim>
Mesh<dim, spacedim> with_constraints(Mesh<dim, spacedim> mesh, const MeshOptions& options) {
  const std::string sliding =
      "'" + option_text("boundary", "slide") + "' and '" + option_text("interfaces", "slide") + "'";
  if (options.slide_distance && !options.slides()) throw only_for("slide-distance", sliding);
  if constexpr (spacedim > dim) {
    if (options.slide_distance) throw only_for("slide-distance", "planar and volume meshes");
    if (!options.boundary.empty())
      throw only_for("boundary", "planar and volume meshes, but this is a surface mesh");
    const FeatureParameters features = features_of(options);
    return with_interface_rule(options.feature_angle ? with_features(mesh, features) : mesh,
                               interface_rule(options.interfaces), features);
  } else {
    if (options.feature_angle && !options.slides())
      throw only_for("feature-angle", "surface meshes, " + sliding);
    return with_rules(mesh, options.rules());
  }
}

/// Returns the mesh with the nodes fixed that the options name.
template <int dim, int spacedim>
Mesh<dim, spacedim> with_named_nodes(Mesh<dim, spacedim> mesh, const MeshOptions& options) {
  if (options.fix) {
    auto reasons = fixed_nodes(mesh.topology(), *options.fix);
    mesh = with_fixed_nodes(std::move(mesh), std::move(reasons));
  }
  if (options.also_fixed.empty()) return mesh;
  auto reasons = mesh.topology().fixed_reasons();
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (options.also_fixed[i]) reasons[i] |= bit(FixedReason::marked);
  return with_fixed_nodes(std::move(mesh), std::move(reasons));
}

template <int dim, int spacedim>
bool boundary_may_move(const Mesh<dim, spacedim>& mesh) {
  const Topology& topology = mesh.topology();
  const auto& free = topology.free_nodes();
  return std::any_of(free.begin(), free.end(),
                     [&](NodeIndex i) { return topology.on_boundary()[i]; });
}

/// Returns the mesh with the nodes of seams fixed, whose sides would come apart. Warns about them.
template <int dim, int spacedim>
Mesh<dim, spacedim> with_fixed_seams(Mesh<dim, spacedim> mesh, const MeshOptions& options,
                                     const NoteTaker& notes) {
  if (!options.examines && !boundary_may_move(mesh)) return mesh;
  // In tangled meshes boundary nodes may lie anywhere.
  const bool is_valid = mesh_quality(mesh).n_invalid == 0;
  if (!is_valid && !(dim == 2 && mesh.constraints())) return mesh;
  const auto [findings, seam_nodes] = examine_boundary(mesh);
  if (is_valid && options.examines)
    for (const Finding& finding : findings) notes.warn(finding.sentence);
  if (seam_nodes.empty()) return mesh;
  auto reasons = mesh.topology().fixed_reasons();
  for (NodeIndex i = 0; i < mesh.n_nodes(); ++i)
    if (seam_nodes[i]) reasons[i] |= bit(FixedReason::hanging);
  return with_fixed_nodes(std::move(mesh), std::move(reasons));
}

/// Returns the mesh with the nodes fixed, too, that are not near a bad cell.
template <int dim, int spacedim>
Mesh<dim, spacedim> with_good_places_fixed(Mesh<dim, spacedim> mesh, const MeshOptions& options) {
  if (!options.only_below) return mesh;
  auto fixed = fixed_away_from_bad_cells(mesh, *options.only_below, options.rings);
  return with_fixed_nodes(std::move(mesh), std::move(fixed));
}

}  // namespace

MeshRules MeshOptions::rules() const {
  return {.interfaces = interface_rule(interfaces),
          .boundary_slides = boundary == "slide",
          .joins_periodic = periodic == "smooth",
          .features = features_of(*this),
          .slide_distance = slide_distance.value_or(default_slide_distance)};
}

template <int dim, int spacedim>
Mesh<dim, spacedim> prepared_mesh(Mesh<dim, spacedim> mesh, const MeshOptions& options,
                                  const NoteTaker& notes) {
  mesh = with_constraints(std::move(mesh), options);
  mesh = with_named_nodes(std::move(mesh), options);
  if constexpr (dim == spacedim)
    mesh = with_layer_rule(std::move(mesh), options, notes);
  else if (options.keep_layers)
    throw only_for("keep-layers", "planar and volume meshes");
  mesh = with_fixed_seams(std::move(mesh), options, notes);
  return with_good_places_fixed(std::move(mesh), options);
}

template <int dim>
Mesh<dim> with_cells_as_targets(const Mesh<dim>& mesh, const AnyMesh& reference,
                                const std::string& name, const std::string& reference_name) {
  const auto* same_kind = std::get_if<Mesh<dim>>(&reference);
  if (same_kind == nullptr || !(same_kind->topology().cells() == mesh.topology().cells()))
    throw InputError(reference_name + " has other cells than " + name + "; " +
                     option_text("target") + " needs a mesh with the same cells in the same order");
  return with_targets(mesh, targets_of(*same_kind, TargetKind::shape_and_size));
}

template <int dim, int spacedim>
SmoothingResult smooth_prepared(Mesh<dim, spacedim>& mesh, Method<dim, spacedim>& method,
                                const MeshOptions& options,
                                const std::type_identity_t<Observer<dim, spacedim>>& observer) {
  if constexpr (spacedim == dim) {
    return smooth_by_rules(mesh, method, options.rules(), observer);
  } else {
    if (options.periodic == "smooth") throw only_for("periodic", "planar and volume meshes");
    return smooth(mesh, method, observer);
  }
}

std::string invalid_cells_text(std::size_t n_invalid, std::size_t n_cells) {
  if (n_invalid == 0) return {};
  return std::to_string(n_invalid) + " of " + std::to_string(n_cells) +
         " cells of the smoothed mesh are invalid; choose a method that keeps cells valid, for "
         "example smart-laplace or getme";
}

std::vector<MidsideNote> midside_notes(const MidsideReport& report) {
  std::vector<MidsideNote> notes;
  const auto count = [](std::size_t n, const std::string& what) {
    return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
  };
  if (report.n_repaired > 0) {
    std::string sentence =
        "curved cells were invalid at first: " + std::to_string(report.n_repaired) +
        "; to repair them, " + count(report.n_relaxed, "midside node") +
        " moved towards the straight place";
    if (report.n_relaxed_on_boundary > 0)
      sentence += "; " + std::to_string(report.n_relaxed_on_boundary) +
                  " of these lie on the boundary or on interfaces, which change there";
    notes.push_back({std::move(sentence), report.n_relaxed_on_boundary > 0});
  }
  if (report.n_bent > 0)
    notes.push_back({count(report.n_bent, "midside node") +
                     " inside still bent as before, because straight edges make cells worse"});
  if (report.n_reset > 0)
    notes.push_back({count(report.n_reset, "corner") +
                     " back at the initial position, because curved cells around became invalid "
                     "or worse than the worst one before"});
  return notes;
}

std::string floor_text(const SmoothingResult& result) {
  if (result.n_floor_reset == 0) return {};
  return std::to_string(result.n_floor_reset) +
         " nodes are back at their initial positions, so that no cell is worse than the worst one "
         "before (" +
         (options_are_arguments() ? "allow_worse=True" : option_text("allow-worse")) +
         " leaves them)";
}

#define INSTANTIATE(...)                                                             \
  template Mesh<__VA_ARGS__> prepared_mesh(Mesh<__VA_ARGS__>, const MeshOptions&,    \
                                           const NoteTaker&);                        \
  template SmoothingResult smooth_prepared(Mesh<__VA_ARGS__>&, Method<__VA_ARGS__>&, \
                                           const MeshOptions&, const Observer<__VA_ARGS__>&);
INSTANTIATE(2)
INSTANTIATE(3)
INSTANTIATE(2, 3)
#undef INSTANTIATE
template Mesh<2> with_cells_as_targets(const Mesh<2>&, const AnyMesh&, const std::string&,
                                       const std::string&);
template Mesh<3> with_cells_as_targets(const Mesh<3>&, const AnyMesh&, const std::string&,
                                       const std::string&);

}  // namespace smoothfem
