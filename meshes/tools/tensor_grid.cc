// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/tools/tensor_grid.h"

#include <cstdint>

namespace smoothfem {

VolumeCells tensor_grid(const std::array<std::vector<double>, 3>& planes,
                        const std::function<bool(std::size_t, std::size_t, std::size_t)>& keep) {
  const std::size_t nx = planes[0].size(), ny = planes[1].size(), nz = planes[2].size();
  std::vector<std::uint8_t> kept((nx - 1) * (ny - 1) * (nz - 1), 1);
  std::vector<std::uint8_t> used(nx * ny * nz, 0);
  const auto for_each_cell = [&](const auto& visit) {
    std::size_t cell = 0;
    for (std::size_t k = 0; k + 1 < nz; ++k)
      for (std::size_t j = 0; j + 1 < ny; ++j)
        for (std::size_t i = 0; i + 1 < nx; ++i) visit(cell++, i, j, k);
  };
  const auto corners = [&](std::size_t i, std::size_t j, std::size_t k) {
    const std::size_t a = i + nx * (j + ny * k), b = a + nx, up = nx * ny;
    return std::array{a, a + 1, b + 1, b, a + up, a + up + 1, b + up + 1, b + up};
  };
  for_each_cell([&](std::size_t cell, std::size_t i, std::size_t j, std::size_t k) {
    if (keep && !keep(i, j, k)) kept[cell] = 0;
    for (const std::size_t corner : corners(i, j, k)) used[corner] |= kept[cell];
  });
  VolumeCells grid;
  std::vector<NodeIndex> number(used.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i] == 0) continue;
    number[i] = static_cast<NodeIndex>(grid.coordinates.size());
    grid.coordinates.emplace_back(planes[0][i % nx], planes[1][i / nx % ny],
                                  planes[2][i / (nx * ny)]);
  }
  for_each_cell([&](std::size_t cell, std::size_t i, std::size_t j, std::size_t k) {
    if (kept[cell] == 0) return;
    std::array<NodeIndex, 8> nodes{};
    const auto row = corners(i, j, k);
    for (std::size_t c = 0; c < nodes.size(); ++c) nodes[c] = number[row[c]];
    grid.cells.append(nodes);
  });
  return grid;
}

}  // namespace smoothfem
