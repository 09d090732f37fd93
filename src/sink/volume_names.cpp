// SPDX-License-Identifier: MIT
#include "sink/volume_names.hpp"

namespace mc::sink {

const char* class_name(VolumeClass cls) {
  switch (cls) {
    case VolumeClass::unknown:
      return "";
    case VolumeClass::level_set:
      return "level_set";
    case VolumeClass::fog:
      return "fog";
    case VolumeClass::mask:
      return "mask";
    case VolumeClass::density_spec:
      return "density_spec";
    case VolumeClass::sdf_spec:
      return "sdf_spec";
  }
  __builtin_unreachable();
}

const char* border_name(Border border) {
  switch (border) {
    case Border::open:
      return "open";
    case Border::closed:
      return "closed";
    case Border::solid:
      return "solid";
  }
  __builtin_unreachable();
}

}  // namespace mc::sink
