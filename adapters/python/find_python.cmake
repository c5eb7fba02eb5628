# Sets GRAINLAW_PYTHON to the first python3 on the path that is new enough and has numpy, and
# GRAINLAW_PYTHON_PASSED_OVER to those before it, with what they lack: as pyenv's, which sees no
# package of Debian.
set(GRAINLAW_PYTHON_PASSED_OVER "")
string(REPLACE ":" ";" directories "$ENV{PATH}:/usr/bin")
foreach(directory ${directories})
  set(candidate ${directory}/python3)
  if(NOT GRAINLAW_PYTHON AND EXISTS ${candidate})
    execute_process(
      COMMAND ${candidate} -c "import sys
if sys.version_info < (3, 11): sys.exit('older than 3.11')
try: import numpy
except ImportError: sys.exit('no numpy')"
      RESULT_VARIABLE failed OUTPUT_QUIET ERROR_VARIABLE lacks ERROR_STRIP_TRAILING_WHITESPACE)
    if(failed EQUAL 0)
      set(GRAINLAW_PYTHON ${candidate} CACHE FILEPATH "A python3 with numpy")
    else()
      string(APPEND GRAINLAW_PYTHON_PASSED_OVER "; not ${candidate}, ${lacks}")
    endif()
  endif()
endforeach()
if(CMAKE_SCRIPT_MODE_FILE)  # a test
  message("${GRAINLAW_PYTHON}${GRAINLAW_PYTHON_PASSED_OVER}")
endif()
