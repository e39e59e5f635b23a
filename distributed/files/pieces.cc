// SPDX-License-Identifier: GPL-3.0-or-later
#include "distributed/files/pieces.h"

#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

#include "meshes/doctor/finding.h"
#include "meshes/io/atomic_file.h"
#include "meshes/io/gmsh/msh_parts.h"
#include "meshes/io/line_reader.h"
#include "meshes/io/losses.h"
#include "meshes/io/mesh_assembly.h"
#include "meshes/io/mesh_file.h"
#include "meshes/io/vtk/vtk_files.h"
#include "meshes/io/vtk/vtk_grid.h"
#include "meshes/io/vtk/xml_tags.h"
#include "smoothing/mesh/fixed_nodes.h"
#include "smoothing/mesh/interfaces.h"

namespace smoothfem {

namespace {

/// Arrays of pieces of VTK that decide on a result, and what happens to a piece without one that
/// others have.
enum PieceArray { tags_array, node_numbers_array, cell_numbers_array, fixed_array };
constexpr std::array<std::string_view, 4> without_array{
    "its cells count as cells of no group",
    "nodes of all pieces with equal coordinates are joined instead",
    "the cells of all pieces are numbered in the order of the files instead",
    "its nodes stay only for the reasons that the mesh gives"};

/// What a rank keeps of one piece until all are read.
struct ReadPiece {
  std::vector<std::int64_t> numbers{};  ///< of its nodes; empty if the file has none
  std::vector<std::int64_t> cells{};    ///< numbers of its cells; empty if the file has none
  std::vector<Point<3>> points{};
  std::vector<FixedReasons> reasons{};
  std::vector<std::size_t> node_ids{}, cell_ids{};         ///< of a whole mesh, for an examination
  std::array<std::string, without_array.size()> arrays{};  ///< their names; empty: there is none
  int dim = 0;
  bool has_marks = false;
};

std::vector<std::int64_t> node_numbers(const MeshParts& parts) {
  const auto* ids = global_ids(parts.content.node_roles, parts.content.node_fields);
  return ids ? *ids : std::vector<std::int64_t>(parts.node_ids.begin(), parts.node_ids.end());
}

/// Returns the names of PieceArrays.
std::array<std::string, without_array.size()> arrays_of(const MeshParts& parts, int dim) {
  const FileContent& content = parts.content;
  std::array<std::string, without_array.size()> names;
  if (!parts.elements[static_cast<std::size_t>(dim)].tags.empty())
    names[tags_array] =
        content.tag_field.empty() ? std::string(vtk_tag_fields.front()) : content.tag_field;
  if (global_ids(content.node_roles, content.node_fields))
    names[node_numbers_array] = content.node_roles.at(global_ids_role);
  else if (!parts.node_ids.empty())
    names[node_numbers_array] = "node_id";
  if (global_ids(content.element_roles, content.element_fields))
    names[cell_numbers_array] = content.element_roles.at(global_ids_role);
  if (parts.fixed) names[fixed_array] = "fixed";
  return names;
}

/// Returns "a.vtu has", "a.vtu and another piece have" or "a.vtu and 2 other pieces have".
std::string some_have(const std::filesystem::path& first, std::size_t n) {
  const std::string name = first.filename().string();
  if (n == 1) return name + " has";
  if (n == 2) return name + " and another piece have";
  return name + " and " + std::to_string(n - 1) + " other pieces have";
}

/// Returns a sentence for each array that some pieces have and others do not. Collective.
std::vector<std::string> notes_on_arrays(const Ranks& ranks,
                                         const std::vector<std::filesystem::path>& files,
                                         const std::vector<ReadPiece>& pieces) {
  std::string lines;  // the names of each piece
  for (const ReadPiece& piece : pieces)
    for (const std::string& name : piece.arrays) lines += name + "\n";
  std::istringstream all(ranks.gather_all(lines));
  struct Array {
    std::string name;
    std::size_t owner = 0, first_without = 0, n_without = 0;
  };
  std::array<Array, without_array.size()> arrays;
  std::string word;
  for (std::size_t p = 0; p < files.size(); ++p)
    for (Array& array : arrays) {
      std::getline(all, word);
      if (!word.empty() && array.name.empty()) {
        array.name = word;
        array.owner = p;
      }
      if (word.empty() && array.n_without++ == 0) array.first_without = p;
    }
  std::vector<std::string> notes;
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    const auto& [name, owner, first, n] = arrays[a];
    if (name.empty() || n == 0) continue;
    notes.push_back(some_have(files[first], n) + " no array '" + name + "', but " +
                    files[owner].filename().string() + " has: " + std::string(without_array[a]) +
                    "; write the pieces anew, each with the same arrays");
  }
  return notes;
}

/// Adds the reasons to stay that a file says: labelled elements below the cells' dimension, marks,
/// what it requires (required_nodes() in interfaces.h), and periodic partners.
void add_reasons(const MeshParts& parts, int dim, std::vector<FixedReasons>& reasons) {
  for (std::size_t d = 0; d < static_cast<std::size_t>(dim); ++d) {
    const ElementList& labelled = parts.elements[d];
    for (std::size_t e = 0; e < labelled.nodes.size(); ++e)
      if (!labelled.tags.empty() && labelled.tags[e] != 0)
        for (const NodeIndex node : labelled.nodes[e]) reasons[node] |= bit(FixedReason::interface);
  }
  for (const MeshField& field : parts.content.node_fields)
    if ((field.name == required_field || field.name == corner_field) && field.n_components == 1)
      for (std::size_t i = 0; i < reasons.size(); ++i)
        if (field.number(i) != 0.0) reasons[i] |= bit(FixedReason::required);
  for (const MeshField& field : parts.content.element_fields) {
    if ((field.name != required_field && field.name != ridge_field) || field.n_components != 1)
      continue;
    for (const ElementList& list : parts.elements)
      for (std::size_t e = 0; e < list.nodes.size(); ++e)
        if (field.number(list.file_positions.empty() ? e : list.file_positions[e]) != 0.0)
          for (const NodeIndex node : list.nodes[e]) reasons[node] |= bit(FixedReason::required);
  }
  for (const PeriodicEntity& periodic : parts.content.periodic)
    for (const auto& pair : periodic.nodes)
      for (const NodeIndex node : pair) reasons[node] |= bit(FixedReason::periodic);
  if (parts.fixed)
    for (std::size_t i = 0; i < parts.fixed->size(); ++i)
      if ((*parts.fixed)[i]) reasons[i] |= bit(FixedReason::marked);
}

/// Returns the file's numbers of nodes or cells, or their order where it has none.
std::vector<std::size_t> ids_to_show(std::vector<std::size_t> ids, std::size_t n) {
  ids.resize(n, 0);
  for (std::size_t i = 0; i < n; ++i)
    if (ids[i] == 0) ids[i] = i;
  return ids;
}

/// Appends the cells of a piece, with node indices that begin at first_node. Adds materials that
/// are new.
void append_cells(const MeshParts& parts, int dim, std::size_t first_node, CellTable& table,
                  MaterialNumbers& materials) {
  const ElementList& cells = parts.elements[static_cast<std::size_t>(dim)];
  std::map<std::pair<int, int>, int> of_labels;
  std::vector<GlobalIndex> row;
  for (std::size_t c = 0; c < cells.nodes.size(); ++c) {
    row.clear();
    for (const NodeIndex node : cells.nodes[c])
      row.push_back(static_cast<GlobalIndex>(first_node + node));
    const std::pair label(cells.entities.empty() ? 0 : cells.entities[c],
                          cells.tags.empty() ? 0 : cells.tags[c]);
    const auto [known, is_new] = of_labels.try_emplace(label, 0);
    if (is_new)
      known->second = materials.of(groups_of(&parts.content, dim, label.first, label.second));
    table.append(static_cast<GlobalIndex>(table.size()), known->second, row);
  }
}

/// Gives materials the same numbers on all ranks. Collective.
void number_materials(const Ranks& ranks, const MaterialNumbers& materials,
                      std::vector<int>& of_cells) {
  std::vector<int> words;  // for each material the number of its groups, these
  for (const auto& [groups, number] : materials.all()) {
    words.push_back(static_cast<int>(groups.size()));
    words.insert(words.end(), groups.begin(), groups.end());
  }
  words = ranks.gather_all(words);
  std::set<std::vector<int>> all;
  for (auto word = words.begin(); word != words.end();) {
    const auto first = word + 1;
    word = first + *word;
    all.emplace(first, word);
  }
  std::vector<int> new_number(materials.all().size());
  for (const auto& [groups, number] : materials.all())
    new_number[static_cast<std::size_t>(number)] =
        static_cast<int>(std::distance(all.begin(), all.find(groups)));
  for (int& material : of_cells) material = new_number[static_cast<std::size_t>(material)];
}

/// has_tags: nodes and cells have the numbers of Gmsh. Takes the parts of a piece; appends its
/// cells with node indices that begin at first_node.
ReadPiece take_piece(const std::filesystem::path& path, MeshParts parts, std::size_t first_node,
                     CellTable& table, MaterialNumbers& materials, ReadFor purpose, bool has_tags) {
  if (parts.leaves_out_unused_nodes && purpose == ReadFor::smoothing)
    drop_unused_nodes(parts);  // as read_mesh() does
  ReadPiece piece{.dim = dimension_of(parts)};
  const auto refuse = [&](const std::string& what) {
    throw InputError(path.string() + ": " + what);
  };
  if (piece.dim == 2 && !is_planar(parts))
    refuse("a surface mesh cannot be handled in parts; use one file without mpirun");
  const ElementList& cells = parts.elements[static_cast<std::size_t>(piece.dim)];
  if (!cells.midside.empty())
    refuse("a mesh of second order cannot be handled in parts; use one file without mpirun");
  append_cells(parts, piece.dim, first_node, table, materials);
  piece.arrays = arrays_of(parts, piece.dim);
  piece.numbers = node_numbers(parts);
  piece.cells = has_tags ? std::vector<std::int64_t>(cells.ids.begin(), cells.ids.end())
                         : cell_numbers(parts);
  piece.reasons.assign(parts.coordinates.size(), 0);
  add_reasons(parts, piece.dim, piece.reasons);
  piece.has_marks = parts.fixed && !parts.fixes_boundary_as_well;
  piece.points = std::move(parts.coordinates);
  if (purpose == ReadFor::examination) {
    piece.node_ids = ids_to_show(std::move(parts.node_ids), piece.points.size());
    piece.cell_ids = ids_to_show(cells.ids, cells.nodes.size());
  }
  return piece;
}

[[noreturn]] void refuse_coordinate(const std::filesystem::path& path, std::size_t node) {
  throw InputError(path.string() + ": node " + std::to_string(node) +
                   " has a coordinate that is not a finite number");
}

/// Throws InputError if a coordinate of a piece is not finite.
void require_finite(const std::filesystem::path& path, const MeshParts& parts) {
  for (std::size_t i = 0; i < parts.coordinates.size(); ++i)
    if (!parts.coordinates[i].allFinite())
      refuse_coordinate(path, parts.node_ids.empty() ? i : parts.node_ids[i]);
}

/// As above, of a mesh that is read in blocks. Collective.
template <int dim>
void require_finite(const Ranks& ranks, const std::filesystem::path& path, FileBlocks& blocks,
                    ScatteredMesh<dim>& mesh) {
  const auto bad_node = [](ScatteredMesh<dim>& of_rank) -> std::optional<std::size_t> {
    const auto& entries = of_rank.nodes.entries();
    const auto bad = std::find_if(entries.begin(), entries.end(),
                                  [](const auto& entry) { return !entry.point().allFinite(); });
    if (bad == entries.end()) return {};
    return static_cast<std::size_t>(bad - entries.begin());
  };
  if (!ranks.any(bad_node(mesh).has_value())) return;
  auto with_numbers = blocks.read(ReadFor::examination);
  auto& seen = std::get<ScatteredMesh<dim>>(with_numbers);
  double first = std::numeric_limits<double>::infinity();
  if (const auto bad = bad_node(seen))
    first = static_cast<double>(seen.node_ids ? seen.node_ids->entries()[*bad]
                                              : seen.nodes.first() + *bad);
  ranks.min({&first, 1});
  refuse_coordinate(path, static_cast<std::size_t>(first));
}

/// True if the largest number of a node is so large that a table of all numbers would be wasteful.
bool are_sparse(const Ranks& ranks, const std::vector<ReadPiece>& pieces) {
  constexpr std::size_t most_a_node = 16;
  double largest = 0.0;
  std::size_t n = 0;
  for (const ReadPiece& piece : pieces) {
    n += piece.points.size();
    for (const std::int64_t number : piece.numbers)
      largest = std::max(largest, static_cast<double>(number));
  }
  return ranks.max(largest) > static_cast<double>(most_a_node * ranks.sum(n));
}

/// Gives nodes of equal coordinates the number of their first appearance in the pieces.
void number_by_coordinates(const Ranks& ranks, std::vector<ReadPiece>& pieces) {
  struct Node {
    std::array<double, 3> x;
    std::int64_t number;

    auto operator<=>(const Node&) const = default;
  };
  std::size_t n = 0;
  for (const ReadPiece& piece : pieces) n += piece.points.size();
  auto next = static_cast<std::int64_t>(ranks.exclusive_scan(n));
  const auto keeper = [&](const Node& node) {
    std::size_t hash = 0;
    for (const double x : node.x) hash = 31 * hash + std::hash<double>()(x);
    return (hash >> 7) % static_cast<std::size_t>(ranks.size());
  };
  std::vector<std::vector<Node>> sent(static_cast<std::size_t>(ranks.size()));
  std::vector<std::size_t> keepers;
  for (const ReadPiece& piece : pieces)
    for (const auto& p : piece.points) {
      const Node node{{p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}, next++};  // no negative zeros
      keepers.push_back(keeper(node));
      sent[keepers.back()].push_back(node);
    }
  const auto received = ranks.exchange(std::move(sent));
  std::vector<Node> all;
  for (const auto& nodes : received) all.insert(all.end(), nodes.begin(), nodes.end());
  std::sort(all.begin(), all.end());
  std::vector<std::vector<std::int64_t>> answers(received.size());
  for (std::size_t r = 0; r < received.size(); ++r)
    for (const Node& node : received[r])
      answers[r].push_back(std::lower_bound(all.begin(), all.end(), Node{node.x, 0})->number);
  const auto numbers = ranks.exchange(std::move(answers));
  std::vector<std::size_t> at(numbers.size(), 0);
  std::size_t i = 0;
  for (ReadPiece& piece : pieces) {
    piece.numbers.clear();
    for (std::size_t k = 0; k < piece.points.size(); ++k, ++i)
      piece.numbers.push_back(numbers[keepers[i]][at[keepers[i]]++]);
  }
}

/// Coordinates that are not numbers are equal: they are reported elsewhere.
template <int dim>
bool is_same_place(const Point<dim>& a, const Point<dim>& b) {
  return ((a.array() == b.array()) || (a.array().isNaN() && b.array().isNaN())).all();
}

template <int dim>
ScatteredMesh<dim> scattered(const Ranks& ranks, const std::filesystem::path& path,
                             const std::vector<std::vector<GlobalIndex>>& numbers,
                             std::vector<ReadPiece> pieces, CellTable cells, bool numbers_cells,
                             bool fixes_boundary, bool keeps_ids) {
  double largest = 0.0;
  for (const auto& of_piece : numbers)
    for (const GlobalIndex number : of_piece) largest = std::max<double>(largest, number);
  ScatteredMesh<dim> mesh{.n_cells = ranks.sum(cells.size()),
                          .cells = std::move(cells),
                          .nodes = NodeDirectory<NodeEntry<dim>>(
                              ranks, static_cast<std::size_t>(ranks.max(largest)) + 1),
                          .fixes_boundary = fixes_boundary};
  if (mesh.n_cells > std::numeric_limits<GlobalIndex>::max())
    throw InputError(path.string() + ": has " + std::to_string(mesh.n_cells) +
                     " cells, but at most 4294967295 are possible");
  if (numbers_cells) {
    std::size_t c = 0;
    for (const ReadPiece& piece : pieces)
      for (const std::int64_t number : piece.cells)
        mesh.cells.numbers[c++] = static_cast<GlobalIndex>(number);
    sort_by_numbers(mesh.cells);
  } else {
    const auto first = static_cast<GlobalIndex>(ranks.exclusive_scan(mesh.cells.size()));
    for (GlobalIndex& number : mesh.cells.numbers) number += first;
  }
  if (keeps_ids) {
    const auto keep = [&](std::size_t n, const std::vector<GlobalIndex>& of_rank,
                          const std::vector<std::size_t>& ids) {
      NodeDirectory<std::size_t> kept(ranks, n);
      kept.give(of_rank, ids, [](std::size_t& entry, std::size_t id, int) { entry = id; });
      return kept;
    };
    const bool has_piece = !pieces.empty();
    mesh.node_ids = keep(mesh.nodes.n(), has_piece ? numbers[0] : std::vector<GlobalIndex>(),
                         has_piece ? pieces[0].node_ids : std::vector<std::size_t>());
    mesh.cell_ids = keep(mesh.n_cells, mesh.cells.numbers,
                         has_piece ? pieces[0].cell_ids : std::vector<std::size_t>());
  }
  std::vector<GlobalIndex> given;
  std::vector<NodeEntry<dim>> entries;
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    given.insert(given.end(), numbers[k].begin(), numbers[k].end());
    for (std::size_t i = 0; i < pieces[k].points.size(); ++i)
      entries.push_back(
          node_entry<dim>(pieces[k].points[i].template head<dim>(), pieces[k].reasons[i]));
    pieces[k] = {};
  }
  std::size_t n_torn = 0;
  mesh.nodes.give(given, entries, [&](NodeEntry<dim>& kept, const NodeEntry<dim>& node, int) {
    n_torn += kept.owner == NodeEntry<dim>::given && !is_same_place(kept.point(), node.point());
    kept.x = node.x;
    kept.reasons |= node.reasons;
    kept.owner = NodeEntry<dim>::given;
  });
  if (const std::size_t n = ranks.sum(n_torn); n > 0)
    throw InputError(path.string() + ": " + count_of(n, "node") + (n == 1 ? " has" : " have") +
                     " other coordinates in one piece than in another; write the pieces anew");
  return mesh;
}

[[noreturn]] void refuse_changed(const std::filesystem::path& path) {
  throw InputError(path.string() + ": has changed since it was read");
}

/// Writes a file of any format with other coordinates. Returns what it cannot hold.
template <int dim>
std::vector<std::string> write_whole(const std::filesystem::path& path,
                                     const std::vector<NodeEntry<dim>>& entries,
                                     const std::filesystem::path& out) {
  MeshFile file = read_mesh(path, {.turns_over = false});
  auto* const mesh = std::get_if<Mesh<dim>>(&file.mesh);
  if (mesh == nullptr || mesh->n_nodes() != entries.size()) refuse_changed(path);
  std::vector<FixedReasons> reasons;
  for (NodeIndex i = 0; i < entries.size(); ++i) {
    mesh->coordinates()[i] = entries[i].point();
    reasons.push_back(entries[i].reasons);
  }
  *mesh = with_fixed_nodes(std::move(*mesh), std::move(reasons));
  write_mesh(out, *mesh);
  return losses(out, *mesh);
}

/// As above, a piece, whose cells were checked when the parts were made.
template <int dim>
void write_piece(const std::filesystem::path& path, MeshParts parts,
                 const std::vector<NodeEntry<dim>>& entries, const std::filesystem::path& out) {
  if (dimension_of(parts) != dim) refuse_changed(path);
  std::vector<Point<3>> points;
  std::vector<bool> fixed;
  for (const NodeEntry<dim>& entry : entries) {
    points.push_back(Point<3>::Zero());
    points.back().head<dim>() = entry.point();
    fixed.push_back(entry.reasons != 0);
  }
  const bool has_tags = !parts.elements[static_cast<std::size_t>(dim)].tags.empty();
  PlainMesh mesh = plain_mesh(std::move(parts), std::move(points), std::move(fixed));
  if (has_tags) mesh.labels.cell_tags.resize(mesh.cells.size(), 0);  // pieces keep their arrays
  write_vtu(out, mesh);
}

}  // namespace

std::vector<std::int64_t> cell_numbers(const MeshParts& parts) {
  const auto* ids = global_ids(parts.content.element_roles, parts.content.element_fields);
  const ElementList& cells = parts.elements[static_cast<std::size_t>(dimension_of(parts))];
  std::vector<std::int64_t> numbers;
  for (std::size_t c = 0; ids && c < cells.nodes.size(); ++c)
    numbers.push_back((*ids)[cells.file_positions.empty() ? c : cells.file_positions[c]]);
  return numbers;
}

Pieces::Pieces(const Ranks& ranks, const std::filesystem::path& path) : ranks_(ranks), path_(path) {
  if (path == "-") throw InputError("standard input cannot be read in parts; give a file");
  files_ = {path};
  if (is_list(path)) {
    kind_ = Kind::vtk;
    ranks_.together([&] { files_ = files_of_pvtu(path); });
    leave_out_empty_pieces();
    return;
  }
  MshPart part;
  ranks_.on_root([&] { part = msh_part(path).value_or(MshPart{}); });
  ranks_.broadcast(part);
  if (part.n_all == 0) return;
  kind_ = Kind::gmsh;
  ranks_.together([&] { files_ = files_of_msh_parts(path, part); });
  ranks_.on_root([&] {
    for (std::size_t p = 0; p < files_.size(); ++p) {
      const auto refuse = [&](const std::string& what) {
        throw InputError(files_[p].string() + ": " + what + ", but " + path.string() +
                         " has part " + std::to_string(part.number) + " of the " +
                         std::to_string(part.n_all) +
                         " parts of a mesh; put the files of all parts into one folder");
      };
      if (!std::filesystem::exists(files_[p])) refuse("there is no such file");
      const auto other = msh_part(files_[p]);
      if (!other || other->n_all != part.n_all || other->number != static_cast<int>(p) + 1)
        refuse("the file does not have part " + std::to_string(p + 1));
    }
    notes_.push_back("the files " + files_.front().filename().string() + " to " +
                     files_.back().filename().string() + " are read, as parts of one mesh");
  });
}

void Pieces::leave_out_empty_pieces() {
  std::string is_empty;  // a character for each piece
  ranks_.together([&] {
    for (std::size_t p = first_piece(); p < last_piece(); ++p)
      is_empty += has_no_cells(files_[p]) ? 'y' : 'n';
  });
  is_empty = ranks_.gather_all(is_empty);
  const std::size_t first = is_empty.find('y');
  if (first == std::string::npos) return;
  const std::filesystem::path empty = files_[first];
  std::vector<std::filesystem::path> others;
  for (std::size_t p = 0; p < files_.size(); ++p)
    if (is_empty[p] == 'n') others.push_back(files_[p]);
  if (others.empty()) throw InputError(path_.string() + ": its pieces have no cells");
  notes_.push_back(some_have(empty, files_.size() - others.size()) +
                   " no cells; the mesh is read from the other pieces");
  files_ = std::move(others);
}

std::filesystem::path Pieces::default_output() const {
  if (kind_ == Kind::gmsh) {
    const std::string first = files_.front().stem().string();
    return path_.parent_path() /
           (first.substr(0, first.size() - 2) + "_smoothed" + path_.extension().string());
  }
  return path_.parent_path() /
         (path_.stem().string() + "_smoothed" +
          (kind_ == Kind::vtk ? std::string(".pvtu") : extension_to_write(path_)));
}

void Pieces::require_output(const std::filesystem::path& out) const {
  if ((kind_ == Kind::vtk) != is_list(out))
    throw InputError(path_.string() + " and " + out.string() +
                     " must both be .pvtu files, or none of them; 'smoothfem convert' writes a "
                     "mesh in pieces");
  if (kind_ == Kind::gmsh && out.extension() != path_.extension())
    throw InputError(out.string() + ": the parts of " + path_.string() +
                     " are written as Gmsh's files; give a name that ends with " +
                     path_.extension().string());
  if (kind_ != Kind::vtk) require_mesh_path(out);
  require_other_files(input_files(), output_files(out));
}

std::vector<std::filesystem::path> Pieces::input_files() const {
  auto files = files_;
  if (kind_ == Kind::vtk) files.push_back(path_);
  return files;
}

std::vector<std::filesystem::path> Pieces::output_files(const std::filesystem::path& out) const {
  if (kind_ == Kind::whole) return {out};
  if (kind_ == Kind::vtk) return files_of_list(out, files_.size());
  std::vector<std::filesystem::path> files;
  for (std::size_t p = 0; p < files_.size(); ++p)
    files.push_back(msh_part_file(out, static_cast<int>(p) + 1));
  return files;
}

std::string Pieces::output_text(const std::filesystem::path& out) const {
  if (kind_ != Kind::gmsh) return out.string();
  const auto files = output_files(out);
  return files.front().string() + " to " + files.back().filename().string();
}

std::size_t first_piece_of(const Ranks& ranks, int rank, std::size_t n_pieces) {
  const auto size = static_cast<std::size_t>(ranks.size());
  return (n_pieces * static_cast<std::size_t>(rank) + size - 1) / size;
}

std::variant<ScatteredMesh<2>, ScatteredMesh<3>> Pieces::read(ReadFor purpose) const {
  if (kind_ == Kind::whole) {
    blocks_ = file_blocks(ranks_, path_);
    if (blocks_->obstacle().empty()) {
      auto mesh = blocks_->read(purpose);
      if (purpose == ReadFor::smoothing)
        std::visit([&](auto& of_dim) { require_finite(ranks_, path_, *blocks_, of_dim); }, mesh);
      return mesh;
    }
    if (ranks_.size() > 1)
      notes_.push_back("the first process alone reads or writes the file: " + blocks_->obstacle());
    blocks_.reset();
  }
  std::vector<ReadPiece> pieces;
  CellTable cells;  // corners are positions among the nodes of all pieces
  MaterialNumbers materials;
  ranks_.together([&] {
    std::size_t n_nodes = 0;
    for (std::size_t p = first_piece(); p < last_piece(); ++p) {
      MeshParts parts = read_mesh_parts(files_[p]);
      if (purpose == ReadFor::smoothing) require_finite(files_[p], parts);
      if (kind_ == Kind::whole) notes_.insert(notes_.end(), parts.notes.begin(), parts.notes.end());
      pieces.push_back(take_piece(files_[p], std::move(parts), n_nodes, cells, materials, purpose,
                                  kind_ == Kind::gmsh));
      if (kind_ == Kind::whole) {  // all nodes are here; two of them may lie in one place
        pieces.back().numbers.resize(pieces.back().points.size());
        std::iota(pieces.back().numbers.begin(), pieces.back().numbers.end(), std::int64_t{0});
      }
      n_nodes += pieces.back().points.size();
      // Tables that grow by doubling would need three times their memory. Pieces have about equal
      // sizes; memory that is not used is not taken.
      if (p == first_piece()) {
        const auto all = [&](std::size_t n) { return n / 4 * 5 * (last_piece() - p); };
        cells.reserve(all(cells.size()), all(cells.corners.size()));
      }
    }
  });
  number_materials(ranks_, materials, cells.materials);
  if (kind_ == Kind::vtk) {
    const auto on_arrays = notes_on_arrays(ranks_, files_, pieces);
    notes_.insert(notes_.end(), on_arrays.begin(), on_arrays.end());
  }
  const auto any = [&](const auto& holds) {
    return ranks_.any(std::any_of(pieces.begin(), pieces.end(), holds));
  };
  const bool any_planar = any([](const ReadPiece&p) { return p.dim == 2; }),
             any_volume = any([](const ReadPiece&p) { return p.dim == 3; }),
             any_marks = any([](const ReadPiece&p) { return p.has_marks; });
  if (any_planar && any_volume)
    throw InputError(path_.string() + ": some pieces are planar and others have volume cells");
  const bool joins_places =
      any([](const ReadPiece& p) { return p.numbers.size() != p.points.size(); }) ||
      are_sparse(ranks_, pieces);
  if (joins_places && kind_ == Kind::gmsh)
    throw InputError(path_.string() +
                     ": the numbers of nodes have large gaps; let Gmsh number them anew "
                     "(Mesh.Renumber)");
  if (joins_places) number_by_coordinates(ranks_, pieces);
  const bool numbers_cells = !any([](const ReadPiece& p) { return p.cells.empty(); });
  const auto is_bad = [](std::int64_t number) {
    return number < 0 || number >= std::numeric_limits<GlobalIndex>::max();
  };
  if (any([&](const ReadPiece& p) {
        return std::any_of(p.numbers.begin(), p.numbers.end(), is_bad) ||
               std::any_of(p.cells.begin(), p.cells.end(), is_bad);
      }))
    throw InputError(path_.string() + ": numbers of nodes and cells must be from 0 to 4294967294");
  nodes_.clear();
  std::vector<GlobalIndex> all;
  for (ReadPiece& piece : pieces) {
    nodes_.emplace_back(piece.numbers.begin(), piece.numbers.end());
    all.insert(all.end(), nodes_.back().begin(), nodes_.back().end());
    piece.numbers = {};
  }
  for (GlobalIndex& corner : cells.corners) corner = all[corner];
  all = {};
  const auto make = [&]<int dim>() {
    auto mesh =
        scattered<dim>(ranks_, path_, nodes_, std::move(pieces), std::move(cells), numbers_cells,
                       !any_marks, purpose == ReadFor::examination && kind_ == Kind::whole);
    mesh.joins_places = joins_places;
    return mesh;
  };
  if (any_volume) return make.template operator()<3>();
  return make.template operator()<2>();
}

MeshParts Pieces::parts(std::size_t piece) const {
  MeshParts parts = read_mesh_parts(files_[piece]);
  if (parts.leaves_out_unused_nodes) drop_unused_nodes(parts);
  if (parts.coordinates.size() != nodes(piece).size()) refuse_changed(files_[piece]);
  return parts;
}

template <int dim>
void Pieces::write(const std::filesystem::path& out,
                   const NodeDirectory<NodeEntry<dim>>& directory) const {
  if (kind_ == Kind::gmsh) return write_gmsh_parts(out, directory);
  if (blocks_ && out.extension() == path_.extension()) return blocks_->write(out, directory);
  std::optional<NewPieces> new_pieces;
  if (kind_ == Kind::vtk) new_pieces.emplace(out, ranks_.is_root());
  if (blocks_) {
    nodes_.assign(1, {});
    if (ranks_.is_root()) nodes_.front().resize(directory.n());
    std::iota(nodes_.front().begin(), nodes_.front().end(), GlobalIndex{0});
  }
  in_rounds([&](std::optional<std::size_t> p) {
    const auto entries = directory.ask(p ? nodes(*p) : std::span<const GlobalIndex>(),
                                       [](const NodeEntry<dim>& entry) { return entry; });
    ranks_.together([&] {
      if (!p) return;
      if (new_pieces)
        write_piece<dim>(files_[*p], parts(*p), entries, new_pieces->file(*p));
      else
        losses_ = write_whole<dim>(files_[*p], entries, out);
    });
  });
  ranks_.together([&] {
    if (ranks_.is_root() && new_pieces) new_pieces->finish(files_.size());
  });
}

template <int dim>
void Pieces::write_gmsh_parts(const std::filesystem::path& out,
                              const NodeDirectory<NodeEntry<dim>>& directory) const {
  in_rounds([&](std::optional<std::size_t> p) {
    // Also nodes that only copies of other parts' cells have.
    std::optional<MshNodeFile> file;
    std::vector<GlobalIndex> numbers;
    ranks_.together([&] {
      if (!p) return;
      file.emplace(files_[*p]);
      for (const std::uint64_t tag : file->tags())
        if (tag < directory.n()) numbers.push_back(static_cast<GlobalIndex>(tag));
    });
    const auto entries = directory.ask(numbers, [](const NodeEntry<dim>& entry) { return entry; });
    ranks_.together([&] {
      if (!p) return;
      auto entry = entries.begin();
      file->write(msh_part_file(out, static_cast<int>(*p) + 1), dim,
                  [&](std::size_t i) -> const double* {
                    if (file->tags()[i] >= directory.n()) return nullptr;
                    const NodeEntry<dim>& node = *entry++;
                    return node.owner < 0 ? nullptr : node.x.data();
                  });
    });
  });
}

std::filesystem::path piece_file(const std::filesystem::path& out, std::size_t piece) {
  const std::string stem = out.stem().string();
  char number[32];
  std::snprintf(number, sizeof number, "_%04zu.vtu", piece);
  return out.parent_path() / stem / (stem + number);
}

std::vector<std::filesystem::path> files_of_list(const std::filesystem::path& out,
                                                 std::size_t n_pieces) {
  std::vector<std::filesystem::path> files{out};
  for (std::size_t p = 0; p < n_pieces; ++p) files.push_back(piece_file(out, p));
  return files;
}

void require_other_files(const std::vector<std::filesystem::path>& read,
                         const std::vector<std::filesystem::path>& written,
                         const std::string& what) {
  std::set<std::filesystem::path> known;
  for (const auto& file : read) known.insert(std::filesystem::weakly_canonical(file));
  for (const auto& file : written)
    if (known.contains(std::filesystem::weakly_canonical(file)))
      throw InputError(what + " would replace " + file.string() +
                       ", a file of the mesh; give another file name");
}

void add_global_ids(const char* name, std::vector<std::int64_t> numbers,
                    std::vector<MeshField>& fields, std::map<std::string, std::string>& roles) {
  std::erase_if(fields, [&](const MeshField& field) { return field.name == name; });
  fields.push_back({.name = name, .type = NumberType::int64, .values = std::move(numbers)});
  roles[global_ids_role] = name;
}

void write_piece_list(const std::filesystem::path& out, std::size_t n_pieces) {
  const std::filesystem::path first = piece_file(out, 0);
  const std::string text = read_whole_file(first);
  XmlTags tags(first.string(), text);
  std::ostringstream list;
  list << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PUnstructuredGrid\" version=\"1.0\" "
          "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
          "  <PUnstructuredGrid GhostLevel=\"0\">\n";
  while (tags.next() && tags.tag().name != "AppendedData") {
    const XmlTag& tag = tags.tag();
    const bool is_section =
        tag.name == "PointData" || tag.name == "CellData" || tag.name == "Points";
    if (is_section) {
      list << "    <" << (tag.begins ? "P" : "/P") << tag.name;
      for (const auto& [name, value] : tag.attributes) list << ' ' << name << "=\"" << value << '"';
      list << (tag.begins && tag.ends ? "/>\n" : ">\n");
    } else if (tag.name == "DataArray" && tag.begins &&
               (tags.parent() == "PointData" || tags.parent() == "CellData" ||
                tags.parent() == "Points")) {
      list << "      <PDataArray";
      for (const auto& [name, value] : tag.attributes)
        if (name == "Name" || name == "type" || name == "NumberOfComponents")
          list << ' ' << name << "=\"" << value << '"';
      list << "/>\n";
    }
  }
  for (std::size_t p = 0; p < n_pieces; ++p)
    list << "    <Piece Source=\""
         << escaped_for_xml(piece_file(out, p).lexically_relative(out.parent_path()).string())
         << "\"/>\n";
  list << "  </PUnstructuredGrid>\n</VTKFile>\n";
  write_atomically(out, list.str());
}

NewPieces::NewPieces(std::filesystem::path out, bool is_root)
    : out_(std::move(out)),
      folder_(piece_file(out_, 0).parent_path() / ".new"),
      has_parent_(std::filesystem::exists(folder_.parent_path())),
      is_root_(is_root) {}

NewPieces::~NewPieces() {
  if (!is_root_) return;
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
  if (!has_parent_) std::filesystem::remove(folder_.parent_path(), ignored);  // if it is empty
}

std::filesystem::path NewPieces::file(std::size_t piece) const {
  return folder_ / piece_file(out_, piece).filename();
}

void NewPieces::finish(std::size_t n_pieces) const {
  try {
    std::filesystem::remove(out_);  // an interruption leaves no list of old and new pieces
    for (std::size_t p = 0; p < n_pieces; ++p)
      std::filesystem::rename(file(p), piece_file(out_, p));
  } catch (const std::filesystem::filesystem_error& error) {
    throw InputError(out_.string() +
                     ": a file of the earlier mesh cannot be replaced: " + error.code().message());
  }
  write_piece_list(out_, n_pieces);
}

template void Pieces::write(const std::filesystem::path&, const NodeDirectory<NodeEntry<2>>&) const;
template void Pieces::write(const std::filesystem::path&, const NodeDirectory<NodeEntry<3>>&) const;

}  // namespace smoothfem
