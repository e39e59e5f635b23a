// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace smoothfem {

/// The Gmsh library for the length of a scope, with a new empty model. Prints nothing, reads no
/// configuration files and no command line, does not change signal handlers, uses one thread and a
/// fixed random seed. Sessions may be nested. Gmsh itself is global: do not use it from two
/// threads.
class GmshSession {
 public:
  GmshSession();
  ~GmshSession();
  GmshSession(const GmshSession&) = delete;
  GmshSession& operator=(const GmshSession&) = delete;

  /// Sets a numerical option until the session ends.
  void set_option(const std::string& name, double value);

  /// Runs Gmsh calls. Exceptions and errors of Gmsh become InputError "context: Gmsh: message". Do
  /// not call it from inside `calls`.
  void run(const std::string& context, const std::function<void()>& calls) const;

 private:
  int former_threads_;  ///< of OpenMP; Gmsh's option changes them for the whole process
  std::string model_;
  std::string outer_model_;  ///< current when this session began
  std::vector<std::pair<std::string, double>> former_options_;
};

}  // namespace smoothfem
