# Compiler flags and the one way to declare a module (folder = namespace = target).

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
# Release keeps the optimiser's best level; NDEBUG is set by CMake.
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")

set(VPE_SANITIZE "" CACHE STRING "Sanitizers for every target, e.g. address,undefined or thread")

add_library(vpe_flags INTERFACE)
# -ffp-contract=off: meshes, the embedded planet and borders must have the same bits on every machine.
target_compile_options(vpe_flags INTERFACE
  -Wall -Wextra -Wconversion -Wshadow -Werror -ffp-contract=off)
target_include_directories(vpe_flags INTERFACE ${CMAKE_CURRENT_SOURCE_DIR})
if(VPE_SANITIZE)
  target_compile_options(vpe_flags INTERFACE -fsanitize=${VPE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(vpe_flags INTERFACE -fsanitize=${VPE_SANITIZE})
endif()

# vpe_module(NAME DEPS ... [LIBS ...]): library of all *.cpp in this folder.
# DEPS are other modules and appear in the public interface; LIBS are third-party targets.
function(vpe_module name)
  cmake_parse_arguments(ARG "" "" "DEPS;LIBS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_library(${name} STATIC ${sources})
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX)
  target_link_libraries(${name} PUBLIC vpe_flags ${ARG_DEPS} ${ARG_LIBS})
endfunction()

# vpe_test(NAME DEPS ...): GoogleTest program of all *.cpp in this folder. Its tests get the ctest label
# "default"; those whose suite name starts with Long get "long".
function(vpe_test name)
  cmake_parse_arguments(ARG "" "" "DEPS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  if(NOT sources)
    return()
  endif()
  add_executable(${name} ${sources})
  target_link_libraries(${name} PRIVATE test_support ${ARG_DEPS})
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 120 TEST_FILTER "-Long*" PROPERTIES LABELS default)
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 120 TEST_FILTER "Long*" TEST_SUFFIX .long
    TEST_LIST ${name}_LONG PROPERTIES LABELS long)
endfunction()
