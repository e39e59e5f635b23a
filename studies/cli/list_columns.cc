// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/cli/list_columns.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "smoothing/base/data_folder.h"
#include "smoothing/base/find_named.h"
#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace {

using Json = nlohmann::ordered_json;

Json read_columns() {
  const auto path = data_folder() / "studies" / "columns.json";
  std::ifstream file(path);
  Json json = Json::parse(file, nullptr, false);
  if (json.is_discarded())
    throw InputError(path.string() +
                     ": the file is missing or damaged; install the program again.");
  return json;
}

/// "Meaning [unit] (source)", without the parts that a column does not have.
std::string description(const Json& columns, const Json& file, const std::string& name) {
  const Json& column = columns.at(name);
  std::string text = column.at("meaning").get<std::string>();
  if (file.contains("here") && file.at("here").contains(name))
    text = file.at("here").at(name).get<std::string>();
  if (column.contains("unit")) text += " [" + column.at("unit").get<std::string>() + "]";
  if (column.contains("source")) text += " (" + column.at("source").get<std::string>() + ")";
  return text;
}

void list_file(const Json& columns, const std::string& name, const Json& file) {
  std::printf("%s\n    %s\n\n", name.c_str(), file.at("content").get<std::string>().c_str());
  for (const auto& column : file.at("columns")) {
    const auto column_name = column.get<std::string>();
    std::printf("  %-29s %s\n", column_name.c_str(),
                description(columns, file, column_name).c_str());
  }
}

}  // namespace

void list_columns(const std::string& csv_file) {
  const Json json = read_columns();
  const Json& files = json.at("files");
  if (!csv_file.empty()) {
    std::vector<std::string> names;
    for (const auto& item : files.items()) names.push_back(item.key());
    const std::string name =
        find_named("CSV file", csv_file, names, [](const std::string& one) { return one; });
    list_file(json.at("columns"), name, files.at(name));
    return;
  }
  bool first = true;
  for (const auto& item : files.items()) {
    if (!first) std::printf("\n");
    first = false;
    list_file(json.at("columns"), item.key(), item.value());
  }
}

}  // namespace smoothfem
