// SPDX-License-Identifier: MIT
#include <string>

#include "mc/sink.hpp"
#include "sink/image/encode_image.hpp"
#include "sink/image/exr_samples.hpp"
#include "sink/image/image_formats.hpp"
#include "sink/output_file.hpp"

// Single pictures.

namespace mc::sink {

namespace {

class ImageSink final : public PictureSink {
 public:
  ImageSink(const std::string& path, const SinkOptions& options, ImageKind kind)
      : options_(options), kind_(kind), file_(path, output_options(options, true)) {}

  void write(const Picture& picture,
             const std::vector<std::pair<std::string, std::string>>& texts) override {
    options_.provenance.insert(options_.provenance.end(), texts.begin(), texts.end());
    if (kind_ == ImageKind::png) {
      check_grey(picture.type);
      put(picture);
    } else if (exr_type(picture.type, file_.place()) == picture.type) {
      put(picture);
    } else {
      put(exr_picture(picture, file_.place()));
    }
  }

 private:
  void check_grey(SampleType type) const {
    if (type == SampleType::u8 || type == SampleType::u16) return;
    throw Error(ErrorKind::usage, file_.place(),
                std::string("PNG holds u8 or u16, not ") + sample_name(type));
  }
  void put(const Picture& picture) {
    Buffer<std::byte> bytes;
    encode_image(kind_, file_.place(), picture, {}, options_, bytes);
    file_.append(bytes);
    file_.commit();
  }

  SinkOptions options_;
  ImageKind kind_;
  OutputFile file_;
};

}  // namespace

std::unique_ptr<PictureSink> open_exr_picture(const std::string& path, const SinkOptions& options) {
  return std::make_unique<ImageSink>(path, options, ImageKind::exr);
}

std::unique_ptr<PictureSink> open_png_picture(const std::string& path, const SinkOptions& options) {
  return std::make_unique<ImageSink>(path, options, ImageKind::png);
}

}  // namespace mc::sink
