// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mc/base.hpp"

// From what the user named (files, a folder, a quoted glob) to the files it means.

namespace mc::source {

struct InputFiles {
  std::vector<std::string> paths;  ///< never empty; "-" is stdin; a series is in natural order
  std::string place;               ///< how messages name the whole: the first input
  bool from_folder = false;        ///< the one input was a folder
};

/// Expands folders and globs and puts several files into natural order. A name is a glob only where
/// no file of that literal name exists. Of a folder or glob, hidden files and files that by their
/// extension describe others (.nhdr, .json, .md, .txt, .xml) are left out, the latter with a note.
/// Errors   input: missing, a folder without files; usage: a file named twice, a folder among
///          several inputs, "-" among several inputs.
InputFiles expand_inputs(std::span<const std::string> inputs, Progress& progress);

/// For files that a document names: opening others may wait for ever.
/// Errors   input: a FIFO or a device. What is not there is no error.
void check_regular(const std::string& path);

/// Files that others name must lie in the folder `root`, symbolic links followed. Empty: anywhere.
/// Errors   input: the path leads out; usage: there is no such folder.
void check_within(const std::string& root, const std::string& path);

/// The extension in lower case without its dot and without what packing adds: "raw" of
/// "head.raw.gz". Empty: it has none.
std::string unpacked_extension_of(const std::string& path);

}  // namespace mc::source
