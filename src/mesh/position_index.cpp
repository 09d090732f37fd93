// SPDX-License-Identifier: MIT
#include "mesh/position_index.hpp"

#include <bit>
#include <cassert>
#include <random>

// Linear probing at a load of at most 5/8. A slot carries 24 bits of the hash, so that a position
// is fetched only where it very likely matches.

namespace mc::mesh {

namespace {

constexpr std::uint64_t kIdMask = (std::uint64_t{1} << 40) - 1;

/// The bits by which a coordinate is compared.
std::uint64_t key(double x) { return std::bit_cast<std::uint64_t>(x + 0.0); }

template <class T>
bool same_position(const std::array<T, 3>& a, const std::array<T, 3>& b) {
  return key(a[0]) == key(b[0]) && key(a[1]) == key(b[1]) && key(a[2]) == key(b[2]);
}

std::uint64_t random_seed() {
  std::random_device device;
  return std::uint64_t{device()} << 32 | device();
}

}  // namespace

PositionIndex::PositionIndex() : seed_(random_seed()), slots_(1024, 0) {}

template <class T>
std::uint64_t PositionIndex::hash(const std::array<T, 3>& p) const {
  std::uint64_t h = seed_;
  for (const T x : p) {
    h = (h ^ key(x)) * 0xD6E8FEB86659FD93U;
    h ^= h >> 32;
  }
  h *= 0xD6E8FEB86659FD93U;
  return h ^ h >> 29;
}

template <class T>
std::uint64_t PositionIndex::first(std::span<const std::array<T, 3>> positions, std::uint64_t id) {
  assert(id < kIdMask && id < positions.size());
  if (n_known_ * 8 >= slots_.size() * 5) {
    grow(positions);
  }
  const std::uint64_t h = hash(positions[id]);
  const std::uint64_t mask = slots_.size() - 1;
  for (std::uint64_t at = h & mask;; at = (at + 1) & mask) {
    const std::uint64_t slot = slots_[at];
    if (slot == 0) {
      slots_[at] = (h & ~kIdMask) | (id + 1);
      ++n_known_;
      return id;
    }
    const std::uint64_t known = (slot & kIdMask) - 1;
    if (((slot ^ h) & ~kIdMask) == 0 && same_position(positions[known], positions[id])) {
      return known;
    }
  }
}

template <class T>
void PositionIndex::grow(std::span<const std::array<T, 3>> positions) {
  std::vector<std::uint64_t> larger(slots_.size() * 2, 0);
  const std::uint64_t mask = larger.size() - 1;
  for (const std::uint64_t slot : slots_) {
    if (slot != 0) {
      std::uint64_t at = hash(positions[(slot & kIdMask) - 1]) & mask;
      while (larger[at] != 0) {
        at = (at + 1) & mask;
      }
      larger[at] = slot;
    }
  }
  slots_.swap(larger);
}

template std::uint64_t PositionIndex::first(std::span<const std::array<float, 3>>, std::uint64_t);
template std::uint64_t PositionIndex::first(std::span<const std::array<double, 3>>, std::uint64_t);

}  // namespace mc::mesh
