// SPDX-License-Identifier: MIT
#include "source/spec/spec.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "source/placement.hpp"
#include "source/source_input.hpp"
#include "source/spec/document.hpp"

// The reader of procedural volumes: planes are computed into the slab's own memory.

namespace mc::source {

namespace {

class SpecReader final : public SlabReader {
 public:
  explicit SpecReader(SpecDocument spec) : spec_(std::move(spec)) {
    for (const auto& attribute : spec_.attributes) attributes_.push_back(attribute.get());
  }

  [[nodiscard]] const Volume& volume() const override { return spec_.volume; }
  [[nodiscard]] AttributeReaders attributes() const override { return attributes_; }
  [[nodiscard]] bool rereads_cheaply() const override { return false; }
  [[nodiscard]] std::uint64_t held_bytes() const override { return spec_.data_bytes; }

  void read(std::int32_t k0, std::int32_t k1, Slab& out) const override {
    spec_.field.sample(spec_.origin, spec_.spacing, {0, 0, k0}, allocate(k0, k1, out));
  }

  void read_surface(std::int32_t k0, std::int32_t k1, const SurfaceQuery& query,
                    Slab& out) const override {
    spec_.field.sample_surface(spec_.origin, spec_.spacing, {0, 0, k0}, query,
                               allocate(k0, k1, out), out.sides);
  }

  [[nodiscard]] bool reads_boxes_cheaply() const override { return true; }
  void read_box(const IndexBox& box, std::span<std::byte> out) const override {
    const auto extent = [&](int a) { return static_cast<std::int32_t>(box.extent(a)); };
    Buffer<float> samples(out.size() / sizeof(float));
    spec_.field.sample(spec_.origin, spec_.spacing, box.lo,
                       {samples.data(), {extent(0), extent(1), extent(2)}});
    std::memcpy(out.data(), samples.data(), out.size());
  }

 private:
  [[nodiscard]] View3<float> allocate(std::int32_t k0, std::int32_t k1, Slab& out) const {
    const IndexBox planes = planes_of(spec_.volume.lattice.box, k0, k1);
    out.allocate(planes, sizeof(float));
    // Storage is aligned for every scalar type.
    return {reinterpret_cast<float*>(out.storage.data()),
            {static_cast<std::int32_t>(planes.extent(0)),
             static_cast<std::int32_t>(planes.extent(1)), k1 - k0}};
  }

  SpecDocument spec_;
  std::vector<const AttributeReader*> attributes_;  // the document's
};

/// Whether a JSON object begins there.
bool looks_like_json(std::string_view head) {
  if (head.starts_with("\xEF\xBB\xBF")) {
    head.remove_prefix(3);
  }
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && head[first] == '{';
}

}  // namespace

std::unique_ptr<SlabReader> open_spec_text(const std::string& place, std::string_view text,
                                           const SpecNesting& within) {
  return std::make_unique<SpecReader>(load_spec(place, text, within));
}

bool looks_like_spec(std::string_view head) { return recognise_spec(head) == Recognition::yes; }

Recognition recognise_spec(std::string_view head) {
  if (!looks_like_json(head)) return Recognition::no;
  const bool named = head.find("mc-volume") != std::string_view::npos;
  return named ? Recognition::yes : Recognition::unsure;
}

Source open_spec(SourceInput& input, const SourceOptions& options, Progress& /*progress*/) {
  SpecNesting within;
  if (input.state().within != nullptr) within = *input.state().within;
  within.root = options.root;
  within.further_formats = options.further_formats;
  within.left = std::min(within.left, SpecNesting::most_samples(options.memory_bytes));
  const MappedFile file = map_file(input);
  std::unique_ptr<SlabReader> spec = open_spec_text(file.place(), file.text(), within);
  Source source;
  source.reader = places(options) ? placed_reader(std::move(spec), options) : std::move(spec);
  return source;
}

}  // namespace mc::source
