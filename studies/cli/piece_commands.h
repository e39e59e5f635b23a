// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

#include "smoothing/mesh/mesh.h"
#include "studies/cli/smooth_arguments.h"

/// Commands on meshes in pieces, on one process or several. They are in a module of their own,
/// whose libraries take long to load.

namespace smoothfem {

struct Examination;
struct PoissonOptions;

/// The user's arguments of `generate box`.
struct BoxArguments {
  std::string cells, split = "tetrahedra";
  double displacement = 0.0;
  std::uint64_t seed = 1;
  std::size_t n_pieces = 1;
  std::string out;
  bool quiet = false;
};

/// True if a command works on parts of its mesh: it writes pieces (.pvtu), or mpirun has started
/// the program, also as a single process, which then makes the same mesh as several. Otherwise
/// pieces are read as one mesh. out: the mesh to write; may be empty.
bool works_in_parts(const std::string& out);

/// Number of processes that mpirun has started; 1 without it.
int n_processes();
/// False for all processes of mpirun but one.
bool is_first_process();

void smooth_pieces(const SmoothArguments& arguments);
void report_pieces(const std::string& mesh, bool as_json);
void generate_box(const BoxArguments& arguments);
/// Examines a mesh in parts (distributed/examine_parts.h). False for all processes but one, which
/// has the result.
bool examine_pieces(const std::string& mesh, Examination& seen);
/// Writes a whole mesh, which a file has, in pieces (distributed/files/split.h).
void split_mesh(const AnyMesh& mesh, std::size_t n_pieces, const std::string& in,
                const std::string& out);
/// Splits the cells of a mesh in pieces (distributed/files/refine.h).
void refine_pieces(const std::string& in, const std::string& out, bool quiet);

}  // namespace smoothfem

/// The functions of the module.
extern "C" {
void smoothfem_smooth_pieces(const smoothfem::SmoothArguments& arguments);
void smoothfem_report_pieces(const std::string& mesh, const bool& as_json);
void smoothfem_examine_pieces(const std::string& mesh, smoothfem::Examination& seen,
                              bool& is_first);
void smoothfem_generate_box(const smoothfem::BoxArguments& arguments);
void smoothfem_split_mesh(const smoothfem::AnyMesh& mesh, const std::size_t& n_pieces,
                          const std::string& in, const std::string& out);
void smoothfem_refine_pieces(const std::string& in, const std::string& out, const bool& quiet);
/// A function of the module of studies: reads --finite-elements.
void smoothfem_read_finite_elements(const std::vector<std::string>& settings,
                                    smoothfem::PoissonOptions& options);
}
