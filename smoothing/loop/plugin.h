// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace smoothfem {

/// Loads a shared library with methods of one's own: those that it registers by RegisteredMethod
/// are then in the catalogue. One that is loaded already is left alone. Throws InputError if it is
/// not there, is no plugin, was built against headers of another smoothfem, cannot be loaded, or
/// registers nothing or a name that is taken.
void load_plugin(const std::filesystem::path& library);

}  // namespace smoothfem
