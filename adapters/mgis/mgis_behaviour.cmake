# grainlaw_mgis_behaviour(NAME MATERIAL)
#
# Builds libNAME.so, which holds the MGIS behaviour NAME of the material file MATERIAL. The absolute
# path of the file goes into the library.
function(grainlaw_mgis_behaviour NAME MATERIAL)
  file(REAL_PATH "${MATERIAL}" material BASE_DIRECTORY "${CMAKE_CURRENT_SOURCE_DIR}")
  if(NOT EXISTS "${material}")
    message(FATAL_ERROR "grainlaw_mgis_behaviour: there is no material file ${material}")
  endif()
  set(source "${CMAKE_CURRENT_BINARY_DIR}/${NAME}_behaviour.c")
  file(CONFIGURE OUTPUT "${source}" @ONLY CONTENT
       "#include <grainlaw/mgis.h>\nGRAINLAW_MGIS_BEHAVIOUR(@NAME@, \"@material@\")\n")
  add_library(${NAME} SHARED "${source}")
  target_link_libraries(${NAME} PRIVATE grainlaw::grainlaw_mgis)
endfunction()
