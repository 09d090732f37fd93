// SPDX-License-Identifier: MIT
#include "sink/nrrd/sample_writer.hpp"

#include <bit>
#include <cassert>
#include <cstring>
#include <span>

#include "field/visit_type.hpp"

// Samples as a flat file has them: i fastest, then j, then k, nothing between.

namespace mc::sink {

namespace {

float float_of(const std::byte* half, bool swapped) {
  if (!swapped) return to_float(field::load_sample<Half, false>(half));
  const float value = to_float(field::load_sample<Half, true>(half));
  return std::bit_cast<float>(field::byte_swapped<4>(std::bit_cast<std::uint32_t>(value)));
}

}  // namespace

SampleWriter::SampleWriter(const Volume& volume, OutputFile& file)
    : file_(file),
      type_(volume.type),
      swapped_(volume.endian != std::endian::native),
      dims_(volume.lattice.dims()),
      row_bytes_(static_cast<std::size_t>(dims_[0]) * sample_size(volume.type)),
      floats_(type_ == SampleType::f16 ? static_cast<std::size_t>(dims_[0]) : 0) {}

void SampleWriter::append_row(const std::byte* row) {
  if (type_ != SampleType::f16) {
    file_.append(std::span(row, row_bytes_));
    return;
  }
  for (std::size_t i = 0; i < floats_.size(); ++i) {
    floats_[i] = float_of(row + i * sizeof(Half), swapped_);
  }
  file_.append_array(std::span<const float>(floats_));
}

void SampleWriter::write(const Slab& slab) {
  assert(slab.k0 == n_planes_);
  const auto n_rows = static_cast<std::size_t>(dims_[1]);
  for (const std::byte* plane : slab.planes) {
    if (slab.row_stride_bytes == row_bytes_ && type_ != SampleType::f16) {
      file_.append(std::span(plane, row_bytes_ * n_rows));
    } else {
      for (std::size_t j = 0; j < n_rows; ++j) append_row(plane + j * slab.row_stride_bytes);
    }
    ++n_planes_;
  }
}

void SampleWriter::finish() const {
  if (n_planes_ != dims_[2]) {
    throw Error(ErrorKind::internal, file_.place(), "the volume was not written to its end");
  }
}

}  // namespace mc::sink
