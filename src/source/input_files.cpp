// SPDX-License-Identifier: MIT
#include "source/input_files.hpp"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "base/text.hpp"
#include "source/natural_order.hpp"
#include "source/text.hpp"

namespace mc::source {

namespace {

namespace fs = std::filesystem;

/// Files that lie beside slices and describe them; a series never holds them.
bool describes_others(const std::string& path) {
  constexpr std::array<std::string_view, 5> kDescribing{"nhdr", "json", "md", "txt", "xml"};
  return std::ranges::find(kDescribing, base::extension_of(path)) != kDescribing.end();
}

std::vector<std::string> without_descriptions(std::vector<std::string> paths, Progress& progress) {
  const auto first = std::stable_partition(paths.begin(), paths.end(),
                                           [](const auto& p) { return !describes_others(p); });
  if (first == paths.begin()) {
    return paths;  // nothing but descriptions: one of them may be what is meant
  }
  for (auto left_out = first; left_out != paths.end(); ++left_out) {
    progress.note(fmt::format("{}: left out of the series", *left_out));
  }
  paths.erase(first, paths.end());
  return paths;
}

std::vector<std::string> files_of_folder(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code error;
  fs::directory_iterator entries(folder, error);
  for (; !error && entries != fs::directory_iterator(); entries.increment(error)) {
    std::error_code ignored;
    const std::string name = entries->path().filename().string();
    if (!name.starts_with('.') && !entries->is_directory(ignored)) {
      paths.push_back(entries->path().string());
    }
  }
  if (error) {
    throw Error(ErrorKind::input, folder, "cannot read: " + error.message());
  }
  if (paths.empty()) {
    throw Error(ErrorKind::input, folder, "a folder with no known file");
  }
  return paths;
}

std::vector<std::string> files_of_glob(const std::string& pattern) {
  glob_t found{};
  const int status = ::glob(pattern.c_str(), GLOB_NOSORT, nullptr, &found);
  std::vector<std::string> paths;
  if (status == 0) {
    paths.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
  std::erase_if(paths, [](const auto& path) {
    std::error_code ignored;
    return fs::is_directory(path, ignored);
  });
  if (paths.empty()) {
    throw Error(ErrorKind::input, pattern, "no such file, and no file matches the pattern");
  }
  return paths;
}

bool is_glob(const std::string& name) {
  std::error_code ignored;
  return name.find_first_of("*?[") != std::string::npos && !fs::exists(name, ignored);
}

bool is_folder(const std::string& name) {
  std::error_code ignored;
  return fs::is_directory(name, ignored);
}

void order_series(std::vector<std::string>& paths) {
  std::ranges::sort(paths, natural_path_less);
  const auto twice = std::ranges::adjacent_find(paths);
  if (twice != paths.end()) {
    throw Error(ErrorKind::usage, *twice, "named twice; give each slice once");
  }
  if (paths.size() > 1 && std::ranges::find(paths, "-") != paths.end()) {
    throw Error(ErrorKind::usage, "<stdin>", "cannot be one of several inputs");
  }
}

}  // namespace

void check_regular(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status)) {
    throw Error(ErrorKind::input, path, "is no regular file");
  }
}

void check_within(const std::string& root, const std::string& path) {
  if (root.empty()) return;
  std::error_code error;
  const fs::path folder = fs::canonical(root, error);
  if (error) {
    throw Error(ErrorKind::usage, "--root", fmt::format("{}: {}", root, error.message()));
  }
  const fs::path file = fs::weakly_canonical(path, error);
  const auto [end, ignored] = std::ranges::mismatch(folder, file);
  if (error || end != folder.end()) {
    throw Error(ErrorKind::input, path, fmt::format("lies outside of {}, which --root names", root),
                "name files in it only");
  }
}

std::string unpacked_extension_of(const std::string& path) {
  const std::string extension = base::extension_of(path);
  const bool packed = extension == "gz" || extension == "zst";
  return packed ? base::extension_of(fs::path(path).stem().string()) : extension;
}

InputFiles expand_inputs(std::span<const std::string> inputs, Progress& progress) {
  if (inputs.empty() || inputs.front().empty()) {
    throw Error(ErrorKind::usage, "", "no input; name a file, a folder or - for stdin");
  }
  InputFiles out;
  out.place = inputs.front() == "-" ? "<stdin>" : inputs.front();
  out.from_folder = inputs.size() == 1 && is_folder(inputs.front());
  for (const std::string& input : inputs) {
    std::vector<std::string> paths{input};
    if (out.from_folder) {
      paths = without_descriptions(files_of_folder(input), progress);
    } else if (is_folder(input)) {
      throw Error(ErrorKind::usage, input, "a folder cannot be one of several inputs");
    } else if (is_glob(input)) {
      paths = without_descriptions(files_of_glob(input), progress);
    }
    out.paths.insert(out.paths.end(), paths.begin(), paths.end());
  }
  order_series(out.paths);
  return out;
}

}  // namespace mc::source
