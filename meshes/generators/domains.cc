#include "meshes/generators/domains.h"

#include "meshes/generators/gear.h"
#include "smoothing/mesh/input_error.h"

namespace smoothfem {

namespace {

PlanarMesh generate_default_gear(const DomainParameters& parameters) {
  GearParameters gear = gear_of_the_thesis(parameters.element_type, parameters.edge_scale);
  gear.seed = parameters.seed;
  return generate_gear(gear);
}

}  // namespace

const std::vector<Domain>& domains() {
  static const std::vector<Domain> all = {
      {"gear", "involute gear with 17 teeth and five holes, like that of Chapter 6",
       generate_default_gear},
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
