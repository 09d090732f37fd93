// SPDX-License-Identifier: MIT
#include "sink/vdb/vdb_sink.hpp"

#include <cassert>
#include <cstdint>
#include <span>

#include "sink/formats.hpp"
#include "sink/output_file.hpp"
#include "sink/vdb/open_module.hpp"
#include "sink/vdb/rewritable_stream.hpp"

// VDB files: everything but what OpenVDB does, which is in the module.

namespace mc::sink {

#if MC_WITH_VDB

namespace {

/// The header of a VDB file: 8 bytes of magic, two versions and a flag, then the UUID as text.
constexpr std::uint64_t kUuidOffset = 21;
constexpr std::uint64_t kUuidBytes = 36;

class VdbSink final : public VolumeSink {
 public:
  VdbSink(const std::string& path, const SinkOptions& options)
      : options_(options),
        file_(path, output_options(options, true)),
        writer_(open_vdb_writer(file_.place())) {}

  void begin(const Volume& volume) override { writer_->begin(volume); }
  void write(const Slab& slab) override { writer_->write(slab); }
  bool write_sparse(const LeafReader& reader) override {
    writer_->write_sparse(reader);
    return true;
  }
  void finish() override {
    RewritableStream bytes(file_);
    bytes.skip_begin = kUuidOffset;
    bytes.skip_end = kUuidOffset + kUuidBytes;
    writer_->finish(bytes, options_.provenance);
    const std::string uuid = bytes.content_uuid();
    assert(uuid.size() == kUuidBytes);
    bytes.overwrite(kUuidOffset, std::as_bytes(std::span(uuid)));
    bytes.finish();
    file_.commit();
  }

 private:
  SinkOptions options_;
  OutputFile file_;
  std::unique_ptr<VdbWriter> writer_;
};

}  // namespace

std::unique_ptr<VolumeSink> open_vdb(const std::string& path, const SinkOptions& options) {
  return std::make_unique<VdbSink>(path, options);
}

#else

std::unique_ptr<VolumeSink> open_vdb(const std::string& path, const SinkOptions& /*options*/) {
  refuse_absent(kVdbFormat, path);
}

#endif

}  // namespace mc::sink
