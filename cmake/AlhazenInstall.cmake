# `cmake --install`: the command line, the library with its headers, and the package for find_package(alhazen) and
# alhazen::tracer (docs/guide/library.md).
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

# Rooms that alhazen_tracer consists of, lowest first.
set(alhazen_installed base math sampling simd parallel geometry imaging shading cameras shapes accel scene_model primitives
    csg aggregates scene solids tracer)

foreach(folder ${alhazen_installed})
    set_target_properties(alhazen_${folder} PROPERTIES EXPORT_NAME ${folder})
    install(TARGETS alhazen_${folder} EXPORT alhazenTargets
            ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}"
            INCLUDES DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
    install(DIRECTORY "${PROJECT_SOURCE_DIR}/src/alhazen/${folder}"
            DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/alhazen"
            FILES_MATCHING PATTERN "*.h")
endforeach()

set_target_properties(alhazen_exr PROPERTIES EXPORT_NAME exr)
install(TARGETS alhazen_exr EXPORT alhazenTargets ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")

# Inline functions of the headers must compute the same in other programs: the linker keeps one copy of each, whoever
# compiled it.
target_compile_options(alhazen_base INTERFACE $<INSTALL_INTERFACE:-ffp-contract=off>)
target_compile_features(alhazen_base INTERFACE $<INSTALL_INTERFACE:cxx_std_20>)

set(alhazen_package "${CMAKE_INSTALL_LIBDIR}/cmake/alhazen")
install(EXPORT alhazenTargets NAMESPACE alhazen:: DESTINATION "${alhazen_package}")
configure_package_config_file("${CMAKE_CURRENT_LIST_DIR}/alhazenConfig.cmake.in"
    "${PROJECT_BINARY_DIR}/alhazenConfig.cmake" INSTALL_DESTINATION "${alhazen_package}")
# Before 1.0 every minor version may change the interface.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/alhazenConfigVersion.cmake"
    COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/alhazenConfig.cmake"
              "${PROJECT_BINARY_DIR}/alhazenConfigVersion.cmake"
        DESTINATION "${alhazen_package}")
