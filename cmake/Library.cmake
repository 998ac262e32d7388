# libskitter, shared and static, of all archives that are named in the global property SKITTER_ARCHIVES, and the targets
# Skitter::skitter and, one for each of SKITTER_COMPONENTS, Skitter::crowd and so on. Users get the public headers, Vulkan
# and GLM from them and nothing else: no definition, no warning option, no symbol outside skitter.
skitter_require(Vulkan 1.3)
skitter_require(glm)
skitter_require(fmt)
skitter_require(PNG)
skitter_require(JPEG)
skitter_require(meshoptimizer)

# What is seen: names of Skitter that are marked SKITTER_API. The compiler hides all others but for instances of the
# standard library's templates and the variables inside inline functions.
set(shown _ZN7skitter* _ZNK7skitter* _ZTIN7skitter* _ZTSN7skitter* _ZTVN7skitter* skitter_*)

get_property(targets GLOBAL PROPERTY SKITTER_ARCHIVES)
list(TRANSFORM targets REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE archives)
set(libraries)
if(SKITTER_SHARED)
  set(symbols ${PROJECT_BINARY_DIR}/symbols.map)
  list(JOIN shown "; " names)
  file(CONFIGURE OUTPUT ${symbols} CONTENT "{ global: @names@; local: *; };\n" @ONLY)
  add_library(skitter_shared SHARED engine/version.cpp)
  target_link_libraries(skitter_shared PRIVATE -Wl,--push-state,--whole-archive ${archives} -Wl,--pop-state)
  target_link_options(skitter_shared PRIVATE -Wl,--version-script=${symbols} -Wl,--no-undefined)
  set_target_properties(skitter_shared PROPERTIES LINK_DEPENDS "${archives};${symbols}"
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR} DEFINE_SYMBOL "")
  list(APPEND libraries skitter_shared)
endif()
if(SKITTER_STATIC)
  # In an archive, hidden symbols of its objects meet the host's, whose Vulkan-Hpp or tinygltf may be another. So all
  # objects are linked into one, in which they become local.
  # Unique symbols, such as the tables that std makes of variants of more than eleven types, become local only if they are
  # weak before.
  set(object ${PROJECT_BINARY_DIR}/skitter.o)
  list(TRANSFORM shown PREPEND --keep-global-symbol= OUTPUT_VARIABLE kept)
  add_custom_command(OUTPUT ${object} DEPENDS ${targets} ${archives} COMMENT "Linking skitter.o" VERBATIM COMMAND_EXPAND_LISTS
    COMMAND ${CMAKE_LINKER} -r --force-group-allocation --whole-archive ${archives} -o ${object}
    COMMAND ${CMAKE_OBJCOPY} --wildcard --weaken-symbol=_ZNSt* ${object}
    COMMAND ${CMAKE_OBJCOPY} --localize-hidden --wildcard ${kept} $<$<BOOL:${SKITTER_STRIP}>:--strip-debug> ${object})
  add_library(skitter_static STATIC engine/version.cpp ${object})
  list(APPEND libraries skitter_static)
endif()
foreach(library IN LISTS libraries)
  add_dependencies(${library} ${targets})
  set_target_properties(${library} PROPERTIES OUTPUT_NAME skitter EXPORT_NAME skitter)
  target_include_directories(${library} PUBLIC
    "$<BUILD_INTERFACE:$<TARGET_PROPERTY:skitter_headers,INTERFACE_INCLUDE_DIRECTORIES>>"
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/bindings/c>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${library} PUBLIC cxx_std_20)
  target_link_libraries(${library} PUBLIC Vulkan::Vulkan glm::glm PRIVATE fmt::fmt PNG::PNG JPEG::JPEG meshoptimizer::meshoptimizer)
endforeach()
list(GET libraries 0 library)
add_library(Skitter::skitter ALIAS ${library})
# A component is a name for what a program uses of the library.
get_property(components GLOBAL PROPERTY SKITTER_COMPONENTS)
foreach(component IN LISTS components)
  add_library(skitter_component_${component} INTERFACE)
  target_link_libraries(skitter_component_${component} INTERFACE ${library})
  add_library(Skitter::${component} ALIAS skitter_component_${component})
endforeach()
