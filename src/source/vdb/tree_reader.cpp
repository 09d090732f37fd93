// SPDX-License-Identifier: MIT
#include "source/vdb/tree_reader.hpp"

#if MC_WITH_VDB

#include <sys/mman.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <limits>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "source/vdb/packed_leaves.hpp"

namespace mc::source {

namespace {

constexpr std::int32_t kLeafSize = 8;

struct FreeBytes {
  void operator()(std::byte* bytes) const { std::free(bytes); }
};
using LeafBytes = std::unique_ptr<std::byte[], FreeBytes>;

/// Memory that nobody has touched, in large pages where the system has them: faulting small ones in
/// takes longer than filling them.
LeafBytes untouched_bytes(std::size_t n_bytes) {
  constexpr std::size_t kLargePage = std::size_t{1} << 21;
  const std::size_t alignment = n_bytes < kLargePage ? 64 : kLargePage;
  if (n_bytes > std::numeric_limits<std::size_t>::max() - alignment) throw std::bad_alloc();
  const std::size_t rounded = (n_bytes + alignment - 1) / alignment * alignment;
  LeafBytes bytes(static_cast<std::byte*>(std::aligned_alloc(alignment, rounded)));
  if (!bytes && rounded != 0) throw std::bad_alloc();
  if (alignment == kLargePage) ::madvise(bytes.get(), rounded, MADV_HUGEPAGE);
  return bytes;
}

void grow(IndexBox& box, const IndexBox& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min(box.lo[axis], other.lo[axis]);
    box.hi[axis] = std::max(box.hi[axis], other.hi[axis]);
  }
}

IndexBox cube(const Index3& lo, std::int32_t size) {
  return {lo, {lo[0] + size - 1, lo[1] + size - 1, lo[2] + size - 1}};
}

constexpr IndexBox kNoBox{
    {std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::max(),
     std::numeric_limits<std::int32_t>::max()},
    {std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::min(),
     std::numeric_limits<std::int32_t>::min()}};

/// The box of a leaf's set bits: words go along x, their bytes along y, and bits of those along z.
/// Precondition: one is set.
IndexBox box_of_bits(const Index3& origin, const std::array<std::uint64_t, 8>& words) {
  unsigned x_set = 0;
  std::uint64_t y_and_z = 0;
  for (unsigned x = 0; x < 8; ++x) {
    x_set |= (words[x] != 0 ? 1U : 0U) << x;
    y_and_z |= words[x];
  }
  std::uint64_t z_set = y_and_z;
  for (const unsigned shift : {32U, 16U, 8U}) z_set |= z_set >> shift;
  z_set &= 0xFFU;
  const auto first = [](std::uint64_t bits) { return std::countr_zero(bits); };
  const auto last = [](std::uint64_t bits) { return std::bit_width(bits) - 1; };
  return {{origin[0] + first(x_set), origin[1] + first(y_and_z) / 8, origin[2] + first(z_set)},
          {origin[0] + static_cast<std::int32_t>(last(x_set)),
           origin[1] + static_cast<std::int32_t>(last(y_and_z)) / 8,
           origin[2] + static_cast<std::int32_t>(last(z_set))}};
}

/// What a tree's reader knows of it whatever its values are.
class TreeReader : public LeafReader {
 public:
  TreeReader(std::vector<TreeOutline::Leaf> leaves, Volume volume)
      : stored_(std::move(leaves)), volume_(std::move(volume)) {
    sort_leaves();
  }

  [[nodiscard]] const Volume& volume() const override { return volume_; }
  [[nodiscard]] Scalar background() const override { return background_; }
  [[nodiscard]] std::span<const Index3> leaves() const override { return origins_; }
  [[nodiscard]] std::array<std::uint64_t, 8> leaf_active(std::size_t n) const override {
    return stored_[stored_at_[n]].active;
  }
  [[nodiscard]] std::span<const Tile> tiles() const override { return tiles_; }
  [[nodiscard]] std::uint64_t held_bytes() const override {
    return stored_.capacity() * sizeof(stored_[0]) + tiles_.capacity() * sizeof(tiles_[0]) +
           origins_.capacity() * sizeof(origins_[0]) +
           stored_at_.capacity() * sizeof(stored_at_[0]);
  }

 protected:
  void measure();

  std::vector<TreeOutline::Leaf> stored_;  // as the file orders them
  Volume volume_;
  Scalar background_;
  std::vector<Tile> tiles_;
  std::vector<Index3> origins_;           // as the port orders leaves
  std::vector<std::uint32_t> stored_at_;  // of those

 private:
  void sort_leaves();
};

void TreeReader::sort_leaves() {
  struct Key {
    std::uint64_t zy;
    std::uint32_t x;
    std::uint32_t place;
    bool operator<(const Key& other) const { return zy != other.zy ? zy < other.zy : x < other.x; }
  };
  const auto ordered = [](std::int32_t n) { return static_cast<std::uint32_t>(n) ^ 0x80000000U; };
  if (stored_.size() >= std::numeric_limits<std::uint32_t>::max()) throw std::bad_alloc();
  std::vector<Key> keys(stored_.size());
  for (std::size_t n = 0; n < stored_.size(); ++n) {
    const Index3& at = stored_[n].origin;
    keys[n] = {std::uint64_t{ordered(at[2])} << 32U | ordered(at[1]), ordered(at[0]),
               static_cast<std::uint32_t>(n)};
  }
  std::sort(keys.begin(), keys.end());
  origins_.reserve(stored_.size());
  stored_at_.reserve(stored_.size());
  for (const Key& key : keys) {
    origins_.push_back(stored_[key.place].origin);
    stored_at_.push_back(key.place);
  }
}

/// Active samples and their box.
void TreeReader::measure() {
  std::uint64_t n_active = 0;
  IndexBox active = kNoBox;
  IndexBox stored = kNoBox;
  for (const TreeOutline::Leaf& leaf : stored_) {
    std::uint64_t n = 0;
    for (const std::uint64_t word : leaf.active) n += static_cast<unsigned>(std::popcount(word));
    n_active += n;
    const IndexBox whole = cube(leaf.origin, kLeafSize);
    grow(stored, whole);
    if (n != 0 && !active.contains(whole)) grow(active, box_of_bits(leaf.origin, leaf.active));
  }
  for (const Tile& tile : tiles_) {
    const auto size = static_cast<std::uint64_t>(tile.size);
    grow(stored, cube(tile.origin, tile.size));
    if (tile.active) {
      n_active += size * size * size;
      grow(active, cube(tile.origin, tile.size));
    }
  }
  volume_.n_active = n_active;
  volume_.lattice.box = n_active > 0                         ? active
                        : origins_.empty() && tiles_.empty() ? IndexBox{}
                                                             : stored;
}

/// Samples of type T; truth values are bytes, of which leaves keep only bits.
template <class T>
class TypedReader final : public TreeReader {
 public:
  TypedReader(const TreeFile& file, TreeOutline outline, const Volume& volume)
      : TreeReader(std::move(outline.leaves), volume),
        is_truth_(file.kind.leaves != LeafKind::values),
        leaf_bytes_(is_truth_ ? kLeafSamples / 8 : kLeafSamples * sizeof(T)) {
    background_ = Scalar::of(value_of(outline.background));
    collect_tiles(file, outline);
    measure();
  }

  const std::byte* leaf_values(std::size_t n, std::byte* scratch) const override {
    if (packed_) {
      packed_->read(n, stored_[stored_at_[n]].at, background_.as<T>(),
                    reinterpret_cast<T*>(scratch));
      return scratch;
    }
    const std::byte* values = values_.get() + n * leaf_bytes_;
    if (!is_truth_) return values;
    for (std::size_t at = 0; at < kLeafSamples; ++at) {
      scratch[at] = values[at / 8] >> (at % 8) & std::byte{1};
    }
    return scratch;
  }

  [[nodiscard]] std::uint64_t held_bytes() const override {
    return TreeReader::held_bytes() + (values_ ? unpacked_bytes() : 0) +
           (packed_ ? packed_->held_bytes() : 0);
  }

  /// Unpacks all leaves, or sees to it that each can be.
  void read_leaves(const TreeFile& file, std::uint64_t memory_bytes);

 private:
  [[nodiscard]] T value_of(std::span<const std::byte> bytes) const {
    return truth_of(number_at<T>(bytes.data()));
  }
  [[nodiscard]] T truth_of(T value) const { return is_truth_ ? static_cast<T>(value != 0) : value; }
  void collect_tiles(const TreeFile& file, const TreeOutline& outline);
  void collect_tiles(const TreeOutline::Node& node, std::span<const T> values);
  [[nodiscard]] std::uint64_t unpacked_bytes() const { return leaves().size() * leaf_bytes_; }
  void unpack_leaves(const TreeFile& file);
  void unpack_leaf(const TreeFile& file, std::size_t at, Unpacker& unpacker, std::byte* to) const;

  bool is_truth_;
  std::size_t leaf_bytes_;
  LeafBytes values_;  // as the port orders leaves; or null
  std::unique_ptr<PackedLeaves> packed_;
};

template <class T>
void TypedReader<T>::collect_tiles(const TreeFile& file, const TreeOutline& outline) {
  for (const TreeOutline::RootTile& tile : outline.root_tiles) {
    const Scalar value = Scalar::of(value_of(tile.value));
    if (tile.active || !(value == background_)) {
      tiles_.push_back({tile.origin, TreeOutline::kRootTileSize, value, tile.active});
    }
  }
  Unpacker unpacker(file.kind.storage, TreeOutline::kMostChildren, file.place(), file.what);
  std::vector<T> values;
  for (const TreeOutline::Node& node : outline.nodes) {
    if (node.values.n_packed == 0 && node.values.inactive == PackedValues::Inactive::background) {
      continue;
    }
    values.resize(node.active.size() * 8);
    unpacker.unpack(node.values, node.active, background_.as<T>(), values.data());
    collect_tiles(node, values);
  }
}

template <class T>
void TypedReader<T>::collect_tiles(const TreeOutline::Node& node, std::span<const T> values) {
  const T background = background_.as<T>();
  for (std::size_t n = 0; n < values.size(); ++n) {
    const T value = truth_of(values[n]);
    // Inlined, unlike a comparison of Scalars: most nodes have nothing but background.
    const bool differs = __builtin_memcmp(&value, &background, sizeof(T)) != 0;
    if ((differs || bit_of(node.active, n)) && !bit_of(node.children, n)) {
      tiles_.push_back(
          {node.child_origin(n), node.child_size, Scalar::of(value), bit_of(node.active, n)});
    }
  }
}

template <class T>
void TypedReader<T>::unpack_leaf(const TreeFile& file, std::size_t at, Unpacker& unpacker,
                                 std::byte* to) const {
  VdbCursor cursor(file.bytes(), stored_[at].at, file.place());
  const LeafBuffer leaf = take_leaf(cursor, file.kind, file.what);
  if (is_truth_) {
    std::ranges::copy(leaf.bits, to);
  } else {
    unpacker.unpack(leaf.values, leaf.active, background_.as<T>(), reinterpret_cast<T*>(to));
  }
}

template <class T>
void TypedReader<T>::unpack_leaves(const TreeFile& file) {
  const std::size_t n_leaves = origins_.size();
  values_ = untouched_bytes(n_leaves * leaf_bytes_);
  std::vector<std::uint32_t> number(n_leaves);  // of the leaves as the file orders them
  for (std::size_t n = 0; n < n_leaves; ++n) {
    number[stored_at_[n]] = static_cast<std::uint32_t>(n);
  }
  base::for_ranges(n_leaves, 256, [&](std::size_t begin, std::size_t end) {
    Unpacker unpacker(file.kind.storage, kLeafSamples, file.place(), file.what);
    for (std::size_t at = begin; at < end; ++at) {
      unpack_leaf(file, at, unpacker, values_.get() + number[at] * leaf_bytes_);
    }
  });
}

template <class T>
void TypedReader<T>::read_leaves(const TreeFile& file, std::uint64_t memory_bytes) {
  constexpr std::uint64_t kUnpackedPart = 2, kCachePart = 8;
  const std::uint64_t most = memory_bytes / kUnpackedPart;
  if (is_truth_ || TreeReader::held_bytes() + unpacked_bytes() <= most) {
    unpack_leaves(file);
  } else {
    packed_ = std::make_unique<PackedLeaves>(file.file, file.kind, std::string(file.what),
                                             memory_bytes / kCachePart);
  }
}

}  // namespace

std::unique_ptr<LeafReader> read_vdb_tree(const TreeFile& file, TreeOutline outline,
                                          const Volume& volume, LeafValues wanted,
                                          std::uint64_t memory_bytes) {
  const auto as = [&]<class T>(T /*type*/) -> std::unique_ptr<LeafReader> {
    auto reader = std::make_unique<TypedReader<T>>(file, std::move(outline), volume);
    if (wanted == LeafValues::read) reader->read_leaves(file, memory_bytes);
    return reader;
  };
  switch (volume.type) {
    case SampleType::u8:
      return as(std::uint8_t{});
    case SampleType::i32:
      return as(std::int32_t{});
    case SampleType::i64:
      return as(std::int64_t{});
    case SampleType::f64:
      return as(double{});
    default:
      return as(float{});
  }
}

}  // namespace mc::source

#endif
