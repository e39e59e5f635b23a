#include "studies/framework/provenance.h"

#include <openssl/evp.h>
#include <sys/utsname.h>

#include <Spectra/Util/Version.h>
#include <Eigen/Core>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "smoothfem_commit.h"
#include "smoothfem_versions.h"

namespace smoothfem {

namespace {

using Json = nlohmann::ordered_json;

std::string sha256_of_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return "";
  std::ostringstream content;
  content << stream.rdbuf();
  const std::string bytes = content.str();
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr);
  std::string text;
  for (unsigned int i = 0; i < length; ++i) {
    constexpr const char* digits = "0123456789abcdef";
    text += {digits[digest[i] >> 4], digits[digest[i] & 15]};
  }
  return text;
}

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::string now_utc() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
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

Json describe_machine(unsigned int n_threads) {
  utsname system{};
  uname(&system);
  return {{"cpu", cpu_model()},
          {"system", std::string(system.sysname) + " " + system.release},
          {"smoothing_threads", 1},
          {"finite_element_threads", n_threads},
          {"ranks", 1}};
}

Json describe_meshes(const RunFacts& facts) {
  Json meshes = Json::array();
  for (const auto& prepared : facts.meshes) {
    const std::string file = "meshes/" + prepared.description.name + "_initial.mesh";
    meshes.push_back({{"name", prepared.description.name},
                      {"title", prepared.description.title},
                      {"origin", prepared.origin},
                      {"published", prepared.published},
                      {"seed", prepared.description.seed},
                      {"n_nodes", prepared.mesh.n_nodes()},
                      {"n_cells", prepared.mesh.n_cells()},
                      {"q_min", prepared.quality.q_min},
                      {"q_mean", prepared.quality.q_mean},
                      {"file", file},
                      {"sha256", sha256_of_file(facts.options.out / file)}});
  }
  return meshes;
}

/// Numbers as numbers, everything else as its text.
Json json_value(const Parameter& parameter) {
  if (const auto* number = std::get_if<double*>(&parameter.value)) return **number;
  if (const auto* number = std::get_if<int*>(&parameter.value)) return **number;
  return value_text(parameter);
}

Json describe_methods(const Study& study) {
  Json methods = Json::array();
  for (const auto& entry : study.methods) {
    Method<2> method = entry.make();
    Json parameters;
    for (const auto& parameter : method.parameters())
      parameters[parameter.name] = json_value(parameter);
    methods.push_back({{"name", entry.name},
                       {"title", entry.title},
                       {"type", entry.type},
                       {"citation", method.info.source},
                       {"parameters", parameters}});
  }
  return methods;
}

}  // namespace

std::map<std::string, std::string> library_versions() {
  return {
      {"deal.II", SMOOTHFEM_DEAL_II_VERSION},
      {"Eigen", std::to_string(EIGEN_WORLD_VERSION) + "." + std::to_string(EIGEN_MAJOR_VERSION) +
                    "." + std::to_string(EIGEN_MINOR_VERSION)},
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
  json["status"] = facts.status;
  json["written"] = now_utc();
  json["quick"] = facts.options.quick;
  json["program"] = describe_program();
  json["machine"] = describe_machine(facts.n_threads);
  json["meshes"] = describe_meshes(facts);
  json["methods"] = describe_methods(facts.study);
  Json parameters;
  for (const auto& [key, value] : facts.study.parameters) parameters[key] = value;
  json["parameters"] = parameters;
  Json seconds;
  for (const auto& [phase, value] : facts.seconds) seconds[phase] = value;
  json["seconds"] = seconds;
  return json.dump(2) + "\n";
}

}  // namespace smoothfem
