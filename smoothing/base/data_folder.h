// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace smoothfem {

/// The folder of the data that come with the program: studies, presets, printed values. The
/// environment variable SMOOTHFEM_DATA, otherwise share/smoothfem in the first folder above this
/// library that has one, be it installed or built. Throws InputError if there is none.
std::filesystem::path data_folder();

}  // namespace smoothfem
