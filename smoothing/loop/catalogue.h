// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "smoothing/loop/plugin_abi.h"
#include "smoothing/loop/smoother.h"

namespace smoothfem {

/// Every plugin with a method contains it.
[[gnu::used]] inline constexpr PluginAbi method_abi = abi_with(
    "smoothfem plugin types:", {sizeof(SmoothingState<3>), sizeof(StepReport), sizeof(StoppingRule),
                                sizeof(Parameter), sizeof(SmootherTraits)});

/// What a method takes from the solution that it moves nodes by (loop/problem.h).
struct ProblemUse {
  bool energy_gradient = false;  ///< the energy and its gradient
  bool indicators = false;       ///< one error indicator for each cell
  bool directions = false;       ///< error tensors or second derivatives
  bool any() const { return energy_gradient || indicators || directions; }
};

struct MethodInfo {
  std::string name;         ///< on the command line, in study files and results
  std::string title;        ///< in tables and figures
  std::string description;  ///< one sentence
  std::string source;       ///< thesis section or paper
  /// True if the method has required parameters: it cannot run without them and is excluded from
  /// "all".
  bool needs_parameters = false;
  ProblemUse problem_use = {};
  std::filesystem::path library = {};  ///< the plugin that registered it; empty: this program

  /// True if the method moves nodes by the solution of a problem, which only studies with a problem
  /// have. It is excluded from "all".
  bool needs_problem() const { return problem_use.any(); }
};

template <int dim, int spacedim = dim>
using Stages = std::vector<std::unique_ptr<Smoother<dim, spacedim>>>;

/// A smoothing method for meshes of one kind: one or more stages, each a smoother.
template <int dim, int spacedim = dim>
struct Method {
  MethodInfo info;
  Stages<dim, spacedim> stages;
  std::shared_ptr<const Problem<spacedim>> problem = {};  ///< for methods that need one
  /// 1: no cell of the result is worse than the worst one of the initial mesh, if that is valid.
  /// Nodes of worse cells get their initial positions at the end.
  int floor = 0;

  /// Returns all parameters, as "stage.name" if the method has more than one stage.
  Parameters parameters();
  /// Sets one parameter by that name; throws InputError.
  void set(const std::string& name, const std::string& value);
};

/// Checks parameters that depend on each other; throws InputError if they do not fit together.
template <int dim, int spacedim>
void check_parameters(const Method<dim, spacedim>& method) {
  for (const auto& stage : method.stages) stage->check_parameters();
}

/// Passes the folders of files to all stages.
template <int dim, int spacedim>
void use_folders(Method<dim, spacedim>& method, const SmootherFolders& folders) {
  for (auto& stage : method.stages) stage->use_folders(folders);
}

/// Factories for the stages of a method, for planar, volume and surface meshes; empty for kinds of
/// meshes that it does not support.
struct StageFactories {
  std::function<Stages<2>()> planar = {};
  std::function<Stages<3>()> volume = {};
  std::function<Stages<2, 3>()> surface = {};
};

/// A method: its description and its factories.
struct MethodEntry {
  std::string name;
  MethodInfo info;
  StageFactories factories;
};

/// Registers a method when its file is loaded: one namespace-scope object for each method.
struct RegisteredMethod {
  RegisteredMethod(MethodInfo info, StageFactories factories);
};

/// Returns the registered methods, sorted by name. Methods that need parameters or a problem are
/// left out, unless include_special is true.
std::vector<MethodInfo> method_catalogue(bool include_special = false);

/// True if every stage keeps nodes where the constraints of a mesh allow them (SmootherTraits).
template <int dim, int spacedim>
bool keeps_constraints(const Method<dim, spacedim>& method);

/// True if every stage moves cells towards the targets of a mesh (SmootherTraits).
template <int dim, int spacedim>
bool takes_targets(const Method<dim, spacedim>& method);

/// True if every stage works in parts of a mesh (SmootherTraits).
template <int dim, int spacedim>
bool works_in_parts(const Method<dim, spacedim>& method);

/// True if every stage moves midside nodes by itself (SmootherTraits). Throws InputError if some
/// stages do and others move corners only.
template <int dim, int spacedim>
bool moves_midside_nodes(const Method<dim, spacedim>& method);

/// Returns the names of the methods that take targets, in the order of the catalogue.
template <int dim>
std::vector<std::string> methods_with_targets();
/// Returns the names of the methods that work in parts of a mesh, in the order of the catalogue.
template <int dim, int spacedim>
std::vector<std::string> methods_for_parts();

/// The functions below take the name of a registered method, or of a method in a file
/// (method_scheme.h).

/// True if the method supports meshes of this kind. with_constraints: also those with nodes that
/// must stay on a surface or curve (surface meshes, sliding boundaries).
template <int dim, int spacedim = dim>
bool supports_mesh_kind(const std::string& method, bool with_constraints = (spacedim > dim));

/// Returns the names of these methods, in the order of the catalogue.
template <int dim, int spacedim = dim>
std::vector<std::string> methods_supporting(bool with_constraints = (spacedim > dim));

/// Returns the kinds of meshes that a method supports: some of planar, planar with sliding
/// boundary, volume, volume with sliding boundary, surface.
std::vector<std::string> mesh_kinds(const std::string& method);

/// Makes a method with its default parameters. Throws InputError for an unknown name; the message
/// lists the available names. Throws it also if the method does not support meshes of this kind;
/// the message lists the methods that do.
template <int dim, int spacedim = dim>
Method<dim, spacedim> make_method(const std::string& name);

/// Makes the stages of a registered method, for methods that consist of others.
template <int dim, int spacedim = dim>
Stages<dim, spacedim> stages_of(const std::string& name);

/// Makes the stage of a method that is a single smoother.
template <class SmootherType, int dim, int spacedim = dim>
Stages<dim, spacedim> make_single_stage() {
  static_assert(std::is_base_of_v<Smoother<dim, spacedim>, SmootherType>,
                "a smoother derives from Smoother<dim>; to support surfaces it derives from "
                "Smoother<dim, spacedim>");
  static_assert(!std::is_abstract_v<SmootherType>,
                "a smoother needs 'std::string_view name() const override' and 'StepReport "
                "step(SmoothingState<dim>& state) override'");
  Stages<dim, spacedim> stages;
  if constexpr (std::is_base_of_v<Smoother<dim, spacedim>, SmootherType> &&
                !std::is_abstract_v<SmootherType>)
    stages.push_back(std::make_unique<SmootherType>());
  return stages;
}

/// Factories for a method with one smoother, a class template over the dimension.
template <template <int> class SmootherType>
StageFactories single_stage() {
  return {make_single_stage<SmootherType<2>, 2>, make_single_stage<SmootherType<3>, 3>};
}

/// Factories for a class template over the dimensions of cells and of space. It must move nodes
/// only to positions of allowed_position (smoothing/mesh/node_constraints.h).
template <template <int, int> class SmootherType>
StageFactories single_stage_also_on_surfaces() {
  return {make_single_stage<SmootherType<2, 2>, 2>, make_single_stage<SmootherType<3, 3>, 3>,
          make_single_stage<SmootherType<2, 3>, 2, 3>};
}

}  // namespace smoothfem
