// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mc/base.hpp"
#include "mc/edit.hpp"
#include "source/spec/spec_files.hpp"

// Scripts of brush edits: the format mc-edits, see mc-edits(5). One JSON document, or JSON Lines
// whose first line is the header, read record by record.

namespace mc::source {

/// What holds for a whole script.
struct ScriptHeader {
  bool index_space = false;  ///< places are sample indices, else the volume's world coordinates
  double dt = 0.02;          ///< seconds a step
  std::array<double, 2> clamp{-std::numeric_limits<double>::infinity(),
                              std::numeric_limits<double>::infinity()};
  bool journal = false;  ///< written by --journal: its last line may be torn
};

enum class RecordKind : std::uint8_t { edit, group, undo, redo, write };

struct ScriptRecord {
  RecordKind kind = RecordKind::edit;
  std::uint64_t number = 0;  ///< of the whole script, from 1; members of a group have the group's
  std::string op;            ///< as it is written
  std::string name;          ///< group
  Edit edit{};
  std::vector<ScriptRecord> members{};    ///< group
  std::size_t count = 1;                  ///< undo, redo: at least 1
  std::string path;                       ///< write: a pattern, see path_of_write()
  std::optional<std::uint64_t> before{};  ///< a journal's hash of the volume before and after
  std::optional<std::uint64_t> after{};
  std::string text;  ///< the record as one line of JSON, what the header's defaults give included
};

class Script {
 public:
  static constexpr std::size_t kMostNesting = 64;       ///< groups in groups
  static constexpr std::size_t kMostPoints = 1000000;   ///< of a path
  static constexpr std::uint64_t kMostDabs = 1000000;   ///< of an edit; of a group ten times that
  static constexpr std::uint32_t kMostSteps = 1000000;  ///< of an edit
  static constexpr std::uint32_t kMostIterations = 100;
  static constexpr std::size_t kMostLineBytes = std::size_t{1} << 28;

  /// Opens a script; "-" is stdin, of which no more is read than the header (or the document).
  /// `within` bounds the files that it names.
  /// Errors   usage: every fault of the header, or of the document; input: cannot be read.
  explicit Script(const std::string& path, const SpecNesting& within = {});
  /// The same over a text in memory; `place` is how messages name it.
  Script(std::string place, std::string text);
  ~Script();
  Script(Script&& other) noexcept;
  Script& operator=(Script&& other) noexcept;

  [[nodiscard]] const std::string& place() const;
  [[nodiscard]] const ScriptHeader& header() const;
  /// The header as a journal has it, one line of JSON.
  [[nodiscard]] std::string journal_header() const;
  /// Whether records come as they are written to a pipe, and cannot be looked at beforehand.
  [[nodiscard]] bool is_live() const;

  /// The next record; none at the end. Waits for a live one's line.
  /// Errors   usage: the record's faults; the record after it can be read all the same.
  std::optional<ScriptRecord> next();
  /// Shows every record to `look`, then begins anew. Only of scripts that are not live.
  /// Errors   usage: the faults of all records, 20 at most; what `look` throws counts as a fault
  ///          where it is an Error of kind usage.
  void check(const std::function<void(const ScriptRecord&)>& look);
  /// A torn last line of a journal was left out: where it was.
  [[nodiscard]] const std::string& torn() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The path of the n-th write: {n} and {n:04} stand for n, which counts from 1.
[[nodiscard]] std::string path_of_write(std::string_view pattern, std::uint64_t n);

}  // namespace mc::source
