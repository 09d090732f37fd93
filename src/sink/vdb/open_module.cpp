// SPDX-License-Identifier: MIT
#include "sink/vdb/open_module.hpp"

#if MC_WITH_VDB

#include <dlfcn.h>

#include <string_view>

#include "mc/base.hpp"

namespace mc::sink {

#ifdef MC_VDB_MODULE

namespace {

[[noreturn]] void cannot_load(const std::string& place) {
  const char* text = ::dlerror();  // "FILE: what is wrong with it"
  throw Error(ErrorKind::output, place,
              "cannot load what writes VDB files: " + std::string(text == nullptr ? "" : text),
              "install " MC_VDB_MODULE
              " with mc and OpenVDB's library (libopenvdb10.0), "
              "or write .nrrd");
}

}  // namespace

std::unique_ptr<VdbWriter> open_vdb_writer(const std::string& place) {
  // Never closed: OpenVDB's library does not bear to be unloaded.
  void* module = ::dlopen(MC_VDB_MODULE, RTLD_NOW | RTLD_LOCAL);
  void* symbol = module == nullptr ? nullptr : ::dlsym(module, kVdbWriterSymbol);
  if (symbol == nullptr) cannot_load(place);
  return std::unique_ptr<VdbWriter>(reinterpret_cast<MakeVdbWriter>(symbol)(place));
}

#else

std::unique_ptr<VdbWriter> open_vdb_writer(const std::string& place) {
  return std::unique_ptr<VdbWriter>(mc_make_vdb_writer(place));
}

#endif

}  // namespace mc::sink

#endif
