// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "source/vdb/cursor.hpp"

// The values of one node of a VDB tree: how they stand in the file, and how they are unpacked. The
// only door to zlib's and Blosc's compression.

namespace mc::source {

/// How all values of a grid are stored.
struct VdbStorage {
  std::size_t value_bytes = 0;    ///< of one value where it stands alone
  std::size_t packed_bytes = 0;   ///< of one value in a block of them: half as wide where as_half
  std::uint32_t compression = 0;  ///< the grid's flags

  static constexpr std::uint32_t kZip = 1;
  static constexpr std::uint32_t kActiveMask = 2;
  static constexpr std::uint32_t kBlosc = 4;

  [[nodiscard]] bool halved() const { return packed_bytes < value_bytes; }
};

[[nodiscard]] inline bool bit_of(std::span<const std::byte> mask, std::size_t n) {
  return (std::to_integer<unsigned>(mask[n / 8]) >> (n % 8) & 1U) != 0;
}

/// Values as they stand in the file. Where inactive values are left out, they are the first of two
/// or, where `selection` has a bit, the second.
struct PackedValues {
  /// What the file says of inactive values.
  enum class Inactive : std::uint8_t {
    background,
    minus_background,
    one,
    background_or_minus,
    background_or_one,
    two,
    stored,
  };
  Inactive inactive = Inactive::stored;
  std::span<const std::byte> inactive_values;  ///< those that the file spells out
  std::span<const std::byte> selection;        ///< a bit for each value; or empty
  std::size_t n_packed = 0;                    ///< values in `packed`: all, or the active ones
  std::span<const std::byte> packed;
  bool compressed = false;
};

/// Reads what precedes the values and passes over them. `active` has a bit for each value.
/// Errors   input: cut off, within `what`; lengths that do not fit.
PackedValues take_values(VdbCursor& cursor, const VdbStorage& storage,
                         std::span<const std::byte> active, std::string_view what);

/// Unpacks values, with memory of its own that is kept from node to node. One for each thread.
class Unpacker {
 public:
  /// For nodes of at most `most_values`. Keeps the views.
  Unpacker(const VdbStorage& storage, std::size_t most_values, std::string_view place,
           std::string_view what);
  ~Unpacker();
  Unpacker(const Unpacker&) = delete;
  Unpacker& operator=(const Unpacker&) = delete;

  /// Fills out[0 .. 8 * active.size()). T is the type of the values; truth values are bytes.
  /// Errors   input: what is there does not unpack to as many values.
  template <class T>
  void unpack(const PackedValues& values, std::span<const std::byte> active, T background, T* out);

 private:
  void decompress(std::span<const std::byte> packed, std::span<std::byte> out);
  template <class T>
  void unpack_stored(const PackedValues& values, T* out);

  struct Inflater;
  VdbStorage storage_;
  std::size_t most_bytes_;
  std::string_view place_;
  std::string_view what_;
  std::unique_ptr<Inflater> inflater_;
  std::unique_ptr<std::byte[]> scratch_;
};

}  // namespace mc::source
