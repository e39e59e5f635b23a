// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/kinds/collection/definition/collection_keys.h"

#include <algorithm>
#include <sstream>

#include "studies/framework/definition/study_keys.h"

namespace smoothfem {

namespace {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Reads the lines of a study file one by one, and knows the subsection of each.
class OwnLines {
 public:
  explicit OwnLines(std::vector<std::string> solutions) : solutions_(std::move(solutions)) {}

  /// True if the next line belongs to the collection alone.
  bool operator()(const std::string& line) {
    const bool goes_on = continues_;
    continues_ = line.ends_with('\\');
    if (goes_on) return own_line_;
    own_line_ = inside_own_solution();
    const StudyLine read = study_line(line);
    if (read.kind == StudyLine::Kind::subsection) {
      sections_.push_back(read.name);
      own_line_ = inside_own_solution();
    } else if (read.kind == StudyLine::Kind::end) {
      if (!sections_.empty()) sections_.pop_back();
    } else if (read.kind == StudyLine::Kind::set && has_own_keys()) {
      own_line_ = own_line_ || contains(collection_lists, read.name) ||
                  (sections_.empty() && contains({"kind", "published", "untangle", "order",
                                                  "families by", "write meshes", "time limit"},
                                                 read.name));
    }
    return own_line_;
  }

 private:
  bool inside_own_solution() const {
    constexpr std::string_view prefix = "solution ";
    return !sections_.empty() && sections_.front().starts_with(prefix) &&
           contains(solutions_, sections_.front().substr(prefix.size()));
  }
  /// True in the file's top level and in a scale, which may have keys of collections.
  bool has_own_keys() const {
    return sections_.empty() || (sections_.size() == 1 && sections_[0].starts_with("scale "));
  }

  std::vector<std::string> solutions_, sections_;
  bool continues_ = false, own_line_ = false;
};

}  // namespace

void declare_collection(ParameterHandler& p) {
  p.declare_entry("kind", "collection", Patterns::Selection("collection"),
                  "Kind of study; other kinds have other keys.");
  p.declare_entry("collection", "", Patterns::Anything(),
                  "Mesh files of any format, relative to this file, with the shell's * and ?, "
                  "separated by commas.");
  p.declare_entry("published", "", Patterns::Anything(),
                  "Sets of published meshes, separated by commas, that 'study FILE --published' "
                  "fetches (see 'study --list').");
  p.declare_entry(
      "untangle", "false", Patterns::Bool(),
      "Makes tangled meshes of files valid first, as 'smooth --untangle' does; nodes on "
      "their boundaries stay.");
  p.declare_entry("domains", "", Patterns::Anything(),
                  "Domains to generate (see 'list'), separated by commas; 'NAME: FACTOR' has edges "
                  "longer by this factor, in addition to the sizes.");
  p.declare_entry("elements", "", Patterns::Anything(),
                  "Elements of generated meshes, separated by commas, where a domain has them; "
                  "empty: all.");
  p.declare_entry("algorithms", "", Patterns::Anything(),
                  "Algorithms of the mesh generator, separated by commas, where a domain has them "
                  "(see 'list'); distorted meshes have the first one only. Empty: the domain's "
                  "first.");
  p.declare_entry(
      "eps", "", Patterns::List(Patterns::Double(0.0, 1.0)),
      "Values for the domains kershaw and kershaw-cube, separated by commas: above 0, 1 "
      "is the uniform grid. Empty: the domain's default.");
  p.declare_entry(
      "order", "1", Patterns::Selection("1|2"),
      "Of generated meshes: 2 has cells of second order, with nodes on the true boundary; "
      "all domains need to have them.");
  p.declare_entry("sizes", "1", Patterns::List(Patterns::Double(0.0), 1),
                  "Edge scales of generated meshes: 2 has edges twice as long.");
  p.declare_entry("distortions", "none", Patterns::Anything(),
                  "Mean qualities to distort the meshes to, separated by commas; 'none' or 0: as "
                  "they are. Files are not changed.");
  p.declare_entry("seeds", "1", Patterns::Anything(),
                  "Seeds, separated by commas; distorted meshes, and generated ones that depend on "
                  "chance, are made once for each.");
  p.declare_entry("families by", "folder", Patterns::Selection("folder|file"),
                  "Families of mesh files in tables and findings: the folder of the file, or each "
                  "file with its distorted meshes. With folder, published meshes have the families "
                  "of their set. Generated meshes: their domain.");
  p.declare_entry("solutions", "", Patterns::Anything(),
                  "Solutions, separated by commas; each is one of the program's (see 'list') or "
                  "has a subsection 'solution NAME'. Empty: the one of the subsection 'solution'.");
  p.declare_entry("write meshes", "false", Patterns::Bool(),
                  "Write the resulting meshes of every member, too.");
  p.declare_entry("time limit", "0", Patterns::Double(0.0),
                  "Largest time, in seconds, that a member may take for each of its mesh, its "
                  "smoothing and its finite elements; a slower one fails. 0: no limit.");
  declare_scales(p);
  p.declare_entry("meshes", "", Patterns::Anything(),
                  "Not for collections; the keys above name their meshes.");
}

void declare_collection_scale(ParameterHandler& p, const std::string& scale) {
  const Subsection subsection(p, "scale " + scale);
  for (const auto& key : collection_lists)
    p.declare_entry(key, "", Patterns::Anything(), "Replaces the value above; empty: no change.");
}

void declare_collection_solution(ParameterHandler& p, const std::string& name) {
  declare_solution(p, name,
                   "u as a formula in x, y, z, or in X, Y, Z: coordinates in the mesh's bounding "
                   "box, from 0 to 1 along its longest side; Z is 0 in the plane.");
}

StudyText without_collection_keys(const StudyText& text,
                                  const std::vector<std::string>& solutions) {
  OwnLines is_own(solutions);
  std::istringstream lines(text.text());
  std::string rest;
  for (std::string line; std::getline(lines, line);) rest += (is_own(line) ? "" : line) + "\n";
  return text.with_text(rest);
}

}  // namespace smoothfem
