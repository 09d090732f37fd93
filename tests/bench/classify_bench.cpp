// SPDX-License-Identifier: MIT
#include <limits>
#include <memory>

#include "extract/bits/classify.hpp"
#include "field/visit_type.hpp"
#include "kernel_bench.hpp"

// One bit a sample, from each type: a plane that stays in the cache, so what is timed is the work
// and not the memory (mc bench times that).

namespace mc::bench {

namespace {

using extraction::classify_rows;
using extraction::SampleRows;
using extraction::Threshold;

template <class T>
struct Plane {
  std::vector<T> samples;
  std::vector<std::uint64_t> words = std::vector<std::uint64_t>(kSide * kSide / 64);
  Threshold threshold{field::type_of<T>(), std::endian::native, 0, Inside::above};

  Plane() {
    for (const double v : gyroid_plane(kSide / 3)) samples.push_back(sample(v));
    if constexpr (std::is_unsigned_v<T>) {
      threshold = Threshold(field::type_of<T>(), std::endian::native,
                            static_cast<double>(std::numeric_limits<T>::max()) / 2, Inside::above);
    }
  }
  static T sample(double v) {
    if constexpr (std::is_same_v<T, Half>) return to_half(static_cast<float>(v));
    if constexpr (std::is_floating_point_v<T>) return static_cast<T>(v);
    if constexpr (std::is_integral_v<T>) {
      const auto top = static_cast<double>(std::numeric_limits<T>::max() / 2);
      return static_cast<T>(std::is_signed_v<T> ? v * top : top + v * top);
    }
  }
  void classify() {
    classify_rows(threshold,
                  SampleRows{reinterpret_cast<const std::byte*>(samples.data()), kSide * sizeof(T),
                             kSide, kSide},
                  words.data(), kSide / 64);
  }
  [[nodiscard]] bool right() const {
    for (std::size_t n = 0; n < samples.size(); ++n) {
      const bool bit = (words[n / 64] >> (n % 64) & 1) != 0;
      if (bit != extraction::is_above(samples[n], threshold)) return false;
    }
    return true;
  }
};

}  // namespace

void add_classification() {
  for (const SampleType type : {SampleType::u8, SampleType::i16, SampleType::u16, SampleType::i32,
                                SampleType::f16, SampleType::f32, SampleType::f64}) {
    field::visit_type(type, []<class T>(field::TypeTag<T> /*tag*/) {
      const auto plane = std::make_shared<Plane<T>>();
      add_kernel(
          std::string("classify/") + sample_name(field::type_of<T>()), "samples", kSide * kSide,
          [plane] { plane->classify(); }, [plane] { return plane->right(); });
    });
  }
}

}  // namespace mc::bench
