# find_package(halfshade) gives the targets halfshade::halfshade (shared) and halfshade::static.
# halfshade_vulkan.h needs Vulkan's headers too: find_package(Vulkan), Vulkan::Headers.
if(TARGET halfshade::halfshade)
  return()
endif()

# <prefix>/share/halfshade/cmake/halfshade-config.cmake
get_filename_component(_halfshade_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
find_path(halfshade_INCLUDE_DIR halfshade.h HINTS "${_halfshade_prefix}/include" NO_DEFAULT_PATH)
find_library(halfshade_LIBRARY NAMES libhalfshade.so halfshade HINTS "${_halfshade_prefix}" PATH_SUFFIXES lib lib64
             "lib/${CMAKE_LIBRARY_ARCHITECTURE}" NO_DEFAULT_PATH)
find_library(halfshade_STATIC_LIBRARY NAMES libhalfshade.a HINTS "${_halfshade_prefix}" PATH_SUFFIXES lib lib64
             "lib/${CMAKE_LIBRARY_ARCHITECTURE}" NO_DEFAULT_PATH)
if(NOT halfshade_INCLUDE_DIR OR NOT halfshade_LIBRARY)
  set(halfshade_FOUND FALSE)
  set(halfshade_NOT_FOUND_MESSAGE "halfshade.h or libhalfshade is not below ${_halfshade_prefix}")
  return()
endif()

add_library(halfshade::halfshade SHARED IMPORTED)
set_target_properties(halfshade::halfshade PROPERTIES
  IMPORTED_LOCATION "${halfshade_LIBRARY}"
  INTERFACE_INCLUDE_DIRECTORIES "${halfshade_INCLUDE_DIR}")
if(halfshade_STATIC_LIBRARY)
  add_library(halfshade::static STATIC IMPORTED)
  set_target_properties(halfshade::static PROPERTIES
    IMPORTED_LOCATION "${halfshade_STATIC_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${halfshade_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES "stdc++;gcc_s;util;rt;pthread;m;dl;c")
endif()
