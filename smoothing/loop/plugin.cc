// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/plugin.h"

#include <dlfcn.h>
#include <elf.h>

#include <algorithm>
#include <cstring>
#include <set>
#include <vector>

#include "smoothing/base/text.h"

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

std::vector<PluginKind>& kinds() {
  static std::vector<PluginKind> all;
  return all;
}

fs::path& present_library() {
  static fs::path library;
  return library;
}

/// While it lives, what registers itself is recorded as of this library.
class PluginScope {
 public:
  explicit PluginScope(const fs::path& library) { present_library() = library; }
  ~PluginScope() { present_library().clear(); }
  PluginScope(const PluginScope&) = delete;
};

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

/// The layout of a kind in a library: none, the program's, or another one.
enum class Layout { none, same, other };

Layout layout_in(const std::string& content, const PluginAbi& abi) {
  const std::string_view mark(abi.mark.data(), abi.mark.size());
  Layout layout = Layout::none;
  for (auto at = content.find(mark); at != std::string::npos; at = content.find(mark, at + 1)) {
    PluginAbi found;
    if (content.size() - at < sizeof(found)) break;
    std::memcpy(&found, content.data() + at, sizeof(found));
    if (found == abi) return Layout::same;
    layout = Layout::other;
  }
  return layout;
}

/// Returns the classes that register things, as "RegisteredMethod or RegisteredSolver".
std::string registrations() {
  std::string text;
  for (const PluginKind& kind : kinds())
    if (kind.n_registered) text += (text.empty() ? "" : " or ") + kind.registration;
  return text;
}

/// Checks that the library and the program have the same layout of shared types; otherwise throws
/// InputError.
void require_same_types(const fs::path& library) {
  const std::string content = file_content(library);
  const std::string elf =
      "\x7f"
      "ELF";
  if (!content.starts_with(elf))
    throw InputError(library.string() +
                     " is not a shared library; build one from the source, as "
                     "'smoothfem new-smoother' and 'smoothfem new-problem' show");
  if (!is_whole(content))
    throw InputError(library.string() + " is incomplete; copy it again, or rebuild it");
  bool is_plugin = false;
  for (const PluginKind& kind : kinds()) {
    const Layout layout = layout_in(content, kind.abi);
    if (layout == Layout::other)
      throw InputError(library.string() +
                       " was built against another smoothfem, whose types differ; rebuild it "
                       "against the installed one");
    is_plugin = is_plugin || layout == Layout::same;
  }
  if (!is_plugin)
    throw InputError(library.string() +
                     " is not a plugin of smoothfem: nothing is registered in it by " +
                     registrations());
}

std::size_t n_registered() {
  std::size_t n = 0;
  for (const PluginKind& kind : kinds())
    if (kind.n_registered) n += kind.n_registered();
  return n;
}

}  // namespace

RegisteredPluginKind::RegisteredPluginKind(PluginKind kind) {
  kinds().push_back(std::move(kind));
}

const fs::path& plugin_being_loaded() {
  return present_library();
}

void load_plugin(const fs::path& library) {
  static std::set<fs::path> loaded;
  std::error_code none;
  const fs::path path = fs::canonical(library, none);
  if (none || !fs::is_regular_file(path))
    throw InputError("there is no plugin " + library.string() + "; check its path");
  if (loaded.contains(path)) return;
  require_same_types(path);
  const std::size_t n_before = n_registered();
  {
    const PluginScope of_library(path);
    if (dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL) == nullptr)
      throw InputError("the plugin " + library.string() + " cannot be loaded: " + dlerror());
  }
  loaded.insert(path);
  if (n_registered() == n_before)
    throw InputError("the plugin " + library.string() +
                     " registers nothing; end its source with a " + registrations() +
                     " at namespace scope");
}

}  // namespace smoothfem
