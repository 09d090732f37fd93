// SPDX-License-Identifier: MIT
#include "sink/output_file.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <random>
#include <vector>

#include "mc/base.hpp"
#include "sink/file_writer.hpp"
#include "sink/partial_names.hpp"

// The file layer below every sink. Guarantees: a regular file appears under its name only when it
// is complete; whatever fails before that leaves no trace; every failed system call comes out as
// Error(output) with the system's text.

namespace mc::sink {

namespace {

constexpr mode_t kNewFileMode = 0666;  // less the umask

[[noreturn]] void refuse_existing(const std::string& place) {
  throw Error(ErrorKind::output, place, "exists", "add --force to replace it");
}

std::string folder_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  return slash == std::string::npos ? "." : path.substr(0, std::max<std::size_t>(slash, 1));
}

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
    const std::string target(link.data(), static_cast<std::size_t>(n));
    at = target.starts_with('/') ? target : folder_of(at) + "/" + target;
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

/// Creates a partial file for `target`; returns its descriptor and sets `name`.
int create_partial(const std::string& target, const std::string& place, std::string& name) {
  constexpr int kTries = 100;
  for (int i = 0; i < kTries; ++i) {
    name = partial_name(target);
    const int fd = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, kNewFileMode);
    if (fd >= 0) {
      return fd;
    }
    if (errno != EEXIST && errno != EINTR) {
      break;
    }
  }
  const bool no_folder = errno == ENOENT || errno == ENOTDIR;
  cannot("create", place,
         no_folder ? "create the folder " + folder_of(target) + " first"
                   : "choose a folder that can be written");
}

}  // namespace

struct OutputFile::State {
  Options options;
  std::string target;   // what is replaced in the end; empty when written in place
  std::string partial;  // likewise
  bool done = false;
  std::unique_ptr<FileWriter> writer;

  void open(const std::string& path, const std::string& place);
  void open_in_place(const std::string& path, const std::string& place);
  void rename_into_place();
  void drop_partial() noexcept;
};

void OutputFile::State::open_in_place(const std::string& path, const std::string& place) {
  int fd = STDOUT_FILENO;
  if (path != "-") {
    do {  // a FIFO waits for its reader here
      fd = ::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    } while (fd < 0 && errno == EINTR);
  }
  if (fd < 0) {
    cannot("open", place);
  }
  writer = std::make_unique<FileWriter>(fd, false, place);
  if (options.binary && !options.force && ::isatty(fd) == 1) {
    throw Error(ErrorKind::output, place, "is a terminal, and the output is binary",
                "redirect it, name a file, or add --force");
  }
}

void OutputFile::State::open(const std::string& path, const std::string& place) {
  struct stat status {};
  const bool exists = path != "-" && ::stat(path.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) {
    throw Error(ErrorKind::output, place, "is a folder, but a file was expected");
  }
  if (path == "-" || (exists && !S_ISREG(status.st_mode))) {
    open_in_place(path, place);
    return;
  }
  if (path.empty() || path.ends_with('/')) {
    throw Error(ErrorKind::output, place, "names no file");
  }
  if (exists && !options.force) {
    refuse_existing(place);
  }
  target = followed(path);
  const int fd = create_partial(target, place, partial);
  register_partial(partial);
  writer = std::make_unique<FileWriter>(fd, true, place);
  if (exists) {  // some file systems have no permissions to keep
    static_cast<void>(::fchmod(fd, status.st_mode & 07777));
  }
}

void OutputFile::State::rename_into_place() {
  const std::string& place = writer->place();
  // Without force the kernel itself refuses to replace; file systems that cannot are asked first.
  if (!options.force) {
    if (::renameat2(AT_FDCWD, partial.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE) == 0) {
      return;
    }
    struct stat status {};
    if (errno == EEXIST || ::lstat(target.c_str(), &status) == 0) {
      refuse_existing(place);
    }
  }
  if (::rename(partial.c_str(), target.c_str()) != 0) {
    cannot("rename into place", place);
  }
}

void OutputFile::State::drop_partial() noexcept {
  if (!partial.empty()) {
    ::unlink(partial.c_str());
    forget_partial(partial);
    partial.clear();
  }
}

OutputFile::OutputFile(const std::string& path, Options options)
    : state_(std::make_unique<State>()) {
  state_->options = options;
  try {
    state_->open(path, path == "-" ? "<stdout>" : path);
  } catch (...) {
    state_->drop_partial();
    throw;
  }
}

OutputFile::~OutputFile() {
  if (!state_->done) {
    state_->drop_partial();
  }
}

bool OutputFile::seekable() const { return !state_->partial.empty(); }

const std::string& OutputFile::place() const { return state_->writer->place(); }

std::uint64_t OutputFile::size() const { return state_->writer->size(); }

std::string OutputFile::scratch_folder() const {
  if (seekable()) {
    return folder_of(state_->target);
  }
  const char* tmpdir = std::getenv("TMPDIR");
  return tmpdir != nullptr && *tmpdir != '\0' ? tmpdir : "/tmp";
}

FileWriter& OutputFile::writer() { return *state_->writer; }

void OutputFile::append(std::span<const std::byte> bytes) { state_->writer->append(bytes); }

void OutputFile::append(std::string_view text) {
  append(std::as_bytes(std::span(text.data(), text.size())));
}

void OutputFile::write_at(std::uint64_t offset, std::span<const std::byte> bytes) {
  assert(seekable());
  state_->writer->write_at(offset, bytes);
}

void OutputFile::skip(std::uint64_t n_bytes) { state_->writer->skip(n_bytes); }

void OutputFile::shift(std::uint64_t offset, std::uint64_t n_bytes) {
  assert(offset <= size());
  FileWriter& writer = *state_->writer;
  Buffer<std::byte> block(
      static_cast<std::size_t>(std::min<std::uint64_t>(kBufferBytes, size() - offset)));
  std::uint64_t end = size();  // from the end down, as the two places overlap
  writer.skip(n_bytes);
  while (end > offset) {
    const std::uint64_t n = std::min<std::uint64_t>(end - offset, block.size());
    const std::span<std::byte> part = std::span(block).first(static_cast<std::size_t>(n));
    end -= n;
    writer.read(end, part);
    writer.write_at(end + n_bytes, part);
  }
}

void OutputFile::close() { state_->writer->close(); }

void OutputFile::commit() { commit_all({this}); }

void OutputFile::commit_all(std::span<OutputFile* const> files) {
  for (OutputFile* file : files) {
    file->state_->writer->close();
  }
  std::vector<State*> renamed;
  renamed.reserve(files.size());
  try {
    for (OutputFile* file : files) {
      State& state = *file->state_;
      if (!state.partial.empty()) {
        state.rename_into_place();
        renamed.push_back(&state);
        // Until the last is in place, an interrupt takes the others away again.
        rename_partial(state.partial, state.target);
      }
    }
  } catch (...) {
    for (State* state : renamed) {
      state->partial = state->target;
      state->drop_partial();
    }
    throw;
  }
  for (State* state : renamed) {
    forget_partial(state->target);
  }
  for (OutputFile* file : files) {
    file->state_->done = true;
  }
}

}  // namespace mc::sink
