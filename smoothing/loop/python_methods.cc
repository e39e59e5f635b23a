// SPDX-License-Identifier: GPL-3.0-or-later
#include "smoothing/loop/python_methods.h"

#include <dlfcn.h>

#include <atomic>
#include <mutex>

namespace smoothfem {

namespace {

namespace fs = std::filesystem;

constexpr const char* host_name = "libsmoothfem_python_host.so";
constexpr const char* start_name = "smoothfem_start_python";

std::atomic<MethodEntry (*)(const MethodInFile&)> maker{nullptr};
std::atomic<bool> started{false};

/// Searches next to this library and above it: variants for other processors lie in subfolders.
fs::path host_path() {
  Dl_info library{};
  dladdr(reinterpret_cast<const void*>(&set_python_methods), &library);
  const fs::path own = fs::weakly_canonical(library.dli_fname ? library.dli_fname : "");
  for (fs::path above = own.parent_path(); above.has_relative_path(); above = above.parent_path())
    if (fs::exists(above / host_name)) return above / host_name;
  throw InputError("methods written in Python need " + std::string(host_name) +
                   ", which is not next to " + own.string() + "; reinstall smoothfem");
}

/// Global symbols: modules such as numpy's use the interpreter's functions.
void start_python() {
  const fs::path path = host_path();
  void* const host = dlopen(path.c_str(), RTLD_NOW | RTLD_GLOBAL);
  if (host == nullptr)
    throw InputError("methods written in Python need libpython, but " + std::string(dlerror()) +
                     "; on Debian: apt install libpython3-dev python3-numpy");
  const auto start = reinterpret_cast<const char* (*)()>(dlsym(host, start_name));
  started = true;
  const char* why_not = start ? start() : "the library has no start function";
  if (why_not == nullptr && maker == nullptr)
    why_not = "the Python package smoothfem belongs to another installation";
  if (why_not != nullptr) {
    started = false;
    throw InputError("Python cannot be started for methods written in it: " + std::string(why_not));
  }
}

MethodEntry make_python_method(const MethodInFile& method) {
  require_python();
  return maker.load()(method);
}

const RegisteredScheme registered({.name = "python", .make = make_python_method});

}  // namespace

void set_python_methods(MethodEntry (*make)(const MethodInFile&)) {
  maker = make;
}

void require_python() {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  if (maker == nullptr) start_python();
}

bool started_python() {
  return started;
}

}  // namespace smoothfem
