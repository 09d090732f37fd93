// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cassert>
#include <cstring>
#include <functional>
#include <utility>
#include <vector>

#include "edit/edited_materials.hpp"
#include "edit/edited_reader.hpp"

// An edited dense volume as planes. Planes without a stored block are the input's own memory; the
// others are copied and patched.

namespace mc::edit {

namespace {

/// Which samples of some planes are left out, one bit each, in rows as a SideMap's.
class SampleBits {
 public:
  explicit SampleBits(const SideMap& sides) : box_(sides.box()) {
    for_rows([&](std::int32_t j, std::int32_t k) {
      const auto row = sides.known(j, k);
      n_words_ = row.size();
      bits_.insert(bits_.end(), row.begin(), row.end());
    });
  }

  [[nodiscard]] bool any(const IndexBox& part) {
    bool found = false;
    for_words(part, [&](std::uint64_t& word, std::uint64_t bits) {
      found = found || (word & bits) != 0;
    });
    return found;
  }
  void clear(const IndexBox& part) {
    for_words(part, [](std::uint64_t& word, std::uint64_t bits) { word &= ~bits; });
  }
  /// The runs that are left, on the sides that `from` tells.
  [[nodiscard]] SideMap to_sides(const SideMap& from) const {
    SideMap out;
    out.reset(box_, 1, 1);
    for_rows([&](std::int32_t j, std::int32_t k) {
      const std::uint64_t* row = bits_.data() + first_word(j, k);
      const auto above = from.above(j, k);
      const auto n = static_cast<std::size_t>(box_.extent(0));
      const auto bit = [](const std::uint64_t* words, std::size_t at) {
        return (words[at / 64] >> (at % 64) & 1U) != 0;
      };
      for (std::size_t at = 0; at < n;) {
        const std::size_t first = at++;
        if (!bit(row, first)) continue;
        const bool side = bit(above.data(), first);
        while (at < n && bit(row, at) && bit(above.data(), at) == side) ++at;
        const auto index = [&](std::size_t i) { return box_.lo[0] + static_cast<std::int32_t>(i); };
        out.leave_out({{index(first), j, k}, {index(at - 1), j, k}}, side);
      }
    });
    return out;
  }

 private:
  template <class F>
  void for_rows(F f) const {
    for (std::int32_t k = box_.lo[2]; k <= box_.hi[2]; ++k) {
      for (std::int32_t j = box_.lo[1]; j <= box_.hi[1]; ++j) f(j, k);
    }
  }
  [[nodiscard]] std::size_t first_word(std::int32_t j, std::int32_t k) const {
    const auto row =
        static_cast<std::size_t>(k - box_.lo[2]) * static_cast<std::size_t>(box_.extent(1)) +
        static_cast<std::size_t>(j - box_.lo[1]);
    return row * n_words_;
  }
  template <class F>
  void for_words(const IndexBox& part, F f) {
    const auto first = static_cast<std::size_t>(part.lo[0] - box_.lo[0]);
    const auto last = static_cast<std::size_t>(part.hi[0] - box_.lo[0]) + 1;
    for (std::int32_t k = part.lo[2]; k <= part.hi[2]; ++k) {
      for (std::int32_t j = part.lo[1]; j <= part.hi[1]; ++j) {
        std::uint64_t* row = bits_.data() + first_word(j, k);
        for (std::size_t at = first; at < last;) {
          const std::size_t n = std::min(last - at, 64 - at % 64);
          f(row[at / 64], (~std::uint64_t{0} >> (64 - n)) << (at % 64));
          at += n;
        }
      }
    }
  }

  IndexBox box_;
  std::size_t n_words_ = 0;
  std::vector<std::uint64_t> bits_;
};

class EditedSlabs final : public SlabReader {
 public:
  EditedSlabs(const World& world, Volume volume)
      : samples_(world.samples),
        materials_(world),
        volume_(std::move(volume)),
        size_(samples_.input().sample_bytes()) {
    for (const auto& [at, block] : samples_.layer().blocks()) stored_.push_back(at);
    std::sort(stored_.begin(), stored_.end(), comes_before);
  }

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  [[nodiscard]] AttributeReaders attributes() const override { return materials_.attributes(); }
  [[nodiscard]] bool rereads_cheaply() const override {
    return samples_.filled() || input().rereads_cheaply();
  }
  [[nodiscard]] std::uint64_t held_bytes() const override {
    return samples_.filled() ? 0 : input().held_bytes();
  }

  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    out.sides.clear();
    if (samples_.filled()) {
      read_fill(k0, k1, out);
    } else {
      input().read(k0, k1, out);
    }
    patch(out);
  }

  void read_surface(std::int32_t k0, std::int32_t k1, const SurfaceQuery& query,
                    Slab& out) const override {
    if (samples_.filled()) return read(k0, k1, out);
    input().read_surface(k0, k1, query, out);
    if (!out.sides.empty()) complete(out);
    patch(out);
  }

  [[nodiscard]] bool reads_boxes_cheaply() const override { return true; }
  void read_box(const IndexBox& box, std::span<std::byte> out) const override {
    samples_.read_box(box, out);
    if (volume_.endian != std::endian::native) swap_samples(out, size_);
  }

 private:
  /// A crossed edge may have its other end in a stored block, and a run looks a step beyond it.
  static constexpr std::int32_t kReach = 2;

  [[nodiscard]] const SlabReader& input() const { return *samples_.input().slabs(); }

  /// Calls f(block) for stored blocks within `reach` planes of [k0, k1).
  template <class F>
  void for_stored(std::int32_t k0, std::int32_t k1, std::int32_t reach, F&& f) const {
    const std::int32_t first = block_of(k0 - reach);
    const std::int32_t last = block_of(k1 - 1 + reach);
    auto at = std::partition_point(stored_.begin(), stored_.end(),
                                   [&](const Index3& b) { return b[2] < first; });
    for (; at != stored_.end() && (*at)[2] <= last; ++at) f(*at);
  }

  /// Places of the planes [k0, k1) in which a stored block lies.
  [[nodiscard]] std::vector<std::size_t> patched_planes(std::int32_t k0, std::int32_t k1) const;
  [[nodiscard]] IndexBox box_of_planes(const Slab& slab) const;
  /// From sample `at` on; the plane is of the slab's own memory.
  [[nodiscard]] std::byte* row_of(Slab& slab, const Index3& at) const;
  /// One plane of the value for all that are not patched.
  void read_fill(std::int32_t k0, std::int32_t k1, Slab& out) const;
  /// Gets the input's samples where it left some out around a stored block.
  void complete(Slab& out) const;
  void copy_input(const IndexBox& part, Slab& out) const;
  void patch(Slab& out) const;
  /// Memory of the slab's own for the planes that are patched.
  void own_planes(Slab& out) const;

  const EditedSamples& samples_;
  EditedMaterials materials_;
  Volume volume_;
  std::size_t size_;
  std::vector<Index3> stored_;  // by (z, y, x)
};

bool is_within(const std::byte* at, const Buffer<std::byte>& storage) {
  const std::less<> less;
  return !less(at, storage.data()) && less(at, storage.data() + storage.size());
}

std::vector<std::size_t> EditedSlabs::patched_planes(std::int32_t k0, std::int32_t k1) const {
  std::vector<bool> patched(static_cast<std::size_t>(k1 - k0), false);
  for_stored(k0, k1, 0, [&](const Index3& at) {
    const std::int32_t first = std::max(at[2] * kBlockSize, k0) - k0;
    const std::int32_t last = std::min(at[2] * kBlockSize + kBlockSize, k1) - k0;
    std::fill(patched.begin() + first, patched.begin() + last, true);
  });
  std::vector<std::size_t> out;
  for (std::size_t n = 0; n < patched.size(); ++n) {
    if (patched[n]) out.push_back(n);
  }
  return out;
}

void EditedSlabs::read_fill(std::int32_t k0, std::int32_t k1, Slab& out) const {
  const std::vector<std::size_t> patched = patched_planes(k0, k1);
  const auto n_own = static_cast<std::int32_t>(patched.size()) + 1;
  Scalar value = *samples_.filled();
  if (volume_.endian != std::endian::native) {
    swap_samples(std::span(value.bytes).first(size_), size_);
  }
  out.allocate(planes_of(volume_.lattice.box, k0, k0 + n_own), size_);
  fill_samples(out.storage.data(), out.storage.size() / size_, value, size_);
  const std::vector<const std::byte*> own = out.planes;
  out.planes.assign(static_cast<std::size_t>(k1 - k0), own.front());
  for (std::size_t p = 0; p < patched.size(); ++p) out.planes[patched[p]] = own[p + 1];
}

void EditedSlabs::own_planes(Slab& out) const {
  const auto k1 = out.k0 + static_cast<std::int32_t>(out.planes.size());
  std::vector<std::size_t> copied = patched_planes(out.k0, k1);
  const auto is_own = [&](std::size_t n) { return is_within(out.planes[n], out.storage); };
  if (std::all_of(copied.begin(), copied.end(), is_own)) return;
  Buffer<std::byte> fresh;
  const bool in_use = std::any_of(out.planes.begin(), out.planes.end(),
                                  [&](const std::byte* at) { return is_within(at, out.storage); });
  if (in_use) {
    copied.resize(out.planes.size());
    for (std::size_t n = 0; n < copied.size(); ++n) copied[n] = n;
  }
  // Rows keep their distance, which is one for all planes; nothing lies beyond the last one.
  const IndexBox& box = volume_.lattice.box;
  const std::size_t plane_bytes =
      out.row_stride_bytes * static_cast<std::size_t>(box.extent(1) - 1) +
      static_cast<std::size_t>(box.extent(0)) * size_;
  Buffer<std::byte>& room = in_use ? fresh : out.storage;
  room.resize(plane_bytes * copied.size());
  for (std::size_t n = 0; n < copied.size(); ++n) {
    std::byte* to = room.data() + n * plane_bytes;
    std::memcpy(to, out.planes[copied[n]], plane_bytes);
    out.planes[copied[n]] = to;
  }
  if (in_use) out.storage = std::move(fresh);
}

std::byte* EditedSlabs::row_of(Slab& slab, const Index3& at) const {
  const std::byte* plane = slab.planes[static_cast<std::size_t>(at[2] - slab.k0)];
  assert(is_within(plane, slab.storage));
  return slab.storage.data() + (plane - slab.storage.data()) +
         static_cast<std::size_t>(at[1]) * slab.row_stride_bytes +
         static_cast<std::size_t>(at[0]) * size_;
}

IndexBox EditedSlabs::box_of_planes(const Slab& slab) const {
  IndexBox box = volume_.lattice.box;
  box.lo[2] = slab.k0;
  box.hi[2] = slab.k0 + static_cast<std::int32_t>(slab.planes.size()) - 1;
  return box;
}

void EditedSlabs::patch(Slab& out) const {
  if (out.planes.empty()) return;
  own_planes(out);
  const IndexBox planes = box_of_planes(out);
  for_stored(planes.lo[2], planes.hi[2] + 1, 0, [&](const Index3& at) {
    const std::byte* samples = samples_.layer().find(at)->samples();
    const Index3 from = origin_of(at);
    const IndexBox part = common_part(samples_of(at), planes);
    const std::size_t row_bytes = static_cast<std::size_t>(part.extent(0)) * size_;
    for (std::int32_t k = part.lo[2]; k <= part.hi[2]; ++k) {
      for (std::int32_t j = part.lo[1]; j <= part.hi[1]; ++j) {
        const auto row = static_cast<std::size_t>(k - from[2]) * kBlockSize +
                         static_cast<std::size_t>(j - from[1]);
        std::byte* to = row_of(out, {part.lo[0], j, k});
        std::memcpy(to, samples + row * kBlockSize * size_, row_bytes);
        if (volume_.endian != std::endian::native) swap_samples({to, row_bytes}, size_);
      }
    }
  });
}

void EditedSlabs::complete(Slab& out) const {
  const IndexBox planes = common_part(box_of_planes(out), out.sides.box());
  std::vector<IndexBox> rings;  // what must be there
  for_stored(planes.lo[2], planes.hi[2] + 1, kReach, [&](const Index3& at) {
    const IndexBox ring = common_part(grown(samples_of(at), kReach), planes);
    if (!is_empty(ring)) rings.push_back(ring);
  });
  if (rings.empty()) return;
  SampleBits left_out(out.sides);
  for (const IndexBox& ring : rings) {
    if (left_out.any(ring)) copy_input(ring, out);
  }
  for (const IndexBox& ring : rings) left_out.clear(ring);
  out.sides = left_out.to_sides(out.sides);
}

void EditedSlabs::copy_input(const IndexBox& part, Slab& out) const {
  const std::size_t row_bytes = static_cast<std::size_t>(part.extent(0)) * size_;
  std::vector<std::byte> samples(row_bytes *
                                 static_cast<std::size_t>(part.extent(1) * part.extent(2)));
  input().read_box(part, samples);
  const std::byte* from = samples.data();
  for (std::int32_t k = part.lo[2]; k <= part.hi[2]; ++k) {
    for (std::int32_t j = part.lo[1]; j <= part.hi[1]; ++j, from += row_bytes) {
      std::memcpy(row_of(out, {part.lo[0], j, k}), from, row_bytes);
    }
  }
}

}  // namespace

std::unique_ptr<SlabReader> make_slab_reader(const World& world, const Volume& volume) {
  return std::make_unique<EditedSlabs>(world, volume);
}

}  // namespace mc::edit
