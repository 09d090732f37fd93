// SPDX-License-Identifier: MIT
#include "source/vdb/packed_values.hpp"

#if MC_WITH_VDB

#include <blosc.h>
#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <new>
#include <type_traits>

#include "field/half_values.hpp"

// Source   OpenVDB 10, io/Compression.h: readCompressedValues() and what it calls. Differs: lengths
// are checked against the file and the node before anything is read or written.

namespace mc::source {

namespace {

using Inactive = PackedValues::Inactive;

std::size_t count_bits(std::span<const std::byte> mask) {
  std::size_t n = 0;
  for (std::size_t at = 0; at < mask.size(); at += sizeof(std::uint64_t)) {
    n += static_cast<std::size_t>(std::popcount(number_at<std::uint64_t>(mask.data() + at)));
  }
  return n;
}

std::size_t values_spelt_out(Inactive inactive) {
  switch (inactive) {
    case Inactive::one:
    case Inactive::background_or_one:
      return 1;
    case Inactive::two:
      return 2;
    default:
      return 0;
  }
}

bool has_selection(Inactive inactive) {
  return inactive == Inactive::background_or_minus || inactive == Inactive::background_or_one ||
         inactive == Inactive::two;
}

template <class T>
T negated(T value) {
  if constexpr (std::is_same_v<T, std::uint8_t>) {
    return value == 0 ? 1 : 0;  // a truth value
  } else if constexpr (std::is_integral_v<T>) {
    using U = std::make_unsigned_t<T>;
    return static_cast<T>(U{0} - static_cast<U>(value));  // the least value has no opposite
  } else {
    return -value;
  }
}

/// The two values that inactive samples have.
template <class T>
std::array<T, 2> inactive_pair(const PackedValues& values, T background) {
  const std::size_t n_spelt = values_spelt_out(values.inactive);
  const std::byte* spelt = values.inactive_values.data();
  const T first = n_spelt > 0                               ? number_at<T>(spelt)
                  : values.inactive == Inactive::background ? background
                                                            : negated(background);
  return {first, n_spelt > 1 ? number_at<T>(spelt + sizeof(T)) : background};
}

/// Spreads the values of active samples, which stand densely, and puts inactive ones between them.
template <class T>
void spread(const T* packed, std::span<const std::byte> active,
            std::span<const std::byte> selection, const std::array<T, 2>& inactive, T* out) {
  for (std::size_t at = 0; at < active.size(); at += sizeof(std::uint64_t)) {
    const auto on = number_at<std::uint64_t>(active.data() + at);
    const std::uint64_t second =
        selection.empty() ? 0 : number_at<std::uint64_t>(selection.data() + at);
    T* to = out + at * 8;
    if (~on == 0) {
      std::copy_n(packed, 64, to);
      packed += 64;
      continue;
    }
    if (second == 0) {
      std::fill_n(to, 64, inactive[0]);
    } else {
      for (std::size_t n = 0; n < 64; ++n) to[n] = inactive[second >> n & 1U];
    }
    for (std::uint64_t left = on; left != 0; left &= left - 1) {
      to[std::countr_zero(left)] = *packed++;
    }
  }
}

}  // namespace

PackedValues take_values(VdbCursor& cursor, const VdbStorage& storage,
                         std::span<const std::byte> active, std::string_view what) {
  PackedValues values;
  const auto inactive = cursor.number<std::uint8_t>(what);
  if (inactive > static_cast<std::uint8_t>(Inactive::stored)) {
    damaged_vdb(cursor.place(), fmt::format("{}: a node packed in an unknown way", what));
  }
  values.inactive = static_cast<Inactive>(inactive);
  values.inactive_values =
      cursor.take(values_spelt_out(values.inactive) * storage.value_bytes, what);
  if (has_selection(values.inactive)) {
    values.selection = cursor.take(active.size(), what);
  }
  const bool leaves_out =
      (storage.compression & VdbStorage::kActiveMask) != 0 && values.inactive != Inactive::stored;
  values.n_packed = leaves_out ? count_bits(active) : active.size() * 8;
  const std::size_t n_bytes = values.n_packed * storage.packed_bytes;
  if ((storage.compression & (VdbStorage::kZip | VdbStorage::kBlosc)) == 0) {
    values.packed = cursor.take(n_bytes, what);
    return values;
  }
  if (storage.halved() && values.n_packed == 0) {
    return values;  // of no halves not even their length is there
  }
  // Negative: so many bytes that compression did not make fewer.
  const auto length = cursor.number<std::int64_t>(what);
  values.compressed = length > 0;
  if (!values.compressed && length != -static_cast<std::int64_t>(n_bytes)) {
    damaged_vdb(cursor.place(), fmt::format("{}: a node with too many or too few values", what));
  }
  values.packed = cursor.take(values.compressed ? static_cast<std::size_t>(length) : n_bytes, what);
  return values;
}

/// libdeflate's own state, which is costly to make.
struct Unpacker::Inflater {
  libdeflate_decompressor* state = libdeflate_alloc_decompressor();

  Inflater() {
    if (state == nullptr) throw std::bad_alloc();
  }
  ~Inflater() { libdeflate_free_decompressor(state); }
  Inflater(const Inflater&) = delete;
  Inflater& operator=(const Inflater&) = delete;
};

Unpacker::Unpacker(const VdbStorage& storage, std::size_t most_values, std::string_view place,
                   std::string_view what)
    : storage_(storage),
      most_bytes_(most_values * storage.value_bytes),
      place_(place),
      what_(what),
      inflater_(std::make_unique<Inflater>()),
      scratch_(new std::byte[2 * most_bytes_]) {}

Unpacker::~Unpacker() = default;

void Unpacker::decompress(std::span<const std::byte> packed, std::span<std::byte> out) {
  std::size_t n_bytes = 0;
  if ((storage_.compression & VdbStorage::kBlosc) != 0) {
    // Blosc believes the lengths in its header unless they are compared with ours before.
    const int n =
        blosc_cbuffer_validate(packed.data(), packed.size(), &n_bytes) == 0 && n_bytes == out.size()
            ? blosc_decompress_ctx(packed.data(), out.data(), out.size(), 1)
            : -1;
    n_bytes = n < 0 ? 0 : static_cast<std::size_t>(n);
  } else if (libdeflate_zlib_decompress(inflater_->state, packed.data(), packed.size(), out.data(),
                                        out.size(), &n_bytes) != LIBDEFLATE_SUCCESS) {
    n_bytes = 0;
  }
  if (n_bytes != out.size()) {
    damaged_vdb(place_, fmt::format("{}: a node that does not decompress", what_));
  }
}

template <class T>
void Unpacker::unpack_stored(const PackedValues& values, T* out) {
  const bool halved = storage_.halved();
  std::span<const std::byte> stored = values.packed;
  if (values.compressed) {
    const std::span<std::byte> to(halved ? scratch_.get() : reinterpret_cast<std::byte*>(out),
                                  values.n_packed * storage_.packed_bytes);
    decompress(values.packed, to);
    stored = to;
  }
  if constexpr (std::is_floating_point_v<T>) {
    if (halved) {
      field::widen_halves(stored.data(), values.n_packed, out);
      return;
    }
  }
  if (!values.compressed) {
    std::memcpy(out, stored.data(), stored.size());
  }
}

template <class T>
void Unpacker::unpack(const PackedValues& values, std::span<const std::byte> active, T background,
                      T* out) {
  const std::size_t n_values = active.size() * 8;
  if (values.n_packed == n_values) {
    unpack_stored(values, out);
    return;
  }
  // The second half of the scratch: unpacking halves takes the first.
  T* packed = reinterpret_cast<T*>(scratch_.get() + most_bytes_);
  if (values.n_packed > 0) unpack_stored(values, packed);
  spread(packed, active, values.selection, inactive_pair(values, background), out);
}

template void Unpacker::unpack(const PackedValues&, std::span<const std::byte>, std::uint8_t,
                               std::uint8_t*);
template void Unpacker::unpack(const PackedValues&, std::span<const std::byte>, std::int32_t,
                               std::int32_t*);
template void Unpacker::unpack(const PackedValues&, std::span<const std::byte>, std::int64_t,
                               std::int64_t*);
template void Unpacker::unpack(const PackedValues&, std::span<const std::byte>, float, float*);
template void Unpacker::unpack(const PackedValues&, std::span<const std::byte>, double, double*);

}  // namespace mc::source

#endif
