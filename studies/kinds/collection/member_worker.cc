// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/member_worker.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "studies/framework/results/results_folder.h"
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
  options_.kept = out_ / kept_folder;
  options_.retime = options.retime && until == RunUntil::smoothing;
}

std::string MemberWorker::run(const Member& member) {
  options_.out = member_folder(out_, member.name);
  // A mesh that an earlier run has left may be that of another file.
  const bool has_mesh = options_.until != RunUntil::meshes;
  const MeshOutline outline = outline_of(collection_, member, has_mesh ? options_.out : "");
  const Study study = member_study(collection_, member, outline);
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

void add_facts(const std::string& facts, MemberRow& row) {
  const auto known = nlohmann::json::parse(facts);
  for (const auto& [key, value] : known.items()) row[key] = value.get<std::string>();
}

}  // namespace smoothfem
