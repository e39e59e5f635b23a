# SPDX-License-Identifier: GPL-3.0-or-later
# Finds GiNaC (Debian: libginac-dev, which ships no CMake files), including CLN. Defines GiNaC::GiNaC.
find_path(GiNaC_INCLUDE_DIR ginac/ginac.h)
find_library(GiNaC_LIBRARY ginac)
find_library(GiNaC_CLN_LIBRARY cln)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(GiNaC REQUIRED_VARS GiNaC_LIBRARY GiNaC_CLN_LIBRARY GiNaC_INCLUDE_DIR)
if(GiNaC_FOUND AND NOT TARGET GiNaC::GiNaC)
  add_library(GiNaC::GiNaC UNKNOWN IMPORTED)
  set_target_properties(GiNaC::GiNaC PROPERTIES
    IMPORTED_LOCATION ${GiNaC_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${GiNaC_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES ${GiNaC_CLN_LIBRARY})
endif()
mark_as_advanced(GiNaC_INCLUDE_DIR GiNaC_LIBRARY GiNaC_CLN_LIBRARY)
