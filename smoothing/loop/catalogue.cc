#include "smoothing/loop/catalogue.h"

#include <map>

#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

struct Entry {
  MethodInfo info;
  std::function<Stages()> make_stages;
};

/// Ordered by name, so listings do not depend on the order in which files are linked or loaded.
std::map<std::string, Entry>& entries() {
  static std::map<std::string, Entry> catalogue;
  return catalogue;
}

const Entry& entry(const std::string& name) {
  const auto found = entries().find(name);
  if (found != entries().end()) return found->second;
  std::string known;
  for (const auto& [known_name, unused] : entries())
    known += (known.empty() ? "" : ", ") + known_name;
  throw InputError("there is no method '" + name + "'; choose one of " + known);
}

}  // namespace

RegisteredMethod::RegisteredMethod(MethodInfo info, std::function<Stages()> make_stages) {
  const std::string name = info.name;
  if (!entries().emplace(name, Entry{std::move(info), std::move(make_stages)}).second)
    throw std::logic_error("two methods are registered as '" + name + "'");
}

std::vector<MethodInfo> method_catalogue() {
  std::vector<MethodInfo> infos;
  for (const auto& [name, entry] : entries()) infos.push_back(entry.info);
  return infos;
}

Method make_method(const std::string& name) {
  return {entry(name).info, entry(name).make_stages()};
}

Stages stages_of(const std::string& name) {
  return entry(name).make_stages();
}

Parameters Method::parameters() {
  Parameters all;
  for (const auto& stage : stages)
    for (auto& parameter : stage->parameters()) {
      if (stages.size() > 1) parameter.name = std::string(stage->name()) + "." + parameter.name;
      all.push_back(std::move(parameter));
    }
  return all;
}

void Method::set(const std::string& name, const std::string& value) {
  const std::string owner = "method " + info.name;
  set_value(find_parameter(parameters(), name, owner), value, owner);
}

}  // namespace smoothfem
