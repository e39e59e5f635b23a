// SPDX-License-Identifier: GPL-3.0-or-later
#include "meshes/generators/domains.h"

#include <algorithm>

#include "meshes/generators/axle.h"
#include "meshes/generators/ball.h"
#include "meshes/generators/box_girder.h"
#include "meshes/generators/car_flow.h"
#include "meshes/generators/embedded_plate.h"
#include "meshes/generators/embedded_ring.h"
#include "meshes/generators/flange.h"
#include "meshes/generators/gear.h"
#include "meshes/generators/nonuniform_grid.h"
#include "meshes/generators/piston.h"
#include "meshes/generators/pump_housing.h"
#include "meshes/generators/random_planar.h"
#include "meshes/generators/revolved_profile.h"
#include "meshes/generators/roof.h"
#include "meshes/generators/stem.h"
#include "meshes/generators/subdivided_cube.h"
#include "meshes/generators/vessel.h"
#include "smoothing/base/find_named.h"

namespace smoothfem {

namespace {

/// For domains with one kind of elements and nothing random.
template <auto generate>
AnyMesh of_one_kind(const DomainParameters& p) {
  return generate(p.edge_scale);
}

/// The same with a seed.
template <auto generate>
AnyMesh of_one_random_kind(const DomainParameters& p) {
  return generate(p.edge_scale, p.seed);
}

AnyMesh make_gear(const DomainParameters& p) {
  const auto type = p.elements == "triangles" ? ElementType::triangle : ElementType::quadrilateral;
  GearParameters gear = gear_of_the_thesis(type, p.edge_scale);
  gear.seed = p.seed;
  return generate_gear(gear);
}

/// "tetrahedra" or "hexahedra".
ElementType volume_type(const std::string& elements) {
  return elements == "tetrahedra" ? ElementType::tetrahedron : ElementType::hexahedron;
}

AnyMesh make_flange(const DomainParameters& p) {
  return generate_flange({volume_type(p.elements), p.edge_scale});
}

AnyMesh make_bridge(const DomainParameters& p) {
  return generate_box_girder(volume_type(p.elements), p.edge_scale);
}

AnyMesh make_random_planar(const DomainParameters& p) {
  return generate_random_planar(p.elements, p.edge_scale, p.seed);
}

}  // namespace

const std::string& Domain::elements_named(const std::string& wanted) const {
  if (wanted.empty()) return elements.front();
  const auto found = std::find(elements.begin(), elements.end(), wanted);
  if (found == elements.end())
    throw InputError("the domain '" + name + "' has no mesh of '" + wanted + "'; " +
                     choose_one_of(elements, wanted));
  return *found;
}

AnyMesh Domain::generate(const DomainParameters& parameters) const {
  DomainParameters known = parameters;
  known.elements = elements_named(parameters.elements);
  return make(known);
}

const std::vector<std::string>& element_names() {
  static const std::vector<std::string> names = {"triangles", "quadrilaterals", "mixed",
                                                 "tetrahedra", "hexahedra"};
  return names;
}

const std::vector<Domain>& domains() {
  static const std::vector<Domain> all = {
      {"gear",
       "involute gear with 17 teeth and five holes, like that of Chapter 6",
       2,
       {"triangles", "quadrilaterals"},
       make_gear},
      {"flange",
       "round flange with hub, bore and eight bolt holes, of the size of Section 6.3's model",
       3,
       {"tetrahedra", "hexahedra"},
       make_flange},
      {"random-planar",
       "stand-ins for Section 5.1.1's meshes: their counts, on a wavy disc with nine holes",
       2,
       {"triangles", "quadrilaterals", "mixed"},
       make_random_planar},
      {"roof",
       "stand-in for Section 5.1.2's surface mesh: its counts and quality, a tent with two peaks",
       2,
       {"quadrilaterals"},
       of_one_kind<generate_roof>},
      {"bridge",
       "stand-in for Section 5.1.3's meshes: their size, a box girder with four tendon ducts",
       3,
       {"tetrahedra", "hexahedra"},
       make_bridge},
      {"sphere",
       "Section 5.2.1's ball: its 258 surface and 346 inner nodes, other random numbers",
       3,
       {"tetrahedra"},
       of_one_random_kind<generate_ball>},
      {"prosthesis",
       "stand-in for Section 5.2.2's mesh: its counts of nodes, random inside, a simpler stem",
       3,
       {"tetrahedra"},
       of_one_random_kind<generate_stem>},
      {"axle",
       "stand-in for Section 5.2.3's meshes: their genus and size, graded towards 16 holes",
       3,
       {"tetrahedra"},
       of_one_kind<generate_axle>},
      {"nonuniform-grid",
       "Section 5.3.1's grid: its 13 x 4 x 11 nodes and printed mean ratios, planes of our own",
       3,
       {"hexahedra"},
       of_one_kind<generate_nonuniform_grid>},
      {"subdivision",
       "Section 5.3.2's cube, refined ten times towards its centre: the same mesh, undistorted",
       3,
       {"hexahedra"},
       of_one_kind<generate_subdivided_cube>},
      {"sweep",
       "stand-in for Section 5.3.3's mesh: its counts, the profile of a wheel turned in 15 layers",
       3,
       {"hexahedra"},
       of_one_kind<generate_revolved_profile>},
      {"car",
       "stand-in for Section 5.3.4's mesh: its size and quality, a grid around a body of two boxes",
       3,
       {"hexahedra"},
       of_one_kind<generate_car_flow>},
      {"plate",
       "stand-in for Section 5.4.1's mesh: about its counts, a plate with two holes in a cuboid",
       3,
       {"mixed"},
       of_one_kind<generate_embedded_plate>},
      {"ring",
       "stand-in for Section 5.4.2's mesh: its grid and counts, around a torus",
       3,
       {"mixed"},
       of_one_kind<generate_embedded_ring>},
      {"aorta",
       "stand-in for Section 5.4.3's mesh: about its counts, an arch with two branches",
       3,
       {"mixed"},
       of_one_kind<generate_vessel>},
      {"piston",
       "stand-in for Section 5.5.2's mesh: its size, a piston with bowl, grooves and pin hole",
       3,
       {"tetrahedra"},
       of_one_kind<generate_piston>},
      {"pump",
       "stand-in for Section 5.5.3's mesh: its size and regularity, a swept plate with 18 bores",
       3,
       {"hexahedra"},
       of_one_kind<generate_pump_housing>},
  };
  return all;
}

const Domain& find_domain(const std::string& name) {
  return find_named("domain", name, domains(), [](const Domain& domain) { return domain.name; });
}

}  // namespace smoothfem
