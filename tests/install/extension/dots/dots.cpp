// SPDX-License-Identifier: MIT
#include "dots/dots.hpp"

#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

class Dots final : public mc::SlabReader {
 public:
  Dots(mc::Volume volume, std::vector<float> samples)
      : volume_(std::move(volume)), samples_(std::move(samples)) {}
  const mc::Volume& volume() const override { return volume_; }
  bool rereads_cheaply() const override { return true; }
  void read(std::int32_t k0, std::int32_t k1, mc::Slab& out) const override {
    const mc::Index3 dims = volume_.lattice.dims();
    const auto row = static_cast<std::size_t>(dims[0]);
    out.k0 = k0;
    out.row_stride_bytes = row * sizeof(float);
    out.planes.clear();
    for (std::int32_t k = k0; k < k1; ++k) {
      const auto plane = static_cast<std::size_t>(k) * row * static_cast<std::size_t>(dims[1]);
      out.planes.push_back(reinterpret_cast<const std::byte*>(samples_.data() + plane));
    }
  }

 private:
  mc::Volume volume_;
  std::vector<float> samples_;
};

mc::Recognition recognise(std::string_view head) {
  return head.starts_with("dots ") ? mc::Recognition::yes : mc::Recognition::no;
}

mc::Source open(mc::SourceInput& input, const mc::SourceOptions& options, mc::Progress&) {
  const auto file = input.map();
  std::istringstream text(
      std::string(reinterpret_cast<const char*>(file->bytes().data()), file->bytes().size()));
  std::string word;
  mc::Index3 dims{};
  if (!(text >> word >> dims[0] >> dims[1] >> dims[2]) || dims[0] < 2 || dims[1] < 2 ||
      dims[2] < 2 || dims[0] > 1000 || dims[1] > 1000 || dims[2] > 1000) {
    throw mc::Error(mc::ErrorKind::input, input.place(), "not dots NX NY NZ from 2 to 1000");
  }
  const auto at = [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    return static_cast<std::size_t>(i + dims[0] * (j + dims[1] * k));
  };
  std::vector<float> samples(at(0, 0, dims[2]));
  mc::Index3 p{};
  for (float value = 0; text >> p[0] >> p[1] >> p[2] >> value;) {
    const mc::IndexBox box{{0, 0, 0}, {dims[0] - 1, dims[1] - 1, dims[2] - 1}};
    if (!box.contains(p)) {
      throw mc::Error(mc::ErrorKind::input, input.place(), "a dot lies outside the volume");
    }
    samples[at(p[0], p[1], p[2])] = value;
  }
  mc::Volume volume;
  volume.format = kDotsFormat.name;
  volume.iso = 0.5;
  volume.lattice.box = {{0, 0, 0}, {dims[0] - 1, dims[1] - 1, dims[2] - 1}};
  volume.lattice.to_world = mc::placed({}, options);
  mc::Source source;
  source.reader = std::make_unique<Dots>(std::move(volume), std::move(samples));
  return source;
}

}  // namespace

constexpr mc::SourceFormat kDotsFormat{.name = "dots",
                                       .display = "dots",
                                       .extensions = "dots",
                                       .recognise = recognise,
                                       .own_iso = "between dots and nothing",
                                       .open = open};
