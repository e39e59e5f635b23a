// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace smoothfem {

/// Writes `content` to folder/name in one piece, with a seal: a checksum of the name, the length
/// and the content. Throws InputError.
void write_sealed(const std::filesystem::path& folder, const std::string& name,
                  std::string_view content);

/// The content of folder/name, or nothing if there is no such file. Throws InputError if the file
/// is not what write_sealed has written under this name: cut off, changed, or another one's.
std::optional<std::string> read_sealed(const std::filesystem::path& folder,
                                       const std::string& name);

/// What is said of a file that is not.
[[noreturn]] void refuse_damaged(const std::filesystem::path& path);

}  // namespace smoothfem
