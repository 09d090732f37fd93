// SPDX-License-Identifier: MIT
#include "sink/partial_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <random>
#include <string_view>
#include <utility>

#include "mc/base.hpp"
#include "sink/file_writer.hpp"
#include "sink/partial_names.hpp"

// A final name shows a whole file, the old one or the new. Where several files belong together, the
// old ones are kept until the last new one is in place: as a second link, so that the name is never
// without a file, or moved away where the file system has no links.

namespace mc::sink {

namespace {

constexpr mode_t kNewFileMode = 0666;  // less the umask
constexpr int kTries = 100;            // for a name that nobody has

/// The file that `path` names in the end, which need not exist.
std::string followed(const std::string& path) {
  constexpr int kMostLinks = 40;  // what the kernel allows
  std::string at = path;
  for (int i = 0; i < kMostLinks; ++i) {
    std::array<char, PATH_MAX> link{};
    const ssize_t n = ::readlink(at.c_str(), link.data(), link.size());
    if (n < 0) {
      return at;
    }
    std::string target(link.data(), static_cast<std::size_t>(n));
    at = target.starts_with('/') ? std::move(target) : folder_of(at).append("/").append(target);
  }
  errno = ELOOP;
  cannot("create", path);
}

/// "NAME.partial-" and four random letters; a long name is cut to what file systems allow.
std::string partial_name(const std::string& target) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz0123456789";
  constexpr std::size_t kLongestBase = NAME_MAX - 16;
  const std::size_t base = target.rfind('/') + 1;  // npos + 1 == 0
  std::string name = target.substr(0, std::min(target.size(), base + kLongestBase)) + ".partial-";
  std::random_device random;
  std::uniform_int_distribution<std::size_t> letter(0, kLetters.size() - 1);
  for (int i = 0; i < 4; ++i) {
    name += kLetters[letter(random)];
  }
  return name;
}

bool exists(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0;
}

[[noreturn]] void cannot_create(const std::string& place, const std::string& target) {
  const bool no_folder = errno == ENOENT || errno == ENOTDIR;
  cannot("create", place,
         no_folder ? "create the folder " + folder_of(target) + " first"
                   : "choose a folder that can be written");
}

}  // namespace

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : path.substr(0, std::max<std::size_t>(slash, 1));
}

PartialFile::PartialFile(const std::string& path, std::string place)
    : target_(followed(path)), place_(std::move(place)) {
  create();
}

void PartialFile::create() {
  PartialNames names;
  for (int i = 0; i < kTries; ++i) {
    name_ = partial_name(target_);
    fd_ = ::open(name_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode);
    if (fd_ >= 0) {
      names.add(name_);
      return;
    }
    if (errno != EEXIST && errno != EINTR) {
      break;
    }
  }
  cannot_create(place_, target_);
}

PartialFile::~PartialFile() {
  if (!name_.empty()) {
    PartialNames names;
    ::unlink(name_.c_str());
    names.forget(name_);
  }
}

void PartialFile::move(bool may_replace) const {
  // Where it may not, the kernel itself refuses; file systems that cannot are asked first.
  if (!may_replace) {
    if (::renameat2(AT_FDCWD, name_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0) {
      return;
    }
    if (errno == EEXIST || exists(target_)) {
      throw Error(ErrorKind::output, place_, "exists", "add --force to replace it");
    }
  }
  if (::rename(name_.c_str(), target_.c_str()) != 0) {
    cannot("rename into place", place_);
  }
}

void PartialFile::rename_into_place(bool may_replace) {
  PartialNames names;
  move(may_replace);
  names.forget(std::exchange(name_, {}));
}

void PartialFile::keep_former() {
  for (int i = 0; i < kTries; ++i) {
    former_ = partial_name(target_);
    if (::link(target_.c_str(), former_.c_str()) == 0) {
      return;
    }
    if (errno != EEXIST) {
      break;
    }
  }
  if (errno == ENOENT || ::rename(target_.c_str(), former_.c_str()) != 0) {
    former_.clear();
    if (errno != ENOENT) {
      cannot("set aside", place_);
    }
  }
}

void PartialFile::put_back_former(PartialNames& names) noexcept {
  std::rename(former_.c_str(), target_.c_str());
  ::unlink(former_.c_str());  // still there where both are one file, which rename() leaves alone
  names.forget(std::exchange(former_, {}));
}

void PartialFile::rename_for_now(bool may_replace) {
  PartialNames names;
  if (may_replace) {
    keep_former();
  }
  if (former_.empty()) {
    move(may_replace);
    names.add(target_);
  } else {
    names.add_former(former_, target_);
    try {
      move(may_replace);
    } catch (...) {
      put_back_former(names);
      throw;
    }
  }
  names.forget(std::exchange(name_, {}));
}

void PartialFile::undo() noexcept {
  PartialNames names;
  if (former_.empty()) {
    ::unlink(target_.c_str());
    names.forget(target_);
  } else {
    put_back_former(names);
  }
}

void PartialFile::confirm_all(std::span<PartialFile* const> files) noexcept {
  PartialNames names;
  for (const PartialFile* file : files) {
    names.forget(file->former_.empty() ? file->target_ : file->former_);
  }
  for (PartialFile* file : files) {
    if (!file->former_.empty()) {
      ::unlink(std::exchange(file->former_, {}).c_str());
    }
  }
}

void sync_folder(const std::string& folder) {
  const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) {
    cannot("open", folder);
  }
  FileWriter(fd, false, folder).sync();
}

}  // namespace mc::sink
