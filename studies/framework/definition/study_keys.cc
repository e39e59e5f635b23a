// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/study_keys.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <sstream>

#include "meshes/distortion/distort.h"
#include "meshes/domains/catalogue.h"
#include "smoothing/base/find_named.h"
#include "smoothing/loop/method_scheme.h"
#include "smoothing/loop/preset.h"
#include "studies/framework/definition/study.h"

namespace smoothfem {

namespace {

using dealii::ParameterHandler;
namespace Patterns = dealii::Patterns;

constexpr const char* method_type_help =
    "Registered method (see 'list'), or 'python:FILE:CLASS', the file relative to this one.";

/// Returns "a|b|c", deal.II's form of a choice.
std::string one_of(const std::vector<std::string>& names) {
  std::string choice;
  for (const auto& name : names) choice += (choice.empty() ? "" : "|") + name;
  return choice;
}

std::string hexahedron_points() {
  constexpr int most = 20;
  std::vector<std::string> choices{"auto"};
  for (int n = 1; n <= most; ++n) choices.push_back(std::to_string(n));
  return one_of(choices);
}

/// Returns a parameter's range as a pattern of deal.II, which reports the line of a bad value.
std::unique_ptr<Patterns::PatternBase> range_of(const Parameter& parameter) {
  if (const auto* choice = std::get_if<Choice>(&parameter.value))
    return std::make_unique<Patterns::Selection>(one_of(choice->names));
  if (std::holds_alternative<std::vector<double>*>(parameter.value))
    return std::make_unique<Patterns::List>(Patterns::Double(parameter.lower, parameter.upper), 1);
  if (std::holds_alternative<std::string*>(parameter.value))
    return std::make_unique<Patterns::Anything>();
  if (!std::holds_alternative<int*>(parameter.value))
    return std::make_unique<Patterns::Double>(parameter.lower, parameter.upper);
  constexpr double max_int = std::numeric_limits<int>::max();
  return std::make_unique<Patterns::Integer>(static_cast<int>(std::max(parameter.lower, -max_int)),
                                             static_cast<int>(std::min(parameter.upper, max_int)));
}

Recorded recorded(const std::string& text) {
  return text == "never"     ? Recorded::never
         : text == "results" ? Recorded::results
                             : Recorded::always;
}

ConditionNumberMethod condition_number_method(const std::string& text) {
  return text == "none"      ? ConditionNumberMethod::none
         : text == "lanczos" ? ConditionNumberMethod::lanczos
                             : ConditionNumberMethod::verified;
}

/// Returns the number of Gauss points; 0: chosen by the program.
int hexahedron_points(const std::string& text) {
  return text == "auto" ? 0 : std::stoi(text);
}

/// Pattern of "STAGE: k, STAGE: k".
Patterns::Map stage_numbers() {
  return {Patterns::Anything(), Patterns::Integer(1)};
}

}  // namespace

void declare_lists(ParameterHandler& p) {
  p.declare_entry("kind", "smoothing", Patterns::Selection("smoothing"),
                  "Kind of study; other kinds have other keys.");
  p.declare_entry("title", "", Patterns::Anything(), "Title in tables and figures.");
  p.declare_entry("preset", "", Patterns::Anything(),
                  "Parameters of the methods (see 'list'); empty: their defaults.");
  p.declare_entry("dimension", "", Patterns::Selection("|2|3"),
                  "Dimension of the meshes' cells: 2 or 3; empty: that of the first mesh.");
  p.declare_entry("surface", "", Patterns::Selection("|true|false"),
                  "true if the meshes, of dimension 2, are surfaces in space. These have no finite "
                  "elements. Empty: as the first mesh.");
  p.declare_entry("plugins", "", Patterns::Anything(),
                  "Shared libraries with methods of your own, relative to this file, separated by "
                  "commas.");
  declare_scales(p);
  p.declare_entry("meshes", "", Patterns::Anything(),
                  "Labels of the meshes, separated by commas; each has a subsection 'mesh LABEL'.");
  p.declare_entry(
      "methods", "all", Patterns::Anything(),
      "Methods, separated by commas, or 'all'. A label with a subsection 'method LABEL' "
      "may be any registered method with other parameters.");
  p.declare_entry(
      "solutions", "", Patterns::Anything(),
      "Labels of several solutions, separated by commas; each is one of the program's "
      "(see 'list') or has a subsection 'solution LABEL' with 'name', or 'u' and, if necessary, "
      "'diffusivity'. Records are those of the "
      "first, solutions.csv has errors of all. Empty: the solution of the subsection 'solution'.");
  p.declare_entry("solvers", "poisson", Patterns::Anything(),
                  "Solvers of every recorded mesh, separated by commas: 'poisson' for the problem "
                  "below, and labels with a subsection 'solver LABEL'. Their numbers are the "
                  "columns LABEL.NUMBER of iterations.csv and summary.csv.");
  p.declare_entry("note", "", Patterns::Anything(),
                  "How far results can be compared with the literature, in one sentence.");
}

void declare_mesh(ParameterHandler& p, int dimension, const std::string& name) {
  const Subsection subsection(p, "mesh " + name);
  p.declare_entry("title", name, Patterns::Anything(), "Title in tables and figures.");
  p.declare_entry("file", "", Patterns::Anything(),
                  "Mesh file, relative to this file; empty: generate.");
  p.declare_entry("domain", "", Patterns::Anything(), "Domain to generate (see 'list').");
  p.declare_entry("elements", "", Patterns::Selection("|" + one_of(element_names())),
                  "Elements of a generated mesh; empty: the domain's default.");
  p.declare_entry("algorithm", "", Patterns::Anything(),
                  "Algorithm of the mesh generator, for domains that have several (see 'list'); "
                  "empty: the first.");
  p.declare_entry("eps", "0", Patterns::Double(0.0, 1.0),
                  "Of the domains kershaw and kershaw-cube: 1 is the uniform grid, smaller values "
                  "make its cells worse; 0: the domain's default.");
  p.declare_entry(
      "order", "1", Patterns::Selection("1|2"),
      "Of a generated mesh: 2 has cells of second order, with nodes on the true boundary, "
      "for domains that have it. Distorted meshes get them afterwards.");
  p.declare_entry(
      "untangle", "false", Patterns::Bool(),
      "Makes a tangled mesh of a file valid first, as 'smooth --untangle' does; nodes on "
      "its boundary stay.");
  p.declare_entry(
      "edge scale", "1", Patterns::Double(1.0),
      "Edges of a generated mesh longer by this factor, in addition to the study's factor.");
  p.declare_entry("published file", "", Patterns::Anything(),
                  "File that --mesh-dir looks for in place of the above; not distorted.");
  p.declare_entry("distort to", "0", Patterns::Double(0.0, 1.0),
                  "Mean quality to distort the mesh to; 0: not distorted.");
  p.declare_entry("distort within", "0", Patterns::Double(0.0),
                  "Instead: radius to distort the mesh within, in mean lengths of a node's edges. "
                  "Large meshes: the radius for a quality takes many trials.");
  p.declare_entry(
      "distortion", distortion_kind_names[0],
      Patterns::Selection(std::string(distortion_kind_names[0]) + "|" + distortion_kind_names[1]),
      "How a node moves: to the worst of several random positions around its own, or by a random "
      "step, shortened until its cells are valid.");
  p.declare_entry(
      "distortion candidates", std::to_string(default_candidates(dimension)), Patterns::Integer(1),
      "Random positions of a node, of which the worst is chosen; not for random steps.");
  p.declare_entry("distortion sweeps", "1", Patterns::Integer(1),
                  "Number of times that all nodes are moved.");
  p.declare_entry("distortion least quality", "0", Patterns::Double(0.0, 1.0),
                  "Lowest mean ratio that distortion may leave.");
  p.declare_entry("seed", "1", Patterns::Integer(0), "Seed of generation and distortion.");
}

/// Declares the keys that every method has in addition to its type and its own parameters.
void declare_method_header(ParameterHandler& p, const std::string& title) {
  p.declare_entry("title", title, Patterns::Anything(), "Title in tables and figures.");
  p.declare_entry("threads", "0", Patterns::Integer(0, 1024),
                  "Threads for smoothing; 0: as in --smoothing-threads. The other keys are the "
                  "parameters of the method (see 'list').");
  p.declare_entry(
      "smooth for", "", Patterns::Anything(),
      "For methods that move nodes by a solution: labels from 'solutions' that the mesh is made "
      "for. Each counts by its relative error, and each needs a solve per mesh. Or the "
      "label of one of the 'solvers'. Empty: the first solution.");
}

std::string selection_of(std::span<const std::string_view> names) {
  std::string all;
  for (const auto name : names) all += (all.empty() ? "" : "|") + std::string(name);
  return all;
}

/// Declares what a method does with interfaces, and its ideal cells.
void declare_mesh_rules(ParameterHandler& p) {
  p.declare_entry(
      "interfaces", std::string(interface_rule_names[0]),
      Patterns::Selection(selection_of(interface_rule_names)),
      "Nodes between cells of different groups and of labelled inner facets: they stay, "
      "slide on the interface, or move freely.");
  p.declare_entry("target", "regular",
                  Patterns::Selection("regular|" + selection_of(initial_target_names)),
                  "Ideal cells of planar and volume meshes: regular ones of any size, those of the "
                  "initial mesh, or regular ones with the sizes of the initial mesh.");
}

/// Declares the type and parameters of a method. Defaults are those of the preset, if it has the
/// method, otherwise the method's own.
void declare_method(ParameterHandler& p, MeshDimensions dimensions, const std::string& name,
                    const std::string& type, const std::string& preset,
                    const std::filesystem::path& folder) {
  const Subsection subsection(p, "method " + name);
  p.declare_entry("type", name, Patterns::Anything(), method_type_help);
  if (type.empty()) {  // a command gives the type
    p.declare_entry("command", "", Patterns::Anything());
    return;
  }
  with_dimensions(dimensions, [&]<int dim, int spacedim>() {
    auto method = make_method<dim, spacedim>(method_name_in(folder, type));
    declare_method_header(p, name == type ? method.info.title : name);
    declare_mesh_rules(p);
    if (!preset.empty() && has_parameters_for(find_preset(preset), method))
      apply_preset(find_preset(preset), method);
    declare_parameters(p, method.parameters());
  });
}

void declare_parameters(ParameterHandler& p, const Parameters& parameters) {
  for (const auto& parameter : parameters)
    p.declare_entry(parameter.name, value_text(parameter), *range_of(parameter),
                    parameter.description);
}

void declare_finite_elements(ParameterHandler& p) {
  p.declare_entry("load", "quadrature", Patterns::Selection("quadrature|nodal"),
                  "quadrature: integrals of f, the Galerkin load; nodal: f is interpolated first, "
                  "as in the protocol of Chapter 6.");
  p.declare_entry("geometry", "curved", Patterns::Selection("curved|straight"),
                  "Cells of second order: mapped by all their nodes, or by their corners alone.");
  p.declare_entry("quadrilateral points", "8", Patterns::Integer(1, 20),
                  "Gauss points per direction on quadrilaterals.");
  p.declare_entry("hexahedron points", "auto", Patterns::Selection(hexahedron_points()),
                  "Gauss points per direction on hexahedra (pyramids, prisms): 1 to 20, or auto: "
                  "each cell has 4, or as many as leave an error of less than 1e-4.");
  p.declare_entry("cg tolerance", "1e-8", Patterns::Double(0.0, 1.0), "Tolerance for |r| / |b|.");
  p.declare_entry("boundary in norm", "true", Patterns::Bool(),
                  "Take the boundary values into |b| (the thesis' counts do).");
  p.declare_entry(
      "cg seconds", "0", Patterns::Double(0.0),
      "Longest time of each run of CG; 0: no limit. The status of a run that is cut says so.");
  p.declare_entry("condition number", "verified", Patterns::Selection("none|lanczos|verified"),
                  "Condition number of every record; initial and resulting meshes have verified "
                  "ones if any.");
  p.declare_entry(
      "jacobi cg", "always", Patterns::Selection("never|results|always"),
      "Meshes for which CG also runs with Jacobi; results: initial and resulting meshes.");
  p.declare_entry("multigrid cg", "never", Patterns::Selection("never|results|always"),
                  "Meshes for which CG also runs with algebraic multigrid. Records of planar "
                  "meshes are then solved one after the other.");
  p.declare_entry("best approximation", "results", Patterns::Selection("never|results|always"),
                  "Meshes for which the errors of the best approximations to u are recorded.");
}

PoissonOptions read_finite_elements(ParameterHandler& p) {
  PoissonOptions options;
  options.load = p.get("load") == "nodal" ? Load::nodal : Load::quadrature;
  options.geometry = p.get("geometry") == "straight" ? Geometry::straight : Geometry::curved;
  options.tensor_points = {static_cast<int>(p.get_integer("quadrilateral points")),
                           hexahedron_points(p.get("hexahedron points"))};
  options.cg_tolerance = p.get_double("cg tolerance");
  options.boundary_in_norm = p.get_bool("boundary in norm");
  if (p.get_double("cg seconds") > 0.0) options.max_cg_seconds = p.get_double("cg seconds");
  options.condition_number = condition_number_method(p.get("condition number"));
  options.jacobi_cg = recorded(p.get("jacobi cg"));
  options.multigrid_cg = recorded(p.get("multigrid cg"));
  options.best_approximation = recorded(p.get("best approximation"));
  return options;
}

PoissonOptions finite_element_options(const std::vector<std::string>& settings) {
  ParameterHandler p;
  declare_finite_elements(p);
  std::vector<std::string> keys;
  for (const auto& [key, value] : all_parameters(p)) keys.push_back(key);
  p.set("condition number", std::string("lanczos"));
  for (const auto& setting : settings) {
    const StudyLine read = study_line("set " + setting);
    if (std::find(keys.begin(), keys.end(), read.name) == keys.end())
      throw InputError(
          "--finite-elements '" + setting + "': " +
          (read.kind == StudyLine::Kind::set ? choose_one_of(keys, read.name) : "give key=value"));
    try {
      p.set(read.name, read.value);
    } catch (const dealii::ExceptionBase&) {
      throw InputError("--finite-elements '" + setting +
                       "' has a bad value; 'smoothfem list --study-keys smoothing' shows the range "
                       "of each key");
    }
  }
  return read_finite_elements(p);
}

void declare_problem(ParameterHandler& p) {
  p.declare_entry("degrees", "1, 2", Patterns::Anything(),
                  "Degrees of the finite elements; empty: smoothing only.");
  p.declare_entry("refined degrees", "", Patterns::Anything(),
                  "Degrees, of those above, at which initial and resulting meshes are solved once "
                  "more with every cell split: refined.csv. Empty: none.");
  p.declare_entry("record degrees", "", Patterns::Anything(),
                  "Degrees, of those above, to solve at every record; the others are solved on "
                  "initial, resulting and last meshes only. Empty: all.");
  p.declare_entry("hanging nodes", "refuse", Patterns::Selection("refuse|constrain"),
                  "Meshes with hanging nodes: refuse, or constrain: the value at a hanging node is "
                  "that of the edge or face in which it lies. Elements of degree 1 only.");
  p.declare_entry("periodic", "prescribe", Patterns::Selection("prescribe|constrain"),
                  "Boundaries with periodic partners in the mesh file: prescribe u there, or "
                  "constrain: partners have the same unknown. Elements of degree 1 only.");
  p.declare_entry(
      "record every", "1", Patterns::Integer(1),
      "Solve at every k-th iteration, and always on the initial, the resulting and the last mesh.");
  p.declare_entry("record stages every", "", stage_numbers(),
                  "The same for stages with their own interval: 'STAGE: k, ...'.");
  p.declare_entry("record growth", "1", Patterns::Double(1.0, 10.0),
                  "After 20 records of a method (or of a stage with its own interval), each record "
                  "comes after this many times as many iterations as the one before.");
  p.declare_entry("seeds", "", Patterns::Anything(),
                  "Seeds, separated by commas: meshes that depend on a seed are made once for "
                  "each, and tables have medians. Empty: the seeds of the meshes.");
  p.declare_entry("record seeds", "all", Patterns::Selection("all|results"),
                  "Solves for the second and further seeds: all as for the first, or only initial, "
                  "resulting and last meshes, without thresholds.");
  p.declare_entry("timing runs", "3", Patterns::Integer(1),
                  "Smoothing times are medians over this many runs.");
  p.declare_entry("edge scale", "1", Patterns::Double(1.0),
                  "Generated meshes: edges longer by this factor.");
  p.declare_entry("record warpage", "false", Patterns::Bool(),
                  "Warpage of volume meshes after every iteration, not only at the end.");
  p.declare_entry(
      "count cells below", "", Patterns::List(Patterns::Double(0.0, 1.0)),
      "Mean ratios: summary.csv has the number of cells below each, initially and at the end.");
  p.declare_entry(
      "metrics", "", Patterns::Anything(),
      "Metrics of the cells (see 'list'), separated by commas, or 'all': metrics.csv has "
      "their range, mean and percentiles in every recorded mesh. Empty: none.");
  p.declare_entry("write series", "false", Patterns::Bool(),
                  "Write each method's meshes as a VTU series (.pvd).");
  p.declare_entry("in parts", "false", Patterns::Bool(),
                  "Each process that mpirun starts has a part of a mesh, and none has the whole. "
                  "A mesh that is generated or distorted is still made by one process.");
  p.declare_entry("refine", "0", Patterns::Integer(0, 10),
                  "In parts: split every cell into 4 or 8, this many times. Nodes of the boundary "
                  "stay on the edges and faces of the unrefined mesh.");
  {
    const Subsection subsection(p, "solution");
    p.declare_entry("name", "", Patterns::Anything(),
                    "Solution (see 'list'), or 'expression' for the formulas below; empty: "
                    "'expression' if there are any, otherwise 'gear'.");
    p.declare_entry("u", "", Patterns::Anything(),
                    "u as a formula in x and y (and z), pieces by 'if(x < 0.5, a, b)'; its "
                    "gradient and f are derived.");
    p.declare_entry("diffusivity", "", Patterns::Anything(),
                    "A of -div(A grad u) = f: one formula, or 'a11, a12 ; a21, a22' (in space 3 "
                    "rows of 3), symmetric and positive definite; empty: 1. 'set diffusivity "
                    "group=NAME = FORMULA' is A of the cells with this group, by name or tag. "
                    "'piecewise by tag', for the program's solutions with an interface: A of the "
                    "cells' groups instead of their positions.");
    p.declare_entry("natural", "", Patterns::Anything(),
                    "Parts of the boundary where A grad u . n is given instead of u: 'group NAME, "
                    "...', with the names or tags of the mesh file; empty: none.");
    p.declare_entry(
        "value", "", Patterns::Anything(),
        "Instead of 'u', if nothing is to be derived: u as an expression in x and y (and z).");
    p.declare_entry("gradient", "", Patterns::Anything(),
                    "Its gradient: 'u_x ; u_y' (and '; u_z').");
    p.declare_entry("load", "", Patterns::Anything(), "f = -laplace(u), or -div(A grad u).");
  }
  {
    const Subsection subsection(p, "finite elements");
    declare_finite_elements(p);
  }
  const Subsection subsection(p, "thresholds");
  p.declare_entry("reference", "", Patterns::Anything(),
                  "Method whose smallest errors set the thresholds; empty: no thresholds.");
  p.declare_entry("margin", "0.05", Patterns::Double(0.0),
                  "Fraction added to the smallest errors.");
}

void declare_solution(ParameterHandler& p, const std::string& name,
                      const std::string& formula_help) {
  const Subsection subsection(p, "solution " + name);
  p.declare_entry("name", "", Patterns::Anything(),
                  "One of the program's solutions (see 'list'); empty: the formula below, or the "
                  "solution of this subsection's name.");
  p.declare_entry("u", "", Patterns::Anything(), formula_help);
  p.declare_entry("diffusivity", "", Patterns::Anything(),
                  "A of -div(A grad u) = f, as in the subsection 'solution'.");
}

namespace {

constexpr std::string_view group_key = "diffusivity group ";

}  // namespace

void declare_group_diffusivities(ParameterHandler& p, const StudyText& text) {
  for (const auto& [section, key] : keys_of_sections(text)) {
    if (!key.starts_with(group_key) || !(section == "solution" || section.starts_with("solution ")))
      continue;
    const Subsection subsection(p, section);
    p.declare_entry(key, "", Patterns::Anything());
  }
}

std::vector<GroupDiffusivity> read_group_diffusivities(ParameterHandler& p,
                                                       const std::string& section) {
  std::vector<GroupDiffusivity> of_groups;
  const std::string start = section + "/" + std::string(group_key);
  for (const auto& [key, value] : all_parameters(p))
    if (key.starts_with(start)) of_groups.push_back({key.substr(start.size()), value});
  return of_groups;
}

StudySolution read_solution(ParameterHandler& p, const StudyText& text, const std::string& name) {
  auto of_groups = read_group_diffusivities(p, "solution " + name);
  const Subsection subsection(p, "solution " + name);
  const std::string formula = p.get("u"), named = p.get("name");
  if (!formula.empty() && !named.empty())
    throw InputError("the solution '" + name +
                     "' has both a name and a formula 'u'; take one of them out");
  return {.name = !formula.empty() ? "expression"
                  : named.empty()  ? name
                                   : named,
          .value = {},
          .gradient = {},
          .load = {},
          .u = formula,
          .diffusivity = p.get("diffusivity"),
          .label = name,
          .of_groups = std::move(of_groups),
          .lines = lines_of_section(text, "solution " + name)};
}

void declare_scale(ParameterHandler& p, const std::string& name) {
  const Subsection subsection(p, "scale " + name);
  p.declare_entry("record every", "0", Patterns::Integer(0),
                  "Replaces the value above; 0: no change.");
  p.declare_entry("record stages every", "", stage_numbers(),
                  "Replaces the value above; empty: no change.");
  p.declare_entry("edge scale", "0", Patterns::Double(0.0),
                  "Replaces the value above; 0: no change.");
  p.declare_entry("timing runs", "0", Patterns::Integer(0),
                  "Replaces the value above; 0: no change.");
  p.declare_entry("meshes", "", Patterns::Anything(),
                  "Meshes to take from the list above; empty: all.");
  for (const std::string key : {"seeds", "degrees", "in parts", "condition number"})
    p.declare_entry(key, "", Patterns::Anything(), "Replaces the value above; empty: no change.");
  p.declare_entry("refine", "0", Patterns::Integer(0), "Replaces the value above; 0: no change.");
}

std::string study_template() {
  ParameterHandler p;
  // Keys are printed in the order of their first declaration. Most studies set these:
  for (const std::string key : {"kind", "title", "meshes", "methods", "degrees"})
    p.declare_entry(key, "", Patterns::Anything());
  declare_mesh(p, 2, "LABEL");
  p.enter_subsection("solution");
  p.declare_entry("u", "", Patterns::Anything());
  p.leave_subsection();
  {
    const Subsection subsection(p, "method LABEL");
    p.declare_entry("type", "LABEL", Patterns::Anything(), method_type_help);
    declare_method_header(p, "LABEL");
    declare_mesh_rules(p);
  }
  declare_lists(p);
  declare_problem(p);
  declare_scale(p, "NAME");
  return commented_keys(p);
}

}  // namespace smoothfem
