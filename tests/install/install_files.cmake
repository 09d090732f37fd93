# cmake --install into an empty folder, and a look at what came.
#   cmake -DBUILD= -DPREFIX= -DPROGRAM= -DLIBDIR= -DHAS_PROGRAM= -DMODULE= -DSPEC= -P install_files.cmake

file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX}
  COMMAND_ERROR_IS_FATAL ANY)

set(wanted include/mc/extract.hpp ${LIBDIR}/libmc_core.a ${LIBDIR}/libmc_io.a
  ${LIBDIR}/cmake/mc/mcConfig.cmake ${LIBDIR}/cmake/mc/mcConfigVersion.cmake share/doc/mc/LICENSE)
if(HAS_PROGRAM)
  list(APPEND wanted bin/${PROGRAM} share/bash-completion/completions/${PROGRAM}
    share/zsh/site-functions/_${PROGRAM} share/fish/vendor_completions.d/${PROGRAM}.fish)
endif()
if(MODULE)
  list(APPEND wanted ${LIBDIR}/mc/${MODULE})
endif()
foreach(file IN LISTS wanted)
  if(NOT EXISTS ${PREFIX}/${file})
    message(SEND_ERROR "not installed: ${file}")
  endif()
endforeach()

# A path of this machine's source or build tree in the package would break it elsewhere.
file(GLOB package ${PREFIX}/${LIBDIR}/cmake/mc/*.cmake)
foreach(file IN LISTS package)
  file(READ ${file} text)
  string(FIND "${text}" "${BUILD}" leak)
  if(NOT leak EQUAL -1)
    message(SEND_ERROR "${file} names the build folder")
  endif()
endforeach()

if(HAS_PROGRAM)
  execute_process(COMMAND ${PREFIX}/bin/${PROGRAM} --version COMMAND_ERROR_IS_FATAL ANY)
endif()

# The installed program finds its module, and says what is missing where it is not there.
function(write_volume result_variable error_variable)
  execute_process(COMMAND ${PREFIX}/bin/${PROGRAM} sample ${SPEC} --force -o ${PREFIX}/a.vdb
    RESULT_VARIABLE result ERROR_VARIABLE error)
  set(${result_variable} ${result} PARENT_SCOPE)
  set(${error_variable} "${error}" PARENT_SCOPE)
endfunction()
if(HAS_PROGRAM AND MODULE)
  write_volume(result error)
  if(NOT result EQUAL 0)
    message(SEND_ERROR "the installed program writes no VDB file: ${error}")
  endif()
  set(module ${PREFIX}/${LIBDIR}/mc/${MODULE})
  file(RENAME ${module} ${module}.away)
  file(REMOVE ${PREFIX}/a.vdb)
  write_volume(result error)
  file(RENAME ${module}.away ${module})
  if(NOT result EQUAL 4 OR NOT error MATCHES "a.vdb: cannot load what writes VDB files: ${MODULE}: ")
    message(SEND_ERROR "without its module the program ends with ${result}: ${error}")
  endif()
  file(GLOB left ${PREFIX}/a.vdb*)
  if(left)
    message(SEND_ERROR "a run that failed leaves ${left}")
  endif()
endif()
