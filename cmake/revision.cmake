# Writes OUTPUT (a header) with the revision that git reports for SOURCE; leaves the file alone when nothing has changed, so that nothing is recompiled.
# Run at each build: cmake -DSOURCE=... -DOUTPUT=... -P revision.cmake
set(revision unknown)
find_package(Git QUIET)
if(GIT_FOUND)
  execute_process(COMMAND ${GIT_EXECUTABLE} -C ${SOURCE} describe --always --dirty --abbrev=10
    OUTPUT_VARIABLE found RESULT_VARIABLE failed OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(revision ${found})
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#define TANKTREAD_REVISION \"${revision}\"\n" @ONLY)
