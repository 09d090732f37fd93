// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cassert>
#include <cstdlib>
#include <utility>

#include "mc/base.hpp"
#include "sink/file_writer.hpp"
#include "sink/output_file.hpp"

// Temporary files of the sinks. They have no name from the start where the file system can, so that
// no end of the process leaves one behind.

namespace mc::sink {

struct SpoolFile::State {
  std::unique_ptr<FileWriter> writer;
  void* mapping = nullptr;
  std::size_t mapped = 0;

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { unmap(); }
  void unmap() {
    if (mapping != nullptr) {
      ::munmap(std::exchange(mapping, nullptr), mapped);
    }
  }
};

SpoolFile::SpoolFile(const OutputFile& beside) : state_(std::make_unique<State>()) {
  beside.note_spool();
  const std::string folder = beside.scratch_folder();
  int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (fd < 0) {  // not every file system has files without a name
    std::string name = folder + "/.mc-spool-XXXXXX";
    fd = ::mkostemp(name.data(), O_CLOEXEC);
    if (fd >= 0) {
      ::unlink(name.c_str());
    }
  }
  const std::string place = folder + " (temporary file)";
  if (fd < 0) {
    cannot("create", place,
           beside.seekable() ? "choose a folder that can be written"
                             : "point TMPDIR at a folder that can be written");
  }
  state_->writer = std::make_unique<FileWriter>(
      fd, true, place, beside.seekable() ? "" : "point TMPDIR at a folder with room");
}

SpoolFile::~SpoolFile() = default;

void SpoolFile::append(std::span<const std::byte> bytes) { state_->writer->append(bytes); }

std::uint64_t SpoolFile::size() const { return state_->writer->size(); }

std::span<const std::byte> SpoolFile::map() {
  state_->unmap();
  state_->writer->flush();
  const std::uint64_t n_bytes = size();
  if (n_bytes == 0) {
    return {};
  }
  state_->mapped = static_cast<std::size_t>(n_bytes);
  void* mapping = ::mmap(nullptr, state_->mapped, PROT_READ, MAP_SHARED, state_->writer->fd(), 0);
  if (mapping == MAP_FAILED) {
    cannot("map", state_->writer->place());
  }
  state_->mapping = mapping;
  return {static_cast<const std::byte*>(mapping), state_->mapped};
}

void SpoolFile::read(std::uint64_t offset, std::span<std::byte> bytes) {
  assert(offset + bytes.size() <= size());
  state_->writer->read(offset, bytes);
}

void SpoolFile::copy_to(OutputFile& out) { out.writer().append_file(*state_->writer); }

FileWriter& SpoolFile::writer() { return *state_->writer; }

}  // namespace mc::sink
