// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "meshes/io/gmsh/msh_groups.h"
#include "smoothing/mesh/mesh_labels.h"

namespace smoothfem {

/// The numbers of a section $NodeData or $ElementData.
struct MshData {
  MeshField field;                                                  ///< without values
  std::vector<std::pair<std::uint64_t, std::vector<double>>> rows;  ///< by node or element tag
};

/// Reads $NodeData or $ElementData. Its header is text in both encodings: a name, a time, and as
/// integers a step, the number of components and the number of rows.
template <class Input>
MshData read_msh_data(Input& in) {
  const auto lines = [&](const char* what) {
    std::vector<std::string> result;
    for (auto n = msh_count_in_text(in, "the number of tags"); n > 0; --n)
      result.emplace_back(in.text_line(what));
    return result;
  };
  const auto strings = lines("a string tag"), reals = lines("a real tag"),
             integers = lines("an integer tag");
  const auto number = [&]<class T>(const std::vector<std::string>& from, std::size_t i,
                                   T fallback) {
    if (i < from.size()) std::istringstream(from[i]) >> fallback;
    return fallback;
  };
  MshData data;
  if (!strings.empty()) {
    const std::size_t begin = strings[0].find('"'), end = strings[0].rfind('"');
    data.field.name = begin == end ? strings[0] : strings[0].substr(begin + 1, end - begin - 1);
  }
  data.field.time = number(reals, 0, 0.0);
  data.field.step = number(integers, 0, 0);
  const auto n_components = number(integers, 1, 1);
  const auto n_rows = number(integers, 2, std::int64_t{0});
  if (integers.size() < 3 || n_components < 1 || n_rows < 0)
    in.fail(
        "the data need as integers a step, a number of components above 0 and a number of rows");
  data.field.n_components = static_cast<std::size_t>(n_components);
  in.require_bytes(static_cast<std::uint64_t>(n_rows),
                   sizeof(std::int32_t) + data.field.n_components * sizeof(double));
  for (std::int64_t i = 0; i < n_rows; ++i) {
    in.begin("row of data", static_cast<std::uint64_t>(i), static_cast<std::uint64_t>(n_rows));
    const int tag = in.integer("row");
    auto& row = data.rows.emplace_back(static_cast<std::uint64_t>(tag), std::vector<double>());
    for (std::size_t k = 0; k < data.field.n_components; ++k)
      row.second.push_back(in.coordinate("a value"));
    in.end();
  }
  return data;
}

/// Returns the field of all nodes or elements. positions: the position of each tag. Rows that the
/// file does not have are no numbers.
inline MeshField field_of(MshData data, std::size_t n_rows,
                          const std::map<std::uint64_t, std::size_t>& positions) {
  const std::size_t n = data.field.n_components;
  std::vector<double> values(n_rows * n, std::numeric_limits<double>::quiet_NaN());
  for (const auto& [tag, row] : data.rows)
    if (const auto found = positions.find(tag); found != positions.end())
      std::copy(row.begin(), row.end(),
                values.begin() + static_cast<std::ptrdiff_t>(found->second * n));
  data.field.values = std::move(values);
  return std::move(data.field);
}

template <class Input, class Index>
void add_periodic_nodes(const Input& in, PeriodicEntity& link, const Index& node,
                        const Index& partner) {
  if (!node || !partner) in.fail("a periodic node is not a node of the file");
  link.nodes.push_back({*node, *partner});
}

/// Reads $Periodic of version 4.1. index_of: returns the node of a tag, or nothing.
template <class Input, class IndexOf>
std::vector<PeriodicEntity> read_msh_periodic_4_1(Input& in, const IndexOf& index_of) {
  std::vector<PeriodicEntity> found;
  in.begin("the number of periodic entities");
  const std::uint64_t n_links = in.count("the number of periodic entities");
  in.end();
  for (std::uint64_t i = 0; i < n_links; ++i) {
    in.begin("periodic entity", i, n_links);
    PeriodicEntity& link = found.emplace_back();
    link.dimension = in.integer("periodic entity");
    link.entity = in.integer("periodic entity");
    link.partner = in.integer("periodic entity");
    in.end();
    in.begin("the affine map of a periodic entity");
    for (auto n = in.count("the number of values"); n > 0; --n) {
      in.require_bytes(n, sizeof(double));
      link.affine.push_back(in.coordinate("a value of the affine map"));
    }
    in.end();
    in.begin("the number of periodic nodes");
    const std::uint64_t n_nodes = in.count("the number of periodic nodes");
    in.end();
    in.require_bytes(n_nodes, 2 * sizeof(std::uint64_t));
    for (std::uint64_t k = 0; k < n_nodes; ++k) {
      in.begin("periodic node", k, n_nodes);
      const auto node = in.tag("the periodic node"), partner = in.tag("its partner");
      in.end();
      add_periodic_nodes(in, link, index_of(node), index_of(partner));
    }
  }
  return found;
}

/// Reads $Periodic of versions 2 and 4.0, which is text in both encodings.
template <class Input, class IndexOf>
std::vector<PeriodicEntity> read_msh_periodic_2(Input& in, const IndexOf& index_of) {
  std::vector<PeriodicEntity> found;
  for (auto n = msh_count_in_text(in, "the number of periodic entities"); n > 0; --n) {
    PeriodicEntity& link = found.emplace_back();
    std::istringstream numbers{std::string(in.text_line("a periodic entity"))};
    if (!(numbers >> link.dimension >> link.entity >> link.partner))
      in.fail("expected dimension, number and partner of a periodic entity");
    std::string line(in.text_line("the affine map, or the number of periodic nodes"));
    if (line.starts_with("Affine")) {
      std::istringstream values(line.substr(6));
      for (double value; values >> value;) link.affine.push_back(value);
      line = in.text_line("the number of periodic nodes");
    }
    std::uint64_t n_nodes = 0;
    if (!(std::istringstream(line) >> n_nodes)) in.fail("expected the number of periodic nodes");
    for (; n_nodes > 0; --n_nodes) {
      std::istringstream pair{std::string(in.text_line("a periodic node"))};
      std::uint64_t node = 0, partner = 0;
      if (!(pair >> node >> partner)) in.fail("expected a periodic node and its partner");
      add_periodic_nodes(in, link, index_of(node), index_of(partner));
    }
  }
  return found;
}

}  // namespace smoothfem
