// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/study_meshes.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "distributed/files/refine.h"
#include "distributed/files/split.h"
#include "meshes/distortion/distort.h"
#include "meshes/doctor/examine_boundary.h"
#include "meshes/domains/catalogue.h"
#include "meshes/io/mesh_file.h"
#include "meshes/preparation/prepare_mesh.h"
#include "smoothing/geometry/extreme_size.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/optimization/untangle.h"
#include "studies/framework/definition/study_file.h"
#include "studies/framework/results/sha256.h"
#include "studies/framework/run/constraints/hanging_nodes.h"
#include "studies/framework/run/constraints/periodic_nodes.h"
#include "studies/framework/run/kept/result_names.h"

namespace smoothfem {

namespace {

template <int dim, int spacedim>
Mesh<dim, spacedim> of_kind(AnyMesh&& mesh, const std::string& name) {
  if (auto* wanted = std::get_if<Mesh<dim, spacedim>>(&mesh)) return std::move(*wanted);
  if (std::holds_alternative<SurfaceMesh>(mesh) || spacedim > dim)
    throw InputError(name + " is a " + kind_name(mesh) + " mesh, but the study is about " +
                     mesh_kind_name(dim, spacedim) +
                     " meshes; set its keys 'dimension' and 'surface' accordingly");
  throw InputError(name + " is a " + kind_name(mesh) + " mesh, but the study has 'dimension = " +
                   std::to_string(dim) + "'; set it to " + std::to_string(5 - dim));
}

/// changes: gets the sentences about changes that were made in reading. may_be_tangled: accepts
/// invalid cells, too.
template <int dim, int spacedim>
Mesh<dim, spacedim> read_valid_mesh(const std::filesystem::path& path,
                                    std::vector<std::string>& changes,
                                    bool may_be_tangled = false) {
  MeshFile file = read_mesh(path);
  changes = std::move(file.notes);
  const auto mesh = of_kind<dim, spacedim>(std::move(file.mesh), path.string());
  if (!may_be_tangled || spacedim > dim) require_valid(mesh, path.string(), file.cell_lines);
  return mesh;
}

/// Makes a tangled mesh of a file valid. Throws InputError if that fails.
template <int dim>
void make_valid(const std::filesystem::path& file, Mesh<dim>& mesh) {
  const std::size_t n_cells = mesh.n_cells();
  const UntangleResult result = untangle(mesh);
  if (result.valid) return;
  throw InputError(file.string() + ": " + std::to_string(result.n_invalid_before) + " of " +
                   std::to_string(n_cells) + " cells are invalid, and untangling leaves " +
                   std::to_string(std::max(result.n_invalid_after, result.invalid_cells.size())) +
                   "; repair them in the mesh generator");
}

/// The origin of a mesh.
struct Source {
  std::filesystem::path file;  ///< empty: generated
  bool published = false;
  std::string generated{};   ///< the domain and its elements
  std::string distortion{};  ///< empty: none

  /// Returns the origin as text. A published mesh is known by its name, because its folder depends
  /// on the machine.
  std::string origin() const {
    return file.empty() || published ? setting() : file.string() + distortion;
  }
  std::string setting() const {
    return (file.empty() ? generated : file.filename().string()) + distortion;
  }
};

std::string distortion_text(const StudyMesh& description) {
  std::ostringstream text;
  if (description.distort_to_q_mean > 0.0)
    text << ", distorted to q_mean " << description.distort_to_q_mean;
  if (description.distort_within > 0.0)
    text << ", distorted within radius " << description.distort_within;
  if (!is_distorted(description)) return {};
  if (description.distortion == DistortionKind::random_steps)
    text << " by " << description.distortion_sweeps << " sweeps of random steps";
  if (description.distortion_least_quality > 0.0)
    text << " not below " << description.distortion_least_quality;
  text << " with seed " << description.seed;
  return text.str();
}

Source source_of(const StudyMesh& description, const std::filesystem::path& mesh_dir) {
  if (!mesh_dir.empty() && !description.published_file.empty())
    return {.file = mesh_dir / description.published_file, .published = true};
  if (!description.file.empty())
    return {.file = description.file, .distortion = distortion_text(description)};
  if (description.domain.empty())
    throw InputError("mesh " + description.name +
                     " has neither a file nor a domain; set one of them in its subsection");
  return {.file = {},
          .generated = "generated " + description.domain + " of " +
                       find_domain(description.domain).elements_named(description.elements) +
                       (description.order == 2 ? " of second order" : ""),
          .distortion = distortion_text(description)};
}

/// Moves the nodes to where an earlier run has written them. Throws InputError if its file has
/// other cells.
template <int dim, int spacedim>
void move_nodes_as_in(const std::filesystem::path& path, Mesh<dim, spacedim>& mesh) {
  std::vector<std::string> ignored;
  const auto moved = read_valid_mesh<dim, spacedim>(path, ignored);
  if (moved.n_nodes() != mesh.n_nodes() || !(moved.topology().cells() == mesh.topology().cells()))
    throw InputError(path.string() +
                     " has other cells than the mesh that it was made of; start anew with --force, "
                     "which keeps the folder under another name");
  mesh.set_coordinates(moved.coordinates());
}

/// True if the mesh is that of a file which may be tangled.
bool is_untangled(const StudyMesh& description, const Source& source) {
  return description.untangle && !source.file.empty() && !source.published;
}

/// True if the mesh is not that of a file as it is, so that a copy is kept.
bool is_made(const StudyMesh& description, const Source& source) {
  return source.file.empty() || is_untangled(description, source) ||
         (is_distorted(description) && !source.published);
}

template <int dim, int spacedim>
void distort_as_described(const StudyMesh& description, Mesh<dim, spacedim>& mesh) {
  DistortionParameters parameters;
  parameters.kind = description.distortion;
  parameters.n_candidates = description.distortion_candidates;
  parameters.n_sweeps = description.distortion_sweeps;
  parameters.min_quality = description.distortion_least_quality;
  parameters.seed = description.seed;
  if (description.distort_within > 0.0) {
    distort_within(mesh, description.distort_within, parameters);
  } else {
    parameters.target_q_mean = description.distort_to_q_mean;
    distort(mesh, parameters);
  }
}

/// Makes the mesh of a domain. made: as below.
template <int dim, int spacedim>
Mesh<dim, spacedim> generated_mesh(const StudyMesh& description, double edge_scale,
                                   const std::filesystem::path& made,
                                   std::vector<std::string>& changes) {
  const Domain& domain = find_domain(description.domain);
  const DomainParameters parameters = parameters_of(description, edge_scale);
  const std::string name = "the domain " + description.domain;
  auto mesh = of_kind<dim, spacedim>(domain.generate(parameters), name);
  if (is_distorted(description) && made.empty()) distort_as_described(description, mesh);
  if (description.order == 2) {
    auto [curved, report] = domain.of_second_order(mesh, parameters);
    mesh = of_kind<dim, spacedim>(std::move(curved), name);
    if (made.empty())
      for (const auto& note : midside_notes(report)) changes.push_back(note.sentence);
  }
  if (!made.empty() && is_distorted(description)) move_nodes_as_in(made, mesh);
  return mesh;
}

/// made: file of an earlier run that has the nodes after untangling and distortion, or empty.
template <int dim, int spacedim>
Mesh<dim, spacedim> make_mesh(const StudyMesh& description, const Source& source, double edge_scale,
                              const std::filesystem::path& made,
                              std::vector<std::string>& changes) {
  if (source.file.empty())
    return generated_mesh<dim, spacedim>(description, edge_scale, made, changes);
  const bool untangles = is_untangled(description, source);
  auto mesh = read_valid_mesh<dim, spacedim>(source.file, changes, untangles);
  if (const std::size_t n = untangles ? mesh_quality(mesh).n_invalid : 0; n > 0)
    changes.push_back("untangled, as " + std::to_string(n) + " of " +
                      std::to_string(mesh.n_cells()) + " cells of the file are invalid");
  if (source.published || (!is_distorted(description) && !untangles)) return mesh;
  if (!made.empty()) {
    move_nodes_as_in(made, mesh);
    return mesh;
  }
  if constexpr (dim == spacedim)
    if (untangles) make_valid(source.file, mesh);
  if (is_distorted(description)) distort_as_described(description, mesh);
  return mesh;
}

/// Returns the constraints that the study wants; null if the mesh has none. Nodes on seams stay.
/// seam: their flags; may be empty. notes: gets a sentence about them, or about partners that are
/// not constrained.
template <int dim>
std::shared_ptr<const NodeTies> ties_of(Mesh<dim>& mesh, const std::vector<bool>& seam,
                                        const Study& study, std::vector<std::string>& notes) {
  NodeTies hanging, periodic;
  if (study.constrain_hanging_nodes) hanging = hanging_ties(mesh);
  if (!hanging.empty()) {
    auto reasons = mesh.topology().fixed_reasons();
    for (std::size_t i = 0; i < seam.size(); ++i)
      if (seam[i]) reasons[i] |= bit(FixedReason::hanging);
    mesh = with_fixed_nodes(std::move(mesh), std::move(reasons));
    notes.push_back("the values at " + count_of(hanging.nodes.size(), "hanging node") +
                    " follow from those of the edge or face around");
  }
  if (const std::size_t n = n_periodic_nodes(mesh.topology()); n > 0) {
    if (study.constrain_periodic_nodes) periodic = periodic_ties(mesh.topology());
    notes.push_back(count_of(n, "node") +
                    (study.constrain_periodic_nodes
                         ? " with periodic partners: partners have the same unknown"
                         : " with periodic partners: u is prescribed there as on the rest of the "
                           "boundary; 'set periodic = constrain' gives partners the same unknown"));
  }
  if (study.constrain_periodic_nodes && periodic.empty())
    notes.push_back(
        "'set periodic = constrain' changes nothing: the mesh has no periodic partners");
  if (hanging.empty() && periodic.empty()) return nullptr;
  return std::make_shared<const NodeTies>(joined_ties(std::move(hanging), periodic));
}

}  // namespace

template <int dim, int spacedim>
PreparedMesh<dim, spacedim> prepare_mesh(const StudyMesh& description, const Study& study,
                                         const std::filesystem::path& mesh_dir,
                                         const KeptResults* kept) {
  const Source source = source_of(description, mesh_dir);
  // The text format of planar and volume meshes does not store what a mesh says besides its cells.
  const bool has_more = !source.file.empty() ||
                        (!description.domain.empty() && find_domain(description.domain).has_groups);
  const std::string source_sha256 = source.file.empty() ? "" : sha256_of_file(source.file);
  std::string kept_name;
  if (dim == spacedim && is_made(description, source))
    kept_name = kept_mesh_name(description, source_sha256, study.edge_scale);
  const auto found =
      kept == nullptr || kept_name.empty() ? std::nullopt : kept->find_mesh(kept_name);
  std::vector<std::string> changes;
  Mesh<dim, spacedim> mesh =
      found && !has_more
          ? read_valid_mesh<dim, spacedim>(*found, changes)
          : make_mesh<dim, spacedim>(description, source, study.edge_scale * description.edge_scale,
                                     found.value_or(std::filesystem::path()), changes);
  std::shared_ptr<const NodeTies> ties;
  if (!study.degrees.empty() || !study.solvers.empty()) {
    if constexpr (dim == spacedim)
      if (!source.file.empty()) {
        const auto seam =
            require_conforming(mesh, source.file.string(), study.constrain_hanging_nodes);
        ties = ties_of(mesh, seam, study, changes);
      }
    for (const int degree : study.degrees)
      at_line(study.natural_lines, [&] {
        require_finite_elements<dim>(mesh.topology(), degree, study.finite_elements.natural_groups);
      });
    if (const int exponent = extreme_exponent(std::as_const(mesh).coordinates()); exponent != 0)
      throw InputError(
          "mesh " + description.name + " is about 2^" + std::to_string(exponent) +
          " wide, which is outside the range of numbers of finite elements; scale it to an "
          "ordinary size");
  }
  constexpr auto implied =
      static_cast<FixedReasons>(bit(FixedReason::interface) | bit(FixedReason::required) |
                                bit(FixedReason::hanging) | bit(FixedReason::periodic));
  if (any_node_has(mesh.topology(), implied))
    changes.push_back(fixed_reasons_text(mesh.topology()));
  // It does not store surfaces and some cells of second order either.
  const bool in_text = dim == spacedim && mesh.topology().midside() == nullptr;
  const std::string initial =
      "meshes/" + description.name + "_initial" + (in_text ? ".mesh" : ".vtk");
  MeshFacts facts{.description = description,
                  .n_nodes = mesh.n_nodes(),
                  .n_cells = mesh.n_cells(),
                  .quality = mesh_quality(mesh),
                  .origin = source.origin(),
                  .setting = source.setting(),
                  .file = initial,
                  .published = source.published,
                  .changes = std::move(changes),
                  .source_sha256 = source_sha256,
                  .sha256 = {}};
  const bool is_straight = study.finite_elements.geometry == Geometry::straight;
  auto of_solvers = is_straight && mesh.topology().midside() != nullptr
                        ? mesh.topology().without_midside()
                        : mesh.shared_topology();
  return {std::move(facts),  std::move(mesh),      nullptr, std::move(ties), std::move(kept_name),
          found.has_value(), std::move(of_solvers)};
}

namespace {

/// Returns the number of pieces for a mesh that the study refines.
std::size_t n_pieces_for(std::size_t n_cells, int dim, int n_refinements) {
  constexpr double cells_a_piece = 250000.0;
  const double n_refined = static_cast<double>(n_cells) * std::exp2(dim * n_refinements);
  return static_cast<std::size_t>(std::ceil(n_refined / cells_a_piece));
}

/// Makes the pieces of a kept mesh. source: pieces to refine, or empty: the root makes the mesh.
/// Collective.
template <int dim>
void make_pieces(const StudyMesh& description, const Study& study,
                 const std::filesystem::path& mesh_dir, std::filesystem::path source,
                 const std::string& name, const KeptResults& kept, const Ranks& ranks) {
  std::vector<std::string> notes;
  std::filesystem::path made;
  const auto next = [&](int n_refinements) {
    return kept.pieces_file(
        n_refinements == study.refine ? name : name + "-" + std::to_string(n_refinements));
  };
  if (source.empty()) {
    made = source = next(0);
    ranks.on_root([&] {
      const auto whole = prepare_mesh<dim>(description, study, mesh_dir, nullptr);
      notes = whole.changes;
      std::filesystem::create_directories(made.parent_path());
      write_in_pieces(whole.mesh, n_pieces_for(whole.n_cells, dim, study.refine), made);
    });
  }
  for (int n = 1; n <= study.refine; ++n) {
    const RefinedPieces refined = refine_pieces(ranks, source, next(n));
    ranks.on_root([&] {
      if (n == 1) notes.insert(notes.end(), refined.losses.begin(), refined.losses.end());
      if (made.empty()) return;
      std::filesystem::remove(made);
      std::filesystem::remove_all(made.replace_extension());
    });
    made = source = next(n);
  }
  ranks.on_root([&] { kept.save_notes(name, notes); });
}

}  // namespace

template <int dim>
PreparedMesh<dim> prepare_mesh_in_parts(const StudyMesh& description, const Study& study,
                                        const std::filesystem::path& mesh_dir,
                                        const KeptResults& kept, const Ranks& ranks) {
  const Source source = source_of(description, mesh_dir);
  const bool root_makes =
      is_made(description, source) || (study.refine > 0 && !Pieces::is_list(source.file));
  const bool has_copy = root_makes || study.refine > 0;
  std::filesystem::path file = source.file;
  std::string kept_name, source_sha256;
  std::vector<std::string> changes;
  if (has_copy) {
    if (!file.empty()) source_sha256 = content_of_pieces(ranks, Pieces(ranks, file));
    kept_name = kept_mesh_name(description, source_sha256, study.edge_scale) +
                (study.refine > 0 ? "-refined-" + std::to_string(study.refine) : "");
    file = kept.pieces_file(kept_name);
    bool is_kept = ranks.is_root() && kept.load_notes(kept_name).has_value();
    ranks.broadcast(is_kept);
    if (!is_kept)
      make_pieces<dim>(description, study, mesh_dir, root_makes ? "" : source.file, kept_name, kept,
                       ranks);
    changes = kept.load_notes(kept_name).value();
  }
  auto parts = std::make_shared<MeshInParts<dim>>(ranks, file);
  if (!has_copy) source_sha256 = parts->content();
  changes.insert(changes.end(), parts->notes().begin(), parts->notes().end());
  if (!root_makes && !study.degrees.empty())
    for (const auto& not_looked_for : require_conforming_parts(ranks, source.file))
      changes.push_back(not_looked_for);
  const std::string refined =
      study.refine == 0 ? "" : ", every cell split " + std::to_string(study.refine) + " times";
  MeshFacts facts{.description = description,
                  .n_nodes = parts->n_nodes(),
                  .n_cells = parts->n_cells(),
                  .quality = mesh_quality(parts->part()),
                  .origin = source.origin() + refined,
                  .setting = source.setting() + refined,
                  .file = "meshes/" + description.name + "_initial" + parts->extension(),
                  .published = source.published,
                  .changes = std::move(changes),
                  .source_sha256 = source_sha256,
                  .sha256 = {}};
  if (facts.quality.n_invalid > 0)
    throw InputError(facts.origin + ": " + std::to_string(facts.quality.n_invalid) + " of " +
                     std::to_string(facts.n_cells) +
                     " cells are invalid; smooth a valid mesh, 'smoothfem quality' counts them");
  Mesh<dim> part = parts->part();
  auto topology = part.shared_topology();
  return {
      std::move(facts),   std::move(part), std::move(parts), nullptr, std::move(kept_name), true,
      std::move(topology)};
}
template PreparedMesh<2> prepare_mesh_in_parts(const StudyMesh&, const Study&,
                                               const std::filesystem::path&, const KeptResults&,
                                               const Ranks&);
template PreparedMesh<3> prepare_mesh_in_parts(const StudyMesh&, const Study&,
                                               const std::filesystem::path&, const KeptResults&,
                                               const Ranks&);

void require_unchanged_meshes(const EarlierRun& run, const std::filesystem::path& out) {
  for (const auto& [file, noted] : run.meshes)
    if (!noted.empty() && std::filesystem::exists(out / file) &&
        sha256_of_file(out / file) != noted)
      throw InputError((out / file).string() +
                       " has been changed since the run began; start anew with --force, which "
                       "keeps the folder under another name");
}

template <int dim, int spacedim>
void write_initial_mesh(PreparedMesh<dim, spacedim>& prepared, const std::filesystem::path& out,
                        const KeptResults& kept) {
  const std::filesystem::path path = out / prepared.file;
  if constexpr (dim == spacedim)
    if (prepared.parts) {
      prepared.parts->write(path, prepared.mesh.coordinates());
      // Of the list, if the mesh is in pieces; files of Gmsh's parts have no list.
      if (std::filesystem::exists(path)) prepared.sha256 = sha256_of_file(path);
      return;
    }
  write_mesh(path, prepared.mesh);
  prepared.sha256 = sha256_of_file(path);
  if (!prepared.kept_name.empty() && !prepared.is_kept) kept.save_mesh(prepared.kept_name, path);
}

#define SMOOTHFEM_INSTANTIATE(...)                                                           \
  template PreparedMesh<__VA_ARGS__> prepare_mesh(                                           \
      const StudyMesh&, const Study&, const std::filesystem::path&, const KeptResults*);     \
  template void write_initial_mesh(PreparedMesh<__VA_ARGS__>&, const std::filesystem::path&, \
                                   const KeptResults&);
SMOOTHFEM_INSTANTIATE(2, 2)
SMOOTHFEM_INSTANTIATE(3, 3)
SMOOTHFEM_INSTANTIATE(2, 3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
