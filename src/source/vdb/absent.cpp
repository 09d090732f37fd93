// SPDX-License-Identifier: MIT
#include "source/vdb/vdb.hpp"

// Stands in for the reader where OpenVDB was not there when mc was built.

#if !MC_WITH_VDB

#include "source/formats.hpp"
#include "source/source_input.hpp"

namespace mc::source {

Source open_vdb(SourceInput& input, const SourceOptions& /*options*/, Progress& /*progress*/) {
  refuse_absent(kVdbFormat, map_file(input).place());
}

std::vector<GridDescription> describe_vdb(SourceInput& input, Progress& /*progress*/) {
  refuse_absent(kVdbFormat, map_file(input).place());
}

}  // namespace mc::source

#endif
