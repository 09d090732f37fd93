// SPDX-License-Identifier: MIT
#if MC_WITH_PNG

#include <png.h>

#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>
#include <string>
#include <vector>

#include "sink/image/module/encode.hpp"

// Grey PNG of 8 or 16 bits. libpng reports errors by longjmp: what may jump runs in one function
// that has nothing to destroy.

namespace mc::sink {

namespace {

struct Writing {
  Buffer<std::byte>* out = nullptr;
  std::array<char, 200> why{};
  png_structp png = nullptr;
  png_infop info = nullptr;

  explicit Writing(Buffer<std::byte>& bytes) : out(&bytes) {
    png = ::png_create_write_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
    info = png == nullptr ? nullptr : ::png_create_info_struct(png);
    if (info == nullptr) {
      ::png_destroy_write_struct(&png, nullptr);
      throw std::bad_alloc();
    }
    ::png_set_write_fn(png, this, put, flush);
  }
  ~Writing() { ::png_destroy_write_struct(&png, &info); }
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;

  static void fail(png_structp png, png_const_charp text) {
    auto& why = static_cast<Writing*>(::png_get_error_ptr(png))->why;
    std::strncpy(why.data(), text, why.size() - 1);
    ::png_longjmp(png, 1);
  }
  static void ignore(png_structp /*png*/, png_const_charp /*text*/) {}
  static void flush(png_structp /*png*/) {}
  static void put(png_structp png, png_bytep bytes, std::size_t n) {
    auto& out = *static_cast<Writing*>(::png_get_io_ptr(png))->out;
    try {
      const std::size_t size = out.size();
      out.resize(size + n);
      std::memcpy(out.data() + size, bytes, n);
    } catch (const std::bad_alloc&) {
      ::png_error(png, "out of memory");
    }
  }
};

bool write_all(Writing& writing, const Picture& picture, std::vector<png_text>& texts,
               std::vector<png_bytep>& rows) noexcept {
  if (setjmp(png_jmpbuf(writing.png)) != 0) return false;
  const int depth = picture.type == SampleType::u16 ? 16 : 8;
  ::png_set_IHDR(writing.png, writing.info, static_cast<png_uint_32>(picture.width),
                 static_cast<png_uint_32>(picture.height), depth, PNG_COLOR_TYPE_GRAY,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  ::png_set_text(writing.png, writing.info, texts.data(), static_cast<int>(texts.size()));
  ::png_write_info(writing.png, writing.info);
  if (std::endian::native == std::endian::little) ::png_set_swap(writing.png);
  ::png_write_image(writing.png, rows.data());
  ::png_write_end(writing.png, writing.info);
  return true;
}

}  // namespace

void encode_png(const Picture& picture, const SinkOptions& options, Buffer<std::byte>& out) {
  std::vector<std::pair<std::string, std::string>> provenance = options.provenance;
  std::vector<png_text> texts;
  for (auto& [key, value] : provenance) {
    png_text text{};
    text.compression = PNG_TEXT_COMPRESSION_NONE;
    text.key = key.data();
    text.text = value.data();
    text.text_length = value.size();
    texts.push_back(text);
  }
  const std::size_t row_bytes = static_cast<std::size_t>(picture.width) * sample_size(picture.type);
  std::vector<png_bytep> rows;
  for (std::size_t r = 0; r < static_cast<std::size_t>(picture.height); ++r) {
    // libpng takes rows that it does not change by a pointer that could.
    rows.push_back(reinterpret_cast<png_bytep>(
        const_cast<std::byte*>(picture.samples.data() + r * row_bytes)));
  }
  Writing writing(out);
  if (!write_all(writing, picture, texts, rows)) {
    throw Error(ErrorKind::output, "", "cannot write PNG: " + std::string(writing.why.data()));
  }
}

}  // namespace mc::sink

#endif
