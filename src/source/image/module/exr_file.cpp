// SPDX-License-Identifier: MIT
#if MC_WITH_EXR

#include <algorithm>
#include <cstring>

#include "mc/base.hpp"
#include "source/image/module/exr_context.hpp"

// OpenEXR through its core library: scan lines and tiles (the full resolution of mipmaps), every
// compression, any number of parts. Deep parts and subsampled channels are left out.

namespace mc::source {

namespace {

/// Unpacked bytes of one chunk (a run of rows or a tile) of all channels.
constexpr std::uint64_t kMostChunkBytes = std::uint64_t{1} << 30;

SampleType type_of(exr_pixel_type_t type) {
  if (type == EXR_PIXEL_UINT) return SampleType::u32;
  return type == EXR_PIXEL_HALF ? SampleType::f16 : SampleType::f32;
}

/// Decodes one channel chunk by chunk; buffers serve all chunks of a picture.
class ChunkDecoder {
 public:
  ChunkDecoder(const ExrContext& file, int part, int channel)
      : file_(file), part_(part), channel_(channel) {}
  ~ChunkDecoder() { ::exr_decoding_destroy(file_.get(), &pipeline_); }
  ChunkDecoder(const ChunkDecoder&) = delete;
  ChunkDecoder& operator=(const ChunkDecoder&) = delete;

  /// The chunk's rows of the channel, one after the other.
  const std::byte* decode(const exr_chunk_info_t& chunk, std::size_t sample_bytes) {
    if (chunk.unpacked_size > kMostChunkBytes) {
      throw Error(ErrorKind::limit, file_.place(),
                  "has chunks of " + std::to_string(chunk.unpacked_size) +
                      " bytes: expected at most " + std::to_string(kMostChunkBytes));
    }
    const auto width = static_cast<std::size_t>(chunk.width);
    samples_.resize(width * static_cast<std::size_t>(chunk.height) * sample_bytes);
    file_.check(begun_ ? ::exr_decoding_update(file_.get(), part_, &chunk, &pipeline_)
                       : ::exr_decoding_initialize(file_.get(), part_, &chunk, &pipeline_));
    for (int n = 0; n < pipeline_.channel_count; ++n) pipeline_.channels[n].decode_to_ptr = nullptr;
    exr_coding_channel_info_t& wanted = pipeline_.channels[channel_];
    wanted.decode_to_ptr = reinterpret_cast<std::uint8_t*>(samples_.data());
    wanted.user_bytes_per_element = static_cast<std::int16_t>(sample_bytes);
    wanted.user_data_type = wanted.data_type;
    wanted.user_pixel_stride = static_cast<std::int32_t>(sample_bytes);
    wanted.user_line_stride = static_cast<std::int32_t>(width * sample_bytes);
    if (!begun_) {
      file_.check(::exr_decoding_choose_default_routines(file_.get(), part_, &pipeline_));
      begun_ = true;
    }
    exr_result_t result = ::exr_decoding_run(file_.get(), part_, &pipeline_);
    const bool is_b44 =
        chunk.compression == EXR_COMPRESSION_B44 || chunk.compression == EXR_COMPRESSION_B44A;
    // OpenEXR 3.1 says so of blocks that end too soon; memory was bounded above.
    if (is_b44 && result == EXR_ERR_OUT_OF_MEMORY) result = EXR_ERR_CORRUPT_CHUNK;
    file_.check(result);
    return samples_.data();
  }

 private:
  const ExrContext& file_;
  int part_;
  int channel_;
  bool begun_ = false;
  exr_decode_pipeline_t pipeline_{};  // all zeros, as EXR_DECODE_PIPELINE_INITIALIZER
  Buffer<std::byte> samples_;
};

/// Where parts and channels that are read stand in the file.
struct InFile {
  int part = 0;
  std::vector<int> channels;
};

class ExrFile final : public ImageFile {
 public:
  ExrFile(const std::string& place, std::span<const std::byte> bytes) : file_(place, bytes) {
    int n_parts = 0;
    file_.check(::exr_get_count(file_.get(), &n_parts));
    for (int part = 0; part < n_parts; ++part) add(part);
    if (parts_.empty()) {
      throw Error(ErrorKind::input, place,
                  "holds no flat picture: deep parts and subsampled channels are not read");
    }
  }

  [[nodiscard]] const std::vector<ImagePart>& parts() const override { return parts_; }

  void read(std::size_t part, std::size_t channel, std::byte* out,
            std::ptrdiff_t row_stride_bytes) const override {
    const InFile& from = in_file_[part];
    exr_storage_t storage = EXR_STORAGE_SCANLINE;
    file_.check(::exr_get_storage(file_.get(), from.part, &storage));
    ChunkDecoder decoder(file_, from.part, from.channels[channel]);
    const std::size_t sample_bytes = sample_size(parts_[part].channels[channel].type);
    const ImagePart& picture = parts_[part];
    const auto put = [&](const exr_chunk_info_t& chunk, std::int64_t column, std::int64_t row) {
      if (column + chunk.width > picture.width || row + chunk.height > picture.height) {
        throw Error(ErrorKind::input, file_.place(), "damaged OpenEXR file: a chunk is too large");
      }
      const std::byte* samples = decoder.decode(chunk, sample_bytes);
      const std::size_t n_bytes = static_cast<std::size_t>(chunk.width) * sample_bytes;
      std::byte* to = out + row * row_stride_bytes + column * std::ptrdiff_t(sample_bytes);
      for (std::int32_t r = 0; r < chunk.height; ++r) {
        std::memcpy(to + r * row_stride_bytes, samples + std::size_t(r) * n_bytes, n_bytes);
      }
    };
    if (storage == EXR_STORAGE_TILED) {
      for_tiles(from.part, picture, put);
    } else {
      for_lines(from.part, picture, put);
    }
  }

 private:
  void add(int part);
  void check_chunks(int part) const;
  template <class F>
  void for_tiles(int part, const ImagePart& picture, F&& put) const;
  template <class F>
  void for_lines(int part, const ImagePart& picture, F&& put) const;

  ExrContext file_;
  std::vector<ImagePart> parts_;
  std::vector<InFile> in_file_;
};

/// A file holds the offset of each chunk, and of each chunk at least its place and its size.
void ExrFile::check_chunks(int part) const {
  constexpr std::uint64_t kLeastBytes = 16;
  std::int32_t n_chunks = 0;
  file_.check(::exr_get_chunk_count(file_.get(), part, &n_chunks));
  if (n_chunks < 1 || static_cast<std::uint64_t>(n_chunks) * kLeastBytes > file_.size()) {
    throw Error(ErrorKind::input, file_.place(),
                "damaged OpenEXR file: " + std::to_string(n_chunks) + " chunks do not fit into " +
                    std::to_string(file_.size()) + " bytes");
  }
}

void ExrFile::add(int part) {
  exr_storage_t storage = EXR_STORAGE_SCANLINE;
  file_.check(::exr_get_storage(file_.get(), part, &storage));
  if (storage != EXR_STORAGE_SCANLINE && storage != EXR_STORAGE_TILED) return;
  exr_attr_box2i_t data;
  exr_attr_box2i_t shown;
  const exr_attr_chlist_t* channels = nullptr;
  file_.check(::exr_get_data_window(file_.get(), part, &data));
  file_.check(::exr_get_display_window(file_.get(), part, &shown));
  file_.check(::exr_get_channels(file_.get(), part, &channels));
  check_chunks(part);
  ImagePart picture;
  const char* name = nullptr;
  if (::exr_get_name(file_.get(), part, &name) == EXR_ERR_SUCCESS && name != nullptr) {
    picture.name = name;
  }
  picture.width = static_cast<std::int32_t>(std::int64_t{data.max.x} - data.min.x + 1);
  picture.height = static_cast<std::int32_t>(std::int64_t{data.max.y} - data.min.y + 1);
  picture.offset = {std::int64_t{data.min.x} - shown.min.x, std::int64_t{shown.max.y} - data.max.y};
  picture.note = slice_note(file_, part);
  InFile places{part, {}};
  for (int n = 0; n < channels->num_channels; ++n) {
    const exr_attr_chlist_entry_t& channel = channels->entries[n];
    if (channel.x_sampling != 1 || channel.y_sampling != 1) continue;
    picture.channels.push_back({channel.name.str, type_of(channel.pixel_type)});
    places.channels.push_back(n);
  }
  if (picture.channels.empty()) return;
  parts_.push_back(std::move(picture));
  in_file_.push_back(std::move(places));
}

template <class F>
void ExrFile::for_tiles(int part, const ImagePart& picture, F&& put) const {
  std::int32_t width = 0;
  std::int32_t height = 0;
  file_.check(::exr_get_tile_sizes(file_.get(), part, 0, 0, &width, &height));
  for (std::int64_t y = 0; y < picture.height; y += height) {
    for (std::int64_t x = 0; x < picture.width; x += width) {
      exr_chunk_info_t chunk;
      file_.check(::exr_read_tile_chunk_info(file_.get(), part, static_cast<int>(x / width),
                                             static_cast<int>(y / height), 0, 0, &chunk));
      put(chunk, x, y);
    }
  }
}

template <class F>
void ExrFile::for_lines(int part, const ImagePart& picture, F&& put) const {
  exr_attr_box2i_t data;
  std::int32_t lines = 0;
  file_.check(::exr_get_data_window(file_.get(), part, &data));
  file_.check(::exr_get_scanlines_per_chunk(file_.get(), part, &lines));
  for (std::int64_t y = 0; y < picture.height; y += lines) {
    exr_chunk_info_t chunk;
    file_.check(::exr_read_scanline_chunk_info(file_.get(), part, static_cast<int>(data.min.y + y),
                                               &chunk));
    put(chunk, 0, y);
  }
}

}  // namespace

ImageFile* open_exr(const std::string& place, std::span<const std::byte> bytes) {
  return new ExrFile(place, bytes);
}

}  // namespace mc::source

#endif
