// SPDX-License-Identifier: MIT
#include "source/mapped_file.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "source/stream/spool.hpp"

namespace mc::source {

namespace {

[[noreturn]] void cannot(std::string_view verb, const std::string& place) {
  const int error = errno;
  const bool no_memory = error == ENOMEM;
  throw Error(no_memory ? ErrorKind::limit : ErrorKind::input, place,
              "cannot " + std::string(verb) + ": " + std::generic_category().message(error),
              no_memory ? "allow the program more memory" : "");
}

/// A copy on disk, at most `most_bytes` and one more of it.
Descriptor spooled(InputFile input, std::uint64_t most_bytes, Progress& progress) {
  if (most_bytes == MappedFile::kUnlimited) input.refuse_device();
  const bool packed = input.packing() != Packing::none;
  const bool is_stdin = input.is_stdin();
  const std::string place = input.place();
  Spool spool(place, packed ? "it is packed" : "it is no file", progress);
  copy_stream(*std::move(input).stream(), most_bytes, spool);
  Descriptor file = spool.release();
  if (is_stdin) {
    // A pipe can be read once: from now on stdin is the copy, so that "-" can be opened again.
    ::lseek(file.get(), 0, SEEK_SET);
    if (::dup2(file.get(), STDIN_FILENO) < 0) {
      cannot("keep a copy of", place);
    }
  }
  return file;
}

}  // namespace

MappedFile::MappedFile(const std::string& path, std::uint64_t most_bytes)
    : MappedFile(InputFile(path), most_bytes) {}

MappedFile::MappedFile(InputFile input, std::uint64_t most_bytes, Progress& progress, Keep keep)
    : place_(input.place()) {
  Descriptor file = input.mappable() ? std::move(input).descriptor()
                                     : spooled(std::move(input), most_bytes, progress);
  map(file);
  if (keep == Keep::open_file) file_ = std::move(file);
}

MappedFile::MappedFile(std::string place, const Descriptor& file) : place_(std::move(place)) {
  map(file);
}

void MappedFile::map(const Descriptor& file) {
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) {
    cannot("read", place_);
  }
  size_ = static_cast<std::size_t>(status.st_size);
  if (size_ == 0) {
    throw Error(ErrorKind::input, place_, "is empty");
  }
  void* mapping = ::mmap(nullptr, size_, PROT_READ, MAP_SHARED, file.get(), 0);
  if (mapping == MAP_FAILED) {
    size_ = 0;
    cannot("map", place_);
  }
  data_ = static_cast<const std::byte*>(mapping);
  live_ = LiveMapping(bytes(), status, place_);
}

MappedFile::~MappedFile() {
  live_ = {};
  if (data_ != nullptr) {
    ::munmap(const_cast<std::byte*>(data_), size_);
  }
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : place_(std::move(other.place_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)),
      live_(std::move(other.live_)),
      file_(std::move(other.file_)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(place_, other.place_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(live_, other.live_);
  std::swap(file_, other.file_);
  return *this;
}

std::string_view MappedFile::text() const { return {reinterpret_cast<const char*>(data_), size_}; }

}  // namespace mc::source
