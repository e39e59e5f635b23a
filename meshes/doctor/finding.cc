// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/doctor/finding.h"

#include <sstream>

namespace smoothfem {

const char* name_of(FindingKind kind) {
  switch (kind) {
    case FindingKind::reversed_cells:
      return "reversed-cells";
    case FindingKind::folded_cells:
      return "folded-cells";
    case FindingKind::straight_sides:
      return "straight-sides";
    case FindingKind::bent_cells:
      return "bent-cells";
    case FindingKind::collapsed_cells:
      return "collapsed-cells";
    case FindingKind::doubled_cells:
      return "doubled-cells";
    case FindingKind::crowded_facets:
      return "crowded-facets";
    case FindingKind::one_sided:
      return "one-sided-surface";
    case FindingKind::hanging_nodes:
      return "hanging-nodes";
    case FindingKind::coincident_nodes:
      return "coincident-nodes";
    case FindingKind::touching_nodes:
      return "touching-nodes";
    case FindingKind::touching_edges:
      return "touching-edges";
    case FindingKind::unused_nodes:
      return "unused-nodes";
  }
  return "unknown";
}

std::string place_text(const Point<3>& at, bool planar) {
  std::ostringstream text;
  text << '(' << at.x() << ", " << at.y();
  if (!planar) text << ", " << at.z();
  text << ')';
  return text.str();
}

std::string count_of(std::size_t n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

}  // namespace smoothfem
