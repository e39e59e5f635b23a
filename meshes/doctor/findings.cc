// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/doctor/findings.h"

#include <stdexcept>

namespace smoothfem {

bool is_repairable(FindingKind kind) {
  return kind == FindingKind::reversed_cells || kind == FindingKind::doubled_cells ||
         kind == FindingKind::unused_nodes || kind == FindingKind::coincident_nodes;
}

FaultText text_of(FindingKind kind, std::size_t count, int dim, bool planar) {
  const bool is_one = count == 1;
  switch (kind) {
    case FindingKind::reversed_cells:
      return {count_of(count, "cell") + (is_one ? " lists its" : " list their") +
                  " nodes in the wrong direction, which is the only fault",
              "'smoothfem repair' turns such cells over, and so do all commands that read the "
              "file without mpirun"};
    case FindingKind::one_sided:
      return {"a piece of the mesh has no upper side, like a Moebius strip",
              "cut it in the mesh generator"};
    case FindingKind::folded_cells:
      return {count_of(count, "cell") + (is_one ? " is" : " are") +
                  " folded, flat or not convex, whatever the direction of " +
                  (is_one ? "its" : "their") + " nodes",
              dim == 2 && !planar ? "repair the surface in the mesh generator"
                                  : "'smoothfem smooth --untangle' may help"};
    case FindingKind::crowded_facets:
      return {
          count_of(count, dim == 2 ? "edge" : "face") +
              (is_one ? " belongs to three or more cells" : " belong to three or more cells each"),
          "separate the pieces there in the mesh generator"};
    case FindingKind::collapsed_cells:
      return {count_of(count, "cell") + (is_one ? " names a node twice" : " name a node twice"),
              "remove them, or list them as cells with fewer nodes"};
    case FindingKind::doubled_cells:
      return {
          count_of(count, "cell") + (is_one ? " has" : " have") + " the same nodes as another cell",
          "'smoothfem repair' removes the later ones"};
    case FindingKind::unused_nodes:
      return {count_of(count, "node") + (is_one ? " belongs" : " belong") + " to no cell",
              "'smoothfem repair' drops such nodes"};
    default:
      throw std::logic_error(std::string("no text of its own: ") + name_of(kind));
  }
}

}  // namespace smoothfem
