// SPDX-License-Identifier: MIT
#include "sink/vdb/module/vdb_writer.hpp"

#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>
#include <openvdb/util/Name.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ostream>
#include <sstream>
#include <string_view>
#include <utility>

#include "field/volume_names.hpp"
#include "sink/vdb/module/grid_builder.hpp"

// The only door to OpenVDB: what the module exports.

namespace mc::sink {

namespace {

/// The simplest of OpenVDB's maps that holds the affine to the last bit.
openvdb::math::MapBase::Ptr map_of(const Affine& affine) {
  using namespace openvdb::math;
  const std::array<double, 12>& m = affine.m;
  const openvdb::Vec3d origin(m[3], m[7], m[11]);
  const openvdb::Vec3d scale(m[0], m[5], m[10]);
  const std::array<double, 6> turning{m[1], m[2], m[4], m[6], m[8], m[9]};
  if (std::any_of(turning.begin(), turning.end(), [](double v) { return v != 0; })) {
    // Rows are images of the unit steps: OpenVDB multiplies row vectors from the left.
    openvdb::Mat4d rows;
    for (std::size_t column = 0; column < 4; ++column) {
      rows.setRow(static_cast<int>(column),
                  openvdb::Vec4d(m[column], m[4 + column], m[8 + column], column == 3 ? 1.0 : 0.0));
    }
    return std::make_shared<AffineMap>(rows);
  }
  const bool moved = origin != openvdb::Vec3d(0.0);
  if (scale.x() == scale.y() && scale.y() == scale.z()) {
    if (moved) return std::make_shared<UniformScaleTranslateMap>(scale.x(), origin);
    return std::make_shared<UniformScaleMap>(scale.x());
  }
  if (moved) return std::make_shared<ScaleTranslateMap>(scale, origin);
  return std::make_shared<ScaleMap>(scale);
}

openvdb::math::Transform::Ptr transform_of(const Affine& affine, const std::string& place) {
  try {
    // Made from a map, a Transform replaces it by a simpler one that is only nearly equal (its
    // tolerances are absolute: a small rotation is lost). Read from a stream, it takes it as it is.
    const openvdb::math::MapBase::Ptr map = map_of(affine);
    std::stringstream bytes;
    openvdb::io::setCurrentVersion(bytes);
    openvdb::writeString(bytes, map->type());
    map->write(bytes);
    auto transform = std::make_shared<openvdb::math::Transform>();
    transform->read(bytes);
    return transform;
  } catch (const openvdb::ArithmeticError&) {
    throw Error(ErrorKind::output, place,
                fmt::format("a cell of volume {} cannot be placed by a VDB file",
                            std::fabs(affine.determinant())),
                "give a larger --spacing, in millimetres for example, or write .nrrd");
  }
}

/// Level sets are cut at 0; a field that is cut elsewhere is none to other programs.
bool is_level_set(const Volume& volume) {
  return below_is_solid(volume.cls) && volume.iso.value_or(0) == 0;
}

void put_text(openvdb::GridBase& grid, const char* key, std::string_view text) {
  if (!text.empty()) grid.insertMeta(key, openvdb::StringMetadata(std::string(text)));
}

void describe(openvdb::GridBase& grid, const Volume& volume) {
  const bool level_set = is_level_set(volume);
  if (level_set) {
    grid.setGridClass(openvdb::GRID_LEVEL_SET);
  } else if (volume.cls == VolumeClass::fog) {
    grid.setGridClass(openvdb::GRID_FOG_VOLUME);
  }
  const bool said = volume.cls == VolumeClass::fog ||
                    (level_set && volume.cls == VolumeClass::level_set) ||
                    grid.isType<openvdb::BoolGrid>();
  const char* usual_name = level_set ? "surface" : "density";
  const bool nameless = volume.name.empty() && volume.format != "vdb";
  grid.setName(nameless ? usual_name : volume.name);
  put_text(grid, "mc_class", said ? "" : field::class_name(volume.cls));
  put_text(grid, "mc_border", volume.border ? field::border_name(*volume.border) : "");
  if (volume.iso) grid.insertMeta("mc_iso", openvdb::DoubleMetadata(*volume.iso));
  if (volume.frame != Frame::none) {
    put_text(grid, "mc_frame", volume.frame == Frame::lps ? "lps" : "ras");
  }
  if (volume.units != Units::unknown) {
    put_text(grid, "mc_units", volume.units == Units::mm ? "mm" : "m");
  }
}

/// Opens the part of OpenVDB that writes a whole file, offsets included, to a stream.
class StreamArchive final : public openvdb::io::Archive {
 public:
  void write_to(std::ostream& out, const openvdb::GridBase::Ptr& grid,
                const openvdb::MetaMap& meta) const {
    Archive::write(out, openvdb::GridCPtrVec{grid}, /*seekable=*/true, meta);
  }
};

class OpenVdbWriter final : public VdbWriter {
 public:
  explicit OpenVdbWriter(std::string place) : place_(std::move(place)) { openvdb::initialize(); }

  void begin(const Volume& volume) override {
    volume_ = volume;
    transform_ = transform_of(volume.lattice.to_world, place_);
    builder_ = grid_builder_for(volume);
  }
  void write(const Slab& slab) override { builder_->add(slab); }
  void write_sparse(const LeafReader& reader) override { builder_->add(reader); }
  void finish(std::streambuf& bytes,
              const std::vector<std::pair<std::string, std::string>>& meta) override;

 private:
  std::string place_;
  Volume volume_;
  openvdb::math::Transform::Ptr transform_;
  std::unique_ptr<GridBuilder> builder_;
};

void OpenVdbWriter::finish(std::streambuf& bytes,
                           const std::vector<std::pair<std::string, std::string>>& meta) {
  const openvdb::GridBase::Ptr grid = builder_->finish();
  grid->setTransform(transform_);
  describe(*grid, volume_);
  openvdb::MetaMap file_meta;
  for (const auto& [key, value] : meta) {
    file_meta.insertMeta(key, openvdb::StringMetadata(value));
  }
  std::ostream out(&bytes);
  out.exceptions(std::ios::badbit | std::ios::failbit);
  try {
    StreamArchive().write_to(out, grid, file_meta);
  } catch (const openvdb::Exception& error) {
    throw Error(ErrorKind::output, place_,
                fmt::format("OpenVDB cannot write it: {}", error.what()));
  }
}

}  // namespace

}  // namespace mc::sink

mc::sink::VdbWriter* mc_make_vdb_writer(const std::string& place) {
  return new mc::sink::OpenVdbWriter(place);
}
