// SPDX-License-Identifier: MIT
#include "cli/commands/batch.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/machine_memory.hpp"
#include "base/parallel.hpp"
#include "cli/arguments/values.hpp"
#include "cli/messages/peak_memory.hpp"
#include "cli/messages/report.hpp"
#include "cli/messages/summary.hpp"
#include "mc/convert.hpp"

// Starting and joining threads costs more than a small file does: such files take turns on the
// threads, and only runs of larger ones are spread over all threads.

namespace mc::cli {

namespace {

/// One job as it went.
struct Outcome {
  RunReport report;
  std::vector<std::string> lines;  ///< that it said
};

bool exists(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0;
}

/// Converts one volume, or with --dry-run says what that would do.
void run_job(const ExtractPlan& plan, const Job& job, Invocation& invocation, RunReport& report) {
  ConvertOptions options = plan.convert;
  if (plan.common.verbose) {
    options.on_memory_need = [&](const MemoryNeed& need) {
      invocation.console.detail(fmt::format("memory: {}", memory_text(need)));
    };
  }
  convert(job.inputs, job.output, options, invocation.console, invocation.stop.get_token(),
          report.done);
  if (options.dry_run && plan.report != "-") {
    print_out(dry_run_text(report.done, job.output, options.extract.region));
  }
}

/// Whatever becomes of a job, its report is complete and its failure told.
void run_reported(const ExtractPlan& plan, const Job& job, Invocation& invocation,
                  RunReport& report) {
  report.output = job.output;
  if (plan.skip_existing && exists(job.output)) {
    report.done.input = job.inputs.front();
    report.skipped = true;
    invocation.console.detail(
        fmt::format("{}: skipped, {} already exists", job.inputs.front(), job.output));
    return;
  }
  const auto failure = attempt([&] { run_job(plan, job, invocation, report); });
  if (failure) {
    report.status = show(invocation.console, *failure);
    report.error = fmt::format("{}", fmt::join(failure->lines, "\n"));
  }
  report.warnings = invocation.console.take_warnings();
}

/// A file whose samples are few. What a document makes its size does not tell.
bool is_small(const Job& job) {
  constexpr off_t kMostBytes = 8 << 20, kPackedBytes = 1 << 20;
  const std::string& input = job.inputs.front();
  struct stat status {};
  if (::stat(input.c_str(), &status) != 0) return true;  // a failure is quick
  const bool packed = input.ends_with(".gz") || input.ends_with(".zst");
  return S_ISREG(status.st_mode) && !input.ends_with(".json") &&
         status.st_size <= (packed ? kPackedBytes : kMostBytes);
}

class Batch {
 public:
  Batch(const ExtractPlan& plan, Invocation& invocation, ReportFile& file)
      : plan_(plan), invocation_(invocation), file_(file) {
    if (plan.report || plan.common.verbose) peak_.emplace();
  }

  void run() {
    const std::span<const Job> jobs(plan_.jobs);
    for (std::size_t first = 0; first < jobs.size() && !stopped();) {
      const auto rest = jobs.subspan(first);
      const bool several = base::thread_count() > 1;
      const auto end = several ? std::ranges::find_if_not(rest, is_small) : rest.begin();
      const auto n_small = static_cast<std::size_t>(end - rest.begin());
      if (n_small > 1) {
        run_at_once(rest.first(n_small));
        first += n_small;
      } else {
        run_alone(rest.front());
        ++first;
      }
    }
    summarise();
    if (peak_) {
      invocation_.console.detail(
          fmt::format("memory: {} at its peak", base::size_text(peak_->bytes())));
    }
  }
  [[nodiscard]] int status() const { return status_; }

 private:
  [[nodiscard]] bool stopped() const { return invocation_.stop.stop_requested(); }

  void run_alone(const Job& job) {
    RunReport report;
    run_reported(plan_, job, invocation_, report);
    add(report);
  }

  void run_at_once(std::span<const Job> jobs) {
    ExtractPlan shared = plan_;
    shared.jobs.clear();
    shared.convert.memory_bytes /= base::pipeline_slots();
    std::vector<Outcome> outcomes(base::pipeline_slots());
    invocation_.console.begin("batch", jobs.size(), "files");
    const std::array<base::Step, 2> steps{{
        {false,
         [&](std::size_t n, std::size_t slot) {
           if (!stopped()) base::alone([&] { outcomes[slot] = run_kept(shared, jobs[n]); });
         }},
        {true,
         [&](std::size_t n, std::size_t slot) {
           if (!stopped()) tell(jobs[n], outcomes[slot]);
         }},
    }};
    base::pipeline(jobs.size(), outcomes.size(), steps);
    invocation_.console.end_stage();
  }

  /// What a job says is kept until its turn.
  [[nodiscard]] Outcome run_kept(const ExtractPlan& shared, const Job& job) const {
    Invocation own;
    own.stop = invocation_.stop;
    own.console.configure(plan_.common);
    own.console.keep_lines();
    Outcome outcome;
    run_reported(shared, job, own, outcome.report);
    outcome.lines = own.console.take_lines();
    return outcome;
  }

  /// A job for which its share of the memory was too little has all of it now.
  void tell(const Job& job, Outcome& outcome) {
    if (outcome.report.status == static_cast<int>(ErrorKind::limit)) {
      run_alone(job);
    } else {
      invocation_.console.print_lines(outcome.lines);
      add(outcome.report);
    }
    invocation_.console.advance(1);
  }

  /// Only of a success, or of a batch.
  void summarise() {
    if (!invocation_.console.shows_summary() || plan_.convert.dry_run || stopped()) return;
    if (plan_.batch) {
      invocation_.console.note(summary_.text(plan_.out_dir));
    } else if (const std::string& output = plan_.jobs.front().output;
               status_ == 0 && output != "-") {
      invocation_.console.note(summary_.text(output));
    }
  }

  void add_to_summary(const RunReport& report) {
    const bool written = report.status == 0 && !report.skipped;
    if (plan_.batch) summary_.add_input(written);
    if (!written || plan_.convert.dry_run) return;
    summary_.add_file(*report.output);
    summary_.add_mesh(report.done.totals);
  }

  void add(RunReport& report) {
    add_to_summary(report);
    if (peak_) report.peak_bytes = peak_->bytes();
    file_.add_line(to_json(report));
    if (status_ == 0) status_ = report.status;
  }

  const ExtractPlan& plan_;
  Invocation& invocation_;
  ReportFile& file_;
  std::optional<PeakMemory> peak_;
  Summary summary_;
  int status_ = 0;
};

}  // namespace

int run_jobs(const ExtractPlan& plan, Invocation& invocation, ReportFile& file) {
  Batch batch(plan, invocation, file);
  batch.run();
  return batch.status();
}

}  // namespace mc::cli
