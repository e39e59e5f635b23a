// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace smoothfem {

/// Returns SHA-256 as 64 hexadecimal digits.
std::string sha256(std::string_view content);

/// Returns SHA-256 of a file's content; empty if the file cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace smoothfem
