# cmake -DSOURCE=DIR -DHEADER=FILE -P WriteCommit.cmake: FILE has the commit of DIR, with "-dirty" where its files differ
# from it, or "unknown" where DIR is no clone. It is written only if that has changed.
cmake_minimum_required(VERSION 3.25)
find_program(GIT git)
set(commit unknown)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse --show-cdup
    OUTPUT_VARIABLE above RESULT_VARIABLE status OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(status EQUAL 0 AND above STREQUAL "")
    execute_process(COMMAND ${GIT} --no-optional-locks -C ${SOURCE} describe --always --abbrev=40 --dirty --exclude *
      OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} @ONLY CONTENT "#define SKITTER_COMMIT \"@commit@\"\n")
