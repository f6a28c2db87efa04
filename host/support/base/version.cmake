# Writes OUTPUT from TEMPLATE with VERSION and the commit of SOURCES. GIT finds the commit if there is a repository.
set(COMMIT unknown)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCES} describe --always --dirty=-changed --abbrev=12 --exclude=*
                  OUTPUT_VARIABLE found RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  if(NOT failed)
    set(COMMIT ${found})
  endif()
endif()
configure_file(${TEMPLATE} ${OUTPUT} @ONLY)
