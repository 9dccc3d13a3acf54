# SPDX-License-Identifier: Apache-2.0
# spectrace_layer(<name> DEPENDS <layers...> PRIVATE <imported targets...> PUBLIC <imported targets...>)
# One static library a layer, from every source below its folder.
function(spectrace_layer name)
  cmake_parse_arguments(ARG "" "" "DEPENDS;PRIVATE;PUBLIC" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
  list(FILTER sources EXCLUDE REGEX "/tools/")
  add_library(spectrace_${name} STATIC ${sources})
  target_link_libraries(spectrace_${name} PUBLIC spectrace_flags)
  foreach(layer IN LISTS ARG_DEPENDS)
    target_link_libraries(spectrace_${name} PUBLIC spectrace_${layer})
  endforeach()
  target_link_libraries(spectrace_${name} PRIVATE ${ARG_PRIVATE} PUBLIC ${ARG_PUBLIC})
endfunction()
