// SPDX-License-Identifier: MIT
#include "sink/raw/raw_sink.hpp"

#include <filesystem>
#include <optional>

#include "sink/nrrd/header.hpp"
#include "sink/nrrd/sample_writer.hpp"
#include "sink/output_file.hpp"

// Flat samples with a sidecar header, so that a .raw written here can be read without options.

namespace mc::sink {

namespace {

std::string sidecar_of(const std::string& path) {
  return std::filesystem::path(path).replace_extension(".nhdr").string();
}

class RawSink final : public VolumeSink {
 public:
  RawSink(const std::string& path, const SinkOptions& options)
      : options_(options),
        name_(std::filesystem::path(path).filename().string()),
        samples_file_(path, output_options(options, true)) {
    if (samples_file_.seekable()) {  // what is written in place has no name to keep a header by
      header_file_.emplace(sidecar_of(path), output_options(options, false));
    }
  }

  void begin(const Volume& volume) override {
    if (header_file_) header_file_->append(nrrd_header(volume, options_, name_));
    samples_.emplace(volume, samples_file_);
  }
  void write(const Slab& slab) override { samples_->write(slab); }
  bool write_sparse(const LeafReader& /*reader*/) override { return false; }
  void finish() override {
    samples_->finish();
    if (header_file_) {
      OutputFile::commit_all({&samples_file_, &*header_file_});
    } else {
      samples_file_.commit();
    }
  }

 private:
  SinkOptions options_;
  std::string name_;
  OutputFile samples_file_;
  std::optional<OutputFile> header_file_;
  std::optional<SampleWriter> samples_;
};

}  // namespace

std::unique_ptr<VolumeSink> open_raw(const std::string& path, const SinkOptions& options) {
  if (path != "-" && std::filesystem::path(path).extension() == ".nhdr") {
    throw Error(ErrorKind::usage, path, "the samples and their header would be one file",
                "name the samples NAME.raw");
  }
  return std::make_unique<RawSink>(path, options);
}

}  // namespace mc::sink
