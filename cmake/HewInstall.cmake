# Installation and the package files for find_package(hew). Rooms are exported under their own names,
# decomp::<room> and cam::<room>; headers go to include/hew.
include(CMakePackageConfigHelpers)

set(HEW_PACKAGE_DIR "${CMAKE_INSTALL_LIBDIR}/cmake/hew")
get_property(rooms GLOBAL PROPERTY HEW_ROOMS)
foreach(room IN LISTS rooms)
  string(REGEX MATCH "^(decomp|cam)_(.*)$" matched ${room})
  set_target_properties(${room} PROPERTIES EXPORT_NAME ${CMAKE_MATCH_2})
  install(TARGETS ${room} EXPORT ${CMAKE_MATCH_1}Targets
          ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
          FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/hew")
endforeach()
foreach(library decomp cam)
  install(EXPORT ${library}Targets NAMESPACE ${library}:: DESTINATION "${HEW_PACKAGE_DIR}")
endforeach()

configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/hewConfig.cmake.in" "${PROJECT_BINARY_DIR}/hewConfig.cmake"
                              INSTALL_DESTINATION "${HEW_PACKAGE_DIR}")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/hewConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/hewConfig.cmake" "${PROJECT_BINARY_DIR}/hewConfigVersion.cmake"
              "${CMAKE_CURRENT_LIST_DIR}/Findlib3mf.cmake"
        DESTINATION "${HEW_PACKAGE_DIR}")

install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY "${PROJECT_SOURCE_DIR}/machine_profiles" DESTINATION "${CMAKE_INSTALL_DATADIR}/hew"
        FILES_MATCHING PATTERN "*.toml")
