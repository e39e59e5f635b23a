// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "fem/deal_ii/kelly.h"
#include "fem/deal_ii/lagrange_space.h"
#include "fem/deal_ii/solution_functions.h"
#include "fem/deal_ii/symmetric_system.h"
#include "fem/deal_ii/triangulation_solver.h"
#include "fem/materials/cell_kinds.h"
#include "fem/solutions/displacement.h"
#include "smoothing/base/text.h"
#include "smoothing/mesh/boundary_tags.h"

namespace smoothfem {
namespace {

/// The Lame constants of an isotropic material. In plane stress lambda is 2 lambda mu / (lambda + 2
/// mu), so that the same formulas hold for the stresses in the plane.
struct Lame {
  double lambda = 0.0, mu = 0.0;
  bool has_normal_stress = true;  ///< in the third direction of a planar problem
};

/// Values of E and nu, for all cells or for a group.
struct Constants {
  double E = 1.0, nu = 0.3;
};

template <int dim>
using Tensor = Eigen::Matrix<double, dim, dim>;

template <int dim>
Tensor<dim> stress_of(const Tensor<dim>& gradient, const Lame& c) {
  const Tensor<dim> strain = 0.5 * (gradient + gradient.transpose());
  return c.lambda * strain.trace() * Tensor<dim>::Identity() + 2.0 * c.mu * strain;
}

template <int dim>
double von_mises(const Tensor<dim>& gradient, const Lame& c) {
  Tensor<3> stress = Tensor<3>::Zero();
  stress.topLeftCorner<dim, dim>() = stress_of<dim>(gradient, c);
  if (dim == 2 && c.has_normal_stress) stress(2, 2) = c.lambda * gradient.trace();
  const Tensor<3> deviator = stress - stress.trace() / 3.0 * Tensor<3>::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

/// a(u, u) of a gradient.
template <int dim>
double energy_density(const Tensor<dim>& gradient, const Lame& c) {
  return (stress_of<dim>(gradient, c).array() * gradient.array()).sum();
}

/// A condition on a group of the boundary: one formula for each component, none where it is free.
template <int dim>
struct BoundaryCondition {
  std::string group;
  VectorFormula<dim> values;
  std::array<bool, dim> is_given;
};

/// Reads "FORMULA ; free".
template <int dim>
BoundaryCondition<dim> boundary_condition(const std::string& key, const std::string& group,
                                          const std::string& text) {
  std::array<bool, dim> is_given{};
  std::string formulas;
  std::size_t component = 0;
  for (std::size_t begin = 0; begin <= text.size(); ++component) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    std::string part = text.substr(begin, end - begin);
    const auto words = split_list(part);
    const bool is_free = words.size() == 1 && words.front() == "free";
    if (component < dim) is_given[component] = !is_free;
    formulas += (component == 0 ? "" : ";") + (is_free ? "0" : part);
    begin = end + 1;
  }
  return {group, VectorFormula<dim>(key + " group " + group, formulas), is_given};
}

/// Linear elasticity: -div sigma = f with sigma = lambda tr(eps) I + 2 mu eps, as deal.II's
/// tutorial step-8.
template <int dim>
class Elasticity final : public TriangulationSolver<dim> {
 public:
  SolverTraits traits() const override {
    return {.degrees = {1, 2, 3, 4},
            .needs_mpi = true,
            .needs_solution = false,
            .takes_ties = true,
            .takes_ranks = true,
            .has_energy = true,
            .has_indicators = true};
  }

  Parameters parameters() override {
    Parameters all{
        {"u",
         "displacement as formulas 'u_x ; u_y' (and '; u_z'): the load and the tractions are "
         "derived, and "
         "errors are recorded; empty: a part under the loads below",
         &u_text_},
        {"E", "Young's modulus", &constants_.E, 0.0, std::numeric_limits<double>::infinity(), true},
        {"nu", "Poisson's ratio", &constants_.nu, -1.0, 0.5, true, true},
        {"natural",
         "with u: groups of the boundary, separated by commas, where the traction is given instead "
         "of u",
         &natural_},
        {"f", "without u: load per volume, as formulas; empty: none", &load_text_},
        {"cg_tolerance", "tolerance for |r| / |b|", &cg_tolerance_, 0.0, 1.0, true},
        {"points", "Gauss points per direction on cells that are not simplices; 0: degree + 4",
         &points_, 0.0, 20.0}};
    if (dim == 2)
      all.push_back(
          {"plane", "state in the plane: strain or stress", Choice{&plane_, {"strain", "stress"}}});
    return all;
  }

  std::vector<std::string> keyed_parameters() const override {
    return {"E group", "nu group", "displacement group", "traction group"};
  }

  void set_keyed(const std::string& parameter, const std::string& group,
                 const std::string& value) override {
    if (parameter == "displacement group")
      displacements_.push_back(boundary_condition<dim>("displacement", group, value));
    else if (parameter == "traction group")
      tractions_.push_back(boundary_condition<dim>("traction", group, value));
    else
      of_groups_.push_back({parameter, group, value});
  }

  void check_parameters() const override {
    if (u_text_.empty() && displacements_.empty())
      throw InputError(
          "elasticity needs a displacement u, or a group of the boundary that is held, such as "
          "'set displacement group=clamp = 0 ; 0'");
    if (!u_text_.empty()) {
      (void)Displacement<dim>(u_text_);
      if (!displacements_.empty() || !tractions_.empty() || !load_text_.empty())
        throw InputError(
            "elasticity has a displacement u, from which loads and displacements follow; leave out "
            "u, or 'f', 'displacement group' and 'traction group'");
    } else if (!natural_.empty()) {
      throw InputError("elasticity has 'natural', but no displacement u; leave it out");
    }
    if (!load_text_.empty()) (void)VectorFormula<dim>("f", load_text_);
    for (const auto& [parameter, group, value] : of_groups_) {
      Constants read = constants_;
      set_constant(parameter, group, value, read);
    }
  }

  std::vector<NumberDescription> numbers() const override {
    auto all = SymmetricSystem::descriptions();
    if (!u_text_.empty()) {
      all.push_back({"l2_error", "", "Error of u in the L2 norm, by quadrature."});
      all.push_back({"h1_error", "", "Error of u in the H1 norm, by quadrature."});
      all.push_back({"energy_error", "",
                     "Error of u in the energy norm: square root of the integral of sigma : eps."});
      all.push_back({"von_mises_error", "",
                     "Largest error of the von Mises stress at the quadrature points."});
    }
    all.push_back({"energy", "", "Square of the energy norm of the computed displacement."});
    all.push_back(
        {"u_max", "", "Largest length of the displacement at a node of the finite elements."});
    all.push_back({"von_mises_max", "", "Largest von Mises stress at the quadrature points."});
    return all;
  }

 protected:
  void setup(const Mesh<dim>& mesh, const dealii::Triangulation<dim>& triangulation,
             unsigned int degree) override {
    if (!u_text_.empty()) u_.emplace(u_text_);
    if (!load_text_.empty()) load_.emplace("f", load_text_);
    take_groups(mesh.topology());
    require_facets_for_tractions(triangulation);
    space_ = std::make_unique<LagrangeSpace<dim>>(triangulation, degree, dim,
                                                  static_cast<unsigned int>(points_), this->ties());
    const auto constraints = boundary_values();
    system_ = std::make_unique<SymmetricSystem>(*space_, constraints);
    if (system_->n_free(constraints) == space_->dofs.n_dofs())
      throw InputError(
          "no part of the boundary is held in elasticity; name a group of it in a "
          "'displacement group', or take one out of 'natural'");
  }

  SolverResult solve(const dealii::Triangulation<dim>& /*triangulation*/) override {
    const auto constraints = boundary_values();
    assemble(constraints);
    SolverResult result{
        .numbers = system_->solve(constraints, rigid_body_modes(constraints), cg_tolerance_)};
    add_norms(result);
    result.numbers.push_back({"u_max", largest_displacement()});
    return result;
  }

  /// Returns J = a(u_h, u_h) - 2 (f, u_h) - 2 <t, u_h> with the tractions t, twice the potential
  /// energy. If the boundary stays, the squared error in the energy norm is J + const.
  double energy(const dealii::Triangulation<dim>& /*triangulation*/) override {
    const auto constraints = boundary_values();
    assemble(constraints);
    system_->solve_accurately(constraints, rigid_body_modes(constraints));
    return system_->energy(*space_, integrands());
  }

  /// For inner vertices v with hat functions N_v, the sum over cells of integrals of
  ///
  ///   (sigma : eps) grad N_v - 2 (grad u)^T sigma grad N_v + 2 N_v (grad u)^T f.
  ///
  /// J is stationary in u. Materials move with their cells. The last term is -2 times the
  /// derivative of (f, u), integrated by parts to avoid grad f.
  std::vector<dealii::Tensor<1, dim>> energy_gradient(
      const dealii::Triangulation<dim>& triangulation) override {
    std::vector<dealii::Tensor<1, dim>> gradient(triangulation.n_vertices());
    const dealii::FEValuesExtractors::Vector displacement(0);
    std::vector<dealii::Tensor<2, dim>> gradients;
    space_->for_each_cell_with_hats([&](const dealii::FEValues<dim>& values,
                                        const dealii::FEValues<dim>& hats, const auto& cell) {
      const Lame& c = material_of(cell);
      gradients.resize(values.n_quadrature_points);
      values[displacement].get_function_gradients(system_->solution, gradients);
      for (const unsigned int q : values.quadrature_point_indices()) {
        const Tensor<dim> grad_u = matrix_from(gradients[q]);
        const Tensor<dim> stress = stress_of<dim>(grad_u, c);
        const Tensor<dim> of_grad_hat = energy_density<dim>(grad_u, c) * Tensor<dim>::Identity() -
                                        2.0 * grad_u.transpose() * stress;
        const Eigen::Matrix<double, dim, 1> of_hat =
            2.0 * grad_u.transpose() * load_at(point_from(values.quadrature_point(q)), c);
        for (const unsigned int v : hats.dof_indices()) {
          auto& of_vertex = gradient[cell->vertex_index(v)];
          const auto grad_hat = hats.shape_grad(v, q);
          for (int k = 0; k < dim; ++k) {
            double sum = of_hat[k] * hats.shape_value(v, q);
            for (int j = 0; j < dim; ++j) sum += of_grad_hat(k, j) * grad_hat[j];
            of_vertex[k] += sum * values.JxW(q);
          }
        }
      }
    });
    return gradient;
  }

  dealii::Vector<float> indicators(const dealii::Triangulation<dim>& /*triangulation*/) override {
    return kelly_means(*space_, system_->solution);
  }

 private:
  using Id = dealii::types::boundary_id;

  /// Takes materials and conditions of groups, which only the root's mesh has.
  void take_groups(const Topology& topology) {
    const Ranks& ranks = this->ranks();
    ranks.on_root([&] {
      set_materials(topology);
      set_boundary(topology);
    });
    ranks.broadcast(materials_);
    ranks.broadcast(natural_ids_);
    ranks.broadcast(displacement_ids_);
    ranks.broadcast(traction_ids_);
  }

  static void set_constant(const std::string& parameter, const std::string& group,
                           const std::string& text, Constants& constants) {
    const bool is_E = parameter == "E group";
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const Parameter described =
        is_E ? Parameter{parameter + " " + group, "", &constants.E, 0.0, infinity, true}
             : Parameter{parameter + " " + group, "", &constants.nu, -1.0, 0.5, true, true};
    set_value(described, text, "elasticity");
  }

  Lame lame_of(const Constants& c) const {
    Lame lame{.lambda = c.E * c.nu / ((1.0 + c.nu) * (1.0 - 2.0 * c.nu)),
              .mu = c.E / (2.0 * (1.0 + c.nu))};
    if (dim == 2 && plane_ == 1) {
      lame.lambda = 2.0 * lame.lambda * lame.mu / (lame.lambda + 2.0 * lame.mu);
      lame.has_normal_stress = false;
    }
    return lame;
  }

  /// Sets the material of each cell.
  void set_materials(const Topology& topology) {
    const auto kinds = cell_kinds(topology);
    const auto groups = groups_of_kinds(topology, kinds);
    std::vector<Constants> of_kinds(std::max<std::size_t>(1, groups.size()), constants_);
    for (const auto& [parameter, group, value] : of_groups_) {
      bool is_known = false;
      for (std::size_t k = 0; k < groups.size(); ++k)
        if (std::find(groups[k].begin(), groups[k].end(), group) != groups[k].end()) {
          set_constant(parameter, group, value, of_kinds[k]);
          is_known = true;
        }
      if (!is_known)
        throw InputError("elasticity has '" + parameter + " " + group +
                         "', but no cell of the mesh is in this group");
    }
    materials_.clear();
    for (const auto kind : kinds) materials_.push_back(lame_of(of_kinds[kind]));
    if (!u_text_.empty() && std::any_of(materials_.begin(), materials_.end(), [&](const Lame& m) {
          return m.lambda != materials_.front().lambda || m.mu != materials_.front().mu;
        }))
      throw InputError(
          "elasticity has a displacement u and several materials, whose interface would need "
          "another load; leave u out, or give all groups the same E and nu");
  }

  /// Returns the id of a group of the boundary, given by its tag or name.
  static Id id_of(const Topology& topology, const std::string& group) {
    for (const int tag : topology.labels().facet_tags)
      if (is_group(topology.labels(), dim - 1, tag, group)) return static_cast<Id>(tag);
    throw InputError("elasticity names the group '" + group +
                     "' of the boundary, which the mesh does not have; " +
                     groups_of_boundary(topology.labels(), dim - 1));
  }

  /// Returns the ids of a group that is held: of all facets for "boundary", if no group has this
  /// name.
  static std::set<Id> ids_of_displacement(const Topology& topology, const std::string& group) {
    const MeshLabels& labels = topology.labels();
    const bool is_named =
        std::any_of(labels.facet_tags.begin(), labels.facet_tags.end(),
                    [&](int tag) { return is_group(labels, dim - 1, tag, group); });
    if (group != "boundary" || is_named) return {id_of(topology, group)};
    std::set<Id> all{0};  // of facets without a tag
    for (const int tag : labels.facet_tags) all.insert(static_cast<Id>(tag));
    return all;
  }

  void set_boundary(const Topology& topology) {
    natural_ids_.clear();
    displacement_ids_.clear();
    traction_ids_.clear();
    for (const auto& group : split_list(natural_)) natural_ids_.push_back(id_of(topology, group));
    for (std::size_t k = 0; k < displacements_.size(); ++k)
      for (const Id id : ids_of_displacement(topology, displacements_[k].group))
        displacement_ids_.push_back({id, k});
    for (std::size_t k = 0; k < tractions_.size(); ++k)
      traction_ids_.push_back({id_of(topology, tractions_[k].group), k});
  }

  bool is_natural(Id id) const {
    return std::find(natural_ids_.begin(), natural_ids_.end(), id) != natural_ids_.end();
  }

  bool has_traction(Id id) const {
    return is_natural(id) || std::any_of(traction_ids_.begin(), traction_ids_.end(),
                                         [&](const OfId& given) { return given.id == id; });
  }

  void require_facets_for_tractions(const dealii::Triangulation<dim>& triangulation) const {
    for (const auto& type : triangulation.get_reference_cells())
      if (has_facets_of_two_shapes(type) && !(natural_ids_.empty() && traction_ids_.empty()))
        throw InputError("elasticity has no tractions on pyramids and prisms; leave them out");
  }

  dealii::AffineConstraints<double> boundary_values() const {
    dealii::AffineConstraints<double> constraints(space_->relevant_dofs);
    const auto points = space_->support_points();
    const auto hold = [&](auto dof, double value) {
      constraints.add_line(dof);
      constraints.set_inhomogeneity(dof, value);
    };
    space_->for_each_boundary_dof([&](auto dof, unsigned int component, Id id) {
      const Point<dim> p = point_from(points.at(dof));
      if (u_) {
        if (!is_natural(id)) hold(dof, u_->at(p).value[component]);
        return;
      }
      for (const auto& [group, k] : displacement_ids_)
        if (group == id && displacements_[k].is_given[component])
          hold(dof, displacements_[k].values.at(p)[component]);
    });
    space_->add_ties(constraints);
    constraints.close();
    return constraints;
  }

  /// Returns f at a point of a cell.
  Eigen::Matrix<double, dim, 1> load_at(const Point<dim>& p, const Lame& c) const {
    if (u_) {
      const auto d = u_->at(p);
      return -(c.lambda + c.mu) * d.grad_div - c.mu * d.laplacian;
    }
    return load_ ? load_->at(p) : Eigen::Matrix<double, dim, 1>::Zero();
  }

  void assemble(const dealii::AffineConstraints<double>& constraints) {
    system_->assemble(*space_, constraints, integrands());
  }

  /// Returns the integrals over a cell, for SymmetricSystem.
  auto integrands() const {
    return [this](const dealii::FEValues<dim>& values, const auto& cell,
                  dealii::FullMatrix<double>& cell_matrix, dealii::Vector<double>& cell_load) {
      const Lame& c = material_of(cell);
      add_stiffness(values, c, cell_matrix);
      for (const unsigned int q : values.quadrature_point_indices()) {
        const auto f = load_at(point_from(values.quadrature_point(q)), c);
        for (const unsigned int i : values.dof_indices())
          cell_load(i) +=
              values.shape_value(i, q) * f[component(cell->get_fe(), i)] * values.JxW(q);
      }
      add_tractions(cell, c, cell_load);
    };
  }

  static Tensor<dim> matrix_from(const dealii::Tensor<2, dim>& given) {
    Tensor<dim> matrix;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) matrix(i, j) = given[i][j];
    return matrix;
  }

  template <class Cell>
  const Lame& material_of(const Cell& cell) const {
    return materials_[cell->id().get_coarse_cell_id()];
  }

  static int component(const dealii::FiniteElement<dim>& element, unsigned int i) {
    return static_cast<int>(element.system_to_component_index(i).first);
  }

  /// Adds the integrals of 2 mu eps(phi_i) : eps(phi_j) + lambda div phi_i div phi_j, as products
  /// of matrices with a row for each point and each entry of eps.
  static void add_stiffness(const dealii::FEValues<dim>& values, const Lame& c,
                            dealii::FullMatrix<double>& cell_matrix) {
    constexpr unsigned int n_strains = dim * (dim + 1) / 2;
    const unsigned int n_points = values.n_quadrature_points, n = values.dofs_per_cell;
    dealii::FullMatrix<double> strain(n_strains * n_points, n), divergence(n_points, n);
    const dealii::FEValuesExtractors::Vector displacement(0);
    for (unsigned int q = 0; q < n_points; ++q) {
      const double of_strain = std::sqrt(2.0 * c.mu * values.JxW(q));
      const double of_divergence = std::sqrt(std::abs(c.lambda) * values.JxW(q));
      for (unsigned int i = 0; i < n; ++i) {
        const auto eps = values[displacement].symmetric_gradient(i, q);
        unsigned int row = n_strains * q;
        for (unsigned int a = 0; a < dim; ++a)
          for (unsigned int b = a; b < dim; ++b)
            strain(row++, i) = of_strain * eps[a][b] * (a == b ? 1.0 : std::sqrt(2.0));
        divergence(q, i) = of_divergence * dealii::trace(eps);
      }
    }
    strain.Tmmult(cell_matrix, strain);
    dealii::FullMatrix<double> of_lambda(n, n);
    divergence.Tmmult(of_lambda, divergence);
    cell_matrix.add(c.lambda < 0.0 ? -1.0 : 1.0, of_lambda);
  }

  /// Adds the tractions on the cell's boundary facets.
  void add_tractions(const typename dealii::DoFHandler<dim>::active_cell_iterator& cell,
                     const Lame& c, dealii::Vector<double>& cell_load) const {
    for (const unsigned int f : cell->face_indices()) {
      if (!cell->face(f)->at_boundary() || space_->is_tied(cell->face(f))) continue;
      const Id id = cell->face(f)->boundary_id();
      if (!has_traction(id)) continue;
      const unsigned int type = cell->active_fe_index();
      const auto& element = cell->get_fe();
      dealii::FEFaceValues<dim> values(space_->mappings[type], element, space_->facet_rules[type],
                                       dealii::update_values | dealii::update_quadrature_points |
                                           dealii::update_normal_vectors |
                                           dealii::update_JxW_values);
      values.reinit(cell, f);
      for (const unsigned int q : values.quadrature_point_indices()) {
        const Point<dim> p = point_from(values.quadrature_point(q));
        Eigen::Matrix<double, dim, 1> traction = Eigen::Matrix<double, dim, 1>::Zero();
        if (u_) {
          Eigen::Matrix<double, dim, 1> normal;
          for (int d = 0; d < dim; ++d) normal[d] = values.normal_vector(q)[d];
          traction = stress_of<dim>(u_->at(p).gradient, c) * normal;
        } else {
          for (const auto& [group, k] : traction_ids_) {
            if (group != id) continue;
            const auto here = tractions_[k].values.at(p);
            for (int d = 0; d < dim; ++d)
              if (tractions_[k].is_given[static_cast<std::size_t>(d)]) traction[d] += here[d];
          }
        }
        for (const unsigned int i : values.dof_indices())
          cell_load(i) +=
              values.shape_value(i, q) * traction[component(element, i)] * values.JxW(q);
      }
    }
  }

  /// Returns the largest displacement of a support point.
  double largest_displacement() const {
    std::vector<dealii::types::global_dof_index> indices;
    double most = 0.0;
    for (const auto& cell : space_->own_cells()) {
      const auto& element = cell->get_fe();
      indices.resize(element.n_dofs_per_cell());
      cell->get_dof_indices(indices);
      std::vector<double> squares(indices.size() / dim);  // of each support point
      for (unsigned int i = 0; i < indices.size(); ++i) {
        const double u = system_->solution[indices[i]];
        squares[element.system_to_component_index(i).second] += u * u;
      }
      most = std::max(most, *std::max_element(squares.begin(), squares.end()));
    }
    return std::sqrt(this->ranks().max(most));
  }

  /// Returns translations and rotations at this rank's dofs, zero at constrained ones.
  std::vector<std::vector<double>> rigid_body_modes(
      const dealii::AffineConstraints<double>& constraints) const {
    constexpr unsigned int n_modes = dim * (dim + 1) / 2;
    const auto& own = space_->dofs.locally_owned_dofs();
    std::vector<std::vector<double>> modes(n_modes, std::vector<double>(own.n_elements()));
    const auto points = space_->support_points();
    space_->for_each_dof([&](auto dof, unsigned int c) {
      if (constraints.is_constrained(dof) || !own.is_element(dof)) return;
      const auto i = own.index_within_set(dof);
      const auto& p = points.at(dof);
      modes[c][i] = 1.0;
      unsigned int mode = dim;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a + 1; b < dim; ++b, ++mode) {
          if (c == a) modes[mode][i] = -p[b];
          if (c == b) modes[mode][i] = p[a];
        }
    });
    return modes;
  }

  /// Adds norms of the error and of the displacement.
  void add_norms(SolverResult& result) const {
    const dealii::FEValuesExtractors::Vector displacement(0);
    std::vector<dealii::Tensor<1, dim>> u_h;
    std::vector<dealii::Tensor<2, dim>> gradients;
    double l2 = 0.0, h1 = 0.0, energy_error = 0.0, energy = 0.0, stress_error = 0.0, stress = 0.0;
    space_->for_each_cell([&](const dealii::FEValues<dim>& values, const auto& cell) {
      const Lame& c = material_of(cell);
      u_h.resize(values.n_quadrature_points);
      gradients.resize(values.n_quadrature_points);
      values[displacement].get_function_values(system_->solution, u_h);
      values[displacement].get_function_gradients(system_->solution, gradients);
      for (const unsigned int q : values.quadrature_point_indices()) {
        const Tensor<dim> gradient = matrix_from(gradients[q]);
        Eigen::Matrix<double, dim, 1> value;
        for (int i = 0; i < dim; ++i) value[i] = u_h[q][i];
        const double weight = values.JxW(q), stress_here = von_mises<dim>(gradient, c);
        energy += weight * energy_density<dim>(gradient, c);
        stress = std::max(stress, stress_here);
        if (!u_) continue;
        const auto exact = u_->at(point_from(values.quadrature_point(q)));
        const Tensor<dim> difference = exact.gradient - gradient;
        l2 += weight * (exact.value - value).squaredNorm();
        h1 += weight * difference.squaredNorm();
        energy_error += weight * energy_density<dim>(difference, c);
        stress_error =
            std::max(stress_error, std::abs(von_mises<dim>(exact.gradient, c) - stress_here));
      }
    });
    for (double* sum : {&l2, &h1, &energy_error, &energy}) *sum = this->ranks().sum(*sum);
    for (double* most : {&stress_error, &stress}) *most = this->ranks().max(*most);
    if (u_) {
      result.numbers.push_back({"l2_error", std::sqrt(l2)});
      result.numbers.push_back({"h1_error", std::sqrt(l2 + h1)});
      result.numbers.push_back({"energy_error", std::sqrt(energy_error)});
      result.numbers.push_back({"von_mises_error", stress_error});
    }
    result.numbers.push_back({"energy", energy});
    result.numbers.push_back({"von_mises_max", stress});
  }

  struct OfGroup {
    std::string parameter, group, value;
  };

  /// A boundary id with the number of a condition there.
  struct OfId {
    Id id;
    std::size_t condition;
  };

  std::string u_text_, load_text_, natural_;
  Constants constants_;
  std::vector<OfGroup> of_groups_;
  std::vector<BoundaryCondition<dim>> displacements_, tractions_;
  int plane_ = 0, points_ = 0;
  double cg_tolerance_ = 1e-8;

  std::optional<Displacement<dim>> u_;
  std::optional<VectorFormula<dim>> load_;
  std::vector<Lame> materials_;  ///< of each cell
  std::vector<Id> natural_ids_;
  std::vector<OfId> displacement_ids_, traction_ids_;
  std::unique_ptr<LagrangeSpace<dim>> space_;
  std::unique_ptr<SymmetricSystem> system_;
};

const RegisteredSolver registered_elasticity(
    {.name = "elasticity",
     .title = "Linear elasticity",
     .description = "linear elasticity of isotropic materials, with a known displacement or under "
                    "loads",
     .source = "deal.II's tutorial program step-8"},
    solver_in_plane_and_space<Elasticity>());

}  // namespace
}  // namespace smoothfem
