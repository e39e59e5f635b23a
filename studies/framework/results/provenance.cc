// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/results/provenance.h"

#include <sys/utsname.h>

#include <Spectra/Util/Version.h>
#include <ginac/version.h>
#include <Eigen/Core>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "smoothfem_commit.h"
#include "smoothfem_versions.h"
#include "smoothing/base/text.h"
#include "smoothing/loop/method_scheme.h"
#include "smoothing/simd/registers.h"

namespace smoothfem {

namespace {

using Json = nlohmann::ordered_json;

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

Json describe_program() {
  Json libraries;
  for (const auto& [name, version] : library_versions()) libraries[name] = version;
  return {{"name", "smoothfem"},
          {"version", SMOOTHFEM_VERSION},
          {"commit", SMOOTHFEM_COMMIT},
          {"uncommitted_changes", SMOOTHFEM_DIRTY},
          {"compiler", SMOOTHFEM_COMPILER},
          {"flags", SMOOTHFEM_FLAGS},
          {"libraries", libraries}};
}

Json describe_machine(const RunFacts& facts) {
  utsname system{};
  uname(&system);
  return {{"cpu", cpu_model()},
          {"registers", registers()},
          {"system", std::string(system.sysname) + " " + system.release},
          {"smoothing_threads", facts.processors.smoothing_threads},
          {"finite_element_threads", facts.processors.finite_element_threads},
          {"ranks", facts.processors.n_ranks}};
}

Json describe_meshes(const RunFacts& facts) {
  Json meshes = Json::array();
  for (const auto& mesh : facts.meshes) {
    meshes.push_back({{"name", mesh.description.name},
                      {"title", mesh.description.title},
                      {"dimension", facts.dimensions.cells},
                      {"origin", mesh.origin},
                      {"source_sha256", mesh.source_sha256},
                      {"published", mesh.published},
                      {"seed", mesh.description.seed},
                      {"n_nodes", mesh.n_nodes},
                      {"n_cells", mesh.n_cells},
                      {"q_min", mesh.quality.q_min},
                      {"q_mean", mesh.quality.q_mean},
                      {"file", mesh.file},
                      {"sha256", mesh.sha256}});
    if (!mesh.changes.empty()) meshes.back()["changes"] = mesh.changes;
    for (const auto& [degree, n_points] : mesh.max_points)
      meshes.back()["most_hexahedron_points"][std::to_string(degree)] = n_points;
    if (!mesh.description.repeats.empty()) meshes.back()["repeats"] = mesh.description.repeats;
  }
  return meshes;
}

/// Returns numbers as numbers, and everything else as text.
Json json_value(const Parameter& parameter) {
  if (const auto* number = std::get_if<double*>(&parameter.value)) return **number;
  if (const auto* number = std::get_if<int*>(&parameter.value)) return **number;
  return value_text(parameter);
}

/// Returns the type of a method or solver, without the folder of its file if it is in a file. The
/// folder depends on the machine; the content does not.
std::string type_without_folder(const std::string& type) {
  auto in_file = method_in_file(type);
  if (!in_file) return type;
  in_file->file = in_file->file.filename();
  return in_file->name();
}

Json describe_methods(const RunFacts& facts) {
  Json methods = Json::array();
  with_dimensions(facts.dimensions, [&]<int dim, int spacedim>() {
    for (const auto& entry : facts.methods) {
      auto method = entry.make<dim, spacedim>();
      Json parameters;
      for (const auto& parameter : method.parameters())
        parameters[parameter.name] = json_value(parameter);
      methods.push_back({{"name", entry.name},
                         {"title", entry.title},
                         {"type", type_without_folder(entry.type)},
                         {"threads", entry.threads},
                         {"citation", method.info.source},
                         {"parameters", parameters}});
      for (const auto& file : entry.files)
        methods.back()["files"].push_back({{"name", file.name}, {"sha256", file.sha256}});
      if (entry.interfaces != InterfaceRule::fixed)
        methods.back()["interfaces"] =
            interface_rule_names[static_cast<std::size_t>(entry.interfaces)];
      if (entry.target)
        methods.back()["target"] = initial_target_names[static_cast<std::size_t>(*entry.target)];
      if (!entry.smooth_for.empty()) methods.back()["smooth_for"] = entry.smooth_for;
      if (!entry.version.empty()) methods.back()["version"] = entry.version;
    }
  });
  return methods;
}

/// Returns the solvers with the meaning of their numbers.
Json describe_solvers(const RunFacts& facts) {
  Json solvers = Json::array();
  with_dimension(facts.dimensions.cells, [&]<int dim>() {
    for (const auto& entry : facts.solvers) {
      const auto solver = entry.make<dim>();
      Json parameters = Json::object(), numbers = Json::array();
      for (const auto& parameter : solver->parameters())
        parameters[parameter.name] = json_value(parameter);
      for (const auto& [parameter, name, value] : entry.keyed)
        parameters[parameter + " " + name] = value;
      for (const auto& number : solver->numbers())
        numbers.push_back({{"column", entry.label + "." + number.name},
                           {"unit", number.unit},
                           {"meaning", number.description}});
      solvers.push_back({{"label", entry.label},
                         {"title", entry.title},
                         {"type", type_without_folder(entry.type)},
                         {"degrees", entry.degrees},
                         {"parameters", parameters},
                         {"numbers", numbers}});
      for (const auto& file : entry.files)
        solvers.back()["files"].push_back({{"name", file.name}, {"sha256", file.sha256}});
      if (!entry.version.empty()) solvers.back()["version"] = entry.version;
    }
  });
  return solvers;
}

/// Returns the earlier sessions and this one.
Json describe_sessions(const RunFacts& facts) {
  Json sessions =
      facts.earlier_sessions.empty() ? Json::array() : Json::parse(facts.earlier_sessions);
  Json seconds = Json::object();
  for (const auto& [phase, value] : facts.seconds) seconds[phase] = value;
  sessions.push_back({{"started", facts.started},
                      {"commit", SMOOTHFEM_COMMIT},
                      {"uncommitted_changes", SMOOTHFEM_DIRTY},
                      {"machine", describe_machine(facts)},
                      {"seconds", seconds}});
  return sessions;
}

Json describe_problem(const ProblemFacts& problem) {
  Json json;
  for (const auto& solution : problem.solutions) {
    Json entry{{"u", solution.u}, {"A", solution.a}};
    if (!solution.label.empty()) entry["label"] = solution.label;
    json["solutions"].push_back(entry);
  }
  json["natural"] = problem.natural;
  json["load"] = problem.load;
  if (!problem.geometry.empty()) json["geometry"] = problem.geometry;
  return json;
}

Json describe_results(const RunFacts& facts) {
  Json results = Json::array();
  for (const auto& result : facts.results) {
    results.push_back({{"mesh", result.mesh}, {"method", result.method}});
    if (!result.smoothed.empty()) results.back()["smoothed"] = result.smoothed;
    for (const auto& [solve, session] : result.solved) results.back()["solved"][solve] = session;
  }
  return results;
}

/// Returns the sessions that some result comes from, and the present one. Without results, all.
Json used_sessions(const RunFacts& facts) {
  Json sessions = describe_sessions(facts);
  if (facts.results.empty()) return sessions;
  std::set<std::string> used{facts.started};
  for (const auto& result : facts.results) {
    used.insert(result.smoothed);
    for (const auto& [solve, session] : result.solved) used.insert(session);
  }
  Json kept = Json::array();
  for (auto& session : sessions)
    if (used.contains(session.at("started").get<std::string>())) kept.push_back(std::move(session));
  return kept;
}

Json seconds_of(const Json& sessions) {
  std::map<std::string, double> sums;
  for (const auto& session : sessions)
    for (const auto& [phase, value] : session.at("seconds").items())
      sums[phase] += value.get<double>();
  return sums;
}

}  // namespace

std::map<std::string, std::string> library_versions() {
  return {
      {"deal.II", SMOOTHFEM_DEAL_II_VERSION},
      {"Eigen", std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) +
                    "." + std::to_string(EIGEN_MINOR_VERSION)},
      {"GiNaC", std::to_string(GINACLIB_MAJOR_VERSION) + "." +
                    std::to_string(GINACLIB_MINOR_VERSION) + "." +
                    std::to_string(GINACLIB_MICRO_VERSION)},
      {"Gmsh", SMOOTHFEM_GMSH_VERSION},
      {"Spectra", std::to_string(SPECTRA_MAJOR_VERSION) + "." +
                      std::to_string(SPECTRA_MINOR_VERSION) + "." +
                      std::to_string(SPECTRA_PATCH_VERSION)},
      {"Trilinos", SMOOTHFEM_TRILINOS_VERSION},
      {"VTK", SMOOTHFEM_VTK_VERSION}};
}

std::string provenance_json(const RunFacts& facts) {
  Json json;
  json["study"] = facts.study.name;
  json["study_title"] = facts.study.title;
  json["note"] = facts.study.note;
  json["status"] = facts.status;
  json["written"] = now_utc();
  json["scale"] = facts.study.scale.empty() ? "default" : facts.study.scale;
  json["built_in"] = facts.study.built_in;
  if (!facts.shard.empty()) json["shard"] = facts.shard;
  if (!facts.members.empty()) json["members"] = facts.members;
  json["program"] = describe_program();
  json["machine"] = describe_machine(facts);
  json["meshes"] = describe_meshes(facts);
  json["methods"] = describe_methods(facts);
  if (!facts.solvers.empty()) json["solvers"] = describe_solvers(facts);
  if (!facts.problem.solutions.empty()) json["problem"] = describe_problem(facts.problem);
  Json parameters;
  for (const auto& [key, value] : facts.study.parameters) parameters[key] = value;
  json["parameters"] = parameters;
  json["settings"] = settings_of(facts.study, facts.meshes, facts.methods, facts.solvers);
  if (!facts.results.empty()) json["results"] = describe_results(facts);
  if (!facts.kept.empty()) json["kept"] = facts.kept;
  json["sessions"] = used_sessions(facts);
  json["seconds"] = seconds_of(json["sessions"]);
  // Names of files may be no UTF-8.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

EarlierRun read_provenance(const std::filesystem::path& path) {
  std::ifstream stream(path);
  if (!stream) return {};
  try {
    const Json json = Json::parse(stream);
    EarlierRun run{.status = json.at("status"),
                   .commit = json.at("program").at("commit"),
                   .sessions = json.at("sessions").dump(),
                   .settings = json.at("settings"),
                   .written = json.at("written"),
                   .meshes = {},
                   .kept = json.value("kept", std::set<std::string>())};
    for (const auto& mesh : json.at("meshes")) run.meshes[mesh.at("file")] = mesh.at("sha256");
    return run;
  } catch (const Json::exception&) {
    throw InputError(
        path.string() +
        " is not a provenance of this program, so the origin of the results next to "
        "it is unknown; start anew with --force, which keeps them under another name, or take "
        "another --out");
  }
}

std::map<std::string, std::string> settings_of(const StudyHeader& study,
                                               const std::vector<MeshFacts>& meshes,
                                               const std::vector<StudyMethod>& methods,
                                               const std::vector<StudySolver>& solvers) {
  std::map<std::string, std::string> settings(study.file_parameters.begin(),
                                              study.file_parameters.end());
  settings["--scale"] = study.scale;
  for (const auto& mesh : meshes) {
    settings["source of mesh " + mesh.description.name] = as_utf8(mesh.setting);
    if (!mesh.source_sha256.empty())
      settings["content of mesh " + mesh.description.name] = mesh.source_sha256;
  }
  if (meshes.empty()) return settings;
  for (const auto& method : methods)
    for (const auto& file : method.files)
      settings["content of method " + method.name + ", " + as_utf8(file.name)] = file.sha256;
  for (const auto& solver : solvers)
    for (const auto& file : solver.files)
      settings["content of solver " + solver.label + ", " + as_utf8(file.name)] = file.sha256;
  return settings;
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

std::string program_commit() {
  return SMOOTHFEM_COMMIT;
}

}  // namespace smoothfem
