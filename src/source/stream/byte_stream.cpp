// SPDX-License-Identifier: MIT
#include "source/stream/byte_stream.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "mc/base.hpp"

namespace mc::source {

namespace {

/// Larger than a pipe's usual 64 KiB: fewer turns between writer and reader.
constexpr int kPipeBytes = 1 << 20;

}  // namespace

Descriptor::~Descriptor() {
  if (fd_ > STDERR_FILENO) {
    ::close(fd_);
  }
}

Descriptor::Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

DescriptorStream::DescriptorStream(Descriptor descriptor, std::string place)
    : descriptor_(std::move(descriptor)), place_(std::move(place)) {
  struct stat status {};
  const bool file = ::fstat(descriptor_.get(), &status) == 0 && S_ISREG(status.st_mode);
  offset_ = file ? ::lseek(descriptor_.get(), 0, SEEK_CUR) : -1;
#ifdef F_SETPIPE_SZ
  ::fcntl(descriptor_.get(), F_SETPIPE_SZ, kPipeBytes);  // fails where it is no pipe
#endif
}

std::size_t DescriptorStream::read(std::span<std::byte> out) {
  std::size_t n_read = 0;
  while (n_read < out.size()) {
    const std::span<std::byte> rest = out.subspan(n_read);
    const ssize_t n = offset_ < 0 ? ::read(descriptor_.get(), rest.data(), rest.size())
                                  : ::pread(descriptor_.get(), rest.data(), rest.size(), offset_);
    if (n < 0 && errno == EINTR) {
      continue;
    }
    if (n < 0) {
      throw Error(ErrorKind::input, place_,
                  "cannot read: " + std::generic_category().message(errno));
    }
    if (n == 0) {
      break;
    }
    n_read += static_cast<std::size_t>(n);
    offset_ += offset_ < 0 ? 0 : n;
  }
  return n_read;
}

std::string_view PeekStream::peek(std::size_t n) {
  const std::size_t known = ahead_.size() - taken_;
  if (known < n) {
    ahead_.erase(ahead_.begin(), ahead_.begin() + static_cast<std::ptrdiff_t>(taken_));
    taken_ = 0;
    ahead_.resize(n);
    ahead_.resize(known + from_->read(std::span(ahead_).subspan(known)));
  }
  return {reinterpret_cast<const char*>(ahead_.data()) + taken_,
          std::min(n, ahead_.size() - taken_)};
}

std::size_t PeekStream::read(std::span<std::byte> out) {
  const std::size_t n = std::min(out.size(), ahead_.size() - taken_);
  if (n > 0) {
    std::memcpy(out.data(), ahead_.data() + taken_, n);
    taken_ += n;
  }
  return n == out.size() ? n : n + from_->read(out.subspan(n));
}

std::uint64_t pass_over(ByteStream& stream, std::uint64_t n) {
  std::array<std::byte, 1 << 14> block;
  for (std::uint64_t passed = 0; passed < n;) {
    const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(n - passed, block.size()));
    const std::size_t got = stream.read(std::span(block).first(wanted));
    passed += got;
    if (got < wanted) {
      return passed;
    }
  }
  return n;
}

}  // namespace mc::source
