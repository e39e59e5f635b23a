#include "smoothing/loop/catalogue.h"

#include <map>

#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

struct Entry {
  MethodInfo info;
  StageFactories factories;
};

/// Ordered by name, so listings do not depend on the order in which files are linked or loaded.
std::map<std::string, Entry>& entries() {
  static std::map<std::string, Entry> catalogue;
  return catalogue;
}

const Entry& entry(const std::string& name) {
  const auto found = entries().find(name);
  if (found != entries().end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [known_name, unused] : entries()) known.push_back(known_name);
  throw InputError("there is no method '" + name + "'; " + choose_one_of(known));
}

}  // namespace

RegisteredMethod::RegisteredMethod(MethodInfo info, StageFactories factories) {
  const std::string name = info.name;
  if (!entries().emplace(name, Entry{std::move(info), std::move(factories)}).second)
    throw std::logic_error("two methods are registered as '" + name + "'");
}

std::vector<MethodInfo> method_catalogue() {
  std::vector<MethodInfo> infos;
  for (const auto& [name, entry] : entries()) infos.push_back(entry.info);
  return infos;
}

namespace {

template <int dim>
const auto& factory_of(const std::string& name) {
  const StageFactories& factories = entry(name).factories;
  if constexpr (dim == 2)
    return factories.planar;
  else
    return factories.volume;
}

}  // namespace

template <int dim>
bool takes_meshes(const std::string& method) {
  return static_cast<bool>(factory_of<dim>(method));
}

template <int dim>
Stages<dim> stages_of(const std::string& name) {
  if (!takes_meshes<dim>(name))
    throw InputError("method " + name + " does not take " + (dim == 2 ? "planar" : "volume") +
                     " meshes; choose another one (see 'list')");
  return factory_of<dim>(name)();
}

template <int dim>
Method<dim> make_method(const std::string& name) {
  return {entry(name).info, stages_of<dim>(name)};
}

template <int dim>
Parameters Method<dim>::parameters() {
  Parameters all;
  for (const auto& stage : stages)
    for (auto& parameter : stage->parameters()) {
      if (stages.size() > 1) parameter.name = std::string(stage->name()) + "." + parameter.name;
      all.push_back(std::move(parameter));
    }
  return all;
}

template <int dim>
void Method<dim>::set(const std::string& name, const std::string& value) {
  const std::string owner = "method " + info.name;
  set_value(find_parameter(parameters(), name, owner), value, owner);
}

template bool takes_meshes<2>(const std::string&);
template bool takes_meshes<3>(const std::string&);
template Stages<2> stages_of(const std::string&);
template Stages<3> stages_of(const std::string&);
template Method<2> make_method(const std::string&);
template Method<3> make_method(const std::string&);
template struct Method<2>;
template struct Method<3>;

}  // namespace smoothfem
