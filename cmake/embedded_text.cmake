# airlight_embedded_text(TARGET NAME FILE...): makes the header "embedded/NAME.h", in which the text of each file is the
# std::string_view `k_STEM_EXTENSION`, as in `k_page_html`. An edited file makes it anew.
function(airlight_embedded_text target name)
  set(output ${CMAKE_BINARY_DIR}/embedded/${target}/embedded/${name}.h)
  list(TRANSFORM ARGN PREPEND ${CMAKE_CURRENT_SOURCE_DIR}/ OUTPUT_VARIABLE files)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -D OUTPUT=${output} -D "FILES=${files}" -P ${CMAKE_SOURCE_DIR}/cmake/embed_text.cmake
    DEPENDS ${files} ${CMAKE_SOURCE_DIR}/cmake/embed_text.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
  target_include_directories(${target} PRIVATE ${CMAKE_BINARY_DIR}/embedded/${target})
endfunction()
