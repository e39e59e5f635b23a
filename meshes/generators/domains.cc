#include "meshes/generators/domains.h"

#include <algorithm>

#include "meshes/generators/flange.h"
#include "meshes/generators/gear.h"
#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

AnyMesh make_gear(const DomainParameters& parameters) {
  GearParameters gear = gear_of_the_thesis(parameters.element_type, parameters.edge_scale);
  gear.seed = parameters.seed;
  return generate_gear(gear);
}

AnyMesh make_flange(const DomainParameters& parameters) {
  return generate_flange({parameters.element_type, parameters.edge_scale});
}

}  // namespace

AnyMesh Domain::generate(const DomainParameters& parameters) const {
  if (std::find(element_types.begin(), element_types.end(), parameters.element_type) ==
      element_types.end()) {
    std::vector<std::string> known;
    for (const ElementType type : element_types) known.emplace_back(name_of(type));
    throw InputError("the domain '" + name + "' has no mesh of type " +
                     std::string(name_of(parameters.element_type)) + "; " + choose_one_of(known));
  }
  return make(parameters);
}

const std::vector<Domain>& domains() {
  static const std::vector<Domain> all = {
      {"gear",
       "involute gear with 17 teeth and five holes, like that of Chapter 6",
       {ElementType::triangle, ElementType::quadrilateral},
       make_gear},
      {"flange",
       "round flange with hub, bore and eight bolt holes, of the size of Section 6.3's model",
       {ElementType::tetrahedron, ElementType::hexahedron},
       make_flange},
  };
  return all;
}

const Domain& find_domain(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& domain : domains()) {
    if (domain.name == name) return domain;
    known.push_back(domain.name);
  }
  throw InputError("there is no domain '" + name + "'; use one of " + joined(known));
}

}  // namespace smoothfem
