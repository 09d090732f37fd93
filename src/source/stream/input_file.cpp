// SPDX-License-Identifier: MIT
#include "source/stream/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "mc/base.hpp"

namespace mc::source {

namespace {

[[noreturn]] void cannot(std::string_view verb, const std::string& place) {
  const int error = errno;
  throw Error(ErrorKind::input, place,
              "cannot " + std::string(verb) + ": " + std::generic_category().message(error));
}

int open_to_read(const std::string& path) {
  int fd = -1;
  do {  // a FIFO waits for its writer here
    fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  } while (fd < 0 && errno == EINTR);
  return fd;
}

}  // namespace

InputFile::InputFile(const std::string& path, Bytes bytes)
    : place_(path == "-" ? "<stdin>" : path), is_stdin_(path == "-") {
  Descriptor opened(is_stdin_ ? STDIN_FILENO : open_to_read(path));
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
  is_device_ = S_ISCHR(status.st_mode);
  if (S_ISREG(status.st_mode)) {
    // Of a file that somebody has read a part of, only the rest is meant.
    whole_file_ = ::lseek(opened.get(), 0, SEEK_CUR) == 0;
    stored_bytes_ = static_cast<std::uint64_t>(status.st_size);
  }
  auto stored = std::make_unique<DescriptorStream>(std::move(opened), place_);
  stored_ = stored.get();
  stream_ = std::make_unique<PeekStream>(std::move(stored));
  if (bytes == Bytes::unpacked) {
    packing_ = packing_of(stream_->peek(kPackingBytes));
  }
  if (packing_ != Packing::none) {
    stream_ = std::make_unique<PeekStream>(unpacked(std::move(stream_), packing_, place_));
  }
  if (!whole_file_ && stream_->peek(1).empty()) {
    throw Error(ErrorKind::input, place_, "is empty");
  }
}

void InputFile::refuse_device() const {
  if (is_device_) {
    throw Error(ErrorKind::input, place_, "is a device, but a file or a pipe was expected",
                "raw data from a device needs all three --dims and --type");
  }
}

}  // namespace mc::source
