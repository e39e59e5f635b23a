// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/run/parts/mesh_in_parts.h"

#include "distributed/examine_parts.h"
#include "distributed/partition.h"
#include "studies/framework/results/sha256.h"
#include "studies/framework/run/kept/result_names.h"

namespace smoothfem {

namespace {

/// Returns the digest of the digests of all ranks, one rank's after the other's.
std::string digest_of(const Ranks& ranks, const std::string& digests) {
  return sha256(ranks.gather_all(digests));
}

/// Reads pieces as a mesh of the study's dimension.
template <int dim>
DistributedMesh<dim> read_parts(const Ranks& ranks, const std::filesystem::path& file,
                                const Pieces& pieces) {
  auto scattered = pieces.read();
  if (auto* wanted = std::get_if<ScatteredMesh<dim>>(&scattered))
    return distribute(ranks, balanced(ranks, std::move(*wanted)));
  throw InputError(file.string() + " is a mesh of cells of dimension " + std::to_string(5 - dim) +
                   ", but the study has 'dimension = " + std::to_string(dim) + "'; set it to " +
                   std::to_string(5 - dim));
}

}  // namespace

std::string content_of_pieces(const Ranks& ranks, const Pieces& pieces) {
  std::string digests;
  ranks.together([&] {
    for (std::size_t p = pieces.first_piece(); p < pieces.last_piece(); ++p)
      digests += sha256_of_file(pieces.files()[p]);
  });
  return digest_of(ranks, digests);
}

template <int dim>
MeshInParts<dim>::MeshInParts(const Ranks& ranks, const std::filesystem::path& file)
    : ranks_(ranks),
      file_(file),
      pieces_(ranks, file),
      mesh_(read_parts<dim>(ranks, file, pieces_)),
      content_(content_of_pieces(ranks, pieces_)) {}

template <int dim>
template <class Visit>
void MeshInParts<dim>::for_each_file(const Visit& visit) const {
  const std::size_t last = first_piece_of(ranks_, ranks_.rank() + 1, n_files());
  for (std::size_t f = first_piece_of(ranks_, ranks_.rank(), n_files()); f < last; ++f)
    visit(f, f * n_nodes_a_file, std::min((f + 1) * n_nodes_a_file, mesh_.directory.n()));
}

template <int dim>
std::vector<GlobalIndex> MeshInParts<dim>::nodes_of_files() const {
  std::vector<GlobalIndex> nodes;
  for_each_file([&](std::size_t, std::size_t first, std::size_t last) {
    for (std::size_t node = first; node < last; ++node)
      nodes.push_back(static_cast<GlobalIndex>(node));
  });
  return nodes;
}

template <int dim>
void MeshInParts<dim>::store(std::span<const Point<dim>> coordinates) {
  mesh_.part.set_coordinates({coordinates.begin(), coordinates.end()});
  store_coordinates(mesh_);
}

template <int dim>
std::string MeshInParts<dim>::save(const KeptResults& kept, const std::string& name,
                                   std::size_t record, std::span<const Point<dim>> coordinates) {
  store(coordinates);
  const auto points =
      mesh_.directory.ask(nodes_of_files(), [](const NodeEntry<dim>& entry) { return entry.x; });
  std::string digests;
  ranks_.together([&] {
    auto point = points.begin();
    for_each_file([&](std::size_t file, std::size_t first, std::size_t last) {
      std::vector<double> numbers;
      numbers.reserve(dim * (last - first));
      for (std::size_t node = first; node < last; ++node, ++point)
        numbers.insert(numbers.end(), point->begin(), point->end());
      kept.save_numbers(name + "/" + std::to_string(record), file, numbers);
      digests += content_of(numbers);
    });
  });
  return digest_of(ranks_, digests);
}

template <int dim>
std::vector<Point<dim>> MeshInParts<dim>::load(const KeptResults& kept, const std::string& name,
                                               std::size_t record) {
  std::vector<NodeEntry<dim>> entries;
  ranks_.together([&] {
    for_each_file([&](std::size_t file, std::size_t first, std::size_t last) {
      const auto numbers =
          kept.load_numbers(name + "/" + std::to_string(record), file, dim * (last - first));
      for (const auto& point : points_of<dim>(numbers)) entries.push_back(node_entry(point, 0));
    });
  });
  mesh_.directory.give(
      nodes_of_files(), entries,
      [](NodeEntry<dim>& known, const NodeEntry<dim>& given, int) { known.x = given.x; });
  std::vector<Point<dim>> coordinates;
  coordinates.reserve(mesh_.part.n_nodes());
  for (const auto& x : mesh_.directory.ask(mesh_.part.topology().part()->nodes(),
                                           [](const NodeEntry<dim>& entry) { return entry.x; }))
    coordinates.emplace_back(x.data());
  return coordinates;
}

template <int dim>
void MeshInParts<dim>::write(const std::filesystem::path& path,
                             std::span<const Point<dim>> coordinates) {
  store(coordinates);
  pieces_.write<dim>(path, mesh_.directory);
}

std::vector<std::string> require_conforming_parts(const Ranks& ranks,
                                                  const std::filesystem::path& file) {
  auto scattered = Pieces(ranks, file).read(ReadFor::examination);
  return std::visit(
      [&](auto& mesh) {
        return require_conforming_parts(ranks, file, std::move(mesh),
                                        {FindingKind::hanging_nodes, FindingKind::coincident_nodes},
                                        "a study in parts");
      },
      scattered);
}

template class MeshInParts<2>;
template class MeshInParts<3>;

}  // namespace smoothfem
