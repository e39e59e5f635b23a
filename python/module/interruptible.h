// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <memory>
#include <utility>

#include "smoothing/loop/smoother.h"

namespace smoothfem {

/// Asks Python whether a signal has come, but only so often that it costs nothing. Throws what its
/// handler raises, for Ctrl-C KeyboardInterrupt.
inline void ask_python_for_signals() {
  using Clock = std::chrono::steady_clock;
  constexpr auto interval = std::chrono::milliseconds(50);
  static thread_local Clock::time_point asked{};
  const auto now = Clock::now();
  if (now - asked < interval) return;
  asked = now;
  const pybind11::gil_scoped_acquire gil;
  if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
}

/// A stage that asks Python before each step whether a signal has come: Ctrl-C then ends the run by
/// KeyboardInterrupt.
template <int dim, int spacedim>
class Interruptible final : public Smoother<dim, spacedim> {
 public:
  explicit Interruptible(std::unique_ptr<Smoother<dim, spacedim>> stage)
      : stage_(std::move(stage)) {}

  std::string_view name() const override { return stage_->name(); }
  Parameters parameters() override { return stage_->parameters(); }
  SmootherTraits traits() const override { return stage_->traits(); }
  StoppingRule stopping() const override { return stage_->stopping(); }
  void initialize(const SmoothingState<dim, spacedim>& state) override {
    stage_->initialize(state);
  }
  void check_parameters() const override { stage_->check_parameters(); }
  void use_folders(const SmootherFolders& folders) override { stage_->use_folders(folders); }
  SmootherOrigin origin() override { return stage_->origin(); }
  double initial_score() const override { return stage_->initial_score(); }

  StepReport step(SmoothingState<dim, spacedim>& state) override {
    ask_python_for_signals();
    return stage_->step(state);
  }

 private:
  std::unique_ptr<Smoother<dim, spacedim>> stage_;
};

}  // namespace smoothfem
