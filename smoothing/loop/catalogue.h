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

using Stages = std::vector<std::unique_ptr<Smoother<2>>>;

/// A smoothing method: one or more smoothers in turn.
struct Method {
  MethodInfo info;
  Stages stages;

  /// All parameters, "stage.name" where the method has more than one stage.
  Parameters parameters();
  /// Sets one parameter by that name; throws InputError.
  void set(const std::string& name, const std::string& value);
};

/// Registers a method when its file is loaded: one namespace-scope object a method.
struct RegisteredMethod {
  RegisteredMethod(MethodInfo info, std::function<Stages()> make_stages);
};

/// All registered methods, sorted by name.
std::vector<MethodInfo> method_catalogue();

/// A method with its default parameters; throws InputError listing the names there are.
Method make_method(const std::string& name);

/// The stages of a registered method, for methods that are made of others.
Stages stages_of(const std::string& name);

/// make_stages for a method of one smoother.
template <class SmootherType>
Stages single_stage() {
  Stages stages;
  stages.push_back(std::make_unique<SmootherType>());
  return stages;
}

}  // namespace smoothfem
