// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/member_worker.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "studies/framework/run/checkpoint.h"
#include "studies/framework/run/run_study.h"
#include "studies/framework/run/solve_workers.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

/// Returns the facts about the mesh from the member's provenance.
std::string facts_of(const fs::path& folder, const MeshOutline& outline) {
  std::ifstream stream(folder / "provenance.json");
  const auto provenance = nlohmann::json::parse(stream);
  nlohmann::json facts{{"elements", outline.elements},
                       {"dimension", std::to_string(outline.dimensions.cells)}};
  for (const std::string key : {"n_nodes", "n_cells", "q_min", "q_mean"})
    facts[key] = provenance.at("meshes").at(0).at(key).dump();
  return facts.dump();
}

}  // namespace

MemberWorker::MemberWorker(const Collection& collection, const StudyOptions& options,
                           RunUntil until, std::optional<MpiSession>& mpi)
    : collection_(collection), out_(options.out), mpi_(mpi) {
  options_.quiet = true;
  options_.n_threads = 1;
  options_.smoothing_threads = options.smoothing_threads;
  options_.until = until;
}

fs::path MemberWorker::folder_of(const Member& member) const {
  return member_folder(out_, member.name);
}

std::string MemberWorker::run(const Member& member) {
  options_.out = folder_of(member);
  options_.initial_meshes_are_there = options_.until == RunUntil::meshes && share_mesh(member);
  const MeshOutline outline = outline_of(collection_, member, options_.out);
  const Study study = member_study(collection_, member, outline);
  if (options_.until == RunUntil::smoothing) share_smoothing(member, study);
  // Methods that need the problem also solve it while they smooth.
  if (options_.until != RunUntil::meshes && needs_mpi(study)) {
    if (!mpi_) mpi_.emplace();
    options_.ranks = Ranks(MPI_COMM_WORLD);
  } else {
    options_.ranks = Ranks();
  }
  run_study(study, options_);
  return options_.until == RunUntil::meshes ? facts_of(options_.out, outline) : "";
}

std::optional<fs::path> MemberWorker::at_another(const Member& member, const std::string& status,
                                                 const fs::path& name) const {
  for (const auto& other : collection_.members) {
    if (other.mesh.name != member.mesh.name || other.name == member.name) continue;
    const fs::path folder = folder_of(other);
    if (read_row(folder)["status"] == status && fs::exists(folder / name)) return folder / name;
  }
  return std::nullopt;
}

/// Takes over the mesh from another member with the same mesh and another solution. Returns true if
/// the mesh is then there.
bool MemberWorker::share_mesh(const Member& member) const {
  if (member.mesh.domain.empty()) return false;  // files are read again
  const fs::path name = fs::path("meshes") / (member.mesh.name + "_initial.mesh");
  const auto made = at_another(member, member_meshed, name);
  if (!made) return false;
  const fs::path own = folder_of(member) / name;
  fs::create_directories(own.parent_path());
  fs::copy_file(*made, own, fs::copy_options::overwrite_existing);
  return true;
}

/// Takes over trajectories from another member with the same mesh and another solution. Methods
/// that move nodes by the solution are smoothed anew.
void MemberWorker::share_smoothing(const Member& member, const Study& study) const {
  const auto other = at_another(member, member_smoothed, "checkpoint");
  if (!other) return;
  const Checkpoint own(folder_of(member) / "checkpoint");
  for (const auto& method : study.methods)
    if (!method.needs_problem(study.dimensions))
      own.adopt(*other, Checkpoint::name(member.mesh.name, method.name));
}

void add_facts(const std::string& facts, MemberRow& row) {
  const auto known = nlohmann::json::parse(facts);
  for (const auto& [key, value] : known.items()) row[key] = value.get<std::string>();
}

}  // namespace smoothfem
