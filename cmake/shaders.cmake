# airlight_shaders(TARGET ENTRY...): compiles GLSL entry points under shaders/ to SPIR-V and embeds them. An entry that is
# not there is looked for beside the CMakeLists.txt that names it.
#
# `epipolar/or_scan.comp` becomes the header "spirv/epipolar/or_scan_comp.h" with the words
# `k_or_scan_comp`. A shader error fails the build; an edited include rebuilds what includes it.
# The words are the same object wherever the header is included, so that a program can know them by their address.
find_program(GLSLANG_VALIDATOR glslangValidator REQUIRED)
set(AIRLIGHT_GLSLANG_OPTIONS -G --target-env opengl --quiet)

function(airlight_shaders target)
  set(outputs)
  foreach(entry ${ARGN})
    string(REPLACE "." "_" stem ${entry})
    get_filename_component(name ${stem} NAME)
    set(output ${CMAKE_BINARY_DIR}/embedded/${target}/spirv/${stem}.h)
    set(source ${CMAKE_SOURCE_DIR}/shaders/${entry})
    if(EXISTS ${source})
      set_property(GLOBAL APPEND PROPERTY AIRLIGHT_EMBEDDED_ENTRIES ${entry})
    else()
      set(source ${CMAKE_CURRENT_SOURCE_DIR}/${entry})
    endif()
    get_filename_component(folder ${output} DIRECTORY)
    file(MAKE_DIRECTORY ${folder})
    add_custom_command(
      OUTPUT ${output}
      COMMAND ${GLSLANG_VALIDATOR} ${AIRLIGHT_GLSLANG_OPTIONS} -I${CMAKE_SOURCE_DIR}/shaders
              --depfile ${output}.d --vn k_${name} -o ${output} ${source}
      COMMAND sed -i "s/^const uint32_t/inline constexpr uint32_t/" ${output}
      DEPENDS ${source}
      DEPFILE ${output}.d
      VERBATIM)
    list(APPEND outputs ${output})
  endforeach()
  target_sources(${target} PRIVATE ${outputs})
  target_include_directories(${target} PRIVATE ${CMAKE_BINARY_DIR}/embedded/${target})
  set_property(GLOBAL APPEND PROPERTY AIRLIGHT_EMBEDDING_TARGETS ${target})
endfunction()

# airlight_every_shader(TARGET): embeds all entry points of shaders/, and makes the header "every_shader.h" with the table
# `k_every_shader` of their names and words.
function(airlight_every_shader target)
  file(GLOB_RECURSE entries CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}/shaders
       ${CMAKE_SOURCE_DIR}/shaders/*.comp ${CMAKE_SOURCE_DIR}/shaders/*.vert ${CMAKE_SOURCE_DIR}/shaders/*.tesc
       ${CMAKE_SOURCE_DIR}/shaders/*.tese ${CMAKE_SOURCE_DIR}/shaders/*.geom ${CMAKE_SOURCE_DIR}/shaders/*.frag)
  airlight_shaders(${target} ${entries})
  airlight_shader_table(${target} ${entries})
endfunction()

# airlight_embedded_shaders(TARGET): makes the same header for the entry points of shaders/ that TARGET and what it links,
# named before it, have embedded.
function(airlight_embedded_shaders target)
  get_property(entries GLOBAL PROPERTY AIRLIGHT_EMBEDDED_ENTRIES)
  get_property(embedding GLOBAL PROPERTY AIRLIGHT_EMBEDDING_TARGETS)
  foreach(other ${embedding})
    target_include_directories(${target} PRIVATE ${CMAKE_BINARY_DIR}/embedded/${other})
  endforeach()
  airlight_shader_table(${target} ${entries})
endfunction()

function(airlight_shader_table target)
  set(includes "")
  set(rows "")
  foreach(entry ${ARGN})
    string(REPLACE "." "_" stem ${entry})
    get_filename_component(name ${stem} NAME)
    string(APPEND includes "#include \"spirv/${stem}.h\"\n")
    string(APPEND rows "    {\"${entry}\", k_${name}},\n")
  endforeach()
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/embedded/${target}/every_shader.h @ONLY CONTENT
"#pragma once

#include <cstdint>
#include <span>

@includes@
struct EmbeddedShader {
  const char* name;
  std::span<const std::uint32_t> words;
};
const EmbeddedShader k_every_shader[] = {
@rows@};
")
endfunction()
