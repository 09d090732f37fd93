// SPDX-License-Identifier: MIT
#include "source/stream/spool.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <vector>

namespace mc::source {

namespace {

std::string system_text(int error) { return std::generic_category().message(error); }

std::string folder() {
  const char* named = std::getenv("TMPDIR");
  return named != nullptr && *named != '\0' ? named : "/tmp";
}

Descriptor unlinked_file() {
  std::string name = folder() + "/mc-spool-XXXXXX";
  const int fd = ::mkostemp(name.data(), O_CLOEXEC);
  if (fd < 0) {
    throw Error(ErrorKind::output, name, "cannot create: " + system_text(errno),
                "point TMPDIR at a folder that can be written");
  }
  ::unlink(name.c_str());
  return Descriptor(fd);
}

}  // namespace

Spool::Spool(const std::string& place, std::string_view reason, Progress& progress)
    : place_(place), progress_(progress), file_(unlinked_file()) {
  progress.detail(place + ": copied to a temporary file in " + folder() + ": " +
                  std::string(reason));
  progress.begin("spool", 0, "B");
}

void Spool::write(std::span<const std::byte> bytes) {
  progress_.advance(bytes.size());
  while (!bytes.empty()) {
    const ssize_t n = ::write(file_.get(), bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) {
      continue;
    }
    if (n < 0) {
      throw Error(ErrorKind::output, place_,
                  "cannot spool to a temporary file: " + system_text(errno),
                  "point TMPDIR at a folder with room");
    }
    bytes = bytes.subspan(static_cast<std::size_t>(n));
  }
}

void copy_stream(ByteStream& stream, std::uint64_t most_bytes, Spool& spool) {
  std::vector<std::byte> block(std::size_t{1} << 18U);
  for (std::uint64_t n_bytes = 0; n_bytes <= most_bytes;) {
    const std::uint64_t left = most_bytes - n_bytes;
    const std::size_t wanted =
        left < block.size() ? static_cast<std::size_t>(left) + 1 : block.size();
    const std::size_t n = stream.read(std::span(block).first(std::min(wanted, block.size())));
    spool.write(std::span<const std::byte>(block).first(n));
    n_bytes += n;
    if (n < wanted) {
      return;
    }
  }
}

}  // namespace mc::source
