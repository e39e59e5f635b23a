// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "smoothing/loop/method_scheme.h"
#include "smoothing/loop/preset.h"
#include "studies/cli/smooth_arguments.h"

namespace smoothfem {

/// Returns the method of `smooth` with its preset and settings. Throws InputError.
template <int dim, int spacedim = dim>
Method<dim, spacedim> configured_method(const SmoothArguments& arguments) {
  auto method = make_method<dim, spacedim>(arguments.method);
  if (!arguments.preset.empty()) apply_preset(find_preset(arguments.preset), method);
  for (const auto& setting : arguments.settings) {
    const auto equals = setting.find('=');
    if (equals == std::string::npos)
      throw InputError("--set needs key=value, not '" + setting + "'");
    method.set(setting.substr(0, equals), setting.substr(equals + 1));
  }
  check_parameters(method);
  return method;
}

}  // namespace smoothfem
