// SPDX-License-Identifier: MIT
#include "convert/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>
#include <utility>

#include "mc/base.hpp"
#include "sink/file_writer.hpp"

// One write a line, at the file's end: a process that is killed leaves whole lines, and one torn
// line at most.

namespace mc::conversion {

Journal::Journal(const std::string& path, const std::string& header, bool force, bool sync)
    : path_(path), sync_(sync) {
  struct stat status {};
  if (!force && ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
      status.st_size > 0) {
    throw Error(ErrorKind::output, path, "exists already",
                "give another --journal FILE, or --force to replace it");
  }
  fd_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
  if (fd_ < 0) sink::cannot("create", path);
  write_line(header);
}

Journal::~Journal() {
  if (fd_ >= 0) ::close(fd_);
}

void Journal::write_line(std::string line) {
  line += '\n';
  std::string_view rest = line;
  while (!rest.empty()) {
    const ssize_t n = ::write(fd_, rest.data(), rest.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) sink::cannot("write", path_);
    rest.remove_prefix(static_cast<std::size_t>(n));
  }
  if (sync_ && ::fdatasync(fd_) != 0 && errno != EINVAL) sink::cannot("sync", path_);
}

void Journal::add(const std::string& record, std::uint64_t before, std::uint64_t after) {
  write_line(fmt::format(R"({},"before":"{:016x}","after":"{:016x}"}})",
                         record.substr(0, record.size() - 1), before, after));
}

}  // namespace mc::conversion
