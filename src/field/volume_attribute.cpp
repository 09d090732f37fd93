// SPDX-License-Identifier: MIT
#include "field/volume_attribute.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "field/block.hpp"
#include "field/visit_type.hpp"

// Samples of one volume at the vertices of another. A dense volume is one slab of all its planes: a
// mapped file stays mapped, anything else is read once. A sparse volume stays sparse: leaves and
// tiles are found by their origins. Arithmetic is in double precision, in one fixed order.

namespace mc::field {

namespace {

AttributeInfo info_of(std::string name, SampleType type) {
  const bool fits_float = type != SampleType::u32 && type != SampleType::i32 &&
                          type != SampleType::i64 && type != SampleType::f64;
  return {.name = std::move(name), .type = fits_float ? SampleType::f32 : SampleType::f64};
}

/// From the lattice of `to_world` to that of `volume`.
Affine to_lattice_of(const Volume& volume, const Affine& to_world) {
  const std::optional<Affine> inverse = volume.lattice.to_world.inverse();
  if (!inverse) {
    throw Error(ErrorKind::input, volume.name,
                "its map from samples to the world cannot be inverted");
  }
  return inverse->after(to_world);
}

/// Where a coordinate lies between two samples; `upper` is `lower` if it is exactly on one.
struct Between {
  std::int32_t lower = 0, upper = 0;
  double t = 0;
};

Between between(double x) {
  constexpr double kMost = 1 << 30;
  if (std::isnan(x)) x = 0;
  x = std::clamp(x, -kMost, kMost);
  const double floor = std::floor(x);
  const auto lower = static_cast<std::int32_t>(floor);
  return {lower, x == floor ? lower : lower + 1, x - floor};
}

double mixed(double a, double b, double t) { return a + t * (b - a); }

/// Linear along each axis. A sample of no weight is not looked at.
template <class SampleAt>
double trilinear(const std::array<Between, 3>& at, const SampleAt& sample) {
  const auto& [x, y, z] = at;
  const auto along_x = [&](std::int32_t j, std::int32_t k) {
    const double a = sample(x.lower, j, k);
    return x.upper == x.lower ? a : mixed(a, sample(x.upper, j, k), x.t);
  };
  const auto along_y = [&](std::int32_t k) {
    const double a = along_x(y.lower, k);
    return y.upper == y.lower ? a : mixed(a, along_x(y.upper, k), y.t);
  };
  const double a = along_y(z.lower);
  return z.upper == z.lower ? a : mixed(a, along_y(z.upper), z.t);
}

class VolumeAttribute : public AttributeReader {
 public:
  VolumeAttribute(const Volume& volume, std::string name, const Affine& to_world)
      : info_(info_of(std::move(name), volume.type)),
        to_lattice_(to_lattice_of(volume, to_world)) {}
  [[nodiscard]] const AttributeInfo& info() const override { return info_; }

 protected:
  /// value(place) is the number at a place in the volume's own lattice.
  template <class Value>
  void fill(std::span<const Vec3> places, std::byte* out, const Value& value) const {
    for (std::size_t n = 0; n < places.size(); ++n) {
      const double number = value(to_lattice_(places[n]));
      if (info_.type == SampleType::f64) {
        std::memcpy(out + n * sizeof number, &number, sizeof number);
      } else {
        const auto narrow = static_cast<float>(number);
        std::memcpy(out + n * sizeof narrow, &narrow, sizeof narrow);
      }
    }
  }

 private:
  AttributeInfo info_;
  Affine to_lattice_;
};

class DenseAttribute final : public VolumeAttribute {
 public:
  DenseAttribute(const SlabReader& reader, std::string name, const Affine& to_world)
      : VolumeAttribute(reader.volume(), std::move(name), to_world),
        type_(reader.volume().type),
        swaps_(reader.volume().endian != std::endian::native),
        dims_(reader.volume().lattice.dims()) {
    reader.read(0, dims_[2], slab_);
  }

  std::size_t values_at(std::span<const Vec3> places, std::byte* out) const override {
    visit_type(type_, [&]<class T>(TypeTag<T>) {
      swaps_ ? fill_as<T, true>(places, out) : fill_as<T, false>(places, out);
    });
    return 0;
  }

 private:
  template <class T, bool Swap>
  void fill_as(std::span<const Vec3> places, std::byte* out) const {
    const auto sample = [this](std::int32_t i, std::int32_t j, std::int32_t k) {
      const std::byte* row = slab_.planes[static_cast<std::size_t>(k)] +
                             static_cast<std::size_t>(j) * slab_.row_stride_bytes;
      return static_cast<double>(
          number(load_sample<T, Swap>(row + static_cast<std::size_t>(i) * sizeof(T))));
    };
    fill(places, out, [&](const Vec3& place) {
      std::array<Between, 3> at;
      for (std::size_t a = 0; a < 3; ++a) {
        at[a] = between(std::clamp(place[a], 0.0, static_cast<double>(dims_[a] - 1)));
      }
      return trilinear(at, sample);
    });
  }

  SampleType type_;
  bool swaps_;
  Index3 dims_;
  Slab slab_;
};

class SparseAttribute final : public VolumeAttribute {
 public:
  SparseAttribute(const LeafReader& reader, std::string name, const Affine& to_world)
      : VolumeAttribute(reader.volume(), std::move(name), to_world),
        reader_(reader),
        type_(reader.volume().type),
        background_(to_double(reader.background(), type_)) {
    const std::span<const Index3> leaves = reader.leaves();
    for (std::size_t n = 0; n < leaves.size(); ++n) leaves_.emplace(block_of(leaves[n]), n);
    for (const Tile& tile : reader.tiles()) {
      tiles_[tile.size].emplace(tile.origin, to_double(tile.value, type_));
    }
  }

  std::size_t values_at(std::span<const Vec3> places, std::byte* out) const override {
    visit_type(type_, [&]<class T>(TypeTag<T>) { fill_as<T>(places, out); });
    return 0;
  }

 private:
  /// Values of the leaves that were looked at last: eight that share a corner have each its own
  /// slot.
  struct Recent {
    struct Slot {
      Index3 block{};
      const std::byte* values = nullptr;
      alignas(8) std::array<std::byte, LeafReader::kLeafSamples * 8> scratch;
    };
    std::vector<Slot> slots{8};

    Slot& of(const Index3& block) {
      return slots[static_cast<std::size_t>((block[0] & 1) | (block[1] & 1) << 1 |
                                            (block[2] & 1) << 2)];
    }
  };

  template <class T>
  void fill_as(std::span<const Vec3> places, std::byte* out) const {
    Recent recent;
    const auto sample = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
      const Index3 p{i, j, k};
      const Index3 block = block_of(p);
      Recent::Slot& slot = recent.of(block);
      if (slot.values == nullptr || slot.block != block) {
        const auto leaf = leaves_.find(block);
        if (leaf == leaves_.end()) return tile_or_background(p);
        slot.values = reader_.leaf_values(leaf->second, slot.scratch.data());
        slot.block = block;
      }
      return static_cast<double>(
          number(load_sample<T, false>(slot.values + leaf_index(i & 7, j & 7, k & 7) * sizeof(T))));
    };
    fill(places, out, [&](const Vec3& place) {
      return trilinear({between(place[0]), between(place[1]), between(place[2])}, sample);
    });
  }

  [[nodiscard]] double tile_or_background(const Index3& p) const {
    for (const auto& [size, tiles] : tiles_) {
      // Sizes are powers of two in every grid there is, but only multiples of 8 are promised.
      const auto below = [size = size](std::int32_t x) {
        const std::int32_t rest = x % size;
        return x - (rest < 0 ? rest + size : rest);
      };
      const auto tile = tiles.find({below(p[0]), below(p[1]), below(p[2])});
      if (tile != tiles.end()) return tile->second;
    }
    return background_;
  }

  const LeafReader& reader_;
  SampleType type_;
  double background_;
  std::unordered_map<Index3, std::size_t, IndexHash> leaves_;                    // by block
  std::map<std::int32_t, std::unordered_map<Index3, double, IndexHash>> tiles_;  // by size, origin
};

}  // namespace

std::unique_ptr<AttributeReader> volume_attribute(const VolumeReader& volume, std::string name,
                                                  const Affine& to_world) {
  assert(!is_stream(volume));
  if (const auto* sparse = std::get_if<std::unique_ptr<LeafReader>>(&volume)) {
    return std::make_unique<SparseAttribute>(**sparse, std::move(name), to_world);
  }
  return std::make_unique<DenseAttribute>(*std::get<std::unique_ptr<SlabReader>>(volume),
                                          std::move(name), to_world);
}

std::uint64_t volume_attribute_bytes(const VolumeReader& volume) {
  constexpr std::uint64_t kEntryBytes = 64;  // of a leaf or tile in its table
  const std::uint64_t held = held_bytes_of(volume);
  if (const auto* sparse = std::get_if<std::unique_ptr<LeafReader>>(&volume)) {
    return held + kEntryBytes * ((*sparse)->leaves().size() + (*sparse)->tiles().size());
  }
  const auto& dense = std::get<std::unique_ptr<SlabReader>>(volume);
  if (dense->rereads_cheaply()) return held;  // mapped
  std::uint64_t n_bytes = sample_size(dense->volume().type);
  for (int a = 0; a < 3; ++a) {
    n_bytes *= static_cast<std::uint64_t>(dense->volume().lattice.box.extent(a));
  }
  return held + n_bytes;
}

}  // namespace mc::field
