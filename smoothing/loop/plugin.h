// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "smoothing/loop/plugin_abi.h"

namespace smoothfem {

/// Loads a shared library with a user's methods or solvers. What it registers (RegisteredMethod,
/// RegisteredSolver) is then in the catalogue. A library that is loaded already is skipped. Throws
/// InputError if the file is missing, is not a plugin, was built against headers of another
/// smoothfem, or cannot be loaded. Also throws it if the plugin registers nothing or a duplicate
/// name.
void load_plugin(const std::filesystem::path& library);

/// Returns the library that registers things now; empty if that is this program.
const std::filesystem::path& plugin_being_loaded();

/// A kind of things that plugins register.
struct PluginKind {
  std::string registration = {};  ///< the class that registers one, for example RegisteredMethod
  PluginAbi abi;                  ///< of libraries with such things
  std::function<std::size_t()> n_registered = {};
};

/// Makes a kind known to load_plugin: one namespace-scope object for each kind.
struct RegisteredPluginKind {
  explicit RegisteredPluginKind(PluginKind kind);
};

}  // namespace smoothfem
