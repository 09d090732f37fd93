// SPDX-License-Identifier: MIT
#include "sink/image/exr_samples.hpp"

#include <cstring>
#include <string>

#include "field/visit_type.hpp"

// Samples in the three types that OpenEXR has; none is rounded.

namespace mc::sink {

SampleType exr_type(SampleType type, std::string_view place) {
  switch (type) {
    case SampleType::u8:
    case SampleType::i8:
    case SampleType::f16:
      return SampleType::f16;
    case SampleType::u16:
    case SampleType::i16:
    case SampleType::f32:
      return SampleType::f32;
    case SampleType::u32:
      return SampleType::u32;
    default:
      throw Error(ErrorKind::limit, place,
                  std::string("OpenEXR has half, float and u32 samples, none of which holds ") +
                      sample_name(type),
                  "write nrrd or vdb");
  }
}

Picture exr_picture(const Picture& picture, std::string_view place) {
  Picture out{picture.width, picture.height, exr_type(picture.type, place), {}};
  const std::size_t n = picture.samples.size() / sample_size(picture.type);
  out.samples.resize(n * sample_size(out.type));
  field::visit_type(picture.type, [&]<class T>(field::TypeTag<T>) {
    for (std::size_t i = 0; i < n; ++i) {
      const T sample = field::load_sample<T, false>(picture.samples.data() + i * sizeof(T));
      const auto value = static_cast<float>(field::number(sample));
      if (out.type == SampleType::f16) {
        const Half half = to_half(value);
        std::memcpy(out.samples.data() + i * sizeof half, &half, sizeof half);
      } else {
        std::memcpy(out.samples.data() + i * sizeof value, &value, sizeof value);
      }
    }
  });
  return out;
}

}  // namespace mc::sink
