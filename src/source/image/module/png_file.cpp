// SPDX-License-Identifier: MIT
#if MC_WITH_PNG

#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/checked.hpp"
#include "mc/base.hpp"
#include "source/image/module/image_file.hpp"

// PNG: grey, colour and palettes of any depth, 1 to 4 bits widened to 8; interlaced or not. Numbers
// are what the file holds: neither gamma nor a colour profile is applied.
//
// libpng reports errors by longjmp. What may jump runs in guarded(), which has nothing to destroy.

namespace mc::source {

namespace {

/// Deflate shrinks no more than this: a file that claims more rows is cut off or lies.
constexpr std::uint64_t kMostInflation = 1032;

class Reading {
 public:
  Reading(std::string place, std::span<const std::byte> bytes)
      : place_(std::move(place)), left_(bytes) {
    png_ = ::png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &Reading::fail, &Reading::ignore);
    info_ = png_ == nullptr ? nullptr : ::png_create_info_struct(png_);
    if (info_ == nullptr) {
      ::png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
    ::png_set_read_fn(png_, this, &Reading::take);
    constexpr png_uint_32 kMost = 0x7FFFFFFF;
    ::png_set_user_limits(png_, kMost, kMost);
  }
  ~Reading() { ::png_destroy_read_struct(&png_, &info_, nullptr); }
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;

  /// Runs `f(png, info)`, which may only call libpng. Errors   input.
  template <class F>
  void guarded(F&& f) {
    if (!runs(f)) throw Error(ErrorKind::input, place_, "damaged PNG: " + std::string(why_.data()));
  }

 private:
  template <class F>
  bool runs(F& f) noexcept {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    f(png_, info_);
    return true;
  }
  static void fail(png_structp png, png_const_charp text) {
    auto& why = static_cast<Reading*>(::png_get_error_ptr(png))->why_;
    std::strncpy(why.data(), text, why.size() - 1);
    ::png_longjmp(png, 1);
  }
  static void ignore(png_structp /*png*/, png_const_charp /*text*/) {}
  static void take(png_structp png, png_bytep out, std::size_t n) {
    auto& left = static_cast<Reading*>(::png_get_io_ptr(png))->left_;
    if (n > left.size()) ::png_error(png, "the file ends too soon");
    std::memcpy(out, left.data(), n);
    left = left.subspan(n);
  }

  std::string place_;
  std::span<const std::byte> left_;
  std::array<char, 200> why_{};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

/// The picture as rows of 8- or 16-bit numbers in native byte order.
struct Shape {
  png_uint_32 width = 0;
  png_uint_32 height = 0;
  std::size_t n_channels = 0;
  std::size_t channel_bytes = 0;
  std::size_t row_bytes = 0;
};

/// Reads the header. Errors   input: more rows than the file can hold. libpng itself takes memory
/// for a row in the next step.
Shape read_header(Reading& reading, const std::string& place, std::size_t file_bytes) {
  Shape shape;
  std::size_t packed_row_bytes = 0;
  reading.guarded([&](png_structp png, png_infop info) {
    ::png_read_info(png, info);
    shape.width = ::png_get_image_width(png, info);
    shape.height = ::png_get_image_height(png, info);
    packed_row_bytes = ::png_get_rowbytes(png, info);
  });
  const auto packed = base::checked_mul<std::uint64_t>(packed_row_bytes, shape.height);
  if (!packed || *packed / kMostInflation > file_bytes) {
    throw Error(ErrorKind::input, place,
                "damaged PNG: " + std::to_string(file_bytes) + " bytes cannot hold " +
                    std::to_string(shape.width) + "x" + std::to_string(shape.height) + " pixels");
  }
  return shape;
}

/// Reads the header and sets the transformations up.
Shape prepare(Reading& reading, const std::string& place, std::size_t file_bytes) {
  Shape shape = read_header(reading, place, file_bytes);
  reading.guarded([&shape](png_structp png, png_infop info) {
    const int colour = ::png_get_color_type(png, info);
    if (colour == PNG_COLOR_TYPE_PALETTE) ::png_set_palette_to_rgb(png);
    if (colour == PNG_COLOR_TYPE_GRAY) ::png_set_expand_gray_1_2_4_to_8(png);
    if (std::endian::native == std::endian::little) ::png_set_swap(png);
    ::png_set_interlace_handling(png);
    ::png_read_update_info(png, info);
    shape.n_channels = ::png_get_channels(png, info);
    shape.channel_bytes = std::size_t{::png_get_bit_depth(png, info)} / 8;
    shape.row_bytes = ::png_get_rowbytes(png, info);
  });
  return shape;
}

class PngFile final : public ImageFile {
 public:
  PngFile(std::string place, std::span<const std::byte> bytes)
      : place_(std::move(place)), bytes_(bytes) {
    Reading reading(place_, bytes_);
    const Shape shape = prepare(reading, place_, bytes_.size());
    constexpr std::string_view kNames[] = {"Y", "YA", "RGB", "RGBA"};
    ImagePart part;
    part.width = static_cast<std::int32_t>(shape.width);
    part.height = static_cast<std::int32_t>(shape.height);
    for (const char name : kNames[shape.n_channels - 1]) {
      part.channels.push_back(
          {{name}, shape.channel_bytes == 2 ? SampleType::u16 : SampleType::u8});
    }
    parts_.push_back(std::move(part));
  }

  [[nodiscard]] const std::vector<ImagePart>& parts() const override { return parts_; }

  void read(std::size_t /*part*/, std::size_t channel, std::byte* out,
            std::ptrdiff_t row_stride_bytes) const override {
    Reading reading(place_, bytes_);
    const Shape shape = prepare(reading, place_, bytes_.size());
    const bool direct = shape.n_channels == 1;
    Buffer<std::byte> pixels(direct ? 0 : shape.row_bytes * shape.height);
    std::vector<png_bytep> rows(shape.height);
    for (std::size_t r = 0; r < rows.size(); ++r) {
      std::byte* row = direct ? out + static_cast<std::ptrdiff_t>(r) * row_stride_bytes
                              : pixels.data() + r * shape.row_bytes;
      rows[r] = reinterpret_cast<png_bytep>(row);
    }
    reading.guarded([&rows](png_structp png, png_infop info) {
      ::png_read_image(png, rows.data());
      ::png_read_end(png, info);
    });
    for (std::size_t r = 0; !direct && r < rows.size(); ++r) {
      pick(shape, pixels.data() + r * shape.row_bytes, channel,
           out + static_cast<std::ptrdiff_t>(r) * row_stride_bytes);
    }
  }

 private:
  static void pick(const Shape& shape, const std::byte* row, std::size_t channel, std::byte* out) {
    const std::size_t size = shape.channel_bytes;
    for (std::size_t i = 0; i < shape.width; ++i) {
      std::memcpy(out + i * size, row + (i * shape.n_channels + channel) * size, size);
    }
  }

  std::string place_;
  std::span<const std::byte> bytes_;
  std::vector<ImagePart> parts_;
};

}  // namespace

ImageFile* open_png(const std::string& place, std::span<const std::byte> bytes) {
  return new PngFile(place, bytes);
}

}  // namespace mc::source

#endif
