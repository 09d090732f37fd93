# Modules: what needs a library that is slow to load stands in a file of its own, which the program
# loads when an output asks for it. It is found by the RUNPATH of the program, or of the shared
# library, that mc_io is linked into.

set(MC_MODULE_DIR ${CMAKE_INSTALL_LIBDIR}/mc)

#   mc_module(NAME MACRO FOLDERS folder... LIBRARIES library...)
# The sources in module/ of the folders as part of mc_io, or as a module of the same version. Defines
# MACRO as its file name.
function(mc_module name macro)
  cmake_parse_arguments(PARSE_ARGV 2 arg "" "" "FOLDERS;LIBRARIES")
  list(TRANSFORM arg_FOLDERS REPLACE "(.+)" "${CMAKE_SOURCE_DIR}/src/\\1/module/*.cpp")
  file(GLOB sources CONFIGURE_DEPENDS ${arg_FOLDERS})
  # Such libraries' templates take minutes at -O3; writing waits for compression and disk anyway.
  set_source_files_properties(${sources} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O1>)
  if(NOT MC_MODULES)
    target_sources(mc_io PRIVATE ${sources})
    target_link_libraries(mc_io PRIVATE ${arg_LIBRARIES})
    return()
  endif()
  add_library(${name} MODULE ${sources})
  mc_strict(${name})
  # Not with hidden symbols: OpenVDB's templates must share their statics with its library.
  set_target_properties(${name} PROPERTIES PREFIX "" OUTPUT_NAME ${name}-${PROJECT_VERSION})
  target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR}/src)
  target_link_libraries(${name} PRIVATE mc_core fmt::fmt ${arg_LIBRARIES})
  mc_define_formats(${name})
  target_link_options(${name} PRIVATE LINKER:--exclude-libs,ALL LINKER:--no-undefined)
  target_compile_definitions(mc_io PRIVATE ${macro}="${name}-${PROJECT_VERSION}.so")
  # The program, which is installed as it is built, says where in its own way.
  target_link_options(mc_io INTERFACE
    $<BUILD_INTERFACE:$<$<NOT:$<STREQUAL:$<TARGET_PROPERTY:NAME>,mc>>:LINKER:-rpath,${CMAKE_BINARY_DIR}>>
    $<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${MC_MODULE_DIR}>)
  install(TARGETS ${name} LIBRARY DESTINATION ${MC_MODULE_DIR})
endfunction()

# `program` is built with all modules.
function(mc_loads_modules program)
  foreach(module mc-vdb mc-image)
    if(TARGET ${module})
      add_dependencies(${program} ${module})
    endif()
  endforeach()
endfunction()

# `program` finds modules where they are built and, wherever the whole is moved, where they are
# installed.
function(mc_finds_modules program)
  file(RELATIVE_PATH there ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR}/mc)
  set_target_properties(${program} PROPERTIES BUILD_RPATH "$ORIGIN;$ORIGIN/${there}")
endfunction()
