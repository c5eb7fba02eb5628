# grainlaw_calculix_material(LIBRARY NAME MATERIAL [NAME MATERIAL ...])
#
# Builds libLIBRARY.so with a function NAME for each material file MATERIAL; in the input of
# CalculiX its material is @LIBRARY_NAME. LIBRARY and NAMEs in capitals, no underscore in LIBRARY.
# The absolute paths of the files go into the library.
function(grainlaw_calculix_material LIBRARY)
  if(NOT LIBRARY MATCHES "^[A-Z0-9]+$")
    message(FATAL_ERROR "grainlaw_calculix_material: CalculiX reads ${LIBRARY} in capitals, up to "
                        "the first underscore; capitals and digits were expected")
  endif()
  set(lines "#include <grainlaw/calculix.h>\n")
  set(rest ${ARGN})
  while(rest)
    list(POP_FRONT rest name material)
    file(REAL_PATH "${material}" material BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
    if(NOT EXISTS "${material}")
      message(FATAL_ERROR "grainlaw_calculix_material: there is no material file ${material}")
    endif()
    string(APPEND lines "GRAINLAW_CALCULIX_MATERIAL(${name}, \"${material}\")\n")
  endwhile()
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${LIBRARY}_material.c")
  file(CONFIGURE OUTPUT "${source}" @ONLY CONTENT "${lines}")
  add_library(${LIBRARY} SHARED "${source}")
  target_link_libraries(${LIBRARY} PRIVATE grainlaw::grainlaw_calculix)
endfunction()
