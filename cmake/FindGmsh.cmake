# SPDX-License-Identifier: GPL-3.0-or-later
# Finds the Gmsh SDK (Debian: libgmsh-dev, which ships no CMake files). Defines Gmsh::Gmsh.
find_path(Gmsh_INCLUDE_DIR gmsh.h)
find_library(Gmsh_LIBRARY gmsh)
if(Gmsh_INCLUDE_DIR)
  file(STRINGS ${Gmsh_INCLUDE_DIR}/gmsh.h _gmsh_version REGEX "#define GMSH_API_VERSION \"")
  string(REGEX MATCH "[0-9]+\\.[0-9]+[.0-9]*" Gmsh_VERSION "${_gmsh_version}")
endif()
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Gmsh REQUIRED_VARS Gmsh_LIBRARY Gmsh_INCLUDE_DIR
                                  VERSION_VAR Gmsh_VERSION)
if(Gmsh_FOUND AND NOT TARGET Gmsh::Gmsh)
  add_library(Gmsh::Gmsh UNKNOWN IMPORTED)
  set_target_properties(Gmsh::Gmsh PROPERTIES
    IMPORTED_LOCATION ${Gmsh_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${Gmsh_INCLUDE_DIR})
endif()
mark_as_advanced(Gmsh_INCLUDE_DIR Gmsh_LIBRARY)
