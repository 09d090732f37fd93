// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/parallel.hpp"
#include "base/simd_target.hpp"
#include "cli/arguments/format_lists.hpp"
#include "cli/invocation.hpp"

// `mc --version -v`: what to quote when reporting a bug.

namespace mc::cli {

namespace {

/// Names of formats that are built in, those that need no library first.
template <class Formats, class Matches>
Names built_in(const Formats& formats, Matches&& matches) {
  Names always, here;
  for (const auto* format : formats) {
    if (!format->built_in || !matches(*format)) continue;
    (format->package.empty() ? always : here).push_back(format->name);
  }
  always.insert(always.end(), here.begin(), here.end());
  return always;
}

/// Formats that a package would bring.
struct Missing {
  std::string_view package;
  Names formats;
};

/// Of volumes, then meshes, then pictures.
std::vector<Missing> missing_packages() {
  std::vector<Missing> all;
  const auto add = [&](const auto* format) {
    if (format->built_in) return;
    auto at = std::ranges::find(all, format->package, &Missing::package);
    if (at == all.end()) at = all.insert(at, {format->package, {}});
    if (std::ranges::count(at->formats, format->name) == 0) at->formats.push_back(format->name);
  };
  const auto add_kind = [&](auto&& matches) {
    for (const SinkFormat* format : sink_formats()) {
      if (matches(*format)) add(format);
    }
  };
  add_kind([](const SinkFormat& f) { return f.open_volume && !f.open_picture; });
  add_kind([](const SinkFormat& f) { return f.open_mesh != nullptr; });
  add_kind([](const SinkFormat& f) { return f.open_picture != nullptr; });
  for (const SourceFormat* format : source_formats()) add(format);
  return all;
}

}  // namespace

std::string version_text(bool verbose) {
  std::string text = "mc " MC_VERSION "\n";
  if (!verbose) return text;
  text += fmt::format("reads    {}\n", joined(built_in(source_formats(), [](const auto& format) {
                        return format.open != nullptr;
                      })));
  text += fmt::format("meshes   {}\n", joined(built_in(sink_formats(), [](const auto& format) {
                        return format.open_mesh != nullptr;
                      })));
  text += fmt::format("volumes  {}\n", joined(built_in(sink_formats(), [](const auto& format) {
                        return format.open_volume != nullptr;
                      })));
  text += fmt::format("pictures {}\n", joined(built_in(sink_formats(), [](const auto& format) {
                        return format.open_picture != nullptr;
                      })));
  text += fmt::format("unpacks  {}\n", std::string(MC_WITH_GZIP != 0 ? "gzip " : "") +
                                           (MC_WITH_ZSTD != 0 ? "zstd" : ""));
  for (const Missing& missing : missing_packages()) {
    text += fmt::format("without  {} (build with {})\n", joined(missing.formats), missing.package);
  }
  if (MC_WITH_GZIP == 0) text += "without  gzip (build with zlib1g-dev)\n";
  if (MC_WITH_ZSTD == 0) text += "without  zstd (build with libzstd-dev)\n";
  text += fmt::format("simd     {} (of {})\n", base::simd_target_name(),
                      fmt::join(base::simd_targets(), " "));
  text += fmt::format("threads  {} ({})\n", base::thread_count(), MC_THREADS_BACK_END);
  return text;
}

}  // namespace mc::cli
