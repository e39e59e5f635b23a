#include "studies/framework/study_keys.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <sstream>

#include "studies/framework/study.h"

namespace smoothfem {

namespace {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

/// The range of a parameter as deal.II checks it, which knows the line of a bad value.
std::unique_ptr<Patterns::PatternBase> range_of(const Parameter& parameter) {
  if (const auto* choice = std::get_if<Choice>(&parameter.value)) {
    std::string names;
    for (const auto& name : choice->names) names += (names.empty() ? "" : "|") + name;
    return std::make_unique<Patterns::Selection>(names);
  }
  if (std::holds_alternative<std::vector<double>*>(parameter.value))
    return std::make_unique<Patterns::List>(Patterns::Double(parameter.lower, parameter.upper), 1);
  if (!std::holds_alternative<int*>(parameter.value))
    return std::make_unique<Patterns::Double>(parameter.lower, parameter.upper);
  constexpr double most = std::numeric_limits<int>::max();
  return std::make_unique<Patterns::Integer>(static_cast<int>(std::max(parameter.lower, -most)),
                                             static_cast<int>(std::min(parameter.upper, most)));
}

}  // namespace

void declare_lists(ParameterHandler& p) {
  p.declare_entry("title", "", Patterns::Anything(), "Title in tables and figures.");
  p.declare_entry("meshes", "", Patterns::Anything(),
                  "Labels of the meshes, separated by commas; each has a subsection 'mesh LABEL'.");
  p.declare_entry(
      "methods", "all", Patterns::Anything(),
      "Methods, separated by commas, or 'all'. A label with a subsection 'method LABEL' "
      "may be any registered method with other parameters.");
}

void declare_mesh(ParameterHandler& p, const std::string& name) {
  const Subsection subsection(p, "mesh " + name);
  p.declare_entry("title", name, Patterns::Anything(), "Title in tables and figures.");
  p.declare_entry("file", "", Patterns::Anything(),
                  "Mesh file, relative to this file; empty: generate.");
  p.declare_entry("domain", "", Patterns::Anything(), "Domain to generate (see 'list').");
  p.declare_entry("elements", "triangles", Patterns::Selection("triangles|quadrilaterals"),
                  "Elements of a generated mesh.");
  p.declare_entry("published file", "", Patterns::Anything(),
                  "File that --mesh-dir looks for in place of the above; not distorted.");
  p.declare_entry("distort to", "0", Patterns::Double(0.0, 1.0),
                  "Mean quality to distort the mesh to; 0: as it is.");
  p.declare_entry("seed", "1", Patterns::Integer(0), "Seed of generation and distortion.");
}

/// The parameters of a method are those it registers, with its own defaults.
void declare_method(ParameterHandler& p, const std::string& name, const std::string& type) {
  const Subsection subsection(p, "method " + name);
  p.declare_entry("type", name, Patterns::Anything(), "Registered method (see 'list').");
  if (type.empty()) return;
  Method<2> method = make_method<2>(type);
  p.declare_entry("title", name == type ? method.info.title : name, Patterns::Anything(),
                  "Title in tables and figures.");
  for (const auto& parameter : method.parameters())
    p.declare_entry(parameter.name, value_text(parameter), *range_of(parameter),
                    parameter.description);
}

void declare_problem(ParameterHandler& p) {
  p.declare_entry("degrees", "1, 2", Patterns::Anything(),
                  "Degrees of the finite elements; empty: smoothing only.");
  p.declare_entry("record every", "1", Patterns::Integer(1),
                  "Solve at every k-th iteration; the initial and the resulting mesh always.");
  p.declare_entry("timing runs", "3", Patterns::Integer(1),
                  "Smoothing times are medians over this many runs.");
  p.declare_entry("edge scale", "1", Patterns::Double(1.0),
                  "Generated meshes: edges longer by this factor.");
  p.declare_entry("write series", "false", Patterns::Bool(),
                  "Write each method's meshes as a VTU series (.pvd).");
  {
    const Subsection subsection(p, "solution");
    p.declare_entry("name", "gear", Patterns::Anything(),
                    "Solution (see 'list'), or 'expression' for the three below.");
    p.declare_entry("value", "", Patterns::Anything(), "u as an expression in x and y.");
    p.declare_entry("gradient", "", Patterns::Anything(), "Its gradient: 'u_x ; u_y'.");
    p.declare_entry("load", "", Patterns::Anything(), "f = -laplace(u).");
  }
  {
    const Subsection subsection(p, "finite elements");
    p.declare_entry("load", "nodal", Patterns::Selection("nodal|quadrature"),
                    "nodal: f interpolated (thesis); quadrature: Galerkin load.");
    p.declare_entry("quadrilateral points", "8", Patterns::Integer(1, 20),
                    "Gauss points a direction on quadrilaterals.");
    p.declare_entry("cg tolerance", "1e-8", Patterns::Double(0.0, 1.0), "On |r| / |b|.");
    p.declare_entry("boundary in norm", "true", Patterns::Bool(),
                    "Take the boundary values into |b| (the thesis' counts do).");
    p.declare_entry("condition number", "true", Patterns::Bool(), "Compute it.");
    p.declare_entry("jacobi cg", "true", Patterns::Bool(), "Also run CG with Jacobi.");
  }
  const Subsection subsection(p, "thresholds");
  p.declare_entry("reference", "", Patterns::Anything(),
                  "Method whose least errors set the thresholds; empty: none.");
  p.declare_entry("margin", "0.05", Patterns::Double(0.0), "Share added to the least errors.");
}

/// What --quick changes.
void declare_quick(ParameterHandler& p) {
  const Subsection subsection(p, "quick");
  p.declare_entry("record every", "5", Patterns::Integer(1), "In place of the value above.");
  p.declare_entry("edge scale", "1", Patterns::Double(1.0), "In place of the value above.");
}

std::string study_template() {
  ParameterHandler p;
  declare_lists(p);
  declare_problem(p);
  declare_quick(p);
  declare_mesh(p, "LABEL");
  std::ostringstream text;
  p.print_parameters(text, ParameterHandler::PRM);
  return text.str();
}

}  // namespace smoothfem
