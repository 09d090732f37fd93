// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "convert/chunk_writer.hpp"
#include "convert/journal.hpp"
#include "mc/convert.hpp"
#include "source/script/script.hpp"

// A volume, a script, and what becomes of them: see apply_script().

namespace mc::conversion {

class ScriptRun {
 public:
  /// Opens the script. Keeps references to all but the script's path.
  ScriptRun(std::span<const std::string> inputs, const std::string& script,
            const ScriptOptions& options, ScriptObserver& observer, Progress& progress,
            const std::stop_token& stop, ScriptReport& report);

  void run();
  /// Enters into the report what the edits stored so far.
  void report_store();

 private:
  using Clock = std::chrono::steady_clock;

  static bool is_step(source::RecordKind kind) {
    return kind == source::RecordKind::undo || kind == source::RecordKind::redo;
  }
  void check_script();
  void look_at_write(const source::ScriptRecord& record);
  void check_outputs();
  void open_input();
  void choose_surface();
  void probe(const ScriptOutput& output) const;
  void describe();
  void begin();
  template <class Write>
  void report_state(const char* op, Write&& write);
  void warn_of_clamped_values() const;
  void follow_script();
  std::optional<source::ScriptRecord> next_record();
  void do_record(const source::ScriptRecord& record);
  EditEffect apply(const source::ScriptRecord& record);
  EditEffect measure(const source::ScriptRecord& record);
  void step_back_or_forth(const source::ScriptRecord& record, RecordReport& report);
  void count_outside(const source::ScriptRecord& record, const EditEffect& effect);
  void check_hash(const source::ScriptRecord& record, const std::optional<std::uint64_t>& expected,
                  const char* when) const;
  void note_in_journal(const source::ScriptRecord& record, std::size_t n_steps);
  [[nodiscard]] ScriptOutput output_of_write(const std::string& path) const;
  void write_output(const ScriptOutput& output);
  [[nodiscard]] Bounds bounds_of(const IndexBox& touched) const;

  std::span<const std::string> inputs_;
  const ScriptOptions& options_;
  ScriptObserver& observer_;
  Progress& progress_;
  const std::stop_token& stop_;
  ScriptReport& report_;
  source::Script script_;
  std::optional<Source> source_;
  Surface surface_;
  std::optional<EditStore> store_;
  std::unique_ptr<Journal> journal_;
  std::unique_ptr<ChunkWriter> chunks_;
  std::vector<ScriptOutput> writes_;  // those of a script that was checked beforehand
  std::set<std::string> written_;     // their names
  bool may_undo_ = true;
  std::uint64_t n_writes_ = 0;
  std::uint64_t last_number_ = 0;  // of the records done
  std::uint64_t hash_ = 0;         // of the store, where a journal is kept
};

}  // namespace mc::conversion
