# cmake -D OUTPUT=HEADER -D FILES=FILE;... -P embed_text.cmake: see embedded_text.cmake.
set(header "#pragma once\n\n#include <string_view>\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  string(REPLACE "." "_" name ${name})
  file(READ ${file} text)
  string(APPEND header "\ninline constexpr std::string_view k_${name} = R\"AIRLIGHT(${text})AIRLIGHT\";\n")
endforeach()
file(WRITE ${OUTPUT} "${header}")
