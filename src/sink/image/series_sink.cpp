// SPDX-License-Identifier: MIT
#include "sink/image/series_sink.hpp"

#include <fmt/format.h>

#include <bit>
#include <cassert>
#include <cstring>
#include <filesystem>
#include <utility>
#include <vector>

#include "base/parallel.hpp"
#include "field/visit_type.hpp"
#include "sink/image/encode_image.hpp"
#include "sink/image/exr_samples.hpp"
#include "sink/output_file.hpp"

// A series of slices: every file is a partial until the last is written.

namespace mc::sink {

namespace {

/// "slices.####.exr" around its number.
struct SeriesName {
  std::string before;
  std::string after;
  std::size_t digits = 0;

  explicit SeriesName(const std::string& path) {
    const std::size_t last = path.rfind('#');
    if (last == std::string::npos || path.find('/', last) != std::string::npos) {
      throw Error(ErrorKind::usage, path == "-" ? "<stdout>" : path,
                  "a volume becomes a series of OpenEXR pictures: expected a name with #",
                  "name it NAME.####.exr, or write one picture by --slice");
    }
    const std::size_t before_first = path.find_last_not_of('#', last);
    const std::size_t first = before_first == std::string::npos ? 0 : before_first + 1;
    before = path.substr(0, first);
    after = path.substr(last + 1);
    digits = last + 1 - first;
  }
  [[nodiscard]] std::string slice(std::int32_t index) const {
    return fmt::format("{}{:0{}}{}", before, index + 1, digits, after);
  }
};

/// A plane as a picture: upside down, in native byte order.
Picture picture_of(const Volume& volume, const std::byte* plane, std::size_t row_stride_bytes) {
  const Index3 dims = volume.lattice.dims();
  Picture picture{dims[0], dims[1], volume.type, {}};
  const std::size_t row_bytes = static_cast<std::size_t>(dims[0]) * sample_size(volume.type);
  const auto n_rows = static_cast<std::size_t>(dims[1]);
  picture.samples.resize(row_bytes * n_rows);
  for (std::size_t j = 0; j < n_rows; ++j) {
    std::memcpy(picture.samples.data() + (n_rows - 1 - j) * row_bytes, plane + j * row_stride_bytes,
                row_bytes);
  }
  if (volume.endian != std::endian::native) {
    field::visit_type(volume.type, [&]<class T>(field::TypeTag<T>) {
      for (std::size_t at = 0; at < picture.samples.size(); at += sizeof(T)) {
        const T sample = field::load_sample<T, true>(picture.samples.data() + at);
        std::memcpy(picture.samples.data() + at, &sample, sizeof(T));
      }
    });
  }
  return picture;
}

class SeriesSink final : public VolumeSink {
 public:
  SeriesSink(const std::string& path, SinkOptions options)
      : name_(path), options_(std::move(options)) {
    add_file();  // a folder that cannot be written shows before the work
  }

  void begin(const Volume& volume) override {
    volume_ = volume;
    type_ = exr_type(volume.type, files_.front()->place());
    const std::int32_t n_slices = volume.lattice.dims()[2];
    for (std::int32_t index = 1; !options_.force && index < n_slices; ++index) {
      std::error_code ignored;
      if (std::filesystem::exists(name_.slice(index), ignored)) {
        throw Error(ErrorKind::output, name_.slice(index), "exists", "add --force to replace it");
      }
    }
  }

  void write(const Slab& slab) override {
    assert(slab.k0 == n_written_);
    packed_.resize(std::max(packed_.size(), slab.planes.size()));
    base::for_ranges(slab.planes.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t n = begin; n < end; ++n) {
        pack(slab.planes[n], slab.row_stride_bytes, slab.k0 + static_cast<std::int32_t>(n),
             packed_[n]);
      }
    });
    for (std::size_t n = 0; n < slab.planes.size(); ++n) {
      if (n_written_ > 0) add_file();
      files_.back()->append(packed_[n]);
      files_.back()->close();
      ++n_written_;
    }
  }

  bool write_sparse(const LeafReader& /*reader*/) override { return false; }

  void finish() override {
    if (n_written_ != volume_.lattice.dims()[2]) {
      throw Error(ErrorKind::internal, name_.slice(n_written_), "was not written");
    }
    std::vector<OutputFile*> files;
    for (const auto& file : files_) files.push_back(file.get());
    OutputFile::commit_all(files);
  }

 private:
  void add_file() {
    files_.push_back(
        std::make_unique<OutputFile>(name_.slice(n_written_), output_options(options_, true)));
  }
  void pack(const std::byte* plane, std::size_t row_stride_bytes, std::int32_t index,
            Buffer<std::byte>& out) const {
    const std::string& place = files_.front()->place();
    Picture picture = picture_of(volume_, plane, row_stride_bytes);
    if (type_ != picture.type) picture = exr_picture(picture, place);
    encode_image(ImageKind::exr, place, picture, {&volume_, index, volume_.lattice.dims()[2]},
                 options_, out);
  }

  SeriesName name_;
  SinkOptions options_;
  Volume volume_;
  SampleType type_ = SampleType::f32;  // of the files
  std::vector<std::unique_ptr<OutputFile>> files_;
  std::vector<Buffer<std::byte>> packed_;  // kept from write to write
  std::int32_t n_written_ = 0;
};

}  // namespace

std::unique_ptr<VolumeSink> open_exr_series(const std::string& path, const SinkOptions& options) {
  return std::make_unique<SeriesSink>(path, options);
}

}  // namespace mc::sink
