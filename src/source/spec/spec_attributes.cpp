// SPDX-License-Identifier: MIT
#include "source/spec/spec_attributes.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace mc::source {

namespace {

/// The index that a node's value names, and whether it is another number.
std::pair<std::uint16_t, bool> index_of(float value) {
  constexpr float kMost = 65535;
  const float rounded = std::nearbyint(value);
  if (rounded >= 0 && rounded <= kMost) return {static_cast<std::uint16_t>(rounded), false};
  return {static_cast<std::uint16_t>(rounded > kMost ? kMost : 0), true};
}

class FieldAttribute final : public AttributeReader {
 public:
  FieldAttribute(AttributeInfo info, GraphField field, const Vec3& origin, const Vec3& spacing)
      : info_(std::move(info)), field_(std::move(field)), origin_(origin), spacing_(spacing) {}

  [[nodiscard]] const AttributeInfo& info() const override { return info_; }

  std::size_t values_at(std::span<const Vec3> places, std::byte* out) const override {
    std::vector<std::array<float, 3>> world(places.size());
    for (std::size_t n = 0; n < places.size(); ++n) {
      for (std::size_t a = 0; a < 3; ++a) {
        world[n][a] = static_cast<float>(origin_[a] + places[n][a] * spacing_[a]);
      }
    }
    if (info_.type == SampleType::f32) {
      field_.sample_places(world, std::span(reinterpret_cast<float*>(out), places.size()));
      return 0;
    }
    std::vector<float> values(places.size());
    field_.sample_places(world, values);
    return round_to_indices(values, reinterpret_cast<std::uint16_t*>(out));
  }

 private:
  /// Returns how many values are no index.
  static std::size_t round_to_indices(std::span<const float> values, std::uint16_t* out) {
    std::size_t n_clamped = 0;
    for (std::size_t n = 0; n < values.size(); ++n) {
      const auto [index, is_clamped] = index_of(values[n]);
      out[n] = index;
      n_clamped += is_clamped ? 1 : 0;
    }
    return n_clamped;
  }

  AttributeInfo info_;
  GraphField field_;
  Vec3 origin_, spacing_;
};

}  // namespace

std::unique_ptr<AttributeReader> field_attribute(const AttributeInfo& info, GraphField field,
                                                 const Vec3& origin, const Vec3& spacing) {
  return std::make_unique<FieldAttribute>(info, std::move(field), origin, spacing);
}

}  // namespace mc::source
