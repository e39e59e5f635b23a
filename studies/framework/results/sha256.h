// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace smoothfem {

/// SHA-256 in 64 hexadecimal digits.
std::string sha256(std::string_view content);

/// Of a file's content; empty if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace smoothfem
