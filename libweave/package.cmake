# What programs outside of this tree build with: find_package(weave) and weave::weave, which are libweave.so and the headers of what is in it.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/weave)

install(TARGETS weave weave_core_needs EXPORT weave_targets
  LIBRARY COMPONENT library NAMELINK_COMPONENT development
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT weave_targets FILE weaveTargets.cmake NAMESPACE weave:: DESTINATION ${package_folder} COMPONENT development)

foreach(topic core block design loom samples curve sim ranks io picture diff)
  install(DIRECTORY weave/${topic} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/weave COMPONENT development FILES_MATCHING PATTERN "*.hpp"
    PATTERN device EXCLUDE PATTERN mpi EXCLUDE)
endforeach()
# Of what runs on devices the rest sees these alone (tests/checks/layers).
install(FILES weave/sim/device/devices.hpp weave/sim/device/relax_device.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/weave/sim/device COMPONENT development)

write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/weaveConfigVersion.cmake COMPATIBILITY SameMinorVersion) # until 1.0.0
file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/weaveConfig.cmake @ONLY CONTENT [[
include(CMakeFindDependencyMacro)
find_dependency(nlohmann_json 3.11)
find_dependency(Eigen3 3.4)
find_dependency(Threads)
include(${CMAKE_CURRENT_LIST_DIR}/weaveTargets.cmake)
]])
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/weaveConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/weaveConfigVersion.cmake DESTINATION ${package_folder} COMPONENT development)
