# What `cmake --install` installs, by component: program (the command), library (libskitter.so, for programs that run with
# it) and development (headers, the static library, the CMake package and skitter.pc).
include(CMakePackageConfigHelpers)

# It holds for the scripts of the folders that are added later, too.
if(SKITTER_STRIP)
  install(CODE "set(CMAKE_INSTALL_DO_STRIP TRUE)" ALL_COMPONENTS)
endif()

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Skitter)
foreach(kind shared static)
  if(TARGET skitter_${kind})
    install(TARGETS skitter_${kind} EXPORT skitter_${kind}
      LIBRARY COMPONENT library NAMELINK_COMPONENT development
      ARCHIVE COMPONENT development)
    install(EXPORT skitter_${kind} NAMESPACE Skitter:: FILE Skitter-${kind}.cmake DESTINATION ${package}
      COMPONENT development)
  endif()
endforeach()
install(DIRECTORY include/skitter ${PROJECT_BINARY_DIR}/include/skitter DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  COMPONENT development FILES_MATCHING PATTERN *.h)

get_property(components GLOBAL PROPERTY SKITTER_COMPONENTS)
list(JOIN components ", " SKITTER_COMPONENTS)
configure_package_config_file(cmake/SkitterConfig.cmake.in ${PROJECT_BINARY_DIR}/SkitterConfig.cmake
  INSTALL_DESTINATION ${package} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may differ in its functions.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/SkitterConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/SkitterConfig.cmake ${PROJECT_BINARY_DIR}/SkitterConfigVersion.cmake
  DESTINATION ${package} COMPONENT development)

set(pkgconfig ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
file(RELATIVE_PATH SKITTER_PREFIX ${CMAKE_INSTALL_PREFIX}/${pkgconfig} ${CMAKE_INSTALL_PREFIX})
# What a static library needs beside itself, which pkg-config tells with --static; or at all times, where there is no other.
set(private .private)
if(NOT SKITTER_SHARED)
  set(private "")
endif()
string(REGEX REPLACE "/$" "" SKITTER_PREFIX ${SKITTER_PREFIX})
configure_file(cmake/skitter.pc.in ${PROJECT_BINARY_DIR}/skitter.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/skitter.pc DESTINATION ${pkgconfig} COMPONENT development)
