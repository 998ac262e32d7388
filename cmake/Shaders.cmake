# skitter_add_shaders(<target> SOURCES <file>... [LOAD_VARIANTS] [UNOPTIMISED]): compiles GLSL to optimised, validated SPIR-V and
# embeds it in the target (skitter_embed), `ik.comp` as `ik_comp`. With LOAD_VARIANTS each file is built twice, with
# LOAD4_TEXEL=1 as `ik_comp_texel` and with LOAD4_TEXEL=0 as `ik_comp_storage` (shaders/lib/load4.glsl).
# Includes are found from shaders/ and beside the file. DEFINES <name[=value]>... are passed on. UNOPTIMISED ones are
# made in a third of the time and take drivers longer.
skitter_require_program(SKITTER_GLSLANG glslang-tools glslangValidator glslang)
skitter_require_program(SKITTER_SPIRV_OPT spirv-tools spirv-opt)
skitter_require_program(SKITTER_SPIRV_VAL spirv-tools spirv-val)

function(skitter_add_shaders target)
  cmake_parse_arguments(PARSE_ARGV 1 arg "LOAD_VARIANTS;UNOPTIMISED" "" "SOURCES;DEFINES")
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_SOURCES)
    message(FATAL_ERROR "skitter_add_shaders(${target}): expected SOURCES <file>..., got ${ARGN}")
  endif()
  set(how ${arg_DEFINES})
  if(arg_UNOPTIMISED)
    list(PREPEND how UNOPTIMISED)
  endif()
  foreach(source IN LISTS arg_SOURCES)
    get_filename_component(source ${source} ABSOLUTE)
    get_filename_component(file ${source} NAME)
    string(MAKE_C_IDENTIFIER ${file} name)
    if(arg_LOAD_VARIANTS)
      skitter_add_shader(${target} ${source} ${name}_texel ${how} LOAD4_TEXEL=1)
      skitter_add_shader(${target} ${source} ${name}_storage ${how} LOAD4_TEXEL=0)
    else()
      skitter_add_shader(${target} ${source} ${name} ${how})
    endif()
  endforeach()
endfunction()

# skitter_add_shader(<target> <file> <name> [UNOPTIMISED] [<define>...])
function(skitter_add_shader target source name)
  cmake_parse_arguments(PARSE_ARGV 3 arg "UNOPTIMISED" "" "")
  set(dir ${CMAKE_CURRENT_BINARY_DIR}/spirv)
  file(MAKE_DIRECTORY ${dir})
  set(shaders ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/../shaders)
  list(TRANSFORM arg_UNPARSED_ARGUMENTS PREPEND -D OUTPUT_VARIABLE defines)
  # --quiet would also silence warnings, so the file name that glslang prints is what a clean compile says.
  add_custom_command(OUTPUT ${dir}/${name}.raw.spv
    COMMAND ${SKITTER_GLSLANG} -V --target-env vulkan1.3 -I${shaders} -I${shaders}/../include ${defines}
            --depfile ${dir}/${name}.d -o ${dir}/${name}.raw.spv ${source}
    DEPENDS ${source} DEPFILE ${dir}/${name}.d COMMENT "GLSL ${name}" VERBATIM)
  set(optimise ${SKITTER_SPIRV_OPT} --target-env=vulkan1.3 -O)
  if(arg_UNOPTIMISED)
    set(optimise ${SKITTER_SPIRV_OPT} --target-env=vulkan1.3)
  endif()
  add_custom_command(OUTPUT ${dir}/${name}.spv
    COMMAND ${optimise} ${dir}/${name}.raw.spv -o ${dir}/${name}.spv
    COMMAND ${SKITTER_SPIRV_VAL} --target-env vulkan1.3 ${dir}/${name}.spv
    DEPENDS ${dir}/${name}.raw.spv COMMENT "SPIR-V ${name}" VERBATIM)
  target_sources(${target} PRIVATE ${dir}/${name}.spv)
  skitter_embed(${target} ${name} ${dir}/${name}.spv)
endfunction()
