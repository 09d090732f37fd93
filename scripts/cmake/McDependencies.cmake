# What mc stands on, all from the distribution. Formats whose library is missing are left out, and
# the program then names the package that would bring them.

find_package(TBB CONFIG REQUIRED COMPONENTS tbb) # before OpenVDB, which defines the same targets
find_package(fmt CONFIG REQUIRED)
find_package(hwy CONFIG REQUIRED)
if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64|i.86")
  set(MC_LINKS_HIGHWAY ON) # on x86 base/highway_simd.cpp stands in for the little that is used
endif()
find_package(nlohmann_json CONFIG REQUIRED)
find_package(CLI11 CONFIG REQUIRED)

find_package(TinyGLTF CONFIG QUIET)
option(MC_GLTF "glTF and GLB through tinygltf" ${TinyGLTF_FOUND})

# Pictures: the light C library of OpenEXR, which is found here before OpenVDB's find module looks.
find_package(OpenEXR 3 CONFIG QUIET)
if(TARGET OpenEXR::OpenEXRCore)
  set(MC_EXR_FOUND ON)
endif()
option(MC_EXR "OpenEXR pictures" ${MC_EXR_FOUND})
find_package(PNG QUIET)
option(MC_PNG "PNG pictures" ${PNG_FOUND})

# Packed inputs.
find_package(ZLIB QUIET)
option(MC_GZIP "gzip-packed inputs" ${ZLIB_FOUND})
find_library(MC_ZSTD_LIBRARY zstd)
find_path(MC_ZSTD_INCLUDE_DIR zstd.h)
if(MC_ZSTD_LIBRARY AND MC_ZSTD_INCLUDE_DIR)
  set(MC_ZSTD_FOUND ON)
endif()
option(MC_ZSTD "zstd-packed inputs" ${MC_ZSTD_FOUND})

# Debian ships OpenVDB's find module outside CMake's own path; it is searched last, since its
# neighbours FindTBB and FindOpenEXR would shadow the good ones.
list(APPEND CMAKE_MODULE_PATH "/usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB")
find_package(OpenVDB 10 QUIET COMPONENTS openvdb)
find_library(MC_BLOSC blosc)
find_library(MC_DEFLATE deflate)
if(OpenVDB_FOUND AND MC_BLOSC AND MC_DEFLATE)
  set(MC_VDB_FOUND ON)
endif()
option(MC_VDB "OpenVDB volumes" ${MC_VDB_FOUND})

# Defines MC_WITH_* for the formats that are built in.
function(mc_define_formats target)
  target_compile_definitions(${target} PUBLIC
    MC_WITH_VDB=$<BOOL:${MC_VDB}> MC_WITH_GLTF=$<BOOL:${MC_GLTF}>
    MC_WITH_EXR=$<BOOL:${MC_EXR}> MC_WITH_PNG=$<BOOL:${MC_PNG}>
    MC_WITH_GZIP=$<BOOL:${MC_GZIP}> MC_WITH_ZSTD=$<BOOL:${MC_ZSTD}>)
endfunction()

# Links what the formats need to `target`.
function(mc_link_formats target)
  mc_define_formats(${target})
  if(MC_VDB)
    target_link_libraries(${target} PRIVATE blosc deflate)
  endif()
  if(MC_GZIP)
    target_link_libraries(${target} PRIVATE ZLIB::ZLIB)
  endif()
  if(MC_ZSTD)
    target_link_libraries(${target} PRIVATE zstd)
  endif()
  if(MC_GLTF)
    target_link_libraries(${target} PRIVATE TinyGLTF::TinyGLTF)
  endif()
endfunction()
