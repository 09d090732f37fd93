// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <optional>

#include "base/machine_memory.hpp"
#include "base/parallel.hpp"
#include "cli/arguments/command_line.hpp"
#include "cli/edit/edit_report.hpp"
#include "cli/edit/resolve_edit.hpp"
#include "cli/invocation.hpp"
#include "cli/messages/help.hpp"
#include "cli/messages/peak_memory.hpp"
#include "cli/messages/report.hpp"
#include "cli/messages/report_file.hpp"
#include "cli/messages/summary.hpp"

// `mc edit`: a volume, changed by a script of brush edits, to meshes and volumes.

namespace mc::cli {

namespace {

/// What a record of a dry run would do.
std::string description_of(const RecordReport& report) {
  if (!report.n_reached) {
    return fmt::format("record {:<4} {}{}\n", report.number, report.op,
                       report.output ? " " + *report.output : "");
  }
  const EditEffect& e = report.effect;
  const std::string what = fmt::format("record {:<4} {:<8} {} dabs, {} samples", report.number,
                                       report.op, e.n_dabs, e.n_samples);
  if (is_empty(e.touched)) return what + ", outside the volume\n";
  return fmt::format("{} in {} chunks, {} to {}\n", what, *report.n_reached,
                     fmt::join(e.touched.lo, ","), fmt::join(e.touched.hi, ","));
}

/// Turns what a script does into lines of JSON, and into chunks on stdout.
class EditTalk final : public ScriptObserver {
 public:
  EditTalk(const EditPlan& plan, Invocation& invocation)
      : plan_(plan), invocation_(invocation), file_(plan.report, invocation.stop.get_token()) {
    if (is_heard() || plan.common.verbose) peak_.emplace();
  }

  void record(const RecordReport& report) override {
    if (plan_.options.base.dry_run) return describe(report);
    if (is_heard()) tell(to_json(report));
  }
  void output(const std::string& path, const ConvertReport& report) override {
    summary_.add_mesh(report.totals);
    if (!is_heard()) return;
    RunReport line;
    line.output = path;
    line.done = report;
    line.peak_bytes = peak_->bytes();
    tell(to_json(line));
  }
  void fault(const Error& error) override { show(invocation_.console, failure_of(error)); }
  void chunk(std::uint64_t record, const Index3& id, std::span<const std::byte> glb) override {
    print_out(fmt::format("{{\"record\":{},\"chunk\":[{},{},{}],\"bytes\":{}}}\n", record, id[0],
                          id[1], id[2], glb.size()));
    print_out({reinterpret_cast<const char*>(glb.data()), glb.size()});
  }
  /// The word at the end of a success.
  void summarise() {
    if (!invocation_.console.shows_summary() || plan_.options.base.dry_run ||
        plan_.sends_chunks()) {
      return;
    }
    std::vector<std::string> paths;
    for (const ScriptOutput& output : plan_.options.outputs) {
      if (output.path == "-") return;
      paths.push_back(output.path);
      summary_.add_file(output.path);
    }
    if (paths.empty()) paths.push_back(plan_.inputs.front());
    invocation_.console.note(summary_.text(fmt::format("{}", fmt::join(paths, ", "))));
  }
  /// The last line.
  void close(EditRunReport report) {
    report.warnings = invocation_.console.take_warnings();
    if (peak_) {
      report.peak_bytes = peak_->bytes();
      invocation_.console.detail(
          fmt::format("memory: {} at its peak", base::size_text(report.peak_bytes)));
    }
    if (is_heard()) tell(to_json(report));
    file_.finish();
  }

 private:
  [[nodiscard]] bool is_heard() const { return plan_.report || plan_.options.chunks; }

  void describe(const RecordReport& report) {
    if (plan_.report && report.n_reached) file_.add_line(to_json(report));
    if (plan_.report != "-") print_out(description_of(report));
  }
  void tell(const std::string& line) {
    if (plan_.report) file_.add_line(line);
    if (plan_.lines_on_stdout() && plan_.report != "-") print_out(line + "\n");
  }

  const EditPlan& plan_;
  Invocation& invocation_;
  ReportFile file_;
  Summary summary_;
  std::optional<PeakMemory> peak_;  // only with a report, or -v
};

void refuse_chunks_on_terminal(const EditPlan& plan) {
  if (!plan.sends_chunks() || plan.options.base.sink.force || plan.options.base.dry_run) return;
  if (::isatty(STDOUT_FILENO) == 1) {
    throw Error(ErrorKind::output, "<stdout>", "is a terminal, and the output is binary",
                "redirect it, give --chunk-dir DIR, or add --force");
  }
}

}  // namespace

int run_edit(Invocation& invocation, std::vector<std::string> words) {
  EditArgs args;
  args.common.typed = words;
  parse_words("edit", options_of(args), &args.source.inputs, std::move(words));
  if (args.common.help) {
    print_out(help_text("edit", args.common.verbose > 0));
    return 0;
  }
  const EditPlan plan = resolve(args);
  invocation.console.configure(plan.common);
  std::optional<base::ThreadLimit> limit;
  if (plan.common.threads > 0) limit.emplace(plan.common.threads);
  EditTalk talk(plan, invocation);
  EditRunReport report;
  const auto failure = attempt([&] {
    refuse_chunks_on_terminal(plan);
    apply_script(plan.inputs, plan.script, plan.options, talk, invocation.console,
                 invocation.stop.get_token(), report.done);
  });
  if (failure) {
    report.status = show(invocation.console, *failure);
    report.error = fmt::format("{}", fmt::join(failure->lines, "\n"));
  } else if (report.done.fault) {
    report.status = static_cast<int>(*report.done.fault);
  } else {
    talk.summarise();
  }
  // A stdout that took no more takes no last line either: that is reported once.
  const auto last = attempt([&] { talk.close(report); });
  if (!last) return report.status;
  const std::string text = fmt::format("{}", fmt::join(last->lines, "\n"));
  return text == report.error ? report.status : show(invocation.console, *last);
}

}  // namespace mc::cli
