# Writes the commit of the clone into OUTPUT, if it has changed; an empty text outside of a clone, as in an unpacked archive.
set(commit "")
find_program(GIT git)
if(GIT AND EXISTS ${SOURCE_DIR}/.git)
  execute_process(COMMAND ${GIT} --no-optional-locks log -1 --format=%h\ of\ %cs --abbrev=10 WORKING_DIRECTORY ${SOURCE_DIR}
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failure)
  execute_process(COMMAND ${GIT} --no-optional-locks diff --quiet HEAD WORKING_DIRECTORY ${SOURCE_DIR} ERROR_QUIET RESULT_VARIABLE changed)
  if(NOT failure AND changed)
    string(APPEND commit ", with changes")
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define INSONIFY_COMMIT \"${commit}\"\n")
