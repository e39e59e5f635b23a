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

template <int dim, int spacedim>
const auto& factory_of(const StageFactories& factories) {
  if constexpr (spacedim > dim)
    return factories.surface;
  else if constexpr (dim == 2)
    return factories.planar;
  else
    return factories.volume;
}

template <int dim, int spacedim>
[[noreturn]] void refuse(const std::string& method) {
  std::vector<std::string> others;
  for (const auto& [name, entry] : entries())
    if (factory_of<dim, spacedim>(entry.factories)) others.push_back(name);
  throw InputError("method " + method + " does not take " + mesh_kind_name(dim, spacedim) +
                   " meshes; " + choose_one_of(others));
}

}  // namespace

template <int dim, int spacedim>
bool takes_meshes(const std::string& method) {
  return static_cast<bool>(factory_of<dim, spacedim>(entry(method).factories));
}

template <int dim, int spacedim>
Stages<dim, spacedim> stages_of(const std::string& name) {
  if (!takes_meshes<dim, spacedim>(name)) refuse<dim, spacedim>(name);
  return factory_of<dim, spacedim>(entry(name).factories)();
}

template <int dim, int spacedim>
Method<dim, spacedim> make_method(const std::string& name) {
  return {entry(name).info, stages_of<dim, spacedim>(name)};
}

template <int dim, int spacedim>
Parameters Method<dim, spacedim>::parameters() {
  Parameters all;
  for (const auto& stage : stages)
    for (auto& parameter : stage->parameters()) {
      if (stages.size() > 1) parameter.name = std::string(stage->name()) + "." + parameter.name;
      all.push_back(std::move(parameter));
    }
  return all;
}

template <int dim, int spacedim>
void Method<dim, spacedim>::set(const std::string& name, const std::string& value) {
  const std::string owner = "method " + info.name;
  set_value(find_parameter(parameters(), name, owner), value, owner);
}

#define SMOOTHFEM_INSTANTIATE(...)                              \
  template bool takes_meshes<__VA_ARGS__>(const std::string&);  \
  template Stages<__VA_ARGS__> stages_of(const std::string&);   \
  template Method<__VA_ARGS__> make_method(const std::string&); \
  template struct Method<__VA_ARGS__>;
SMOOTHFEM_INSTANTIATE(2, 2)
SMOOTHFEM_INSTANTIATE(3, 3)
SMOOTHFEM_INSTANTIATE(2, 3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
