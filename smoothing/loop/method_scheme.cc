// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/method_scheme.h"

#include <algorithm>
#include <utility>

#include "smoothing/base/registry.h"

namespace smoothfem {

namespace {

Registry<MethodScheme>& registered_schemes() {
  static Registry<MethodScheme> schemes("scheme");
  return schemes;
}

}  // namespace

RegisteredScheme::RegisteredScheme(MethodScheme scheme) {
  registered_schemes().add(std::move(scheme));
}

std::optional<MethodInFile> method_in_file(const std::string& name) {
  const auto first = name.find(':'), last = name.rfind(':');
  const auto& schemes = registered_schemes().all();
  if (first == std::string::npos ||
      std::none_of(schemes.begin(), schemes.end(),
                   [&](const auto& s) { return s.name == name.substr(0, first); }))
    return std::nullopt;
  if (last <= first + 1 || last + 1 == name.size())
    throw InputError("method '" + name +
                     "' has no file, or no name of a method in the file; write " +
                     name.substr(0, first) + ":FILE:NAME");
  return MethodInFile{.scheme = name.substr(0, first),
                      .file = name.substr(first + 1, last - first - 1),
                      .object = name.substr(last + 1)};
}

std::string method_name_in(const std::filesystem::path& folder, const std::string& name) {
  auto method = method_in_file(name);
  if (!method) return name;
  method->file = folder / method->file;  // an absolute path stays
  return method->name();
}

MethodEntry make_entry(const MethodInFile& method) {
  return registered_schemes().find(method.scheme).make(method);
}

}  // namespace smoothfem
