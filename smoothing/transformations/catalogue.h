// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>

namespace smoothfem {

/// A transformation that makes elements regular, for lists.
struct TransformationInfo {
  const char *name, *elements, *description, *source;
};

/// The transformations of this folder.
inline constexpr std::array transformation_catalogue{
    TransformationInfo{
        "polygon", "triangles, quadrilaterals and other polygons",
        "apices of similar triangles on the sides, in one direction and then in the other",
        "thesis, Section 2.3"},
    TransformationInfo{"opposite-face-normals", "tetrahedra",
                       "nodes move along the normals of the opposite faces",
                       "thesis, Definition 3.3"},
    TransformationInfo{"dual-element", "tetrahedra, hexahedra, pyramids and prisms",
                       "normals are erected on the faces of the dual element",
                       "thesis, Definition 3.4"}};

}  // namespace smoothfem
