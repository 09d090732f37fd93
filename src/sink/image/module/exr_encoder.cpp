// SPDX-License-Identifier: MIT
#if MC_WITH_EXR

#include <openexr.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "field/volume_names.hpp"
#include "sink/image/module/encode.hpp"

// OpenEXR through its core library: one part of scan lines, one channel Y, ZIP compression.

namespace mc::sink {

namespace {

class Writing {
 public:
  explicit Writing(Buffer<std::byte>& out) {
    exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
    start.error_handler_fn = [](exr_const_context_t, exr_result_t, const char*) {};
    start.user_data = &out;
    start.write_fn = put;
    check(::exr_start_write(&context_, "picture", EXR_WRITE_FILE_DIRECTLY, &start));
  }
  /// Also where finish() was not called.
  ~Writing() { ::exr_finish(&context_); }
  Writing(const Writing&) = delete;
  Writing& operator=(const Writing&) = delete;

  [[nodiscard]] exr_context_t get() const { return context_; }
  static void check(exr_result_t result) {
    if (result == EXR_ERR_SUCCESS) return;
    throw Error(ErrorKind::output, "",
                "cannot write OpenEXR: " + std::string(::exr_get_default_error_message(result)));
  }
  void text(const char* name, const std::string& value) const {
    if (!value.empty()) check(::exr_attr_set_string(context_, 0, name, value.c_str()));
  }
  /// Writes the table of chunks too.
  void finish() { check(::exr_finish(&context_)); }

 private:
  static std::int64_t put(exr_const_context_t /*context*/, void* user, const void* bytes,
                          std::uint64_t n, std::uint64_t offset,
                          exr_stream_error_func_ptr_t /*error*/) {
    auto& out = *static_cast<Buffer<std::byte>*>(user);
    try {
      if (out.size() < offset + n) out.resize(offset + n);
    } catch (const std::bad_alloc&) {
      return -1;
    }
    std::memcpy(out.data() + offset, bytes, n);
    return static_cast<std::int64_t>(n);
  }

  exr_context_t context_ = nullptr;
};

exr_pixel_type_t pixel_type(SampleType type) {
  if (type == SampleType::u32) return EXR_PIXEL_UINT;
  return type == SampleType::f16 ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT;
}

/// The map of the volume's slice `index`; its rows are images of the unit steps, since OpenEXR
/// multiplies row vectors from the left.
exr_attr_m44d_t map_of(const Volume& volume, std::int32_t index) {
  const Affine& whole = volume.lattice.to_world;
  const Index3& lo = volume.lattice.box.lo;
  const Vec3 first = whole({double(lo[0]), double(lo[1]), double(lo[2]) + index});
  std::array<double, 16> rows{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t column = 0; column < 3; ++column) {
      rows[4 * column + axis] = whole.m[4 * axis + column];
    }
    rows[12 + axis] = first[axis];
  }
  rows[15] = 1;
  exr_attr_m44d_t out;
  std::memcpy(&out, rows.data(), sizeof out);
  return out;
}

void describe(const Writing& file, const SliceOf& slice) {
  const Volume& volume = *slice.volume;
  const exr_attr_m44d_t map = map_of(volume, slice.index);
  Writing::check(::exr_attr_set_m44d(file.get(), 0, "mc_to_world", &map));
  Writing::check(::exr_attr_set_int(file.get(), 0, "mc_slice", slice.index));
  Writing::check(::exr_attr_set_int(file.get(), 0, "mc_slices", slice.count));
  file.text("mc_name", volume.name);
  file.text("mc_class", field::class_name(volume.cls));
  file.text("mc_border", volume.border ? field::border_name(*volume.border) : "");
  if (volume.iso) {
    Writing::check(::exr_attr_set_double(file.get(), 0, "mc_iso", *volume.iso));
  }
  if (volume.frame != Frame::none) {
    file.text("mc_frame", volume.frame == Frame::lps ? "lps" : "ras");
  }
  if (volume.units != Units::unknown) {
    file.text("mc_units", volume.units == Units::mm ? "mm" : "m");
  }
}

/// One chunk of rows at a time.
void write_rows(const Writing& file, const Picture& picture) {
  const std::size_t size = sample_size(picture.type);
  const std::size_t row_bytes = static_cast<std::size_t>(picture.width) * size;
  exr_encode_pipeline_t pipeline{};  // all zeros, as EXR_ENCODE_PIPELINE_INITIALIZER
  std::int32_t lines = 0;
  exr_result_t result = ::exr_get_scanlines_per_chunk(file.get(), 0, &lines);
  for (std::int64_t y = 0; y < picture.height && result == EXR_ERR_SUCCESS; y += lines) {
    exr_chunk_info_t chunk;
    result = ::exr_write_scanline_chunk_info(file.get(), 0, static_cast<int>(y), &chunk);
    if (result != EXR_ERR_SUCCESS) break;
    result = y == 0 ? ::exr_encoding_initialize(file.get(), 0, &chunk, &pipeline)
                    : ::exr_encoding_update(file.get(), 0, &chunk, &pipeline);
    if (result != EXR_ERR_SUCCESS) break;
    exr_coding_channel_info_t& channel = pipeline.channels[0];
    channel.user_bytes_per_element = static_cast<std::int16_t>(size);
    channel.user_data_type = channel.data_type;
    channel.user_pixel_stride = static_cast<std::int32_t>(size);
    channel.user_line_stride = static_cast<std::int32_t>(row_bytes);
    channel.encode_from_ptr = reinterpret_cast<const std::uint8_t*>(picture.samples.data()) +
                              static_cast<std::size_t>(y) * row_bytes;
    if (y == 0) result = ::exr_encoding_choose_default_routines(file.get(), 0, &pipeline);
    if (result == EXR_ERR_SUCCESS) result = ::exr_encoding_run(file.get(), 0, &pipeline);
  }
  ::exr_encoding_destroy(file.get(), &pipeline);
  Writing::check(result);
}

}  // namespace

void encode_exr(const Picture& picture, const SliceOf& slice, const SinkOptions& options,
                Buffer<std::byte>& out) {
  Writing file(out);
  int part = 0;
  Writing::check(::exr_add_part(file.get(), "", EXR_STORAGE_SCANLINE, &part));
  Writing::check(::exr_initialize_required_attr_simple(file.get(), part, picture.width,
                                                       picture.height, EXR_COMPRESSION_ZIP));
  Writing::check(::exr_add_channel(file.get(), part, "Y", pixel_type(picture.type),
                                   EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1));
  if (slice.volume != nullptr) describe(file, slice);
  for (const auto& [key, value] : options.provenance) file.text(key.c_str(), value);
  Writing::check(::exr_write_header(file.get()));
  write_rows(file, picture);
  file.finish();
}

}  // namespace mc::sink

#endif
