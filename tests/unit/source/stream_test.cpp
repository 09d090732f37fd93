// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <set>
#include <span>
#include <thread>

#include "mc/convert.hpp"
#include "source/stream/sample_range.hpp"
#include "source/stream/unpack.hpp"
#include "support/packed_bytes.hpp"
#include "support/source_files.hpp"

namespace mc {
namespace {

using test::counting_bytes;
using test::error_of;
using test::Folder;

/// A string as a stream.
class TextStream final : public ByteStream {
 public:
  explicit TextStream(std::string text) : text_(std::move(text)) {}
  std::size_t read(std::span<std::byte> out) override {
    const std::size_t n = std::min(out.size(), text_.size() - at_);
    std::memcpy(out.data(), text_.data() + at_, n);
    at_ += n;
    return n;
  }

 private:
  std::string text_;
  std::size_t at_ = 0;
};

/// All of it, so many bytes a read.
std::string unpack(const std::string& packed, std::size_t step = 1U << 16U) {
  const auto stream =
      source::unpacked(std::make_unique<TextStream>(packed), source::packing_of(packed), "packed");
  std::string out;
  for (std::string part(step, '\0');;) {
    const std::size_t n = stream->read(std::as_writable_bytes(std::span(part)));
    out += part.substr(0, n);
    if (n < step) return out;
  }
}

/// A FIFO with a writer of its own.
class Fifo {
 public:
  Fifo(const Folder& folder, std::string bytes) : path_(folder.path("fifo")) {
    ::mkfifo(path_.c_str(), 0600);
    writer_ = std::thread([path = path_, text = std::move(bytes)] {
      const int fd = ::open(path.c_str(), O_WRONLY);
      for (std::size_t at = 0; at < text.size();) {
        const ssize_t n = ::write(fd, text.data() + at, std::min<std::size_t>(text.size() - at, 7));
        if (n <= 0) break;
        at += static_cast<std::size_t>(n);
      }
      ::close(fd);
    });
  }
  ~Fifo() {
    writer_.join();
    ::unlink(path_.c_str());
  }
  Fifo(const Fifo&) = delete;
  Fifo& operator=(const Fifo&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::thread writer_;
};

SourceOptions raw(std::vector<std::int64_t> dims, SampleType type) {
  SourceOptions options;
  options.dims = std::move(dims);
  options.type = type;
  options.streams = true;
  return options;
}

std::string bytes_of(const Slab& slab, std::size_t plane_bytes) {
  std::string out;
  for (const std::byte* plane : slab.planes) {
    out.append(reinterpret_cast<const char*>(plane), plane_bytes);
  }
  return out;
}

TEST(Packing, IsToldByTheFirstBytes) {
  EXPECT_EQ(source::packing_of(test::gzip_bytes("")), source::Packing::gzip);
  EXPECT_EQ(source::packing_of(test::zstd_bytes("")), source::Packing::zstd);
  EXPECT_EQ(source::packing_of("\x1f\x8b\x08"), source::Packing::none);
  EXPECT_EQ(source::packing_of("\x1f\x8b\x08\xe0"), source::Packing::none);
  EXPECT_EQ(source::packing_of(""), source::Packing::none);
}

TEST(Packing, UnpacksMembersAndFramesInAnySteps) {
  const std::string text = counting_bytes(1000);
  const std::string gzip = test::gzip_bytes(text) + test::gzip_bytes("") + test::gzip_bytes(text);
  const std::string zstd = test::zstd_bytes(text) + test::zstd_bytes("") + test::zstd_bytes(text);
  for (const std::size_t step : {1U, 7U, 1000U, 1999U, 4096U}) {
    EXPECT_EQ(unpack(gzip, step), text + text) << step;
    EXPECT_EQ(unpack(zstd, step), text + text) << step;
  }
  EXPECT_EQ(unpack(gzip + std::string(600, '\0')), text + text);
}

TEST(Packing, EveryCutIsFound) {
  for (const std::string& packed :
       {test::gzip_bytes(counting_bytes(40)), test::zstd_bytes(counting_bytes(40))}) {
    for (std::size_t n = source::kPackingBytes; n < packed.size(); ++n) {
      EXPECT_NE(error_of([&] { unpack(packed.substr(0, n)); }), "no error") << n;
    }
  }
}

TEST(Packing, AWindowTooLargeIsRefused) {
  // A frame header that asks for a window of 1 GiB.
  const std::string frame("\x28\xb5\x2f\xfd\x00\xa0\x01\x00\x00", 9);
  EXPECT_EQ(error_of([&] { unpack(frame); }),
            "3 packed: packed by zstd with a window of more than 128 MiB, too much to unpack; "
            "unpack it first, or pack it without --long and --ultra");
}

TEST(Streams, PlanesPassByOnceAndAreShared) {
  const Folder folder;
  const std::string bytes = counting_bytes(2 * 3 * 9);
  const Fifo fifo(folder, bytes);
  const Source source = test::open({fifo.path()}, raw({2, 3, 9}, SampleType::u8));
  PlaneStream& planes = test::stream(source);
  Slab first, second, third;
  planes.read(0, 4, first);
  planes.read(2, 6, second);
  planes.read(5, 9, third);
  EXPECT_EQ(bytes_of(first, 6), bytes.substr(0, 24));
  EXPECT_EQ(bytes_of(second, 6), bytes.substr(12, 24));
  EXPECT_EQ(bytes_of(third, 6), bytes.substr(30));
  EXPECT_EQ(first.planes[2], second.planes[0]);
  EXPECT_EQ(planes.statistics().min, 0);
  EXPECT_EQ(planes.statistics().max, 53);
  EXPECT_EQ(planes.statistics().n_samples, 54U);
}

TEST(Streams, MemoryOfPlanesIsUsedAgain) {
  const Folder folder;
  const Fifo fifo(folder, counting_bytes(6 * 100));
  const Source source = test::open({fifo.path()}, raw({2, 3, 100}, SampleType::u8));
  Slab slab;
  std::set<const std::byte*> places;
  for (std::int32_t k = 0; k < 99; ++k) {
    test::stream(source).read(k, k + 2, slab);
    places.insert(slab.planes.begin(), slab.planes.end());
  }
  EXPECT_LE(places.size(), 3U);
}

TEST(Streams, KeptPlanesAreAnOrdinaryReader) {
  const Folder folder;
  const std::string bytes = counting_bytes(2 * 3 * 9);
  const Fifo fifo(folder, bytes);
  Source source = test::open({fifo.path()}, raw({2, 3, 9}, SampleType::u8));
  EXPECT_TRUE(is_stream(source.reader));
  EXPECT_TRUE(spool_stream(source.reader, silent_progress()));
  EXPECT_FALSE(is_stream(source.reader));
  EXPECT_FALSE(spool_stream(source.reader, silent_progress()));
  EXPECT_EQ(test::all_bytes(test::slabs(source)), bytes);
  EXPECT_EQ(test::all_bytes(test::slabs(source)), bytes);
}

TEST(Streams, HaveNoRegions) {
  const Folder folder;
  const Fifo fifo(folder, counting_bytes(2 * 3 * 9));
  const Source source = test::open({fifo.path()}, raw({2, 3, 9}, SampleType::u8));
  const std::string output = folder.path("part.nrrd");
  VolumeOptions options;
  options.region = IndexBox{{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(error_of([&] { write_volume(source.reader, output, options, silent_progress(), {}); }),
            "2 " + output + ": a region of a stream: copy the stream to disk first");
  EXPECT_FALSE(std::filesystem::exists(output));
}

TEST(Streams, OnlyWhoAsksMeetsThem) {
  const Folder folder;
  const Fifo fifo(folder, counting_bytes(8));
  SourceOptions options = raw({2, 2, 2}, SampleType::u8);
  options.streams = false;
  const Source source = test::open({fifo.path()}, options);
  EXPECT_FALSE(is_stream(source.reader));
  EXPECT_EQ(test::all_bytes(test::slabs(source)), counting_bytes(8));
}

TEST(Streams, WrongLengthsAreFoundWithTheLastPlane) {
  const auto error = [&](std::size_t n_bytes, std::uint64_t skip) {
    const Folder folder;
    const Fifo fifo(folder, counting_bytes(n_bytes));
    SourceOptions options = raw({2, 2, 3}, SampleType::u8);
    options.skip_bytes = skip;
    return error_of([&] {
             const Source source = test::open({fifo.path()}, options);
             Slab slab;
             test::stream(source).read(0, 2, slab);
             test::stream(source).read(1, 3, slab);
           })
        .substr(2 + fifo.path().size());
  };
  EXPECT_EQ(error(11, 0), ": 11 bytes, but 2x2x3 u8 needs 12; check --dims and --type");
  EXPECT_EQ(error(13, 0), ": at least 13 bytes, but 2x2x3 u8 needs 12; check --dims and --type");
  EXPECT_EQ(error(14, 3),
            ": 14 bytes, but 2x2x3 u8 after 3 skipped bytes needs 15; check --dims, "
            "--type and --skip");
  EXPECT_EQ(error(2, 3),
            ": 2 bytes, but 2x2x3 u8 after 3 skipped bytes needs 15; check --dims, "
            "--type and --skip");
}

TEST(SampleRange, IsThatOfMeasuredFields) {
  // 40000 floats: whole lanes, a tail, and every kind of number that is none.
  std::vector<float> samples(40003);
  for (std::size_t n = 0; n < samples.size(); ++n) {
    samples[n] = static_cast<float>(n % 977) - 300;
  }
  samples[17] = samples[39999] = std::numeric_limits<float>::quiet_NaN();
  samples[18000] = std::numeric_limits<float>::infinity();
  samples[40002] = -std::numeric_limits<float>::infinity();
  samples[20000] = 5000;
  samples[40001] = -7000;
  for (const std::endian endian : {std::endian::little, std::endian::big}) {
    std::vector<float> stored = samples;
    if (endian == std::endian::big) {
      for (float& v : stored)
        v = std::bit_cast<float>(__builtin_bswap32(std::bit_cast<std::uint32_t>(v)));
    }
    source::SampleRange range(SampleType::f32, endian);
    range.add(reinterpret_cast<const std::byte*>(stored.data()), stored.size());
    EXPECT_EQ(range.seen().n_samples, 40003U);
    EXPECT_EQ(range.seen().n_nan, 2U);
    EXPECT_EQ(range.seen().n_infinite, 2U);
    EXPECT_EQ(range.seen().min, -7000);
    EXPECT_EQ(range.seen().max, 5000);
    EXPECT_TRUE(range.spans(0));
    EXPECT_FALSE(range.spans(5000));
  }
}

TEST(SampleRange, OfEveryType) {
  for (const char* name : {"u8", "i8", "u16", "i16", "u32", "i32", "i64", "f16", "f32", "f64"}) {
    const SampleType type = *sample_type_named(name);
    const std::string zeros(100 * sample_size(type), '\0');
    source::SampleRange range(type, std::endian::native);
    EXPECT_TRUE(std::isnan(range.seen().min)) << name;
    range.add(reinterpret_cast<const std::byte*>(zeros.data()), 100);
    EXPECT_EQ(range.seen().min, 0) << name;
    EXPECT_EQ(range.seen().max, 0) << name;
    EXPECT_EQ(range.seen().n_samples, 100U) << name;
  }
}

}  // namespace
}  // namespace mc
