# SPDX-License-Identifier: GPL-3.0-or-later
# Installed files for users (component program) and for programs that call the libraries (component
# development), and the Debian packages of both components.
include(CMakePackageConfigHelpers)

set(libraries smoothfem_smoothing smoothfem_meshes smoothfem_domains smoothfem_fem)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/smoothfem)
install(TARGETS ${libraries} EXPORT smoothfem
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT program NAMELINK_COMPONENT development)
install(TARGETS smoothfem_distributed smoothfem_results smoothfem_studies
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT program NAMELINK_SKIP)
foreach(arch IN LISTS SMOOTHFEM_OTHER_ARCHS)
  install(TARGETS smoothfem_smoothing-${arch}
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/glibc-hwcaps/${arch} COMPONENT program NAMELINK_SKIP)
endforeach()
file(RELATIVE_PATH libexec_to_lib /${CMAKE_INSTALL_LIBEXECDIR}/smoothfem /${CMAKE_INSTALL_LIBDIR})
set(modules smoothfem_generate_command smoothfem_piece_commands smoothfem_study_commands)
set_target_properties(smoothfem ${modules} PROPERTIES INSTALL_RPATH $ORIGIN/${libexec_to_lib})
install(TARGETS ${modules} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/smoothfem COMPONENT program)
install(TARGETS smoothfem RUNTIME DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/smoothfem COMPONENT program)
if(SMOOTHFEM_BUILD_PYTHON)
  file(RELATIVE_PATH python_to_lib /${SMOOTHFEM_PYTHON_PACKAGE} /${CMAKE_INSTALL_LIBDIR})
  set_target_properties(smoothfem_python PROPERTIES INSTALL_RPATH $ORIGIN/${python_to_lib})
  install(TARGETS smoothfem_python LIBRARY DESTINATION ${SMOOTHFEM_PYTHON_PACKAGE} COMPONENT program)
  install(TARGETS smoothfem_python_host LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT program)
  install(DIRECTORY python/smoothfem/ DESTINATION ${SMOOTHFEM_PYTHON_PACKAGE} COMPONENT program
    FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN py.typed PATTERN __pycache__ EXCLUDE)
  install(DIRECTORY python/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/smoothfem/python COMPONENT program
    FILES_MATCHING PATTERN "*.py" PATTERN __pycache__ EXCLUDE)
endif()

# Scripts and data.
install(PROGRAMS launcher/smoothfem DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(PROGRAMS launcher/find_python launcher/fetch_published
  DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/smoothfem COMPONENT program)
install(FILES launcher/smoothfem.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES launcher/completion.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  RENAME smoothfem COMPONENT program)
# The manual: its pages as they are, and pages that the program makes. Links between all of them work.
install(FILES README.md CONTRIBUTING.md CITATION.cff CHANGELOG.md LICENSE packages.txt
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
  FILES_MATCHING PATTERN "*.md" PATTERN "*.png" PATTERN "*.csv" PATTERN "*.ipynb"
  PATTERN doxygen.md EXCLUDE PATTERN build EXCLUDE PATTERN tests EXCLUDE PATTERN __pycache__ EXCLUDE)
install(CODE "execute_process(
  COMMAND ${SMOOTHFEM_PYTHON} -B ${PROJECT_SOURCE_DIR}/docs/reference_pages.py ${PROJECT_BINARY_DIR}/bin/smoothfem
  \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR}/docs\" COMMAND_ERROR_IS_FATAL ANY)"
  COMPONENT program)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright COMPONENT program)
install(DIRECTORY studies/ DESTINATION ${CMAKE_INSTALL_DATADIR}/smoothfem/studies COMPONENT program
  FILES_MATCHING PATTERN "*.prm" PATTERN "*.json" PATTERN "*.csv"
  PATTERN tests EXCLUDE PATTERN cli EXCLUDE PATTERN framework EXCLUDE PATTERN kinds EXCLUDE)
install(DIRECTORY plots DESTINATION ${CMAKE_INSTALL_DATADIR}/smoothfem COMPONENT program
  FILES_MATCHING PATTERN "*.py" PATTERN "*.html" PATTERN "*.css" PATTERN "*.js"
  PATTERN tests EXCLUDE PATTERN __pycache__ EXCLUDE)

install(DIRECTORY meshes/io/foreign DESTINATION ${CMAKE_INSTALL_DATADIR}/smoothfem/meshes/io COMPONENT program
  FILES_MATCHING PATTERN "*.py" PATTERN __pycache__ EXCLUDE)
install(DIRECTORY adapters DESTINATION ${CMAKE_INSTALL_DATADIR}/smoothfem COMPONENT program
  USE_SOURCE_PERMISSIONS)
install(DIRECTORY launcher/new_smoother launcher/new_problem DESTINATION ${CMAKE_INSTALL_DATADIR}/smoothfem/launcher COMPONENT program
  USE_SOURCE_PERMISSIONS)

# Headers for users' smoothers, and for reading and generating meshes and for solving.
foreach(folder base geometry getme laplacian loop mesh optimization parts periodic polygons quality second_order simd surface transformations)
  file(GLOB headers CONFIGURE_DEPENDS smoothing/${folder}/*.h)
  install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/smoothfem/smoothing/${folder}
    COMPONENT development)
endforeach()
foreach(header meshes/distortion/distort.h meshes/domains/catalogue.h meshes/io/mesh_file.h
        meshes/tools/curved_boundary.h meshes/tools/outline.h
        meshes/io/mesh_view.h meshes/io/vtu_series.h fem/space/finite_element_space.h fem/solutions/manufactured_solution.h fem/solutions/point_function.h
        fem/constraints/node_ties.h fem/poisson_solver.h fem/assembly/load.h fem/solution_record.h fem/ranks/ranks.h fem/elements/reference_element.h
        fem/elements/curved_cells.h
        fem/solvers/mesh_solver.h fem/deal_ii/triangulation_solver.h)
  cmake_path(GET header PARENT_PATH folder)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/smoothfem/${folder} COMPONENT development)
endforeach()
# find_package can also find the build tree.
export(EXPORT smoothfem NAMESPACE smoothfem:: FILE ${PROJECT_BINARY_DIR}/smoothfem.cmake)
install(EXPORT smoothfem NAMESPACE smoothfem:: DESTINATION ${package_folder} COMPONENT development)
configure_package_config_file(cmake/smoothfemConfig.cmake.in ${PROJECT_BINARY_DIR}/smoothfemConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/smoothfemConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/smoothfemConfig.cmake ${PROJECT_BINARY_DIR}/smoothfemConfigVersion.cmake
  DESTINATION ${package_folder} COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME smoothfem)
set(CPACK_PACKAGE_CONTACT "smoothfem developers <noreply@example.org>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "What mesh smoothing does to a finite element solution")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION math)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME smoothfem)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS
  "openmpi-bin, python3, python3-numpy, python3-scipy, python3-matplotlib, python3-vtk9, python3-pyvirtualdisplay, xvfb, \
python3-plotly, esbuild, libjs-jquery, libjs-jquery-datatables")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "python3-pandas")
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION
  "Smooths meshes by GETMe, Laplacian variants and global optimization, and solves a Poisson problem after every iteration.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libsmoothfem-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "smoothfem (= ${PROJECT_VERSION}), libeigen3-dev, libopenmpi-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "libdeal.ii-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers and CMake package of smoothfem's libraries.")
include(CPack)
