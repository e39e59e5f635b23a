// SPDX-License-Identifier: GPL-3.0-or-later
#include <memory>

#include "studies/cli/commands.h"
#include "studies/kinds/collection/merge_results.h"

namespace smoothfem {

namespace {

struct MergeArguments {
  std::vector<std::filesystem::path> folders;
  std::filesystem::path out;
};

}  // namespace

void smoothfem_add_merge_command(CLI::App& app) {
  auto arguments = std::make_shared<MergeArguments>();
  auto* command = add_subcommand(app, "merge");
  command->add_option("folders", arguments->folders, "results folders")->required();
  command->add_option("-o,--out", arguments->out, "folder to make")->required();
  add_examples(*command, {"smoothfem merge results/shard-1 results/shard-2 --out results/field"});
  command->callback([arguments] { merge_results(arguments->folders, arguments->out); });
}

}  // namespace smoothfem
