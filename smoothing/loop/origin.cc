// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/origin.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "smoothing/base/data_folder.h"
#include "smoothing/base/find_named.h"

namespace smoothfem {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* of_any_stage = "*";

const Json& default_origins() {
  static const Json origins = [] {
    const auto file = data_folder() / "studies/origins.json";
    std::ifstream stream(file);
    try {
      return Json::parse(stream);
    } catch (const Json::exception&) {
      throw InputError(file.string() + " is missing or damaged; reinstall the program");
    }
  }();
  return origins;
}

}  // namespace

std::string text_of(const Origin& origin) {
  return origin.place.empty() ? origin.kind : origin.kind + ", " + origin.place;
}

Origin make_origin(const std::string& kind, const std::string& place, const std::string& where) {
  const std::vector<std::string> kinds = {"printed", "inferred", "own choice"};
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw InputError(where + ": there is no origin '" + kind + "'; " + choose_one_of(kinds));
  return {kind, place};
}

std::optional<Origin> default_origin(const std::string& stage, const std::string& parameter) {
  const Json& all = default_origins();
  const auto read = [&](const Json& origin) {
    return make_origin(origin.at(0), origin.at(1),
                       "studies/origins.json, " + stage + "." + parameter);
  };
  for (const std::string& name : {stage, std::string(of_any_stage)}) {
    if (!all.contains(name)) continue;
    const Json& found = all[name];
    if (found.is_array()) return read(found);
    if (found.contains(parameter)) return read(found[parameter]);
  }
  return std::nullopt;
}

}  // namespace smoothfem
