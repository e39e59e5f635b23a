// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace smoothfem {

/// Writes `content` to folder/name as a whole, with a seal: a checksum of the name, the length and
/// the content. Throws InputError.
void write_sealed(const std::filesystem::path& folder, const std::string& name,
                  std::string_view content);

/// Returns the content of folder/name, or nothing if there is no such file. Throws InputError if
/// write_sealed did not write the file under this name, or if it is cut off or changed.
std::optional<std::string> read_sealed(const std::filesystem::path& folder,
                                       const std::string& name);

/// Throws InputError that the file is damaged.
[[noreturn]] void refuse_damaged(const std::filesystem::path& path);

}  // namespace smoothfem
