// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mc/base.hpp"
#include "source/live_mapping.hpp"
#include "source/stream/input_file.hpp"

// A file's bytes, read-only. Regular files are mapped; what cannot be mapped (a pipe, a FIFO,
// packed data) is first copied to an unlinked temporary file in $TMPDIR, so that every reader may
// seek. A piped stdin is replaced by its copy: who opens it again finds all of it.

namespace mc::source {

class MappedFile {
 public:
  /// Whether the file stays open beside its mapping: a process may have few files open.
  enum class Keep : bool { mapping, open_file };
  static constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

  /// "-" is stdin. A stream is read up to `most_bytes` and one more, which tells that it is longer;
  /// a device, which may never end, only with such a limit. Errors   input (missing, a folder,
  /// unreadable, empty, an endless device, damaged where packed); output: no room for a copy;
  /// limit: no address space.
  explicit MappedFile(const std::string& path, std::uint64_t most_bytes = kUnlimited);
  /// The same of what has been opened; a detail says when a copy is made.
  explicit MappedFile(InputFile input, std::uint64_t most_bytes = kUnlimited,
                      Progress& progress = silent_progress(), Keep keep = Keep::mapping);
  /// Maps a file that is not there by name.
  MappedFile(std::string place, const Descriptor& file);
  ~MappedFile();
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const { return {data_, size_}; }
  [[nodiscard]] std::string_view text() const;
  /// The open file; -1 if it was not kept.
  [[nodiscard]] int descriptor() const { return file_ ? file_->get() : -1; }
  /// How messages name it: the path, or "<stdin>".
  [[nodiscard]] const std::string& place() const { return place_; }

 private:
  void map(const Descriptor& file);

  std::string place_;
  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  LiveMapping live_;
  std::optional<Descriptor> file_;
};

}  // namespace mc::source
