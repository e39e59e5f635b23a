// SPDX-License-Identifier: GPL-3.0-or-later
#include <pybind11/stl.h>

#include <cstdio>
#include <optional>

#include "meshes/distortion/distort.h"
#include "meshes/domains/catalogue.h"
#include "meshes/io/mesh_file.h"
#include "meshes/metrics/metric.h"
#include "meshes/preparation/prepare_mesh.h"
#include "python/module/bind.h"
#include "python/module/python_mesh.h"
#include "smoothing/base/find_named.h"
#include "smoothing/quality/mesh_quality.h"
#include "smoothing/second_order/curved_quality.h"

namespace smoothfem {

namespace {

using Fields = std::map<std::string, std::vector<double>>;

py::array_t<double> array_of(const std::vector<double>& numbers) {
  return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
}

DistortionKind distortion_kind(const std::string& name) {
  const std::vector<std::string> names(distortion_kind_names.begin(), distortion_kind_names.end());
  return find_named("kind of distortion", name, names) == names[0] ? DistortionKind::worst_candidate
                                                                   : DistortionKind::random_steps;
}

/// To a mean quality, or within a radius; the mesh stays as it is if that fails.
double distort_mesh(PythonMesh& mesh, std::optional<double> q_mean, std::optional<double> radius,
                    const std::string& kind, std::uint64_t seed, std::optional<int> candidates,
                    int sweeps, double least_quality) {
  if (q_mean.has_value() == radius.has_value())
    throw InputError("distort needs q_mean or radius, and not both");
  DistortionParameters parameters;
  parameters.kind = distortion_kind(kind);
  parameters.seed = seed;
  parameters.n_sweeps = sweeps;
  parameters.min_quality = least_quality;
  if (q_mean) parameters.target_q_mean = *q_mean;
  return mesh.visit([&]<int dim, int spacedim>(Mesh<dim, spacedim>& m) {
    parameters.n_candidates = candidates.value_or(default_candidates(dim));
    const py::gil_scoped_release others_may_run;
    Mesh<dim, spacedim> work = m;  // arrays look at the memory of m
    const double reached =
        radius ? distort_within(work, *radius, parameters) : distort(work, parameters).q_mean;
    m.set_coordinates(work.coordinates());
    return reached;
  });
}

template <int dim, int spacedim>
std::vector<double> cell_sizes(const Mesh<dim, spacedim>& mesh) {
  if constexpr (dim == spacedim)
    return curved_cell_sizes(mesh);
  else
    throw InputError("the metric size is for planar and volume meshes, but this is a surface mesh");
}

template <int dim, int spacedim>
std::vector<double> cell_numbers(const Mesh<dim, spacedim>& mesh, const std::string& metric) {
  if (metric == "size") return cell_sizes(mesh);
  const auto metrics = metrics_named(metric);
  if (metrics.size() != 1)
    throw InputError("quality takes one metric, not '" + metric + "'; call it once for each");
  if (metrics[0]->compares_with_initial)
    throw InputError("the metric " + metric + " is for studies, which know the initial mesh");
  return metrics[0]->values(&mesh);
}

/// name -> (meaning, whether larger is better, value of a regular cell or none).
py::dict metric_facts() {
  py::dict facts;
  for (const Metric& metric : metric_catalogue())
    if (!metric.compares_with_initial)
      facts[metric.name.c_str()] =
          py::make_tuple(metric.meaning, metric.larger_is_better, metric.ideal);
  return facts;
}

py::array_t<double> quality(const PythonMesh& mesh, const std::string& metric) {
  std::vector<double> numbers;
  {
    const py::gil_scoped_release others_may_run;
    numbers = mesh.visit([&](const auto& m) { return cell_numbers(m, metric); });
  }
  return array_of(numbers);
}

/// Warns of what was changed in reading.
PythonMesh read(const std::string& path) {
  MeshFile file = read_mesh(path);
  for (const std::string& note : file.notes)
    if (PyErr_WarnEx(PyExc_UserWarning, (path + ": " + note).c_str(), 2) != 0)
      throw py::error_already_set();
  return PythonMesh(std::move(file.mesh));
}

std::string quality_text(const MeshQuality& q) {
  char text[128];
  std::snprintf(text, sizeof(text),
                "Quality(q_min=%.6g, q_star_min=%.6g, q_mean=%.6g, n_invalid=%zu)", q.q_min,
                q.q_star_min, q.q_mean, q.n_invalid);
  return text;
}

}  // namespace

void bind_files(py::module_& module) {
  py::class_<MeshQuality>(module, "Quality",
                          "Quality numbers of a mesh, from its cells' mean ratios.")
      .def_readonly("q_min", &MeshQuality::q_min, "lowest of all cells")
      .def_readonly("q_star_min", &MeshQuality::q_star_min,
                    "lowest of the cells with at least one free node")
      .def_readonly("q_mean", &MeshQuality::q_mean, "arithmetic mean over all cells")
      .def_readonly("n_invalid", &MeshQuality::n_invalid, "number of cells with quality <= 0")
      .def("__repr__", &quality_text);
  module.def("read", &read);
  module.def("write", [](const PythonMesh& mesh, const std::string& path, const Fields& cell,
                         const Fields& point) {
    mesh.visit([&](const auto& m) { write_mesh(path, m, {.cell = cell, .point = point}); });
  });
  module.def("domains", [] {
    py::dict elements;
    for (const Domain& domain : domains()) elements[domain.name.c_str()] = domain.elements;
    return elements;
  });
  module.def("generate", [](const std::string& domain, const std::string& elements,
                            double edge_scale, std::uint64_t seed, const std::string& algorithm,
                            std::optional<double> eps, int order) {
    const Domain& found = find_domain(domain);
    if (order == 2) found.require_second_order();
    const DomainParameters parameters{.elements = elements,
                                      .edge_scale = edge_scale,
                                      .seed = seed,
                                      .algorithm = algorithm,
                                      .eps = eps};
    AnyMesh mesh = found.generate(parameters);
    if (order < 2) return PythonMesh(std::move(mesh));
    auto [curved, report] = found.of_second_order(mesh, parameters);
    for (const auto& note : midside_notes(report))
      if (PyErr_WarnEx(PyExc_UserWarning, note.sentence.c_str(), 3) != 0)
        throw py::error_already_set();
    return PythonMesh(std::move(curved));
  });
  module.def("distort", &distort_mesh);
  module.def("quality", &quality);
  module.def("metrics", &metric_facts);
  module.def("summary", [](const PythonMesh& mesh) {
    const py::gil_scoped_release others_may_run;
    return mesh.visit([](const auto& m) { return mesh_quality(m); });
  });
}

}  // namespace smoothfem
