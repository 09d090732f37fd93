// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "base/simd_target.hpp"
#include "source/spec/spec.hpp"
#include "support/random_spec.hpp"

namespace mc::tests {

/// The bits of the planes [k0, k1); all NaNs as one.
inline std::vector<std::uint32_t> plane_bits(const SlabReader& reader, std::int32_t k0,
                                             std::int32_t k1) {
  Slab slab;
  reader.read(k0, k1, slab);
  std::vector<std::uint32_t> bits(slab.storage.size() / sizeof(float));
  std::memcpy(bits.data(), slab.storage.data(), slab.storage.size());
  for (std::uint32_t& v : bits) {
    const float value = std::bit_cast<float>(v);
    v = value != value ? 0x7FC00000U : v;
  }
  return bits;
}

/// Materials at places between the samples, none where the document has none; and how many are
/// clamped.
inline std::vector<std::uint32_t> materials_of(const SlabReader& reader) {
  const AttributeReader* materials = find_attribute(reader.attributes(), material_attribute());
  if (materials == nullptr) return {};
  std::vector<Vec3> places;
  for (int n = 0; n < 300; ++n) places.push_back({n % 9 - 0.3, n % 7 * 0.8, n * 0.017});
  std::vector<std::uint16_t> found(places.size());
  const std::size_t n_clamped =
      materials->values_at(places, reinterpret_cast<std::byte*>(found.data()));
  std::vector<std::uint32_t> out(found.begin(), found.end());
  out.push_back(static_cast<std::uint32_t>(n_clamped));
  return out;
}

/// Makes a document of the bytes, which must be good, and samples it on each of these SIMD targets:
/// whole, and plane by plane, and its materials. Returns false where it expands past the limit;
/// anything else that goes wrong comes out as an exception that holds the document.
inline bool replay_graph(std::span<const std::uint8_t> bytes,
                         std::span<const std::string> targets) {
  const std::string text = RandomSpec(bytes).text();
  std::vector<std::uint32_t> expected;
  std::optional<std::vector<std::uint32_t>> materials;
  for (const std::string& target : targets) {
    base::set_simd_target(target);
    try {
      const auto reader = source::open_spec_text("random.json", text);
      const std::int32_t n_planes = reader->volume().lattice.dims()[2];
      const std::vector<std::uint32_t> whole = plane_bits(*reader, 0, n_planes);
      std::vector<std::uint32_t> pieces;
      for (std::int32_t k = 0; k < n_planes; ++k) {
        const auto plane = plane_bits(*reader, k, k + 1);
        pieces.insert(pieces.end(), plane.begin(), plane.end());
      }
      const std::vector<std::uint32_t> found = materials_of(*reader);
      if (pieces != whole || (!expected.empty() && whole != expected) ||
          found != materials.value_or(found)) {
        throw std::logic_error(target + " differs on " + text);
      }
      expected = whole;
      materials = found;
    } catch (const Error& error) {
      if (std::string_view(error.what()).find("expand to more") == std::string_view::npos) {
        throw std::logic_error(std::string(error.what()) + " in " + text);
      }
      base::reset_simd_target();
      return false;
    }
  }
  base::reset_simd_target();
  return true;
}

}  // namespace mc::tests
