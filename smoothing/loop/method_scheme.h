// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/method_in_file.h"

namespace smoothfem {

/// Maker of the methods of a scheme.
struct MethodScheme {
  std::string name;  ///< the word before the colon
  /// Makes the method. Throws InputError if the file has no such method.
  MethodEntry (*make)(const MethodInFile& method);
};

/// Registers a scheme when its file is loaded: one namespace-scope object for each scheme.
struct RegisteredScheme {
  explicit RegisteredScheme(MethodScheme scheme);
};

/// Makes the entry of the method. Throws InputError as the scheme's `make` does.
MethodEntry make_entry(const MethodInFile& method);

}  // namespace smoothfem
