// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/cli/standard_streams.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <vector>

#include "smoothing/base/input_error.h"

namespace smoothfem {

namespace fs = std::filesystem;

namespace {

/// "standard-input.msh" for "msh" and ".msh".
std::unique_ptr<TemporaryFile> temporary_for(const std::string& stream, const std::string& format,
                                             const std::string& option) {
  if (format.empty() || format.find('/') != std::string::npos)
    throw InputError("'-' is standard " + stream +
                     ", which has no file extension; give the format by " + option +
                     " msh, vtu or another one of 'smoothfem list'");
  return std::make_unique<TemporaryFile>("standard-" + stream +
                                         (format.starts_with(".") ? format : "." + format));
}

}  // namespace

std::unique_ptr<TemporaryFile> copy_of_standard_input(const std::string& name,
                                                      const std::string& format) {
  if (name != "-") {
    if (!format.empty()) throw InputError("--from is for standard input, '-'; leave it out");
    return nullptr;
  }
  auto file = temporary_for("input", format, "--from");
  std::ofstream stream(file->path(), std::ios::binary);
  // An empty input also sets the stream's failbit, but the reader reports it.
  if (std::cin.peek() != std::istream::traits_type::eof()) stream << std::cin.rdbuf();
  stream.close();
  if (!stream)
    throw InputError("cannot copy standard input to " + file->path().string() + ": " +
                     std::strerror(errno) + "; name a folder with more room in TMPDIR");
  return file;
}

std::unique_ptr<TemporaryFile> file_for_standard_output(const std::string& name,
                                                        const std::string& format) {
  if (name == "-") return temporary_for("output", format, "--to");
  return nullptr;
}

void require_extension(const std::string& out, const std::string& to, const WriteTarget& target) {
  if (!target.extension.empty() && !out.ends_with(target.extension))
    throw InputError("--to " + to + " makes a file '" + target.extension + "', but " + out +
                     " has another extension; change one of them");
}

void print_content(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::vector<char> buffer(1 << 16);
  while (stream.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) ||
         stream.gcount() > 0)
    if (const auto n = static_cast<std::size_t>(stream.gcount());
        std::fwrite(buffer.data(), 1, n, stdout) != n)
      throw InputError(std::string("cannot write to standard output: ") + std::strerror(errno));
}

}  // namespace smoothfem
