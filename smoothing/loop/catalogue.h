#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "smoothing/loop/smoother.h"

namespace smoothfem {

struct MethodInfo {
  std::string name;         ///< on the command line, in study files and results
  std::string title;        ///< in tables and figures
  std::string description;  ///< one sentence
  std::string source;       ///< thesis section or paper
};

template <int dim>
using Stages = std::vector<std::unique_ptr<Smoother<dim>>>;

/// A smoothing method for meshes of one dimension: one or more smoothers in turn.
template <int dim>
struct Method {
  MethodInfo info;
  Stages<dim> stages;

  /// All parameters, "stage.name" where the method has more than one stage.
  Parameters parameters();
  /// Sets one parameter by that name; throws InputError.
  void set(const std::string& name, const std::string& value);
};

/// How to make the stages of a method for planar and for volume meshes; empty where it takes none
/// of these.
struct StageFactories {
  std::function<Stages<2>()> planar;
  std::function<Stages<3>()> volume;
};

/// Registers a method when its file is loaded: one namespace-scope object a method.
struct RegisteredMethod {
  RegisteredMethod(MethodInfo info, StageFactories factories);
};

/// All registered methods, sorted by name.
std::vector<MethodInfo> method_catalogue();

/// True if the method takes meshes of dimension dim.
template <int dim>
bool takes_meshes(const std::string& method);

/// A method with its default parameters. Throws InputError listing the names there are, or saying
/// that the method does not take meshes of dimension dim.
template <int dim>
Method<dim> make_method(const std::string& name);

/// The stages of a registered method, for methods that are made of others.
template <int dim>
Stages<dim> stages_of(const std::string& name);

/// Factories for a method of one smoother, a class template over the dimension.
template <template <int> class SmootherType>
StageFactories single_stage() {
  const auto make = []<int dim>() {
    Stages<dim> stages;
    stages.push_back(std::make_unique<SmootherType<dim>>());
    return stages;
  };
  return {[make] { return make.template operator()<2>(); },
          [make] { return make.template operator()<3>(); }};
}

}  // namespace smoothfem
