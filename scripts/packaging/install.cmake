# Files that `cmake --install` puts in a prefix besides the command and the libraries, and the packages of `cpack -G DEB`.
include(CMakePackageConfigHelpers)
set(documents ${CMAKE_INSTALL_DATAROOTDIR}/doc/insonify)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Insonify)
install(EXPORT InsonifyTargets NAMESPACE Insonify:: DESTINATION ${package_folder} COMPONENT development)
get_property(installed GLOBAL PROPERTY insonify_installed)
configure_package_config_file(scripts/packaging/InsonifyConfig.cmake.in ${PROJECT_BINARY_DIR}/InsonifyConfig.cmake
  INSTALL_DESTINATION ${package_folder} PATH_VARS CMAKE_INSTALL_LIBDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/InsonifyConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/InsonifyConfig.cmake ${PROJECT_BINARY_DIR}/InsonifyConfigVersion.cmake
  DESTINATION ${package_folder} COMPONENT development)

# The manual page is generated from the help of the command and component libraries.
get_property(components GLOBAL PROPERTY insonify_components)
add_custom_command(
  OUTPUT ${PROJECT_BINARY_DIR}/insonify.1
  COMMAND insonify man > ${PROJECT_BINARY_DIR}/insonify.1
  DEPENDS insonify ${components}
  VERBATIM)
add_custom_target(insonify_man ALL DEPENDS ${PROJECT_BINARY_DIR}/insonify.1)
install(FILES ${PROJECT_BINARY_DIR}/insonify.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT runtime OPTIONAL)

# What built.cmake looks for.
get_property(packages GLOBAL PROPERTY insonify_packages)
set(files "runtime $<TARGET_FILE:insonify>\nruntime $<TARGET_FILE:insonify_core>\nruntime ${PROJECT_BINARY_DIR}/insonify.1\n")
foreach(target IN LISTS installed)
  string(APPEND files "development $<TARGET_FILE:${target}>\n")
endforeach()
foreach(package IN LISTS packages)
  string(APPEND files "${package} $<TARGET_FILE:insonify_component_${package}>\n")
endforeach()
file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/installed-$<CONFIG> CONTENT "${files}")

# The command has the shaders in it; installed headers include some.
file(GLOB shaders CONFIGURE_DEPENDS shaders/*.glsl)
install(FILES ${shaders} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/insonify/shaders COMPONENT development)
install(DIRECTORY deploy DESTINATION ${CMAKE_INSTALL_DATADIR}/insonify COMPONENT runtime PATTERN pictures EXCLUDE)
install(FILES README.md CHANGELOG.md DESTINATION ${documents} COMPONENT runtime)
# The folder that systemd searches, below /usr or /usr/local; independent of the name of the libraries' folder.
install(FILES deploy/insonify.service DESTINATION lib/systemd/system COMPONENT runtime)
file(GLOB pages RELATIVE ${PROJECT_SOURCE_DIR} CONFIGURE_DEPENDS components/*.md components/*/*.md types/*.md)
foreach(page ${pages})
  get_filename_component(folder ${page} DIRECTORY)
  install(FILES ${page} DESTINATION ${documents}/${folder} COMPONENT runtime)
  install(FILES ${page} DESTINATION insonify/share/doc/insonify/${folder} COMPONENT python EXCLUDE_FROM_ALL)  # of a wheel
endforeach()

# The copyright of each package: the licence, and those of the libraries that are compiled in, which the system's packages have.
install(FILES LICENSE DESTINATION ${documents} RENAME copyright COMPONENT runtime)
find_program(INSONIFY_DPKG_QUERY dpkg-query)
find_program(INSONIFY_PYTHON3 python3)
if(INSONIFY_DPKG_QUERY AND INSONIFY_PYTHON3)
  file(GLOB lists CONFIGURE_DEPENDS types/packages components/*/packages)
  add_custom_command(
    OUTPUT ${PROJECT_BINARY_DIR}/copyright
    COMMAND ${INSONIFY_PYTHON3} scripts/packaging/sbom.py ${PROJECT_BINARY_DIR}/copyright
    DEPENDS LICENSE scripts/packaging/sbom.py ${lists}
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
    VERBATIM)
  add_custom_target(insonify_copyright ALL DEPENDS ${PROJECT_BINARY_DIR}/copyright)
  install(FILES ${PROJECT_BINARY_DIR}/copyright DESTINATION ${documents} COMPONENT runtime OPTIONAL)
  set(copyright insonify_copyright)
endif()

# insonify, the command with its examples; insonify-NAME for each component library; python3-insonify; and insonify-dev.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME insonify)
set(CPACK_PACKAGE_CONTACT "The Insonify developers")
get_property(packages GLOBAL PROPERTY insonify_packages)
set(CPACK_COMPONENTS_ALL runtime development ${packages})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME insonify)
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "Imaging sonar from a 3-D scene, in real time
 The insonify command and deployments as examples.")
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS "libegl1, libegl-mesa0, libgl1-mesa-dri")  # opened while running
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/lib)  # libinsonify.so is in another package
foreach(package ${packages})
  string(TOUPPER ${package} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME insonify-${package})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "Imaging sonar from a 3-D scene: component library ${package}")
  set(CPACK_DEBIAN_${upper}_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "insonify (= ${PROJECT_VERSION})")
endforeach()
set(CPACK_DEBIAN_SDF_PACKAGE_RECOMMENDS insonify-meshes)
set(CPACK_DEBIAN_GAZEBO_PACKAGE_RECOMMENDS insonify-meshes)
set(CPACK_DEBIAN_WORLDS_PACKAGE_RECOMMENDS "python3-numpy, python3-venv, python3-yaml")
if(TARGET insonify_python)
  set(python insonify_python)
  list(APPEND CPACK_COMPONENTS_ALL python3)
  set(CPACK_DEBIAN_PYTHON3_PACKAGE_NAME python3-insonify)
  set(CPACK_DEBIAN_PYTHON3_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON3_DESCRIPTION "Imaging sonar from a 3-D scene: the Python module")
  set(CPACK_DEBIAN_PYTHON3_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON3_PACKAGE_DEPENDS "insonify (= ${PROJECT_VERSION}), python3 (>= 3.9), python3-numpy")
  set(CPACK_DEBIAN_PYTHON3_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_LIST_DIR}/prerm)
endif()
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME insonify-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "Headers and libraries of Insonify, to write components with
 find_package(Insonify) gives the framework and the library of each component.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "insonify (= ${PROJECT_VERSION}), libfmt-dev, libglm-dev, libyaml-cpp-dev, pkg-config")
if(GEOGRAPHICLIB_FOUND)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", libgeographiclib-dev")  # of Insonify::types
endif()
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS
  "cyclonedds-dev, libembree-dev, libepoxy-dev, libgdal-dev, liblz4-dev, libmeshoptimizer-dev, libopencv-dev, libpng-dev, libprotobuf-dev, libsdformat-dev, libsnappy-dev, libsqlite3-dev, libstb-dev, libtinygltf-dev, libtinyxml2-dev, libzmq3-dev, libzstd-dev, zlib1g-dev")
# Each has the documents of insonify, on which it depends, by a link of their folder.
foreach(component IN LISTS CPACK_COMPONENTS_ALL)
  string(TOUPPER ${component} upper)
  if(NOT component STREQUAL "runtime")
    install(CODE "set(documents \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATAROOTDIR}/doc\")
      file(MAKE_DIRECTORY \"\${documents}\")
      file(CREATE_LINK insonify \"\${documents}/${CPACK_DEBIAN_${upper}_PACKAGE_NAME}\" SYMBOLIC)"
      COMPONENT ${component} EXCLUDE_FROM_ALL)
  endif()
endforeach()
# Contents of the packages.
add_custom_target(insonify_packages DEPENDS insonify insonify_man ${copyright} ${python} ${installed} ${components})
include(CPack)
