// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/definition/check_study.h"

#include <algorithm>

#include "meshes/domains/catalogue.h"
#include "smoothing/base/find_named.h"
#include "studies/framework/definition/study_file.h"

namespace smoothfem {

namespace {

void check_names(const Study& study) {
  if (!study.degrees.empty() && study.dimensions.space > study.dimensions.cells)
    throw InputError(
        "finite elements are not solved on surface meshes; write 'set degrees =' without any");
  for (const StudySolution* solution : solutions_of(study))
    if (needs_solutions(study) && solution->name != "expression")
      with_dimension(study.dimensions.cells,
                     [&]<int dim>() { (void)manufactured_solution<dim>(solution->name); });
  for (const auto& mesh : study.meshes)
    if (!mesh.domain.empty()) {
      const Domain& domain = find_domain(mesh.domain);
      (void)domain.algorithm_named(mesh.algorithm, domain.elements_named(mesh.elements));
      (void)domain.eps_of(parameters_of(mesh, 1.0).eps);
      if (mesh.order == 2) domain.require_second_order();
    }
}

/// Throws InputError if positions do not tell the materials of a solution.
void check_piecewise_by_tag(const StudySolution& solution, int dimension) {
  std::vector<std::string> known;
  with_dimension(dimension, [&]<int dim>() {
    for (const auto& possible : manufactured_solutions<dim>())
      if (possible.material_at) known.push_back(possible.name);
  });
  if (std::find(known.begin(), known.end(), solution.name) == known.end())
    throw InputError(
        "'diffusivity = piecewise by tag' is for the program's solutions with an interface; " +
        choose_one_of(known, solution.name) +
        " as 'name', or give 'diffusivity group=NAME' for each group of cells");
  if (!solution.of_groups.empty())
    throw InputError("the solution has 'diffusivity = piecewise by tag' and one for the group '" +
                     solution.of_groups.front().group + "'; take one of them out");
}

/// Throws InputError if a solution is given in more than one way.
void check_solution(const StudySolution& solution, int dimension) {
  if (!solution.u.empty() && solution.name != "expression")
    throw InputError("the solution has the name '" + solution.name +
                     "' and the formula 'u'; take one of them out");
  for (const auto& [key, text] : {std::pair{"value", solution.value},
                                  {"gradient", solution.gradient},
                                  {"load", solution.load}})
    if (!solution.u.empty() && !text.empty())
      throw InputError("the solution has both 'u' and '" + std::string(key) +
                       "'; the program derives it from 'u', so take '" + key + "' out");
  if (solution.is_piecewise_by_tag()) return check_piecewise_by_tag(solution, dimension);
  if (!solution.of_groups.empty() && solution.u.empty())
    throw InputError("the solution has a diffusivity for the group '" +
                     solution.of_groups.front().group +
                     "', from which the load is derived; give the solution as a formula 'u'");
  if (!solution.diffusivity.empty() && solution.name != "expression")
    throw InputError("the solution '" + solution.name +
                     "' has no diffusivity; give its formula as 'u' instead");
}

/// Throws InputError if a stage with its own record interval belongs to none of the methods.
void check_stages(const Study& study) {
  const auto& methods = study.methods;
  if (std::any_of(methods.begin(), methods.end(), [](const auto& m) { return m.is_stand_in; }))
    return;
  std::vector<std::string> known;
  with_dimensions(study.dimensions, [&]<int dim, int spacedim>() {
    for (const auto& method : study.methods)
      for (const auto& stage : method.make<dim, spacedim>().stages)
        if (std::find(known.begin(), known.end(), stage->name()) == known.end())
          known.emplace_back(stage->name());
  });
  for (const auto& [stage, every] : study.record_every.stages)
    if (std::find(known.begin(), known.end(), stage) == known.end())
      throw InputError("'record stages every' names the stage '" + stage +
                       "', which none of the methods has; " + choose_one_of(known, stage));
}

/// Throws InputError if a method needs a problem and the study has none.
void check_problem(const Study& study) {
  if (!study.degrees.empty()) return;
  for (const auto& method : study.methods)
    if (method.needs_problem(study.dimensions) && solver_smoothed_for(study, method) == nullptr)
      throw InputError("method " + method.name +
                       " moves nodes by the solution of the study's problem, but the study "
                       "solves none; write 'set degrees = 1', name one of the 'solvers' in the "
                       "method's 'smooth for', or leave the method out");
}

/// Throws InputError if a method moves nodes by a solution whose diffusivity belongs to groups of
/// cells.
void check_materials(const Study& study) {
  const auto solutions = solutions_of(study);
  if (std::none_of(solutions.begin(), solutions.end(),
                   [](const StudySolution* solution) { return solution->has_materials(); }))
    return;
  for (const auto& method : study.methods)
    if (!method.is_stand_in && method.needs_problem(study.dimensions) &&
        solver_smoothed_for(study, method) == nullptr)
      throw InputError("method " + method.name +
                       " moves nodes by the solution, for which it needs the diffusivity as a "
                       "function of the position; give 'diffusivity' as one formula with "
                       "conditions, or leave the method out");
}

/// Throws InputError unless a solver gives what a method takes from its solution.
void check_solver_of_method(const Study& study, const StudyMethod& method,
                            const StudySolver& solver) {
  const std::string what = "method " + method.name + " has 'smooth for = " + solver.label + "'";
  if (method.smooth_for.size() > 1)
    throw InputError(what + " and other labels; a mesh is smoothed for one solver alone");
  if (OnlyLook::is_on()) return;
  const ProblemUse use = method.problem_use(study.dimensions);
  const SolverTraits& given = solver.traits;
  if (use.directions)
    throw InputError(what +
                     ", but moves nodes by directions of the error, which only Poisson's equation "
                     "has; take indicator-weighted, or leave 'smooth for' out");
  if (use.energy_gradient && !given.has_energy)
    throw InputError(what + ", but this solver has no energy and gradient; take " +
                     (given.has_indicators ? "a method with error indicators, such as "
                                             "indicator-weighted"
                                           : "another solver"));
  if (use.indicators && !given.has_indicators)
    throw InputError(what + ", but this solver has no error indicators; take " +
                     (given.has_energy ? "energy-descent or energy-lbfgs" : "another solver"));
}

/// Throws InputError if a mesh is smoothed for a solution or solver that the study does not have.
void check_smooth_for(const Study& study) {
  std::vector<std::string> labels;
  for (const StudySolution* solution : solutions_of(study)) labels.push_back(solution->label);
  for (const auto& method : study.methods) {
    if (method.smooth_for.empty()) continue;
    const std::string what = "method " + method.name + " has 'smooth for'";
    if (!method.is_stand_in && !method.needs_problem(study.dimensions))
      throw InputError(what + ", but does not move nodes by a solution; take it out");
    if (const StudySolver* solver = solver_smoothed_for(study, method)) {
      check_solver_of_method(study, method, *solver);
      continue;
    }
    if (study.solution.label.empty())
      throw InputError(
          what + " = " + method.smooth_for.front() +
          ", which is not in the list 'solvers', and the study has no list 'solutions'; "
          "take it out, or name it in one of these lists");
    for (const auto& label : method.smooth_for) {
      if (std::find(labels.begin(), labels.end(), label) == labels.end())
        throw InputError(what + " = " + label +
                         ", which is not in the lists 'solutions' and 'solvers'; " +
                         choose_one_of(labels, label));
      if (std::count(method.smooth_for.begin(), method.smooth_for.end(), label) > 1)
        throw InputError(what + " with '" + label + "' twice; name it once");
    }
  }
}

/// Throws InputError unless the study has each of a key's degrees.
void check_degrees(const std::string& key, const std::vector<int>& chosen, const Study& study) {
  for (const int degree : chosen)
    if (std::find(study.degrees.begin(), study.degrees.end(), degree) == study.degrees.end())
      throw InputError(
          "'" + key + "' has " + std::to_string(degree) +
          ", which is not one of the study's degrees; add it to 'degrees' or take it out");
}

void check_thresholds(const Study& study) {
  const auto& reference = study.thresholds.reference;
  if (reference.empty()) return;
  const bool named = std::any_of(study.methods.begin(), study.methods.end(),
                                 [&](const auto& method) { return method.name == reference; });
  if (!named)
    throw InputError("the thresholds' reference '" + reference +
                     "' is not one of the study's methods");
}

/// Throws InputError for what does not work on meshes in parts.
void check_parts(const Study& study) {
  if (!study.in_parts && study.refine > 0)
    throw InputError(
        "'refine' works on a mesh in parts; write 'set in parts = true', or leave it out");
  if (!study.in_parts) return;
  const auto refuse = [](const std::string& what, const std::string& instead) {
    throw InputError(what + ", which does not work with 'set in parts = true'; " + instead);
  };
  const std::string leave_out = "take one of them out";
  if (study.dimensions.space > study.dimensions.cells)
    refuse("the study is about surface meshes", leave_out);
  for (const int degree : study.degrees)
    if (degree != 1) refuse("'degrees' has " + std::to_string(degree), "write 'set degrees = 1'");
  const std::pair<bool, const char*> given[]{
      {!study.refined_degrees.empty(), "'refined degrees'"},
      {!study.solvers.empty(), "'solvers'"},
      {!study.metrics.empty(), "'metrics'"},
      {study.write_series, "'write series'"},
      {study.record_warpage, "'record warpage'"},
      {study.constrain_hanging_nodes, "'hanging nodes = constrain'"},
      {study.constrain_periodic_nodes, "'periodic = constrain'"},
      {!study.finite_elements.natural_groups.empty(), "'natural'"}};
  for (const auto& [is_given, key] : given)
    if (is_given) refuse("the study has " + std::string(key), leave_out);
  for (const StudySolution* solution : solutions_of(study))
    if (solution->has_materials()) refuse("the solution has a diffusivity of groups", leave_out);
  for (const auto& mesh : study.meshes)
    if (mesh.order == 2) refuse("mesh " + mesh.name + " has 'order = 2'", leave_out);
  with_dimension(study.dimensions.cells, [&]<int dim>() {
    for (const auto& method : study.methods) {
      if (method.interfaces != InterfaceRule::fixed || method.target)
        refuse("method " + method.name + " has a rule for interfaces or a target", leave_out);
      if (!method.is_stand_in && !works_in_parts(method.make<dim>()))
        refuse("the study has the method " + method.name,
               "leave it out, or take one of " + joined(methods_for_parts<dim, dim>()));
    }
  });
}

}  // namespace

void check_labels(std::vector<std::string> labels, const std::string& what,
                  const std::string& file) {
  if (labels.empty()) throw InputError(file + ": the study names no " + what);
  for (const auto& label : labels) check_label(label, what, file);
  std::sort(labels.begin(), labels.end());
  const auto twice = std::adjacent_find(labels.begin(), labels.end());
  if (twice != labels.end())
    throw InputError(file + ": the " + what + " '" + *twice + "' is named twice");
}

void check_study(const Study& study) {
  check_names(study);
  for (const StudySolution* solution : solutions_of(study))
    check_solution(*solution, study.dimensions.cells);
  check_stages(study);
  check_smooth_for(study);
  check_problem(study);
  check_materials(study);
  check_degrees("refined degrees", study.refined_degrees, study);
  check_degrees("record degrees", study.record_degrees, study);
  check_thresholds(study);
  check_parts(study);
}

}  // namespace smoothfem
