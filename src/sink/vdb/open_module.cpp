// SPDX-License-Identifier: MIT
#include "sink/vdb/open_module.hpp"

#if MC_WITH_VDB

#ifdef MC_VDB_MODULE
#include "base/module.hpp"
#endif
#include "mc/base.hpp"

namespace mc::sink {

#ifdef MC_VDB_MODULE

std::unique_ptr<VdbWriter> open_vdb_writer(const std::string& place) {
  std::string why;
  void* symbol = base::module_symbol(MC_VDB_MODULE, kVdbWriterSymbol, why);
  if (symbol == nullptr) {
    throw Error(ErrorKind::output, place, "cannot load what writes VDB files: " + why,
                "install " MC_VDB_MODULE
                " with mc and OpenVDB's library (libopenvdb10.0), or write .nrrd");
  }
  return std::unique_ptr<VdbWriter>(reinterpret_cast<MakeVdbWriter>(symbol)(place));
}

#else

std::unique_ptr<VdbWriter> open_vdb_writer(const std::string& place) {
  return std::unique_ptr<VdbWriter>(mc_make_vdb_writer(place));
}

#endif

}  // namespace mc::sink

#endif
