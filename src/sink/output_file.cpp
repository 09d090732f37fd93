// SPDX-License-Identifier: MIT
#include "sink/output_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdlib>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "mc/base.hpp"
#include "sink/file_writer.hpp"
#include "sink/partial_file.hpp"

// The file layer below every sink. Guarantees: a regular file appears under its name only when it
// is complete; whatever fails before that leaves no trace; every failed system call comes out as
// Error(output) with the system's text.

namespace mc::sink {

namespace {

[[noreturn]] void refuse_existing(const std::string& place) {
  throw Error(ErrorKind::output, place, "exists", "add --force to replace it");
}

}  // namespace

struct OutputFile::State {
  Options options;
  std::optional<PartialFile> partial;  // none when written in place
  std::unique_ptr<FileWriter> writer;

  void open(const std::string& path, const std::string& place);
  void open_in_place(const std::string& path, const std::string& place);
  void open_in_memory(const std::string& place);
  void take_memory();
  void close();
  static void sync_folders(std::span<State* const> files);
  static void commit_together(std::span<State* const> files);
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

/// The same file layer, below it a file that has no name: its bytes are those of a file.
void OutputFile::State::open_in_memory(const std::string& place) {
  const int fd = ::memfd_create("output", MFD_CLOEXEC);
  if (fd < 0) {
    cannot("create", place);
  }
  writer = std::make_unique<FileWriter>(fd, true, place);
}

void OutputFile::State::take_memory() {
  writer->flush();
  options.memory->resize(static_cast<std::size_t>(writer->size()));
  writer->read(0, *options.memory);
}

void OutputFile::State::open(const std::string& path, const std::string& place) {
  if (options.memory != nullptr) {
    open_in_memory(place);
    return;
  }
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
  partial.emplace(path, place);
  writer = std::make_unique<FileWriter>(partial->fd(), true, place);
  if (exists) {  // some file systems have no permissions to keep
    static_cast<void>(::fchmod(partial->fd(), status.st_mode & 07777));
  }
}

void OutputFile::State::sync_folders(std::span<State* const> files) {
  std::set<std::string> folders;
  for (const State* file : files) {
    if (file->options.sync) {
      folders.insert(folder_of(file->partial->target()));
    }
  }
  std::for_each(folders.begin(), folders.end(), sync_folder);
}

void OutputFile::State::commit_together(std::span<State* const> files) {
  std::vector<PartialFile*> renamed;
  renamed.reserve(files.size());
  try {
    for (State* file : files) {
      if (file == files.back()) {
        sync_folders(files.first(files.size() - 1));
      }
      file->partial->rename_for_now(file->options.force);
      renamed.push_back(&*file->partial);
    }
    sync_folders(files);
  } catch (...) {
    for (PartialFile* file : renamed) {
      file->undo();
    }
    throw;
  }
  PartialFile::confirm_all(renamed);
}

void OutputFile::State::close() {
  if (options.memory != nullptr) {
    take_memory();
  }
  if (options.sync) {
    writer->sync();
  }
  writer->close();
}

OutputFile::OutputFile(const std::string& path, Options options)
    : state_(std::make_unique<State>()) {
  state_->options = options;
  state_->open(path, path == "-" ? "<stdout>" : path);
}

OutputFile::~OutputFile() = default;

bool OutputFile::seekable() const { return state_->writer->has_offsets(); }

const std::string& OutputFile::place() const { return state_->writer->place(); }

std::uint64_t OutputFile::size() const { return state_->writer->size(); }

std::string OutputFile::scratch_folder() const {
  if (state_->partial) {
    return folder_of(state_->partial->target());
  }
  const char* tmpdir = std::getenv("TMPDIR");
  return tmpdir != nullptr && *tmpdir != '\0' ? tmpdir : "/tmp";
}

void OutputFile::note_spool() const {
  Progress* const told = std::exchange(state_->options.progress, nullptr);
  if (!seekable() && told != nullptr) {
    told->detail(place() + ": is no file: spooled to a temporary file in " + scratch_folder());
  }
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

void OutputFile::close() { state_->close(); }

void OutputFile::commit() { commit_all({this}); }

void OutputFile::commit_all(std::span<OutputFile* const> files) {
  std::vector<State*> named;
  for (OutputFile* file : files) {
    file->state_->close();
    if (file->state_->partial) {
      named.push_back(file->state_.get());
    }
  }
  if (named.size() == 1 && !named.front()->options.sync) {
    named.front()->partial->rename_into_place(named.front()->options.force);
  } else {
    State::commit_together(named);
  }
}

}  // namespace mc::sink
