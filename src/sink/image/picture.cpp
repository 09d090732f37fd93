// SPDX-License-Identifier: MIT
#include <string>

#include "mc/sink.hpp"
#include "sink/image/encode_image.hpp"
#include "sink/image/exr_samples.hpp"
#include "sink/output_file.hpp"

// Single pictures.

namespace mc {

namespace {

class ImageSink final : public PictureSink {
 public:
  ImageSink(const std::string& path, const SinkOptions& options, sink::ImageKind kind)
      : options_(options), kind_(kind), file_(path, sink::output_options(options, true)) {}

  void write(const Picture& picture,
             const std::vector<std::pair<std::string, std::string>>& texts) override {
    options_.provenance.insert(options_.provenance.end(), texts.begin(), texts.end());
    if (kind_ == sink::ImageKind::png) {
      check_grey(picture.type);
      put(picture);
    } else if (sink::exr_type(picture.type, file_.place()) == picture.type) {
      put(picture);
    } else {
      put(sink::exr_picture(picture, file_.place()));
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
    sink::encode_image(kind_, file_.place(), picture, {}, options_, bytes);
    file_.append(bytes);
    file_.commit();
  }

  SinkOptions options_;
  sink::ImageKind kind_;
  sink::OutputFile file_;
};

}  // namespace

std::unique_ptr<PictureSink> open_picture_sink(const std::string& path,
                                               const SinkOptions& options) {
  const std::string format = output_format(path, options);
  if (format != "png" && format != "exr") {
    throw Error(ErrorKind::usage, path, format + " holds no pictures", "write png or exr");
  }
  return std::make_unique<ImageSink>(path, options,
                                     format == "png" ? sink::ImageKind::png : sink::ImageKind::exr);
}

}  // namespace mc
