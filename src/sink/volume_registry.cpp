// SPDX-License-Identifier: MIT
#include <string>

#include "mc/sink.hpp"
#include "sink/image/series_sink.hpp"
#include "sink/nrrd/nrrd_sink.hpp"
#include "sink/raw/raw_sink.hpp"
#include "sink/vdb/vdb_sink.hpp"

// Which sink writes which volume format.

namespace mc {

std::unique_ptr<VolumeSink> open_volume_sink(const std::string& path, const SinkOptions& options) {
  const std::string format = output_format(path, options);
  if (is_mesh_format(format)) {
    throw Error(ErrorKind::usage, path, format + " holds meshes, but this is a volume",
                "write vdb, nrrd, raw or exr");
  }
  if (format == "vdb") return sink::open_vdb(path, options);
  if (format == "nrrd") return sink::open_nrrd(path, options);
  if (format == "exr") return sink::open_exr_series(path, options);
  if (format == "png") {
    throw Error(ErrorKind::usage, path, "png holds pictures, but this is a volume",
                "write vdb, nrrd, raw or exr");
  }
  return sink::open_raw(path, options);
}

}  // namespace mc
