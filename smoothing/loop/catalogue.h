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

struct MethodInfo {
  std::string name;         ///< on the command line, in study files and results
  std::string title;        ///< in tables and figures
  std::string description;  ///< one sentence
  std::string source;       ///< thesis section or paper
  /// Whether it says nothing without parameters that users give it: then it is not one of "all".
  bool needs_parameters = false;
  /// Whether it moves nodes by the solution of a problem (loop/problem.h), which only studies that
  /// solve one have: it is not one of "all" either.
  bool needs_problem = false;
  std::filesystem::path library = {};  ///< the plugin that registered it; empty: this program
};

template <int dim, int spacedim = dim>
using Stages = std::vector<std::unique_ptr<Smoother<dim, spacedim>>>;

/// A smoothing method for meshes of one kind: one or more smoothers in turn.
template <int dim, int spacedim = dim>
struct Method {
  MethodInfo info;
  Stages<dim, spacedim> stages;
  std::shared_ptr<const Problem<spacedim>> problem = {};  ///< for methods that need one

  /// All parameters, "stage.name" where the method has more than one stage.
  Parameters parameters();
  /// Sets one parameter by that name; throws InputError.
  void set(const std::string& name, const std::string& value);
};

/// Throws InputError where parameters do not go together.
template <int dim, int spacedim>
void check_parameters(const Method<dim, spacedim>& method) {
  for (const auto& stage : method.stages) stage->check_parameters();
}

/// Tells all stages where their files are.
template <int dim, int spacedim>
void use_folders(Method<dim, spacedim>& method, const SmootherFolders& folders) {
  for (auto& stage : method.stages) stage->use_folders(folders);
}

/// How to make the stages of a method for planar, volume and surface meshes; empty where it takes
/// none of these.
struct StageFactories {
  std::function<Stages<2>()> planar = {};
  std::function<Stages<3>()> volume = {};
  std::function<Stages<2, 3>()> surface = {};
};

/// A method: what is said about it, and how to make it.
struct MethodEntry {
  std::string name;
  MethodInfo info;
  StageFactories factories;
};

/// Registers a method when its file is loaded: one namespace-scope object a method.
struct RegisteredMethod {
  RegisteredMethod(MethodInfo info, StageFactories factories);
};

/// As long as it lives, methods that register themselves are those of this library.
class LibraryOfMethods {
 public:
  explicit LibraryOfMethods(const std::filesystem::path& library);
  ~LibraryOfMethods();
  LibraryOfMethods(const LibraryOfMethods&) = delete;
};

/// The registered methods that can do without parameters and without a problem, or all there are,
/// sorted by name.
std::vector<MethodInfo> method_catalogue(bool also_those_with_needs = false);

/// True if every stage keeps nodes where the constraints of a mesh have them (SmootherTraits).
template <int dim, int spacedim>
bool keeps_constraints(const Method<dim, spacedim>& method);

/// In what follows, a method is given by its name among the registered ones, or as one in a file
/// (method_scheme.h).

/// True if the method takes meshes of this kind; with_constraints: also those whose nodes have to
/// stay on a surface, as those of surface meshes and of sliding boundaries of volume meshes.
template <int dim, int spacedim = dim>
bool takes_meshes(const std::string& method, bool with_constraints = (spacedim > dim));

/// The names of the methods that do, in the order of the catalogue.
template <int dim, int spacedim = dim>
std::vector<std::string> methods_that_take(bool with_constraints = (spacedim > dim));

/// What a method takes, in words: some of planar, volume, volume with sliding boundary, surface.
std::vector<std::string> mesh_kinds(const std::string& method);

/// A method with its default parameters. Throws InputError listing the names there are, or saying
/// that the method does not take meshes of this kind, and which ones do.
template <int dim, int spacedim = dim>
Method<dim, spacedim> make_method(const std::string& name);

/// The stages of a registered method, for methods that are made of others.
template <int dim, int spacedim = dim>
Stages<dim, spacedim> stages_of(const std::string& name);

/// The one stage of a method that is a single smoother.
template <class SmootherType, int dim, int spacedim = dim>
Stages<dim, spacedim> make_single_stage() {
  static_assert(std::is_base_of_v<Smoother<dim, spacedim>, SmootherType>,
                "a smoother derives from Smoother<dim>, or on surfaces too from "
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

/// Factories for a method of one smoother, a class template over the dimension.
template <template <int> class SmootherType>
StageFactories single_stage() {
  return {make_single_stage<SmootherType<2>, 2>, make_single_stage<SmootherType<3>, 3>};
}

/// The same for a class template over the dimensions of cells and of space, which puts nodes where
/// allowed_position (smoothing/mesh/node_constraints.h) has them.
template <template <int, int> class SmootherType>
StageFactories single_stage_also_on_surfaces() {
  return {make_single_stage<SmootherType<2, 2>, 2>, make_single_stage<SmootherType<3, 3>, 3>,
          make_single_stage<SmootherType<2, 3>, 2, 3>};
}

}  // namespace smoothfem
