# airlight_folder(NAME SOURCES... LINKS...): the library of one folder of the house.
#
# Its headers are reached as "NAME/file.h" through a private link to that folder alone, so that a folder
# can include only the folders it links (directly or through them), and a forbidden include fails to compile.
function(airlight_folder name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;PRIVATE_LINKS" ${ARGN})
  set(headers ${CMAKE_BINARY_DIR}/headers/${name})
  file(MAKE_DIRECTORY ${headers})
  file(CREATE_LINK ${CMAKE_SOURCE_DIR}/${name} ${headers}/${name} SYMBOLIC)
  add_library(airlight_${name} STATIC ${ARG_SOURCES})
  add_library(airlight::${name} ALIAS airlight_${name})
  target_include_directories(airlight_${name} PUBLIC ${headers})
  target_link_libraries(airlight_${name} PUBLIC ${ARG_LINKS} PRIVATE ${ARG_PRIVATE_LINKS})
endfunction()
