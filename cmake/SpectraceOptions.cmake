# SPDX-License-Identifier: Apache-2.0
# Language level, warnings and the switches of the whole build.
option(SPECTRACE_BUILD_TESTS "Build the test programs" ON)
option(SPECTRACE_BUILD_BENCH "Build the micro-benchmarks too (docs/validation.md)" OFF)
option(SPECTRACE_BUILD_FUZZ "Build the fuzz targets; needs clang (docs/validation.md)" OFF)
option(SPECTRACE_WERROR "Treat warnings as errors" OFF)
option(SPECTRACE_DOUBLE "Build the light path in double precision (validation only)" OFF)
set(SPECTRACE_SANITIZE "" CACHE STRING "Sanitizers, for example address,undefined or thread")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "" FORCE)
endif()

add_library(spectrace_flags INTERFACE)
target_compile_options(spectrace_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
# Neither changes a value: nobody reads errno or traps floating-point exceptions, and loops over lanes become vector code
# only so.
target_compile_options(spectrace_flags INTERFACE -fno-math-errno -fno-trapping-math)
# Identical images on every build of one source: no fused multiply-add behind our back.
target_compile_options(spectrace_flags INTERFACE -ffp-contract=off)
target_include_directories(spectrace_flags INTERFACE "${PROJECT_SOURCE_DIR}")
if(SPECTRACE_WERROR)
  target_compile_options(spectrace_flags INTERFACE -Werror)
endif()
if(SPECTRACE_DOUBLE)
  target_compile_definitions(spectrace_flags INTERFACE SPECTRACE_DOUBLE=1)
endif()
if(SPECTRACE_SANITIZE)
  target_compile_options(spectrace_flags INTERFACE -fsanitize=${SPECTRACE_SANITIZE} -fno-omit-frame-pointer -g)
  target_link_options(spectrace_flags INTERFACE -fsanitize=${SPECTRACE_SANITIZE})
  # Instrumented, a moved std::variant or std::optional looks uninitialised to GCC 12 ("may produce false positives", its
  # manual says).
  target_compile_options(spectrace_flags INTERFACE "$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>")
endif()
