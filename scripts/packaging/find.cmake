# How folders find what they need. -DCMAKE_DISABLE_FIND_PACKAGE_<NAME>=ON hides a package from all of these, as from CMake's own find_package.

# Forgets places that no longer exist, so that a package that was removed counts as absent.
if(PROJECT_IS_TOP_LEVEL)
  get_cmake_property(names CACHE_VARIABLES)
  list(FILTER names EXCLUDE REGEX "^CMAKE_")
  foreach(name IN LISTS names)
    get_property(type CACHE ${name} PROPERTY TYPE)
    if(type MATCHES "^(FILE)?PATH$" AND IS_ABSOLUTE "${${name}}" AND NOT EXISTS "${${name}}")
      unset(${name} CACHE)
    endif()
  endforeach()
endif()

# insonify_missing(missing Snappy Snappy_FOUND "the folder device" insonify_device) sets `missing` to the names, joined by
# commas, of which the variable is false and the target is absent.
function(insonify_missing result)
  set(missing "")
  while(ARGN)
    list(POP_FRONT ARGN name condition)
    if(NOT TARGET ${condition} AND NOT ${condition})
      list(APPEND missing ${name})
    endif()
  endwhile()
  list(JOIN missing ", no " missing)
  set(${result} "${missing}" PARENT_SCOPE)
endfunction()

# insonify_needs(dds "dds::PublisherTask is not built" CycloneDDS CycloneDDS_FOUND) leaves a component's CMakeLists.txt, with a
# message that names what is missing. Building the component library prints the same message.
macro(insonify_needs component consequence)
  insonify_missing(missing ${ARGN})
  if(missing)
    message(STATUS "No ${missing}: ${consequence}")
    add_custom_target(insonify_component_${component}
      COMMAND ${CMAKE_COMMAND} -E echo "${component} cannot be built on this system and is omitted. No ${missing}: ${consequence}"
      VERBATIM)
    return()
  endif()
endmacro()

# insonify_pkg_config(LZ4 liblz4 REQUIRED) makes PkgConfig::LZ4 and LZ4_FOUND.
find_package(PkgConfig REQUIRED)
macro(insonify_pkg_config prefix module)
  unset(${prefix}_FOUND CACHE)  # pkg_check_modules would not look again
  if(NOT CMAKE_DISABLE_FIND_PACKAGE_${module})
    pkg_check_modules(${prefix} QUIET ${ARGN} IMPORTED_TARGET ${module})
  endif()
endmacro()

# Headers of Boost: the viewer and stand-ins for instruments use Asio and Beast.
if(NOT CMAKE_DISABLE_FIND_PACKAGE_Boost)
  find_path(INSONIFY_BOOST boost/beast.hpp NO_CACHE)
  string(REGEX REPLACE "/$" "" INSONIFY_BOOST "${INSONIFY_BOOST}")
endif()

# OpenCV's headers, and its modules in the same prefix; Debian's packages of single modules have no CMake file.
find_path(INSONIFY_OPENCV opencv2/imgproc.hpp PATH_SUFFIXES opencv4 REQUIRED NO_CACHE)
string(REGEX REPLACE "/$" "" INSONIFY_OPENCV "${INSONIFY_OPENCV}")
string(REGEX REPLACE "/include(/opencv4)?$" "" opencv_prefix "${INSONIFY_OPENCV}")
foreach(module core imgproc imgcodecs videoio)
  string(TOUPPER INSONIFY_OPENCV_${module} library)
  if(NOT CMAKE_DISABLE_FIND_PACKAGE_OpenCV_${module} AND EXISTS ${INSONIFY_OPENCV}/opencv2/${module}.hpp)
    find_library(${library} opencv_${module} PATHS ${opencv_prefix}
      PATH_SUFFIXES lib/${CMAKE_LIBRARY_ARCHITECTURE} lib64 lib NO_DEFAULT_PATH NO_CACHE)
  endif()
endforeach()
if(NOT INSONIFY_OPENCV_CORE OR NOT INSONIFY_OPENCV_IMGPROC)
  message(FATAL_ERROR "${INSONIFY_OPENCV} has headers of OpenCV, but ${opencv_prefix} has no libopencv_core and libopencv_imgproc; "
    "install them (libopencv-core-dev and libopencv-imgproc-dev on Debian), or name another prefix in CMAKE_PREFIX_PATH")
endif()

# insonify_oldest(Boost 1.74 ${version} ${folder}) ends the configuration if the version is older.
function(insonify_oldest name oldest version folder)
  if(version VERSION_LESS oldest)
    message(FATAL_ERROR "${name} in ${folder} is ${version}; Insonify needs ${oldest} or newer. Name a prefix with a newer one in "
      "CMAKE_PREFIX_PATH, or hide this one from PATH and CMAKE_PREFIX_PATH")
  endif()
endfunction()
file(STRINGS ${INSONIFY_OPENCV}/opencv2/core/version.hpp numbers REGEX "define CV_VERSION_(MAJOR|MINOR) ")
string(REGEX REPLACE "[^;0-9]" "" numbers "${numbers}")
list(JOIN numbers "." INSONIFY_OPENCV_VERSION)
insonify_oldest(OpenCV 4.5 ${INSONIFY_OPENCV_VERSION} ${INSONIFY_OPENCV})
if(INSONIFY_BOOST)
  file(STRINGS ${INSONIFY_BOOST}/boost/version.hpp number REGEX "define BOOST_VERSION ")
  string(REGEX REPLACE "[^0-9]" "" number "${number}")
  math(EXPR major "${number} / 100000")
  math(EXPR minor "${number} / 100 % 1000")
  set(INSONIFY_BOOST_VERSION ${major}.${minor})
  insonify_oldest(Boost 1.74 ${INSONIFY_BOOST_VERSION} ${INSONIFY_BOOST})
endif()

# The oldest versions that Insonify is built with; folders find the same ones again.
find_package(CLI11 2.1 REQUIRED)
find_package(fmt 8 REQUIRED)
find_package(glm 0.9.9 REQUIRED)
find_package(meshoptimizer REQUIRED)
find_package(nlohmann_json 3.10 REQUIRED)
find_package(TinyGLTF REQUIRED)
find_package(yaml-cpp 0.7 REQUIRED)

# Prints where the libraries are from: several prefixes are usually a mistake.
function(insonify_print_prefixes)
  set(all OpenCV ${INSONIFY_OPENCV_VERSION} ${INSONIFY_OPENCV})
  if(INSONIFY_BOOST)
    list(APPEND all Boost ${INSONIFY_BOOST_VERSION} ${INSONIFY_BOOST})
  endif()
  foreach(name CLI11 fmt glm meshoptimizer nlohmann_json TinyGLTF yaml-cpp embree)
    if(${name}_DIR)
      list(APPEND all ${name} "${${name}_VERSION}" ${${name}_DIR})
    endif()
  endforeach()
  while(all)
    list(POP_FRONT all name version folder)
    string(REGEX REPLACE "/(lib|lib64|share|include)(/.*)?$" "" prefix ${folder})
    list(APPEND prefixes ${prefix})
    list(APPEND "in ${prefix}" "${name} ${version}")
  endwhile()
  list(REMOVE_DUPLICATES prefixes)
  foreach(prefix IN LISTS prefixes)
    list(JOIN "in ${prefix}" ", " libraries)
    message(STATUS "From ${prefix}: ${libraries}")
  endforeach()
endfunction()

# Sets `result` to the targets of a folder and of the folders below.
function(insonify_list_targets result folder)
  get_property(all DIRECTORY ${folder} PROPERTY BUILDSYSTEM_TARGETS)
  get_property(below DIRECTORY ${folder} PROPERTY SUBDIRECTORIES)
  foreach(each IN LISTS below)
    insonify_list_targets(more ${each})
    list(APPEND all ${more})
  endforeach()
  set(${result} ${all} PARENT_SCOPE)
endfunction()
