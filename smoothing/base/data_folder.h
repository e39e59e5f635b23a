// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace smoothfem {

/// Returns the folder of the data that come with the program: studies, presets, printed values. It
/// is the environment variable SMOOTHFEM_DATA, if set. Otherwise it is share/smoothfem in the first
/// folder above this library that has one, installed or built. Throws InputError if there is no
/// such folder.
std::filesystem::path data_folder();

}  // namespace smoothfem
