# SPDX-License-Identifier: GPL-3.0-or-later
# Functions that make the libraries, tests and benchmarks of this project.

# The build tree has the layout of the installation: one folder, with the data next to the programs.
include(GNUInstallDirs)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
set(SMOOTHFEM_PYTHON_PACKAGE lib/python3/dist-packages/smoothfem)  # as for packages of Debian's python3
set(SMOOTHFEM_LIBEXEC ${PROJECT_BINARY_DIR}/libexec/smoothfem)
file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/bin ${SMOOTHFEM_LIBEXEC} ${PROJECT_BINARY_DIR}/share)
file(CREATE_LINK ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/share/smoothfem SYMBOLIC)
file(CREATE_LINK ${PROJECT_SOURCE_DIR}/launcher/smoothfem ${PROJECT_BINARY_DIR}/bin/smoothfem SYMBOLIC)
foreach(script find_python fetch_published)
  file(CREATE_LINK ${PROJECT_SOURCE_DIR}/launcher/${script} ${SMOOTHFEM_LIBEXEC}/${script} SYMBOLIC)
endforeach()

# Headers that most files include, compiled once per library.
function(smoothfem_precompile target)
  target_precompile_headers(${target} PRIVATE <Eigen/Core> <Eigen/Geometry> <algorithm> <array> <cmath>
    <functional> <map> <memory> <optional> <span> <string> <variant> <vector> ${ARGN})
endfunction()

# Compiles several files of a target at once, as much of their time goes into the headers that all of them include: about a
# third of the time that one by one takes. Not for files with loops that have to be fast: other files must not change how these
# are inlined.
function(smoothfem_compile_together target files)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
  # To GCC an unnamed namespace of a file in such a group seems to be one of a header.
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endfunction()

# As above, but only the files of each of these folders of the calling one, all at once.
function(smoothfem_compile_folders_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  foreach(folder IN LISTS ARGN)
    file(GLOB files CONFIGURE_DEPENDS ${folder}/*.cc)
    set_property(SOURCE ${files} PROPERTY UNITY_GROUP ${folder})
  endforeach()
endfunction()

# smoothfem_add_library(NAME source...): smoothfem::NAME. Shared, not static: an archive would drop the
# files that only register themselves.
function(smoothfem_add_library name)
  set(target smoothfem_${name})
  add_library(${target} SHARED ${ARGN})
  add_library(smoothfem::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES
    EXPORT_NAME ${name}
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    INSTALL_RPATH $ORIGIN)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_include_directories(${target} INTERFACE
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/smoothfem>)
  target_link_libraries(${target} PRIVATE smoothfem_options)
endfunction()

# Adds a copy of a library for another processor, in a separate folder.
function(smoothfem_add_copy_for_arch target arch folder)
  set(copy ${target}-${arch})
  get_target_property(sources ${target} SOURCES)
  get_target_property(libraries ${target} LINK_LIBRARIES)
  add_library(${copy} SHARED ${sources})
  target_link_libraries(${copy} PRIVATE ${libraries})
  get_target_property(version ${target} VERSION)
  get_target_property(soversion ${target} SOVERSION)
  set_target_properties(${copy} PROPERTIES
    SMOOTHFEM_ARCH_OF_COPY ${arch}
    OUTPUT_NAME ${target}
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib/${folder}
    VERSION ${version} SOVERSION ${soversion})
  smoothfem_precompile(${copy})
endfunction()

# What `./run test` builds besides the program; `./run test --fast LIBRARY` builds smoothfem_tests_LIBRARY.
add_custom_target(smoothfem_tests)
foreach(library smoothing meshes fem studies python plots)
  add_custom_target(smoothfem_tests_${library})
endforeach()
add_dependencies(smoothfem_tests_python smoothfem)
if(SMOOTHFEM_BUILD_TESTS)
  enable_testing()
  # Their own lines need not be fast, but compiled quickly; the libraries they call are.
  set(test_compile_options -O0)
  # The headers of the tests, compiled once for all of them.
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/test_headers.cc CONTENT "int main() {}\n")
  add_executable(smoothfem_test_headers EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/test_headers.cc)
  target_link_libraries(smoothfem_test_headers PRIVATE smoothfem_options Eigen3::Eigen
    OpenMP::OpenMP_CXX GTest::gtest GTest::gmock)
  target_compile_options(smoothfem_test_headers PRIVATE ${test_compile_options})
  smoothfem_precompile(smoothfem_test_headers <gtest/gtest.h> <gmock/gmock.h>)
endif()

# How all programs of tests are compiled: eight files at once, as much of the time goes into headers (smoothing_unit_test takes 87
# CPU seconds, not 154).
function(smoothfem_compile_as_test name)
  target_compile_options(${name} PRIVATE ${test_compile_options})
  target_precompile_headers(${name} REUSE_FROM smoothfem_test_headers)
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests
    UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
endfunction()

# smoothfem_add_test(NAME label [SERIAL] [ALSO_LONG] [SHARDS n] SOURCES source... LIBRARIES library...): a GoogleTest program, which
# is one entry of ctest, or n of them that share its cases. A program a case would start 2,000 processes, each of which
# loads up to 225 libraries; NAME --gtest_filter=CASE in the folder tests runs one. The labels are unit, integration or
# long, the library of the calling folder, and compiled. Waiting threads sleep, as other tests run meanwhile. SERIAL: nothing else runs meanwhile.
# ALSO_LONG: the long tests run the program once more, with the sizes that its tests choose then (test::short_or_long).
# Tests find the repository and the meshes that are not part of it.
function(smoothfem_add_test name label)
  if(NOT SMOOTHFEM_BUILD_TESTS)
    return()
  endif()
  cmake_parse_arguments(ARG "SERIAL;ALSO_LONG" "SHARDS" "SOURCES;LIBRARIES;DEFINITIONS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE smoothfem_options ${ARG_LIBRARIES} GTest::gtest GTest::gmock
                                        GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    SMOOTHFEM_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    SMOOTHFEM_SHARED_MESHES="${PROJECT_SOURCE_DIR}/../shared/meshes"
    ${ARG_DEFINITIONS})
  smoothfem_compile_as_test(${name})
  smoothfem_list_test(${name} ${label} "${ARG_SERIAL}" "${ARG_SHARDS}")
  if(ARG_ALSO_LONG)
    add_test(NAME ${name}_long COMMAND ${name} --gtest_brief=1)
    set_tests_properties(${name}_long PROPERTIES LABELS long
      ENVIRONMENT "SMOOTHFEM_LONG_TESTS=1;OMP_WAIT_POLICY=passive")
  endif()
endfunction()

# The entries of ctest of a test program, and the targets that build it.
function(smoothfem_list_test name label serial shards)
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR FILENAME library)
  if(NOT label STREQUAL long)  # `./run test --all` builds everything
    add_dependencies(smoothfem_tests ${name})
  endif()
  if(label STREQUAL unit AND TARGET smoothfem_tests_${library})
    add_dependencies(smoothfem_tests_${library} ${name})
  endif()
  if(NOT shards)
    set(shards 1)
  endif()
  foreach(shard RANGE 1 ${shards})
    set(entry ${name})
    if(shards GREATER 1)
      string(APPEND entry _${shard})
    endif()
    math(EXPR index "${shard} - 1")
    add_test(NAME ${entry} COMMAND ${name} --gtest_brief=1)
    set_tests_properties(${entry} PROPERTIES LABELS "${label};${library};compiled" RUN_SERIAL "${serial}" COST ${shards}
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${index};OMP_WAIT_POLICY=passive")
  endforeach()
endfunction()

# smoothfem_add_bench(NAME SOURCES source... LIBRARIES library...): a program with Google Benchmark.
function(smoothfem_add_bench name)
  if(NOT SMOOTHFEM_BUILD_BENCHMARKS)
    return()
  endif()
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE smoothfem_options ${ARG_LIBRARIES} benchmark::benchmark)
  target_compile_definitions(${name} PRIVATE
    SMOOTHFEM_SHARED_MESHES="${PROJECT_SOURCE_DIR}/../shared/meshes")
  set_target_properties(${name} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bench)
endfunction()

# smoothfem_add_mpi_program(NAME SOURCES source... LIBRARIES library...): a GoogleTest program for several processes, with a main of
# its own (fem/tests/all_ranks.h).
function(smoothfem_add_mpi_program name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE smoothfem_options ${ARG_LIBRARIES} GTest::gtest GTest::gmock)
  smoothfem_compile_as_test(${name})
endfunction()

# smoothfem_add_mpi_test(NAME LABELS ranks...): runs such a program on these numbers of processes, with any number of cores; also as
# root, for containers. Next to several processes nothing else runs: on busy cores they wait for each other ten times as long.
function(smoothfem_add_mpi_test name labels)
  if(NOT labels STREQUAL long)  # `./run test --all` builds everything
    add_dependencies(smoothfem_tests ${name})
  endif()
  foreach(n_ranks IN LISTS ARGN)
    add_test(NAME ${name}_${n_ranks}_ranks
      COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} ${n_ranks} --oversubscribe --mca mpi_yield_when_idle 1
              $<TARGET_FILE:${name}> --gtest_brief=1)
    set_tests_properties(${name}_${n_ranks}_ranks PROPERTIES LABELS "${labels}"
      ENVIRONMENT "OMPI_ALLOW_RUN_AS_ROOT=1;OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1;OMP_WAIT_POLICY=passive")
    if(n_ranks GREATER 1)
      set_tests_properties(${name}_${n_ranks}_ranks PROPERTIES RUN_SERIAL TRUE)
    endif()
  endforeach()
endfunction()
