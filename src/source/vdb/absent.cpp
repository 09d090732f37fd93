// SPDX-License-Identifier: MIT
#include "source/vdb/vdb.hpp"

// Stands in for the reader where OpenVDB was not there when mc was built.

#if !MC_WITH_VDB

namespace mc::source {

namespace {

[[noreturn]] void absent(const MappedFile& file) {
  throw Error(ErrorKind::input, file.place(), "this build of mc has no support for VDB files",
              "install the package libopenvdb-dev and build again");
}

}  // namespace

VdbSource open_vdb(MappedFile file, const SourceOptions& /*options*/) { absent(file); }

std::vector<GridDescription> describe_vdb(MappedFile file) { absent(file); }

}  // namespace mc::source

#endif
