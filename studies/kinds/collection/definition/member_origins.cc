// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <set>

#include "meshes/doctor/finding.h"
#include "meshes/domains/catalogue.h"
#include "studies/kinds/collection/definition/expand_members.h"

namespace smoothfem {

namespace {

using Members = std::vector<const Member*>;

bool depends_on_seed(const Member& member) {
  return is_distorted(member.mesh) ||
         (!member.mesh.domain.empty() &&
          find_domain(member.mesh.domain).is_random(member.mesh.elements));
}

/// Returns "; what a, b", or nothing if no member has a value.
template <class ValueOf>
std::string listed(const std::string& what, const Members& members, ValueOf value_of) {
  std::set<decltype(value_of(Member{}))> values;
  for (const Member* member : members) values.insert(value_of(*member));
  std::string text;
  for (const auto& value : values) {
    std::string word;
    if constexpr (std::is_same_v<decltype(value_of(Member{})), std::string>)
      word = value;
    else
      word = std::to_string(value);
    if (!word.empty()) text += (text.empty() ? "; " + what + " " : ", ") + word;
  }
  return text;
}

std::string origin_line(const std::string& domain, const Members& members) {
  std::set<std::filesystem::path> files;
  Members random;
  bool some_as_they_are = false;
  for (const Member* member : members) {
    files.insert(member->mesh.file);
    if (depends_on_seed(*member)) random.push_back(member);
    some_as_they_are = some_as_they_are || member->distortion.empty();
  }
  std::string number = std::to_string(members.size());
  number.insert(0, 5 - std::min<std::size_t>(4, number.size()), ' ');
  return number + " from " +
         (domain.empty() ? count_of(files.size(), "mesh file") : "the domain " + domain) +
         listed("elements", members, [](const Member& m) { return m.mesh.elements; }) +
         listed("algorithms", members, [](const Member& m) { return m.mesh.algorithm; }) +
         listed("order", members,
                [](const Member& m) {
                  return m.mesh.order > 1 ? std::to_string(m.mesh.order) : std::string();
                }) +
         listed("sizes", members, [](const Member& m) { return m.size; }) +
         (some_as_they_are ? "; as they are" : "") +
         listed("distorted to", members, [](const Member& m) { return m.distortion; }) +
         listed("seeds", random, [](const Member& m) { return m.mesh.seed; }) +
         listed("solutions", members, [](const Member& m) { return m.solution; }) + "\n";
}

}  // namespace

std::string origins_of(const std::vector<const Member*>& members) {
  std::map<std::string, Members> by_domain;
  for (const Member* member : members) by_domain[member->mesh.domain].push_back(member);
  std::string text;
  for (const auto& [domain, its_members] : by_domain) text += origin_line(domain, its_members);
  return text;
}

std::vector<std::string> unused_keys(const std::vector<Member>& members, std::size_t n_seeds) {
  if (n_seeds < 2 || std::any_of(members.begin(), members.end(), depends_on_seed)) return {};
  return {
      "'seeds' changes nothing, because no mesh is distorted or generated at random; "
      "'distortions' distorts the meshes."};
}

}  // namespace smoothfem
