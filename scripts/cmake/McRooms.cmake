# Rooms of the house (folders of src/) to libraries. A new file in a room needs no edit here.

# All sources below the given rooms.
function(mc_room_sources out)
  set(all)
  foreach(room IN LISTS ARGN)
    file(GLOB_RECURSE found CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/${room}/*.cpp)
    list(APPEND all ${found})
  endforeach()
  list(FILTER all EXCLUDE REGEX "/main\\.cpp$") # a program's, not a library's
  list(FILTER all EXCLUDE REGEX "/module/") # loaded when needed: see McModules.cmake
  set(${out} ${all} PARENT_SCOPE)
endfunction()

# A static library of the given rooms.
function(mc_library target)
  mc_room_sources(sources ${ARGN})
  add_library(${target} STATIC ${sources})
  add_library(mc::${target} ALIAS ${target})
  mc_strict(${target})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR}/src)
  # SVE's vectors have no size, so that nothing can hold them: kernels are built for NEON. GCC gives
  # constructors that it writes itself no target of their own, so the files allow NEON's throughout.
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(aarch64|arm64)$")
    target_compile_definitions(${target} PRIVATE
      "HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128)")
    set(kernels ${sources})
    list(FILTER kernels INCLUDE REGEX "_simd\\.cpp$")
    set_source_files_properties(${kernels} PROPERTIES COMPILE_OPTIONS -march=armv8-a+crypto)
  endif()
  # A kernel's branches say little of its input. Traced by libFuzzer, they take most of its time.
  if(MC_FUZZ)
    list(FILTER sources INCLUDE REGEX "_simd\\.cpp$")
    set_source_files_properties(${sources} PROPERTIES
      COMPILE_OPTIONS -fno-sanitize=fuzzer-no-link)
  endif()
endfunction()
