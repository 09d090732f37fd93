// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <cstdint>
#include <memory>
#include <optional>

#include "mc/field.hpp"

namespace mc::pipe {

/// The dense input of a run: planes that are read in any order and again, or a stream of them.
/// Keeps a pointer to the reader or stream.
class PlaneInput {
 public:
  // NOLINTNEXTLINE(google-explicit-constructor): a reader is an input
  PlaneInput(const SlabReader& reader) : reader_(&reader) {}

  /// Precondition: is_dense(reader).
  static PlaneInput of(const VolumeReader& reader) {
    if (const auto* stream = std::get_if<std::unique_ptr<PlaneStream>>(&reader)) {
      PlaneInput input;
      input.stream_ = stream->get();
      input.single_pass_ = true;
      return input;
    }
    return *std::get<std::unique_ptr<SlabReader>>(reader);
  }
  /// The samples of `reader`, planned for as if they came from a stream. Only for estimates: they
  /// are read in any order.
  static PlaneInput planned_as_stream(const SlabReader& reader) {
    PlaneInput input(reader);
    input.single_pass_ = true;
    return input;
  }

  [[nodiscard]] const Volume& volume() const {
    return stream_ != nullptr ? stream_->volume() : reader_->volume();
  }
  /// Whether planes are read once, in order, one read at a time.
  [[nodiscard]] bool single_pass() const { return single_pass_; }
  [[nodiscard]] bool rereads_cheaply() const { return !single_pass_ && reader_->rereads_cheaply(); }
  /// SlabReader::copies().
  [[nodiscard]] std::unique_ptr<SlabReader> copies(std::size_t n_planes) const {
    return single_pass_ ? nullptr : reader_->copies(n_planes);
  }
  [[nodiscard]] std::uint64_t held_bytes() const {
    return single_pass_ ? 0 : reader_->held_bytes();
  }
  /// Planes [k0, k1); with a query only what it needs of them.
  void read(std::int32_t k0, std::int32_t k1, const std::optional<SurfaceQuery>& query,
            Slab& out) const {
    if (stream_ != nullptr) {
      query ? stream_->read_surface(k0, k1, *query, out) : stream_->read(k0, k1, out);
    } else {
      query ? reader_->read_surface(k0, k1, *query, out) : reader_->read(k0, k1, out);
    }
  }

 private:
  PlaneInput() = default;

  const SlabReader* reader_ = nullptr;
  PlaneStream* stream_ = nullptr;
  bool single_pass_ = false;
};

}  // namespace mc::pipe
