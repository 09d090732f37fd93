// SPDX-License-Identifier: MIT
#include "sink/nrrd/nrrd_sink.hpp"

#include <optional>

#include "sink/nrrd/header.hpp"
#include "sink/nrrd/sample_writer.hpp"
#include "sink/output_file.hpp"

// NRRD with its header attached.

namespace mc::sink {

namespace {

class NrrdSink final : public VolumeSink {
 public:
  NrrdSink(const std::string& path, const SinkOptions& options)
      : options_(options), file_(path, output_options(options, true)) {}

  void begin(const Volume& volume) override {
    file_.append(nrrd_header(volume, options_));
    samples_.emplace(volume, file_);
  }
  void write(const Slab& slab) override { samples_->write(slab); }
  bool write_sparse(const LeafReader& /*reader*/) override { return false; }
  void finish() override {
    samples_->finish();
    file_.commit();
  }

 private:
  SinkOptions options_;
  OutputFile file_;
  std::optional<SampleWriter> samples_;
};

}  // namespace

std::unique_ptr<VolumeSink> open_nrrd(const std::string& path, const SinkOptions& options) {
  return std::make_unique<NrrdSink>(path, options);
}

}  // namespace mc::sink
