// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <streambuf>
#include <string>
#include <utility>
#include <vector>

#include "mc/field.hpp"

// What stands between mc and OpenVDB. OpenVDB's library takes longer to load than most runs take:
// what needs it is a module of its own, loaded when a VDB file is written. Only this header is seen
// from both sides.

namespace mc::sink {

/// Grows one grid, then writes it.
class VdbWriter {
 public:
  virtual ~VdbWriter() = default;
  /// Errors   output: a map that cannot be inverted.
  virtual void begin(const Volume& volume) = 0;
  virtual void write(const Slab& slab) = 0;
  virtual void write_sparse(const LeafReader& reader) = 0;
  /// Writes a whole VDB file, going back in it. `meta` becomes metadata of the file.
  virtual void finish(std::streambuf& bytes,
                      const std::vector<std::pair<std::string, std::string>>& meta) = 0;
};

/// What the module exports, by the name kVdbWriterSymbol; `place` is the output in messages.
using MakeVdbWriter = VdbWriter* (*)(const std::string& place);
inline constexpr const char* kVdbWriterSymbol = "mc_make_vdb_writer";

}  // namespace mc::sink

extern "C" mc::sink::VdbWriter* mc_make_vdb_writer(const std::string& place);
