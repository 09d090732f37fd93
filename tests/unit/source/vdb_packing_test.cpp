// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#if MC_WITH_VDB

#include <blosc.h>
#include <libdeflate.h>

#include <array>
#include <cstring>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "mc/base.hpp"
#include "source/vdb/packed_values.hpp"

// What OpenVDB cannot be made to write: the distribution's is built without zlib.

namespace mc::source {
namespace {

constexpr std::size_t kValues = 512;
using Bytes = std::vector<std::byte>;

std::vector<std::int32_t> counting() {
  std::vector<std::int32_t> values(kValues);
  std::iota(values.begin(), values.end(), -100);
  return values;
}

Bytes zipped(std::span<const std::byte> bytes) {
  libdeflate_compressor* compressor = libdeflate_alloc_compressor(6);
  Bytes out(libdeflate_zlib_compress_bound(compressor, bytes.size()));
  out.resize(
      libdeflate_zlib_compress(compressor, bytes.data(), bytes.size(), out.data(), out.size()));
  libdeflate_free_compressor(compressor);
  return out;
}

Bytes blosced(std::span<const std::byte> bytes) {
  Bytes out(bytes.size() + BLOSC_MAX_OVERHEAD);
  const int n = blosc_compress_ctx(9, 1, sizeof(std::int32_t), bytes.size(), bytes.data(),
                                   out.data(), out.size(), BLOSC_LZ4_COMPNAME, 0, 1);
  out.resize(static_cast<std::size_t>(n));
  return out;
}

/// A node as it stands in a file: all values there, their length, then they.
Bytes node_of(const Bytes& packed) {
  Bytes node(1 + sizeof(std::int64_t));
  node[0] = std::byte{6};
  const auto length = static_cast<std::int64_t>(packed.size());
  std::memcpy(node.data() + 1, &length, sizeof length);
  node.insert(node.end(), packed.begin(), packed.end());
  return node;
}

/// The values that a node unpacks to, or the message of the error.
std::string unpacked(const Bytes& node, std::uint32_t compression,
                     std::vector<std::int32_t>& values) {
  const VdbStorage storage{4, 4, compression};
  const std::array<std::byte, kValues / 8> active{};
  values.assign(kValues, 0);
  try {
    VdbCursor cursor(node, 0, "f.vdb");
    const PackedValues packed = take_values(cursor, storage, active, "grid \"g\"");
    Unpacker(storage, kValues, "f.vdb", "grid \"g\"")
        .unpack(packed, active, std::int32_t{0}, values.data());
    return "no error";
  } catch (const Error& error) {
    return error.what();
  }
}

TEST(VdbPacking, ZipAndBlosc) {
  const std::vector<std::int32_t> expected = counting();
  const auto bytes = std::as_bytes(std::span(expected));
  std::vector<std::int32_t> values;
  EXPECT_EQ(unpacked(node_of(zipped(bytes)), VdbStorage::kZip, values), "no error");
  EXPECT_EQ(values, expected);
  EXPECT_EQ(unpacked(node_of(blosced(bytes)), VdbStorage::kBlosc, values), "no error");
  EXPECT_EQ(values, expected);
}

TEST(VdbPacking, WhatDoesNotUnpackIsDamage) {
  const std::string message =
      "f.vdb: damaged VDB file: grid \"g\": a node that does not decompress; fetch or write the "
      "file again";
  const std::vector<std::int32_t> right = counting();
  const auto bytes = std::as_bytes(std::span(right));
  Bytes longer(bytes.begin(), bytes.end());
  longer.resize(longer.size() + 4);
  std::vector<std::int32_t> values;
  const auto expect_damage = [&](const Bytes& packed, std::uint32_t compression) {
    EXPECT_EQ(unpacked(node_of(packed), compression, values), message);
  };
  for (const auto& content : {bytes.first(bytes.size() - 4), std::span<const std::byte>(longer)}) {
    expect_damage(zipped(content), VdbStorage::kZip);
    expect_damage(blosced(content), VdbStorage::kBlosc);
  }
  for (const std::size_t n : {1U, 15U, 40U}) {
    Bytes zip = zipped(bytes);
    Bytes blosc = blosced(bytes);
    zip.resize(n);
    blosc.resize(n);
    expect_damage(zip, VdbStorage::kZip);
    expect_damage(blosc, VdbStorage::kBlosc);
  }
}

TEST(VdbPacking, LengthsThatDoNotFit) {
  std::vector<std::int32_t> values;
  Bytes node = node_of({});
  const auto with_length = [&](std::int64_t length) {
    std::memcpy(node.data() + 1, &length, sizeof length);
    return unpacked(node, VdbStorage::kZip, values);
  };
  const std::string cut =
      "f.vdb: cut off after 9 bytes, within grid \"g\"; fetch or write the "
      "file again";
  const std::string wrong =
      "f.vdb: damaged VDB file: grid \"g\": a node with too many or too few "
      "values; fetch or write the file again";
  EXPECT_EQ(with_length(std::int64_t{1} << 62), cut);
  EXPECT_EQ(with_length(-std::int64_t{kValues * 4}), cut);
  EXPECT_EQ(with_length(-std::int64_t{kValues}), wrong);
  EXPECT_EQ(with_length(std::numeric_limits<std::int64_t>::min()), wrong);
  node[0] = std::byte{7};
  EXPECT_EQ(with_length(1),
            "f.vdb: damaged VDB file: grid \"g\": a node packed in an unknown way; "
            "fetch or write the file again");
}

}  // namespace
}  // namespace mc::source

#endif
