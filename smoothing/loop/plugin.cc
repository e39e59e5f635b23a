// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/plugin.h"

#include <dlfcn.h>
#include <elf.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "smoothing/base/text.h"
#include "smoothing/loop/catalogue.h"
#include "smoothing/loop/plugin_abi.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

/// Checks that a shared library is complete: it ends with its section headers. The loader may crash
/// if they are cut off.
bool is_whole(const std::string& content) {
  Elf64_Ehdr header;
  if (content.size() < sizeof(header)) return false;
  std::memcpy(&header, content.data(), sizeof(header));
  const std::uint64_t size = content.size();
  return header.e_shoff <= size &&
         size - header.e_shoff >= std::uint64_t{header.e_shnum} * header.e_shentsize;
}

/// Checks that the library's methods and the program have the same layout of shared types;
/// otherwise throws InputError.
void require_same_types(const fs::path& library) {
  const std::string content = file_content(library);
  const std::string elf =
      "\x7f"
      "ELF";
  if (!content.starts_with(elf))
    throw InputError(library.string() +
                     " is not a shared library; build one from the source, as "
                     "'smoothfem new-smoother' shows");
  if (!is_whole(content))
    throw InputError(library.string() + " is incomplete; copy it again, or rebuild it");
  const std::string_view mark(plugin_abi.mark.data(), plugin_abi.mark.size());
  bool is_plugin = false;
  for (auto at = content.find(mark); at != std::string::npos; at = content.find(mark, at + 1)) {
    PluginAbi found;
    if (content.size() - at < sizeof(found)) break;
    std::memcpy(&found, content.data() + at, sizeof(found));
    if (found == plugin_abi) return;
    is_plugin = true;
  }
  throw InputError(library.string() +
                   (is_plugin
                        ? " was built against another smoothfem, whose types differ; rebuild it "
                          "against the installed one"
                        : " is not a plugin of smoothfem: no method is registered in it by "
                          "RegisteredMethod"));
}

}  // namespace

void load_plugin(const fs::path& library) {
  static std::set<fs::path> loaded;
  std::error_code none;
  const fs::path path = fs::canonical(library, none);
  if (none || !fs::is_regular_file(path))
    throw InputError("there is no plugin " + library.string() + "; check its path");
  if (loaded.contains(path)) return;
  require_same_types(path);
  const std::size_t n_before = method_catalogue(true).size();
  {
    const PluginScope of_library(path);
    if (dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL) == nullptr)
      throw InputError("the plugin " + library.string() + " cannot be loaded: " + dlerror());
  }
  loaded.insert(path);
  if (method_catalogue(true).size() == n_before)
    throw InputError("the plugin " + library.string() +
                     " registers no method; end its source with a RegisteredMethod at namespace "
                     "scope");
}

}  // namespace smoothfem
