// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/partition.h"

#include <zoltan_cpp.h>

#include <numeric>

namespace smoothfem {

namespace {

/// Consecutive cells of a rank that stay together, with the middle of their corners.
template <int dim>
struct Run {
  std::size_t first, last;
  Point<dim> middle;
};

template <int dim>
std::vector<Run<dim>> make_runs(const ScatteredMesh<dim>& mesh) {
  constexpr std::size_t most_runs = std::size_t{1} << 22;  // of the whole mesh: 100 bytes each
  const std::size_t length = std::max<std::size_t>(1, mesh.n_cells / most_runs);
  // Coordinates are asked for once.
  std::vector<GlobalIndex> asked;
  for (std::size_t first = 0; first < mesh.cells.size(); first += length)
    for (const GlobalIndex node : mesh.cells[first]) asked.push_back(node);
  const auto points = mesh.nodes.ask(asked, [](const NodeEntry<dim>& entry) { return entry.x; });
  std::vector<Run<dim>> runs;
  std::size_t next = 0;
  for (std::size_t first = 0; first < mesh.cells.size(); first += length) {
    Point<dim> sum = Point<dim>::Zero();
    const std::size_t n = mesh.cells[first].size();
    for (std::size_t k = 0; k < n; ++k) sum += Point<dim>(points[next++].data());
    runs.push_back(
        {first, std::min(first + length, mesh.cells.size()), sum / static_cast<double>(n)});
  }
  return runs;
}

/// Answers to Zoltan's questions about the runs of this rank.
template <int dim>
struct Answers {
  std::vector<Run<dim>> runs;
  std::size_t first;  ///< number of the first one among those of all ranks

  static const Answers& of(void* data) { return *static_cast<const Answers*>(data); }

  static int n_runs(void* data, int* error) {
    *error = ZOLTAN_OK;
    return static_cast<int>(of(data).runs.size());
  }
  static void numbers(void* data, int, int, ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR local, int,
                      float* weights, int* error) {
    const Answers& answers = of(data);
    for (std::size_t i = 0; i < answers.runs.size(); ++i) {
      global[i] = static_cast<ZOLTAN_ID_TYPE>(answers.first + i);
      local[i] = static_cast<ZOLTAN_ID_TYPE>(i);
      weights[i] = static_cast<float>(answers.runs[i].last - answers.runs[i].first);
    }
    *error = ZOLTAN_OK;
  }
  static int n_coordinates(void*, int* error) {
    *error = ZOLTAN_OK;
    return dim;
  }
  static void coordinates(void* data, int, int, int n, ZOLTAN_ID_PTR, ZOLTAN_ID_PTR local, int,
                          double* x, int* error) {
    for (int i = 0; i < n; ++i)
      for (int d = 0; d < dim; ++d) x[dim * i + d] = of(data).runs[local[i]].middle[d];
    *error = ZOLTAN_OK;
  }
};

/// Returns the part of each run, from 0 to n_parts - 1.
template <int dim>
std::vector<int> bisected(const Ranks& ranks, const std::vector<Run<dim>>& runs, int n_parts) {
  Answers<dim> answers{runs, ranks.exclusive_scan(runs.size())};
  float version = 0.0;
  Zoltan_Initialize(0, nullptr, &version);
  Zoltan zoltan(ranks.communicator());
  for (const auto& [name, value] : {std::pair{"DEBUG_LEVEL", "0"},
                                    {"LB_METHOD", "RCB"},
                                    {"OBJ_WEIGHT_DIM", "1"},
                                    {"RETURN_LISTS", "PARTS"},
                                    {"IMBALANCE_TOL", "1.01"}})
    zoltan.Set_Param(name, value);
  zoltan.Set_Param("NUM_GLOBAL_PARTS", std::to_string(n_parts));
  zoltan.Set_Num_Obj_Fn(Answers<dim>::n_runs, &answers);
  zoltan.Set_Obj_List_Fn(Answers<dim>::numbers, &answers);
  zoltan.Set_Num_Geom_Fn(Answers<dim>::n_coordinates, &answers);
  zoltan.Set_Geom_Multi_Fn(Answers<dim>::coordinates, &answers);
  int changes = 0, n_global = 0, n_local = 0, n_in = 0, n_out = 0;
  ZOLTAN_ID_PTR in_global = nullptr, in_local = nullptr, out_global = nullptr, out_local = nullptr;
  int *in_ranks = nullptr, *in_parts = nullptr, *out_ranks = nullptr, *out_parts = nullptr;
  const int status =
      zoltan.LB_Partition(changes, n_global, n_local, n_in, in_global, in_local, in_ranks, in_parts,
                          n_out, out_global, out_local, out_ranks, out_parts);
  if (ranks.any(status != ZOLTAN_OK && status != ZOLTAN_WARN))
    throw InputError("Zoltan cannot divide the mesh among the processes");
  std::vector<int> to(runs.size());
  for (int i = 0; i < n_out; ++i) to[out_local[i]] = out_parts[i];
  Zoltan::LB_Free_Part(&in_global, &in_local, &in_ranks, &in_parts);
  Zoltan::LB_Free_Part(&out_global, &out_local, &out_ranks, &out_parts);
  return to;
}

}  // namespace

template <int dim>
ScatteredMesh<dim> balanced(const Ranks& ranks, ScatteredMesh<dim> mesh) {
  constexpr double tolerance = 1.05;
  const auto most = static_cast<std::size_t>(ranks.max(static_cast<double>(mesh.cells.size())));
  if (ranks.size() == 1 || (mesh.is_compact && static_cast<double>(most) * ranks.size() <=
                                                   tolerance * static_cast<double>(mesh.n_cells)))
    return mesh;
  if (mesh.n_cells < static_cast<std::size_t>(ranks.size()))
    throw InputError("the mesh has fewer cells (" + std::to_string(mesh.n_cells) +
                     ") than mpirun has started processes; start fewer");
  const auto runs = make_runs(mesh);
  const std::vector<int> to = bisected(ranks, runs, ranks.size());
  std::vector<std::vector<GlobalIndex>> sent(static_cast<std::size_t>(ranks.size()));
  for (std::size_t i = 0; i < runs.size(); ++i)
    for (std::size_t c = runs[i].first; c < runs[i].last; ++c)
      append_words(mesh.cells, c, sent[static_cast<std::size_t>(to[i])]);
  mesh.cells = {};
  mesh.cells = sorted_cells(ranks.exchange(std::move(sent)), 0);
  return mesh;
}

template <int dim>
std::vector<int> bisected_cells(const Mesh<dim>& mesh, int n_parts) {
  std::vector<Run<dim>> cells;
  for (CellIndex c = 0; c < mesh.n_cells(); ++c) {
    Point<dim> sum = Point<dim>::Zero();
    const auto nodes = mesh.topology().cell_nodes(c);
    for (const NodeIndex i : nodes) sum += mesh.coordinates()[i];
    cells.push_back({c, std::size_t{c} + 1, sum / static_cast<double>(nodes.size())});
  }
  return bisected(Ranks(), cells, n_parts);
}

template std::vector<int> bisected_cells(const Mesh<2>&, int);
template std::vector<int> bisected_cells(const Mesh<3>&, int);
template ScatteredMesh<2> balanced(const Ranks&, ScatteredMesh<2>);
template ScatteredMesh<3> balanced(const Ranks&, ScatteredMesh<3>);

}  // namespace smoothfem
