// SPDX-License-Identifier: MIT
#include "source/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "mc/base.hpp"

namespace mc::source {

namespace {

std::string system_text(int error) { return std::generic_category().message(error); }

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ > STDERR_FILENO) {
      ::close(fd_);
    }
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

[[noreturn]] void cannot(std::string_view verb, const std::string& place) {
  const int error = errno;
  throw Error(ErrorKind::input, place, "cannot " + std::string(verb) + ": " + system_text(error));
}

void write_all(int fd, std::span<const std::byte> bytes, const std::string& place) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) {
      continue;
    }
    if (n < 0) {
      throw Error(ErrorKind::output, place,
                  "cannot spool to a temporary file: " + system_text(errno),
                  "point TMPDIR at a folder with room");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
}

/// Copies a stream to an unlinked file and returns its descriptor.
/// Stops after `most_bytes` and one more.
int spooled(int stream, const std::string& place, std::uint64_t most_bytes) {
  const char* folder = std::getenv("TMPDIR");
  std::string name = std::string(folder != nullptr && *folder != '\0' ? folder : "/tmp");
  name += "/mc-spool-XXXXXX";
  const int fd = ::mkstemp(name.data());
  if (fd < 0) {
    throw Error(ErrorKind::output, name, "cannot create: " + system_text(errno),
                "point TMPDIR at a folder that can be written");
  }
  ::unlink(name.c_str());
  std::array<std::byte, 1 << 16> block{};
  std::uint64_t n_bytes = 0;
  for (;;) {
    const std::uint64_t left = most_bytes - n_bytes;
    const std::size_t wanted =
        left < block.size() ? static_cast<std::size_t>(left) + 1 : block.size();
    const ssize_t n = ::read(stream, block.data(), std::min(wanted, block.size()));
    if (n < 0 && errno == EINTR) {
      continue;
    }
    if (n < 0) {
      cannot("read", place);
    }
    if (n == 0) {
      return fd;
    }
    write_all(fd, std::span(block).first(static_cast<std::size_t>(n)), place);
    n_bytes += static_cast<std::uint64_t>(n);
    if (n_bytes > most_bytes) {
      return fd;
    }
  }
}

}  // namespace

MappedFile::MappedFile(const std::string& path, std::uint64_t most_bytes)
    : place_(path == "-" ? "<stdin>" : path) {
  const Descriptor opened(path == "-" ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (opened.get() < 0) {
    cannot("open", place_);
  }
  struct stat status {};
  if (::fstat(opened.get(), &status) != 0) {
    cannot("read", place_);
  }
  if (S_ISDIR(status.st_mode)) {
    throw Error(ErrorKind::input, place_, "is a folder, but a file was expected");
  }
  const bool regular = S_ISREG(status.st_mode);
  if (S_ISCHR(status.st_mode) && most_bytes == kUnlimited) {
    throw Error(ErrorKind::input, place_, "is a device, but a file or a pipe was expected",
                "raw data from a device needs all three --dims and --type");
  }
  const Descriptor file(regular ? ::dup(opened.get()) : spooled(opened.get(), place_, most_bytes));
  if (!regular && path == "-") {
    // A pipe can be read once: from now on stdin is the copy, so that "-" can be opened again.
    ::lseek(file.get(), 0, SEEK_SET);
    if (::dup2(file.get(), STDIN_FILENO) < 0) {
      cannot("keep a copy of", place_);
    }
  }
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
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) {
    ::munmap(const_cast<std::byte*>(data_), size_);
  }
}

MappedFile::MappedFile(MappedFile&& other) noexcept
    : place_(std::move(other.place_)),
      data_(std::exchange(other.data_, nullptr)),
      size_(std::exchange(other.size_, 0)) {}

MappedFile& MappedFile::operator=(MappedFile&& other) noexcept {
  std::swap(place_, other.place_);
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  return *this;
}

std::string_view MappedFile::text() const { return {reinterpret_cast<const char*>(data_), size_}; }

}  // namespace mc::source
