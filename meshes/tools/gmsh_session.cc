// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/gmsh_session.h"

#include <gmsh.h>

#include <exception>
#include <string_view>
#include <vector>

#include "smoothing/base/input_error.h"
#include "smoothing/base/parallel.h"

namespace smoothfem {

namespace {

int n_sessions = 0;

/// Returns Gmsh's error lines without their label, joined to one sentence.
std::string logged_errors() {
  constexpr std::string_view label = "Error: ";
  std::vector<std::string> lines;
  gmsh::logger::get(lines);
  std::string errors;
  for (const auto& line : lines)
    if (line.starts_with(label)) errors += (errors.empty() ? "" : "; ") + line.substr(label.size());
  return errors;
}

}  // namespace

GmshSession::GmshSession() : former_threads_(n_threads()) {
  if (n_sessions == 0)
    gmsh::initialize(0, nullptr, false);
  else
    gmsh::model::getCurrent(outer_model_);
  set_option("General.Terminal", 0);
  set_option("General.AbortOnError", 2);
  set_option("General.NumThreads", 1);
  set_option("Mesh.RandomSeed", 1);
  model_ = "smoothfem " + std::to_string(n_sessions++);
  gmsh::model::add(model_);
}

GmshSession::~GmshSession() {
  try {
    gmsh::model::setCurrent(model_);
    gmsh::model::remove();
    for (auto option = former_options_.rbegin(); option != former_options_.rend(); ++option)
      gmsh::option::setNumber(option->first, option->second);
    if (--n_sessions == 0)
      gmsh::finalize();
    else
      gmsh::model::setCurrent(outer_model_);
  } catch (...) {  // Gmsh throws strings; a destructor must not throw
  }
  set_n_threads(former_threads_);
}

void GmshSession::set_option(const std::string& name, double value) {
  double former = 0.0;
  gmsh::option::getNumber(name, former);
  former_options_.emplace_back(name, former);
  gmsh::option::setNumber(name, value);
}

void GmshSession::run(const std::string& context, const std::function<void()>& calls) const {
  std::string thrown;
  gmsh::logger::start();
  try {
    calls();
  } catch (const InputError&) {
    gmsh::logger::stop();
    throw;
  } catch (const std::exception& error) {
    thrown = error.what();
  } catch (const std::string& error) {
    thrown = error.empty() ? "unknown error" : error;
  } catch (int code) {
    thrown = "error code " + std::to_string(code);
  }
  const std::string logged = logged_errors();
  gmsh::logger::stop();
  if (!thrown.empty() || !logged.empty())
    throw InputError(context + ": Gmsh: " + (logged.empty() ? thrown : logged));
}

}  // namespace smoothfem
