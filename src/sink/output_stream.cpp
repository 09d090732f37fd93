// SPDX-License-Identifier: MIT
#include <cassert>

#include "mc/sink.hpp"
#include "sink/output_file.hpp"

// The file layer for sinks outside the library.

namespace mc {

OutputStream::OutputStream(const std::string& path, const SinkOptions& options, bool binary)
    : file_(std::make_unique<sink::OutputFile>(path, sink::output_options(options, binary))) {}

OutputStream::~OutputStream() = default;

const std::string& OutputStream::place() const { return file_->place(); }
bool OutputStream::seekable() const { return file_->seekable(); }
std::uint64_t OutputStream::size() const { return file_->size(); }

void OutputStream::write(std::span<const std::byte> bytes) { file_->append(bytes); }
void OutputStream::write(std::string_view text) { file_->append(text); }

void OutputStream::patch(std::uint64_t offset, std::span<const std::byte> bytes) {
  assert(seekable() && offset + bytes.size() <= size());
  file_->write_at(offset, bytes);
}

void OutputStream::finish() { file_->commit(); }

}  // namespace mc
