// SPDX-License-Identifier: MIT
#include "source/placement.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mc::source {

namespace {

class PlacedReader final : public SlabReader {
 public:
  PlacedReader(std::unique_ptr<SlabReader> reader, const SourceOptions& options)
      : reader_(std::move(reader)), volume_(reader_->volume()) {
    volume_.lattice.to_world = placed(volume_.lattice.to_world, options);
  }
  [[nodiscard]] const Volume& volume() const override { return volume_; }
  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    reader_->read(k0, k1, out);
  }
  void read_box(const IndexBox& box, std::span<std::byte> out) const override {
    reader_->read_box(box, out);
  }
  [[nodiscard]] bool reads_boxes_cheaply() const override { return reader_->reads_boxes_cheaply(); }
  void read_surface(std::int32_t k0, std::int32_t k1, const SurfaceQuery& query,
                    Slab& out) const override {
    reader_->read_surface(k0, k1, query, out);
  }
  [[nodiscard]] bool rereads_cheaply() const override { return reader_->rereads_cheaply(); }
  [[nodiscard]] std::unique_ptr<SlabReader> copies(std::size_t n_planes) const override {
    return reader_->copies(n_planes);
  }
  [[nodiscard]] AttributeReaders attributes() const override { return reader_->attributes(); }
  [[nodiscard]] std::uint64_t held_bytes() const override { return reader_->held_bytes(); }

 private:
  std::unique_ptr<SlabReader> reader_;
  Volume volume_;
};

bool finite(double value) { return std::isfinite(value); }

}  // namespace

void check_placement(const SourceOptions& options) {
  if (options.spacing &&
      !std::ranges::all_of(*options.spacing, [](double s) { return finite(s) && s > 0; })) {
    throw Error(ErrorKind::usage, "--spacing", "three finite numbers above 0 were expected");
  }
  if (options.origin && !std::ranges::all_of(*options.origin, finite)) {
    throw Error(ErrorKind::usage, "--origin", "three finite numbers were expected");
  }
}

bool places(const SourceOptions& options) {
  return options.spacing.has_value() || options.origin.has_value();
}

std::unique_ptr<SlabReader> placed_reader(std::unique_ptr<SlabReader> reader,
                                          const SourceOptions& options) {
  return std::make_unique<PlacedReader>(std::move(reader), options);
}

void check_map(const Affine& to_world, std::string_view place) {
  const double volume = to_world.determinant();
  if (!std::ranges::all_of(to_world.m, finite) || !finite(volume) || volume == 0) {
    throw Error(ErrorKind::input, place,
                "the map from samples to the world is singular or not finite");
  }
}

}  // namespace mc::source

namespace mc {

Affine placed(Affine to_world, const SourceOptions& options) {
  if (options.spacing) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double length = to_world.spacing(static_cast<int>(axis));
      const double wanted = (*options.spacing)[axis];
      for (std::size_t row = 0; row < 3; ++row) {
        // An axis-aligned map takes the number as given, not a rounded multiple of the old one.
        double& m = to_world.m[4 * row + axis];
        m = std::abs(m) == length ? std::copysign(wanted, m) : m * (wanted / length);
      }
    }
  }
  if (options.origin) {
    for (std::size_t row = 0; row < 3; ++row) {
      to_world.m[4 * row + 3] = (*options.origin)[row];
    }
  }
  return to_world;
}

}  // namespace mc
