// SPDX-License-Identifier: MIT
#include "edit/place_samples.hpp"

#include <array>

namespace mc::edit {

void sample_places(const GraphField& field, const Affine& to_place, const Index3& first,
                   View3<float> out) {
  const std::array<double, 12>& m = to_place.m;
  const bool along_axes =
      m[1] == 0 && m[2] == 0 && m[4] == 0 && m[6] == 0 && m[8] == 0 && m[9] == 0;
  if (along_axes) {
    return field.sample({m[3], m[7], m[11]}, {m[0], m[5], m[10]}, first, out);
  }
  for (std::int32_t k = 0; k < out.dims[2]; ++k) {
    for (std::int32_t j = 0; j < out.dims[1]; ++j) {
      float* row = out.data + k * out.plane_stride + j * out.row_stride;
      for (std::int32_t i = 0; i < out.dims[0]; ++i) {
        const Vec3 place =
            to_place({static_cast<double>(first[0] + i), static_cast<double>(first[1] + j),
                      static_cast<double>(first[2] + k)});
        field.sample(place, {0, 0, 0}, {0, 0, 0}, View3<float>(row + i, {1, 1, 1}));
      }
    }
  }
}

}  // namespace mc::edit
