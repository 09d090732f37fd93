# Compiler settings of our own code: strict warnings in our lanes, exact floating point everywhere.

if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

find_program(MC_CCACHE ccache)
if(MC_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${MC_CCACHE})
endif()

# Warnings and floating-point rules for one target of ours. No fused multiply-add and no fast-math:
# the same input gives the same bytes on every machine.
function(mc_strict target)
  target_compile_options(${target} PRIVATE
    -Wall -Wextra -Wshadow -Wconversion $<$<BOOL:${MC_WERROR}>:-Werror> -ffp-contract=off
    $<$<CXX_COMPILER_ID:Clang>:-fconstexpr-steps=100000000>) # the case table is computed
endfunction()
