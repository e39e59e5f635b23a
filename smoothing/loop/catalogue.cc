// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/catalogue.h"

#include <algorithm>
#include <utility>

#include "smoothing/base/registry.h"
#include "smoothing/loop/method_scheme.h"
#include "smoothing/loop/plugin.h"

namespace smoothfem {

namespace {

Registry<MethodEntry>& registry() {
  static Registry<MethodEntry> methods("method");
  return methods;
}

MethodEntry entry(const std::string& name) {
  if (const auto in_file = method_in_file(name)) return make_entry(*in_file);
  return registry().find(name);
}

}  // namespace

RegisteredMethod::RegisteredMethod(MethodInfo info, StageFactories factories) {
  std::string name = info.name;
  info.library = plugin_being_loaded();
  registry().add({std::move(name), std::move(info), std::move(factories)});
}

static const RegisteredPluginKind methods_of_plugins({.registration = "RegisteredMethod",
                                                      .abi = method_abi,
                                                      .n_registered = [] {
                                                        return method_catalogue(true).size();
                                                      }});

std::vector<MethodInfo> method_catalogue(bool include_special) {
  std::vector<MethodInfo> infos;
  for (const auto& entry : registry().all())
    if (include_special || !(entry.info.needs_parameters || entry.info.needs_problem()))
      infos.push_back(entry.info);
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

}  // namespace

template <int dim, int spacedim>
bool keeps_constraints(const Method<dim, spacedim>& method) {
  return std::all_of(method.stages.begin(), method.stages.end(),
                     [](const auto& stage) { return stage->traits().keeps_constraints; });
}

template <int dim, int spacedim>
bool takes_targets(const Method<dim, spacedim>& method) {
  return std::all_of(method.stages.begin(), method.stages.end(),
                     [](const auto& stage) { return stage->traits().takes_targets; });
}

template <int dim, int spacedim>
bool moves_midside_nodes(const Method<dim, spacedim>& method) {
  const auto moves = [](const auto& stage) { return stage->traits().moves_midside_nodes; };
  const bool any = std::any_of(method.stages.begin(), method.stages.end(), moves);
  if (any && !std::all_of(method.stages.begin(), method.stages.end(), moves))
    throw InputError("method " + method.info.name +
                     " has stages that move midside nodes and stages that move corners only; run "
                     "these as separate methods on meshes of second order");
  return any;
}

template <int dim, int spacedim>
bool works_in_parts(const Method<dim, spacedim>& method) {
  return std::all_of(method.stages.begin(), method.stages.end(),
                     [](const auto& stage) { return stage->traits().works_in_parts; });
}

namespace {

/// Returns the names of the methods that a condition holds for.
template <int dim, int spacedim, class Condition>
std::vector<std::string> methods_with(const Condition& condition) {
  std::vector<std::string> names;
  for (const auto& entry : registry().all())
    if (supports_mesh_kind<dim, spacedim>(entry.name) &&
        condition(make_method<dim, spacedim>(entry.name)))
      names.push_back(entry.name);
  return names;
}

}  // namespace

template <int dim>
std::vector<std::string> methods_with_targets() {
  return methods_with<dim, dim>(takes_targets<dim, dim>);
}
template <int dim, int spacedim>
std::vector<std::string> methods_for_parts() {
  return methods_with<dim, spacedim>(works_in_parts<dim, spacedim>);
}

template <int dim, int spacedim>
bool supports_mesh_kind(const std::string& method, bool with_constraints) {
  const MethodEntry found = entry(method);
  const auto& make_stages = factory_of<dim, spacedim>(found.factories);
  return make_stages && (!with_constraints || keeps_constraints(Method<dim, spacedim>{
                                                  .info = found.info, .stages = make_stages()}));
}

template <int dim, int spacedim>
std::vector<std::string> methods_supporting(bool with_constraints) {
  std::vector<std::string> names;
  for (const auto& entry : registry().all())
    if (supports_mesh_kind<dim, spacedim>(entry.name, with_constraints))
      names.push_back(entry.name);
  return names;
}

std::vector<std::string> mesh_kinds(const std::string& method) {
  std::vector<std::string> kinds;
  if (supports_mesh_kind<2>(method)) kinds.emplace_back(mesh_kind_name(2, 2));
  if (supports_mesh_kind<2>(method, true))
    kinds.push_back(mesh_kind_name(2, 2) + std::string(" with sliding boundary"));
  if (supports_mesh_kind<3>(method)) kinds.emplace_back(mesh_kind_name(3, 3));
  if (supports_mesh_kind<3>(method, true))
    kinds.push_back(mesh_kind_name(3, 3) + std::string(" with sliding boundary"));
  if (supports_mesh_kind<2, 3>(method)) kinds.emplace_back(mesh_kind_name(2, 3));
  return kinds;
}

template <int dim, int spacedim>
Stages<dim, spacedim> stages_of(const std::string& name) {
  if (!supports_mesh_kind<dim, spacedim>(name))
    throw InputError("method " + name + " does not support " + mesh_kind_name(dim, spacedim) +
                     " meshes; " + choose_one_of(methods_supporting<dim, spacedim>()));
  return factory_of<dim, spacedim>(entry(name).factories)();
}

template <int dim, int spacedim>
Method<dim, spacedim> make_method(const std::string& name) {
  return {.info = entry(name).info, .stages = stages_of<dim, spacedim>(name)};
}

template <int dim, int spacedim>
Parameters Method<dim, spacedim>::parameters() {
  Parameters all;
  for (const auto& stage : stages)
    for (auto& parameter : stage->parameters()) {
      if (stages.size() > 1) parameter.name = std::string(stage->name()) + "." + parameter.name;
      all.push_back(std::move(parameter));
    }
  all.push_back({"floor",
                 "initial: reset nodes at the end until no cell is worse than the worst one of the "
                 "initial mesh; not in the thesis",
                 Choice{&floor, {"none", "initial"}}});
  return all;
}

template <int dim, int spacedim>
void Method<dim, spacedim>::set(const std::string& name, const std::string& value) {
  const std::string owner = "method " + info.name;
  set_value(find_parameter(parameters(), name, owner), value, owner);
}

template std::vector<std::string> methods_with_targets<2>();
template std::vector<std::string> methods_with_targets<3>();

#define SMOOTHFEM_INSTANTIATE(...)                                         \
  template bool takes_targets(const Method<__VA_ARGS__>&);                 \
  template bool works_in_parts(const Method<__VA_ARGS__>&);                \
  template std::vector<std::string> methods_for_parts<__VA_ARGS__>();      \
  template bool keeps_constraints(const Method<__VA_ARGS__>&);             \
  template bool moves_midside_nodes(const Method<__VA_ARGS__>&);           \
  template bool supports_mesh_kind<__VA_ARGS__>(const std::string&, bool); \
  template std::vector<std::string> methods_supporting<__VA_ARGS__>(bool); \
  template Stages<__VA_ARGS__> stages_of(const std::string&);              \
  template Method<__VA_ARGS__> make_method(const std::string&);            \
  template struct Method<__VA_ARGS__>;
SMOOTHFEM_INSTANTIATE(2, 2)
SMOOTHFEM_INSTANTIATE(3, 3)
SMOOTHFEM_INSTANTIATE(2, 3)
#undef SMOOTHFEM_INSTANTIATE

}  // namespace smoothfem
