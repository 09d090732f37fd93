// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/chunk_emitter.hpp"
#include "cli/edit_report.hpp"
#include "cli/invocation.hpp"
#include "cli/journal.hpp"
#include "cli/peak_memory.hpp"
#include "cli/report_file.hpp"
#include "cli/resolve_edit.hpp"
#include "mc/edit.hpp"
#include "mc/source.hpp"
#include "source/script/script.hpp"

// A volume, a script, and what becomes of them.

namespace mc::cli {

class EditSession {
 public:
  EditSession(const EditArgs& args, EditPlan plan, Invocation& invocation);

  /// All of it; returns the exit status. What ends the work is thrown.
  int run();
  /// The last line of the report, with what was thrown.
  void close_report(int status, const std::optional<std::string>& error);

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
  void pin(EditOutput& output) const;
  void probe(const EditOutput& output) const;
  void describe();
  void begin();
  void begin_to_emit();
  void end_to_emit();
  template <class Emit>
  void tell_state(const char* op, Emit&& emit);
  void note_materials() const;
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
  void write_output(EditOutput output);
  void tell(const std::string& line);
  [[nodiscard]] bool is_heard() const;
  [[nodiscard]] Bounds bounds_of(const IndexBox& touched) const;

  const EditArgs& args_;
  EditPlan plan_;
  Invocation& invocation_;
  ReportFile report_;
  std::optional<PeakMemory> peak_;  // only with a report
  source::Script script_;
  std::optional<Source> source_;
  std::optional<EditStore> store_;
  std::unique_ptr<Journal> journal_;
  std::unique_ptr<ChunkEmitter> emitter_;
  std::vector<EditOutput> writes_;  // those of a script that was looked at beforehand
  std::set<std::string> written_;   // their names
  bool may_undo_ = true;
  std::uint64_t n_writes_ = 0;
  std::uint64_t last_number_ = 0;  // of the records done
  std::uint64_t hash_ = 0;         // of the store, where a journal is kept
  int status_ = 0;
  EditTotals totals_;
};

}  // namespace mc::cli
