# Compiler settings of our own code: strict warnings in our lanes, exact floating point everywhere.

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

find_program(MC_CCACHE ccache)
if(MC_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${MC_CCACHE})
endif()

# Warnings and floating-point rules for one target of ours. No fused multiply-add and no fast-math:
# the same input gives the same bytes on every machine. Nobody reads the floating-point exception
# flags: -fno-trapping-math changes no value, and lets GCC turn selects into vectors. GCC 12 at -O3
# drops the rounding of (double)(float)x where its basic-block vectoriser packs two of them, so that
# pass is off.
function(mc_strict target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wshadow -Wconversion $<$<BOOL:${MC_WERROR}>:-Werror>
    -ffp-contract=off -fno-trapping-math
    $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>
    $<$<CXX_COMPILER_ID:Clang>:-fconstexpr-steps=100000000>) # the case table is computed
  # GCC 12 sees overlap in "x" + std::string(...) where there is none (its bug 105651).
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    target_compile_options(${target} PRIVATE -Wno-restrict)
  endif()
endfunction()
