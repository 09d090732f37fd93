// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>

// A file under a name of its own beside the one it is to get.

namespace mc::sink {

class PartialNames;

/// The folder part of a path; "." where there is none.
std::string folder_of(const std::string& path);

class PartialFile {
 public:
  /// Creates TARGET.partial-XXXX, where TARGET is what `path` names in the end (links are
  /// followed). `place` is how messages call it. Errors   output: cannot be made.
  PartialFile(const std::string& path, std::string place);
  /// Whatever has not its final name is unlinked.
  ~PartialFile();
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;

  [[nodiscard]] const std::string& target() const { return target_; }
  /// What it was created with, to be closed by who writes it.
  [[nodiscard]] int fd() const { return fd_; }

  /// Gives it its final name; `may_replace` a file that has it. Errors   output.
  void rename_into_place(bool may_replace);
  /// The same, to be undone or confirmed: what had the name is kept beside it.
  void rename_for_now(bool may_replace);
  void undo() noexcept;
  /// Ends that for all at once.
  static void confirm_all(std::span<PartialFile* const> files) noexcept;

 private:
  void create();
  void move(bool may_replace) const;
  void keep_former();
  void put_back_former(PartialNames& names) noexcept;

  std::string target_, place_;
  std::string name_;    // empty once it is in place or gone
  std::string former_;  // what had the name before, while that may come back
  int fd_ = -1;
};

/// Waits until the folder's entries are on the disk. Errors   output.
void sync_folder(const std::string& folder);

}  // namespace mc::sink
