// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace smoothfem {

/// Loads a shared library with a user's methods. Methods that it registers by RegisteredMethod are
/// then in the catalogue. A library that is loaded already is skipped. Throws InputError if the
/// file is missing, is not a plugin, was built against headers of another smoothfem, or cannot be
/// loaded. Also throws it if the plugin registers nothing or a duplicate name.
void load_plugin(const std::filesystem::path& library);

}  // namespace smoothfem
