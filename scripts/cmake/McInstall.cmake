# What cmake --install puts in place: the program, both libraries, the headers, a CMake package, the
# man pages, the shells' completions and the licence.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(MC_PACKAGE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/mc)
target_compile_features(mc_core PUBLIC cxx_std_20)

# Two export sets, so that who wants the core alone needs neither OpenVDB nor tinygltf.
install(TARGETS mc_core EXPORT mcCoreTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS mc_io EXPORT mcIoTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
foreach(part Core Io)
  install(EXPORT mc${part}Targets NAMESPACE mc:: DESTINATION ${MC_PACKAGE_DIR})
endforeach()
install(DIRECTORY include/mc DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")

configure_package_config_file(scripts/cmake/mcConfig.cmake.in mcConfig.cmake
  INSTALL_DESTINATION ${MC_PACKAGE_DIR} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(mcConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/mcConfig.cmake ${CMAKE_BINARY_DIR}/mcConfigVersion.cmake
  DESTINATION ${MC_PACKAGE_DIR})

# In the build folder the program is always mc; it gets its own name where it is installed.
if(TARGET mc)
  install(PROGRAMS $<TARGET_FILE:mc> DESTINATION ${CMAKE_INSTALL_BINDIR} RENAME ${MC_PROGRAM_NAME})
endif()
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The shells' completions, printed by the program under the name that it is installed by.
if(TARGET mc)
  foreach(shell IN ITEMS bash zsh fish)
    set(script completions/${shell})
    add_custom_command(OUTPUT ${script}
      COMMAND ${CMAKE_COMMAND} -E make_directory completions
      COMMAND $<TARGET_FILE:mc> completion ${shell} ${MC_PROGRAM_NAME} > ${script}
      DEPENDS mc COMMENT "Printing completions for ${shell}" VERBATIM)
    list(APPEND MC_COMPLETIONS ${script})
  endforeach()
  add_custom_target(mc_completions ALL DEPENDS ${MC_COMPLETIONS})
  install(FILES ${CMAKE_BINARY_DIR}/completions/bash
    DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ${MC_PROGRAM_NAME})
  install(FILES ${CMAKE_BINARY_DIR}/completions/zsh
    DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions RENAME _${MC_PROGRAM_NAME})
  install(FILES ${CMAKE_BINARY_DIR}/completions/fish
    DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d RENAME ${MC_PROGRAM_NAME}.fish)
endif()

# Man pages: man/PAGE.SECTION.md -> PAGE.SECTION, named after the program in section 1.
find_program(MC_PANDOC pandoc)
file(GLOB MC_PAGES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/man/*.[15].md)
if(MC_PANDOC AND MC_PAGES)
  foreach(page IN LISTS MC_PAGES)
    get_filename_component(name ${page} NAME_WLE)
    get_filename_component(section ${name} LAST_EXT)
    string(SUBSTRING ${section} 1 1 section)
    add_custom_command(OUTPUT man/${name}
      COMMAND ${CMAKE_COMMAND} -E make_directory man
      COMMAND ${MC_PANDOC} --standalone --from markdown --to man --output man/${name} ${page}
      DEPENDS ${page} COMMENT "Rendering ${name}" VERBATIM)
    list(APPEND MC_RENDERED man/${name})
    set(installed_name ${name})
    if(section EQUAL 1)
      string(REGEX REPLACE "^mc" "${MC_PROGRAM_NAME}" installed_name ${name})
    endif()
    install(FILES ${CMAKE_BINARY_DIR}/man/${name}
      DESTINATION ${CMAKE_INSTALL_MANDIR}/man${section} RENAME ${installed_name})
  endforeach()
  add_custom_target(mc_man ALL DEPENDS ${MC_RENDERED})
endif()
