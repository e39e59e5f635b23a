// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/files/file_blocks.h"

#include "distributed/files/msh_blocks.h"
#include "distributed/files/vtu_blocks.h"

namespace smoothfem {

std::shared_ptr<FileBlocks> file_blocks(const Ranks& ranks, const std::filesystem::path& path) {
  bool is_vtk = false;
  ranks.on_root([&] { is_vtk = begins_as_vtk_xml(path); });
  ranks.broadcast(is_vtk);
  if (is_vtk) return std::make_shared<VtuBlocks>(ranks, path);
  return std::make_shared<MshBlocks>(ranks, path);
}

}  // namespace smoothfem
