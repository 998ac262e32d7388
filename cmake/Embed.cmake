# skitter_embed(<target> <name> <file>): puts a file's bytes into the target as
# `std::span<const uint8_t> skitter::embedded::<name>()`, declared in "embedded/<name>.h".
function(skitter_embed target name file)
  get_filename_component(file ${file} ABSOLUTE)
  set(dir ${CMAKE_CURRENT_BINARY_DIR}/embedded)
  file(CONFIGURE OUTPUT ${dir}/${name}.S @ONLY CONTENT
".section .rodata
.balign 16
.global skitter_embedded_@name@_begin
.global skitter_embedded_@name@_end
.hidden skitter_embedded_@name@_begin
.hidden skitter_embedded_@name@_end
skitter_embedded_@name@_begin:
.incbin \"@file@\"
skitter_embedded_@name@_end:
.byte 0
.section .note.GNU-stack,\"\",%progbits
")
  file(CONFIGURE OUTPUT ${dir}/${name}.h @ONLY CONTENT
"#pragma once
#include <cstdint>
#include <span>
extern \"C\" const uint8_t skitter_embedded_@name@_begin[], skitter_embedded_@name@_end[];
namespace skitter::embedded {
inline std::span<const uint8_t> @name@() {
  return {skitter_embedded_@name@_begin, skitter_embedded_@name@_end};
}
}  // namespace skitter::embedded
")
  set_source_files_properties(${dir}/${name}.S PROPERTIES OBJECT_DEPENDS ${file})
  target_sources(${target} PRIVATE ${dir}/${name}.S)
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_BINARY_DIR})
endfunction()
