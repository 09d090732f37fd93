# cmake --install into an empty folder, and a look at what came.
#   cmake -DBUILD= -DPREFIX= -DPROGRAM= -DLIBDIR= -DHAS_PROGRAM= -P install_files.cmake

file(REMOVE_RECURSE ${PREFIX})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${PREFIX}
  COMMAND_ERROR_IS_FATAL ANY)

set(wanted include/mc/extract.hpp ${LIBDIR}/libmc_core.a ${LIBDIR}/libmc_io.a
  ${LIBDIR}/cmake/mc/mcConfig.cmake ${LIBDIR}/cmake/mc/mcConfigVersion.cmake share/doc/mc/LICENSE)
if(HAS_PROGRAM)
  list(APPEND wanted bin/${PROGRAM})
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
