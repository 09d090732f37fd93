// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "cli/arguments/command_line.hpp"
#include "cli/invocation.hpp"
#include "cli/messages/help.hpp"
#include "cli/messages/report.hpp"
#include "mc/host.hpp"
#include "mc/source.hpp"

// `mc check`: counts what is wrong with meshes.

namespace mc::cli {

namespace {

std::string vector_text(const Vec3& v) { return fmt::format("{} {} {}", v[0], v[1], v[2]); }

/// The counts that make a mesh defective, those that are not zero.
std::string defects_text(const MeshReport& r, bool must_be_closed) {
  struct Count {
    std::uint64_t n;
    const char* name;
  };
  const Count counts[] = {{r.not_finite, "vertices that are not finite"},
                          {r.out_of_range, "triangles with an index out of range"},
                          {r.degenerate, "degenerate triangles"},
                          {r.duplicate, "duplicate triangles"},
                          {r.nonmanifold_edges, "edges with more than two triangles"},
                          {r.nonmanifold_vertices, "non-manifold vertices"},
                          {r.misoriented_edges, "edges with inconsistent orientation"},
                          {must_be_closed ? r.boundary_edges : 0, "boundary edges"}};
  std::string text;
  for (const Count& count : counts) {
    if (count.n == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count.n, count.name);
  }
  return text;
}

std::string lines(const std::string& path, const MeshReport& r, bool must_be_closed) {
  const bool defective = r.defective(must_be_closed);
  std::string text =
      fmt::format("{}: {}\n", path == "-" ? "<stdin>" : path,
                  defective ? "defective: " + defects_text(r, must_be_closed)
                            : std::string(r.closed() ? "good, closed" : "good, open"));
  const auto count = [&](const char* name, auto n) { text += fmt::format("  {:22}{}\n", name, n); };
  count("vertices", r.n_vertices);
  count("triangles", r.n_triangles);
  count("not finite", r.not_finite);
  count("out of range", r.out_of_range);
  count("degenerate", r.degenerate);
  count("duplicate", r.duplicate);
  count("boundary edges", r.boundary_edges);
  count("non-manifold edges", r.nonmanifold_edges);
  count("non-manifold vertices", r.nonmanifold_vertices);
  count("misoriented edges", r.misoriented_edges);
  count("unreferenced vertices", r.unreferenced_vertices);
  count("duplicate vertices", r.duplicate_vertices);
  count("components", r.components);
  count("euler number", r.euler);
  count("area", r.area);
  count("volume", r.volume);
  if (!r.bounds.empty()) {
    count("bounds", vector_text(r.bounds.lo) + " to " + vector_text(r.bounds.hi));
  }
  return text;
}

/// One mesh; returns 7 when it is defective.
int check_one(const std::string& path, const CheckArgs& args) {
  const MeshReport report = check_mesh(read_mesh(path));
  refuse_changed_inputs();
  const bool defective = report.defective(args.closed);
  print_out(args.json ? to_json(path, report, defective) + "\n" : lines(path, report, args.closed));
  return defective ? static_cast<int>(ErrorKind::defect) : 0;
}

}  // namespace

int run_check(Invocation& invocation, std::vector<std::string> words) {
  CheckArgs args;
  parse_words("check", options_of(args), &args.inputs, std::move(words));
  if (args.common.help) {
    print_out(help_text("check", args.common.verbose > 0));
    return 0;
  }
  if (args.inputs.empty()) {
    throw Error(ErrorKind::usage, "check", "no mesh: expected a file, or - for stdin",
                "see mc check --help");
  }
  invocation.console.configure(resolve_common(args.common));
  int status = 0;
  for (const std::string& path : args.inputs) {
    int this_status = 0;
    const auto failure = attempt([&] { this_status = check_one(path, args); });
    if (failure) this_status = show(invocation.console, *failure);
    if (status == 0) status = this_status;
  }
  return status;
}

}  // namespace mc::cli
