# What `cmake --install` lays down, by component: `runtime` (shared library), `development` (headers, static libraries,
# CMake package, pkg-config file), `python` (bindings), `node` (src/node/programs), `mpi` (src/mpi).
# `cmake --install BUILD --component NAME` takes one.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/garrison)

install(TARGETS garrison garrison_node garrison_headers EXPORT garrison
        LIBRARY COMPONENT runtime NAMELINK_COMPONENT development
        ARCHIVE COMPONENT development)
install(DIRECTORY include/garrison DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
        FILES_MATCHING PATTERN "*.hpp")

install(EXPORT garrison NAMESPACE garrison:: FILE garrisonTargets.cmake DESTINATION ${package_dir} COMPONENT development)
configure_package_config_file(cmake/garrisonConfig.cmake.in garrisonConfig.cmake INSTALL_DESTINATION ${package_dir})
# Before 1.0 a minor release may break its users.
write_basic_package_version_file(garrisonConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/garrisonConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/garrisonConfigVersion.cmake
        DESTINATION ${package_dir} COMPONENT development)

# The path from the .pc file to the prefix, so that the installed tree can be moved.
file(RELATIVE_PATH GARRISON_PC_TO_PREFIX
     ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
if(GARRISON_FEW_DIMENSIONS)
  set(GARRISON_PC_DEFINITIONS " -DGARRISON_FEW_DIMENSIONS")
endif()
configure_file(cmake/garrison.pc.in garrison.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/garrison.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig
        COMPONENT development)
