// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include "mc/field.hpp"
#include "sink/output_file.hpp"

namespace mc::sink {

/// Appends the samples of slabs to a file, without gaps, in their own byte order. Halves become
/// floats of the same byte order.
class SampleWriter {
 public:
  SampleWriter(const Volume& volume, OutputFile& file);

  /// Planes come in order. Precondition: slab.k0 is the next one (asserted).
  void write(const Slab& slab);
  /// Errors   internal: planes are missing.
  void finish() const;

 private:
  void append_row(const std::byte* row);

  OutputFile& file_;
  SampleType type_;
  bool swapped_;
  Index3 dims_;
  std::size_t row_bytes_;
  std::int32_t n_planes_ = 0;
  std::vector<float> floats_;  // one row, where halves are converted
};

}  // namespace mc::sink
