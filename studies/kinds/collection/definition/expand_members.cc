// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/definition/expand_members.h"

#include <glob.h>

#include <algorithm>
#include <charconv>
#include <set>

#include "meshes/domains/catalogue.h"
#include "smoothing/base/find_named.h"
#include "studies/framework/definition/published_sets.h"
#include "studies/framework/definition/seeds.h"

namespace smoothfem {

namespace {

using dealii::ParameterHandler;
namespace fs = std::filesystem;

/// Returns the files that match a pattern, sorted. Throws InputError if there are none.
std::vector<fs::path> matching_files(const fs::path& pattern) {
  glob_t found{};
  const int outcome = ::glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<fs::path> files;
  if (outcome == 0)
    for (std::size_t i = 0; i < found.gl_pathc; ++i)
      if (std::error_code not_there; fs::is_regular_file(found.gl_pathv[i], not_there))
        files.emplace_back(found.gl_pathv[i]);
  ::globfree(&found);
  if (files.empty())
    throw InputError("'collection' names " + pattern.string() +
                     ", but there is no such file; check the pattern, which is relative to the "
                     "study file");
  return files;
}

/// Keeps letters, digits, '.', '_' and '-', and replaces anything else by '-', also a '.' at the
/// beginning: labels are names of folders.
std::string label_of(std::string text) {
  for (char& c : text)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '_') c = '-';
  if (text.starts_with('.')) text.front() = '-';
  return text;
}

/// Numbers labels that occur several times: a, a.2, a.3.
void number_equal_labels(std::vector<Member>& members) {
  std::set<std::string> taken;
  for (const auto& member : members) taken.insert(member.name);
  std::map<std::string, int> n_called;
  for (auto& member : members) {
    int& n = n_called[member.name];
    if (++n == 1) continue;
    while (taken.contains(member.name + "." + std::to_string(n))) ++n;
    member.name += "." + std::to_string(n);
    taken.insert(member.name);
  }
}

/// Returns the qualities of a list; an empty text stands for a mesh as it is. Throws InputError for
/// anything else.
std::vector<std::string> read_distortions(const std::string& list) {
  std::vector<std::string> distortions;
  for (const auto& item : split_list(list)) {
    double quality = 0.0;
    const auto [end, error] = std::from_chars(item.data(), item.data() + item.size(), quality);
    const bool is_number = error == std::errc() && end == item.data() + item.size();
    if (item != "none" && !(is_number && quality >= 0.0 && quality < 1.0))
      throw InputError("'distortions' has '" + item +
                       "'; write mean qualities of at least 0 and below 1, and 'none' or 0 for "
                       "meshes as they are");
    distortions.push_back(quality > 0.0 ? item : "");
  }
  if (distortions.empty()) distortions.emplace_back();
  return distortions;
}

/// The distortions and seeds of a collection, which make several initial meshes of one.
class Variations {
 public:
  explicit Variations(ParameterHandler& p)
      : distortions_(read_distortions(p.get("distortions"))), seeds_(read_seeds(p.get("seeds"))) {
    if (seeds_.empty()) seeds_.push_back(1);
  }

  /// Adds the variants of a mesh. depends_on_seed: also where the mesh is not distorted.
  /// only_as_it_is: leaves out the distorted ones.
  void add(const Member& mesh, bool depends_on_seed, std::vector<Member>& members,
           bool only_as_it_is = false) const {
    for (const auto& distortion : distortions_)
      for (const auto seed : seeds_) {
        if (only_as_it_is && !distortion.empty()) break;
        Member member = mesh;
        const bool is_random = depends_on_seed || !distortion.empty();
        member.distortion = distortion;
        if (!distortion.empty()) {
          member.name += ".q" + distortion;
          member.mesh.distort_to_q_mean = std::stod(distortion);
        }
        if (is_random && seeds_.size() > 1) member.name += ".r" + std::to_string(seed);
        if (is_random || !member.mesh.domain.empty()) member.mesh.seed = seed;
        member.mesh.name = member.mesh.title = member.name;
        members.push_back(std::move(member));
        if (!is_random) break;
      }
  }

 private:
  std::vector<std::string> distortions_;
  std::vector<std::uint64_t> seeds_;
};

/// Makes one member per file, given with its family. Files with the same name get their folder, and
/// if necessary their extension, or a number, as part of their name.
std::vector<Member> file_members(const std::map<fs::path, std::string>& files,
                                 bool is_family_each) {
  std::map<std::string, int> n_called, n_in_folder;
  for (const auto& [file, family] : files) {
    ++n_called[label_of(file.stem())];
    ++n_in_folder[label_of(file.parent_path().filename() / file.stem())];
  }
  std::vector<Member> members;
  for (const auto& [file, family] : files) {
    const std::string folder = file.parent_path().filename();
    std::string label = label_of(file.stem());
    if (n_called[label] > 1) {
      label = label_of(folder / file.stem());
      if (n_in_folder[label] > 1) label = label_of(folder / file.filename());
    }
    Member member{.name = label, .family = family, .mesh = {}, .solution = {}};
    member.mesh.file = file;
    members.push_back(std::move(member));
  }
  number_equal_labels(members);
  if (is_family_each)
    for (auto& member : members) member.family = member.name;
  return members;
}

/// Reads "NAME: FACTOR" or "NAME".
std::pair<std::string, double> read_domain(const std::string& item) {
  const auto colon = item.find(':');
  const auto name = split_list(item.substr(0, colon));
  if (name.empty()) throw InputError("'domains' has '" + item + "', which names no domain");
  if (colon == std::string::npos) return {name.front(), 1.0};
  try {
    std::size_t end = 0;
    const std::string text = item.substr(colon + 1);
    const double factor = std::stod(text, &end);
    if (factor > 0.0 && text.find_first_not_of(" \t", end) == std::string::npos)
      return {name.front(), factor};
  } catch (const std::logic_error&) {  // reported below
  }
  throw InputError("'domains' has '" + item +
                   "'; write NAME, or NAME: FACTOR with a factor above 0");
}

/// Returns the wanted elements that the domain has; all of its elements if none are wanted.
std::vector<std::string> elements_of(const Domain& domain, const std::vector<std::string>& wanted) {
  std::vector<std::string> elements;
  for (const auto& name : domain.elements)
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end())
      elements.push_back(name);
  return elements;
}

/// Returns the names of the mesh generator's algorithms for any domain.
std::vector<std::string> all_algorithms() {
  std::set<std::string> names;
  for (const Domain& domain : domains())
    for (const auto& [elements, of_elements] : domain.algorithms)
      names.insert(of_elements.begin(), of_elements.end());
  return {names.begin(), names.end()};
}

class GeneratedMembers {
 public:
  GeneratedMembers(ParameterHandler& p, const Variations& variations)
      : elements_(split_list(p.get("elements"))),
        algorithms_(split_list(p.get("algorithms"))),
        eps_(split_list(p.get("eps"))),
        sizes_(split_list(p.get("sizes"))),
        order_(static_cast<int>(std::stol(p.get("order")))),
        variations_(variations) {
    for (const auto& name : elements_)
      (void)find_named("kind of elements", name, element_names(), [](const auto& n) { return n; });
    const auto known = all_algorithms();
    for (const auto& name : algorithms_)
      (void)find_named("algorithm", name, known, [](const auto& n) { return n; });
  }

  void add(const Domain& domain, double factor, std::vector<Member>& members) const {
    if (order_ == 2) domain.require_second_order();
    const auto elements = elements_of(domain, elements_);
    if (elements.empty())
      throw InputError("the domain " + domain.name + " has none of the elements " +
                       joined(elements_) + "; it has " + joined(domain.elements));
    for (const auto& name : elements)
      for (const auto& size : sizes_) {
        Member member{.name = domain.name + "." + name + ".s" + size,
                      .family = domain.name,
                      .mesh = {},
                      .solution = {},
                      .size = size};
        member.mesh.domain = domain.name;
        member.mesh.elements = name;
        member.mesh.order = order_;
        member.mesh.edge_scale = factor * std::stod(size);
        member.mesh.distortion_candidates = default_candidates(domain.dimension);
        for (const Member& with_eps : for_each_eps(domain, member)) {
          const auto algorithms = algorithms_of(domain, name);
          for (std::size_t a = 0; a < algorithms.size(); ++a) {
            Member by_algorithm = with_eps;
            if (algorithms.size() > 1) by_algorithm.name += "." + algorithms[a];
            by_algorithm.mesh.algorithm = algorithms[a];
            variations_.add(by_algorithm, domain.is_random(name), members, a > 0);
          }
        }
      }
  }

 private:
  /// Returns a member for each eps, or the member itself if the domain has none.
  std::vector<Member> for_each_eps(const Domain& domain, const Member& member) const {
    if (!domain.eps || eps_.empty()) return {member};
    std::vector<Member> members;
    for (const auto& eps : eps_) {
      members.push_back(member);
      members.back().name += ".e" + eps;
      members.back().mesh.eps = *domain.eps_of(std::stod(eps));
    }
    return members;
  }

  /// Returns the wanted algorithms that the domain has for these elements; without any its first.
  std::vector<std::string> algorithms_of(const Domain& domain, const std::string& elements) const {
    const auto known = domain.algorithms.find(elements);
    if (known == domain.algorithms.end()) return {""};
    std::vector<std::string> algorithms;
    for (const auto& name : algorithms_)
      if (std::find(known->second.begin(), known->second.end(), name) != known->second.end())
        algorithms.push_back(name);
    if (algorithms.empty()) algorithms.push_back(known->second.front());
    return algorithms;
  }

  std::vector<std::string> elements_, algorithms_, eps_, sizes_;
  int order_;
  const Variations& variations_;
};

std::vector<Member> with_solutions(const std::vector<Member>& meshes,
                                   const std::vector<std::string>& solutions) {
  if (solutions.empty()) return meshes;
  std::vector<Member> members;
  for (const auto& mesh : meshes)
    for (const auto& solution : solutions) {
      members.push_back(mesh);
      members.back().name += "." + solution;
      members.back().solution = solution;
    }
  return members;
}

std::string origin_of(const Member& member) {
  return member.mesh.file.empty() ? "the domain " + member.mesh.domain : member.mesh.file.string();
}

}  // namespace

std::vector<Member> expand_members(ParameterHandler& p, const fs::path& folder) {
  std::map<fs::path, std::string> files, published;  // with their families
  for (const fs::path pattern : split_list(p.get("collection")))
    for (const auto& file : matching_files(pattern.is_relative() ? folder / pattern : pattern))
      files.emplace(file, file.parent_path().filename());
  const auto sets = split_list(p.get("published"));
  for (const auto& set : sets)
    for (const auto& [file, family] : published_meshes(set))
      published.emplace(file, sets.size() > 1 ? set + "." + family : family);
  files.insert(published.begin(), published.end());
  const Variations variations(p);
  std::vector<Member> meshes;
  for (Member& member : file_members(files, p.get("families by") == "file")) {
    if (published.contains(member.mesh.file)) member.mesh.published_file = member.mesh.file;
    member.mesh.untangle = p.get_bool("untangle");
    variations.add(member, false, meshes);
  }
  const GeneratedMembers generated(p, variations);
  for (const auto& item : split_list(p.get("domains"))) {
    const auto [name, factor] = read_domain(item);
    generated.add(find_domain(name), factor, meshes);
  }
  if (meshes.empty())
    throw InputError(
        "the collection has no meshes; name files by 'collection', 'published', or 'domains'");
  auto members = with_solutions(meshes, split_list(p.get("solutions")));
  std::sort(members.begin(), members.end(),
            [](const Member& a, const Member& b) { return a.name < b.name; });
  const auto twice =
      std::adjacent_find(members.begin(), members.end(),
                         [](const Member& a, const Member& b) { return a.name == b.name; });
  if (twice != members.end())
    throw InputError("the collection has two members of the name " + twice->name + " (" +
                     origin_of(*twice) + ", and " + origin_of(*std::next(twice)) +
                     "); name each size, distortion, solution and file once");
  return members;
}

}  // namespace smoothfem
