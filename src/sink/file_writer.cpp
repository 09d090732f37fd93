// SPDX-License-Identifier: MIT
#include "sink/file_writer.hpp"

#include <sys/sendfile.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "mc/base.hpp"

// Interrupted calls and short writes are taken up again; everything else is an Error.

namespace mc::sink {

void cannot(std::string_view verb, const std::string& place, std::string_view remedy) {
  const int error = errno;
  throw Error(error == ENOMEM ? ErrorKind::limit : ErrorKind::output, place,
              std::string("cannot ").append(verb).append(": ").append(
                  std::generic_category().message(error)),
              remedy);
}

namespace {

/// Reads a byte of every page. Of a mapped input that became shorter, the system would not write
/// what is gone; touched, it raises SIGBUS, whose handler puts zeros there.
void touch(std::span<const std::byte> bytes) {
  constexpr std::size_t kLeastPage = 4096;
  for (std::size_t at = 0; at < bytes.size(); at += kLeastPage) {
    static_cast<void>(*static_cast<const volatile std::byte*>(&bytes[at]));
  }
  static_cast<void>(*static_cast<const volatile std::byte*>(&bytes.back()));
}

}  // namespace

FileWriter::FileWriter(int fd, bool offsets, std::string place, std::string_view remedy)
    : fd_(fd), offsets_(offsets), place_(std::move(place)), remedy_(remedy) {}

FileWriter::~FileWriter() {
  if (fd_ > STDERR_FILENO) {
    ::close(fd_);
  }
}

void FileWriter::append(std::span<const std::byte> bytes) {
  if (bytes.empty()) {
    return;
  }
  if (buffered_ + bytes.size() > kBufferBytes) {
    flush();
  }
  if (bytes.size() >= kBufferBytes) {
    put(flushed_, bytes);
    flushed_ += bytes.size();
    return;
  }
  if (!buffer_) {
    buffer_ = std::make_unique_for_overwrite<std::byte[]>(kBufferBytes);
  }
  std::memcpy(buffer_.get() + buffered_, bytes.data(), bytes.size());
  buffered_ += bytes.size();
}

/// Bytes of `from` that the kernel has copied to where the next go; whatever keeps it from the rest
/// will be met, and told, by who copies that.
std::uint64_t FileWriter::copied_by_kernel(const FileWriter& from) const {
  constexpr std::size_t kMost = std::size_t{1} << 30;
  off_t in = 0;
  auto out = static_cast<off_t>(flushed_);
  while (static_cast<std::uint64_t>(in) < from.flushed_) {
    const ssize_t n = offsets_ ? ::copy_file_range(from.fd_, &in, fd_, &out, kMost, 0)
                               : ::sendfile(fd_, from.fd_, &in, kMost);
    if (n == 0 || (n < 0 && errno != EINTR)) break;
  }
  return static_cast<std::uint64_t>(in);
}

void FileWriter::append_file(FileWriter& from) {
  flush();
  from.flush();
  std::uint64_t at = copied_by_kernel(from);
  flushed_ += at;
  const std::uint64_t n_bytes = from.size();
  Buffer<std::byte> block(
      static_cast<std::size_t>(std::min<std::uint64_t>(kBufferBytes, n_bytes - at)));
  for (; at < n_bytes; at += block.size()) {
    block.resize(static_cast<std::size_t>(std::min<std::uint64_t>(block.size(), n_bytes - at)));
    from.read(at, block);
    append(block);
  }
}

void FileWriter::flush() {
  put(flushed_, {buffer_.get(), buffered_});
  flushed_ += std::exchange(buffered_, 0);
}

void FileWriter::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  assert(offsets_);
  if (offset + bytes.size() > flushed_ && offset < size()) {
    flush();  // else the buffer would later overwrite them
  }
  put(offset, bytes);
}

void FileWriter::put_at(std::uint64_t offset, std::span<const std::byte> bytes) const {
  assert(offsets_);
  put(offset, bytes);
}

void FileWriter::skip(std::uint64_t n_bytes) {
  assert(offsets_);
  flush();
  flushed_ += n_bytes;
}

void FileWriter::truncate(std::uint64_t n_bytes) {
  assert(offsets_ && n_bytes <= size());
  flush();
  while (::ftruncate(fd_, static_cast<off_t>(n_bytes)) != 0) {
    if (errno != EINTR) cannot("cut", place_);
  }
  flushed_ = n_bytes;
}

void FileWriter::read(std::uint64_t offset, std::span<std::byte> bytes) {
  flush();
  read_flushed(offset, bytes);
}

void FileWriter::read_flushed(std::uint64_t offset, std::span<std::byte> bytes) const {
  assert(offsets_ && offset + bytes.size() <= flushed_);
  while (!bytes.empty()) {
    const ssize_t n = ::pread(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) {
      continue;
    }
    if (n <= 0) {
      errno = n == 0 ? EIO : errno;  // what was written is no longer there
      cannot("read back", place_);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

void FileWriter::sync() {
  flush();
  while (fd_ >= 0 && ::fsync(fd_) != 0) {
    const bool is_stream = errno == EINVAL || errno == ENOTSUP || errno == EROFS;
    if (!offsets_ && is_stream) {
      return;
    }
    if (errno != EINTR) {
      cannot("sync", place_);
    }
  }
}

void FileWriter::close() {
  flush();
  buffer_.reset();  // a series of files has them all until the last is written
  const int fd = std::exchange(fd_, -1);
  if (fd > STDERR_FILENO && ::close(fd) != 0 && errno != EINTR) {
    cannot("write", place_, remedy_);
  }
}

void FileWriter::put(std::uint64_t offset, std::span<const std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t n = offsets_
                          ? ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset))
                          : ::write(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) {
      continue;
    }
    if (n < 0 && errno == EFAULT) {
      touch(bytes);
      continue;
    }
    if (n < 0) {
      cannot("write", place_, remedy_);
    }
    bytes = bytes.subspan(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

}  // namespace mc::sink
