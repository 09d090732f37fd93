// SPDX-License-Identifier: MIT
#include "source/vdb/layout.hpp"

#include <fmt/format.h>

#include <cstring>
#include <set>

#include "mc/base.hpp"

namespace mc::source {

namespace {

constexpr char kNumberFollows = '\x1E';
constexpr std::string_view kHalfSuffix = "_HalfFloat";
constexpr std::string_view kTreePrefix = "Tree_";
constexpr std::string_view kTreeSuffix = "_5_4_3";
constexpr std::uint32_t kOldest = 222;  // OpenVDB 1.0, the first release
constexpr std::uint32_t kNewest = 224;
constexpr std::size_t kUuidBytes = 36;

}  // namespace

VdbMetaMap read_meta_map(VdbCursor& cursor) {
  VdbMetaMap map;
  const auto n_entries = cursor.number<std::int32_t>("metadata");
  for (std::int32_t n = 0; n < n_entries; ++n) {  // each takes bytes, so the file bounds the loop
    std::string name = cursor.text("metadata");
    std::string type = cursor.text("metadata");
    const auto n_bytes = cursor.number<std::uint32_t>("metadata");
    map[std::move(name)] = {std::move(type), cursor.take(n_bytes, "metadata")};
  }
  return map;
}

std::string VdbGrid::numbered_name() const {
  return number.empty() ? name : fmt::format("{}[{}]", name, number);
}

std::string VdbGrid::shown_name() const { return shares_name ? numbered_name() : name; }

void number_grids(std::vector<VdbGrid>& grids) {
  std::map<std::string_view, std::vector<VdbGrid*>> of_name;
  for (VdbGrid& grid : grids) {
    const std::size_t at = grid.unique_name.find(kNumberFollows);
    grid.number = at == std::string::npos ? "" : grid.unique_name.substr(at + 1);
    of_name[grid.name].push_back(&grid);
  }
  for (const auto& [name, sharing] : of_name) {
    if (sharing.size() < 2) {
      continue;
    }
    std::set<std::int32_t> indices;
    for (VdbGrid* grid : sharing) {
      grid->shares_name = true;
      if (const auto index = grid->meta_int32("index")) {
        indices.insert(*index);
      }
    }
    if (indices.size() == sharing.size()) {
      for (VdbGrid* grid : sharing) {
        grid->number = std::to_string(*grid->meta_int32("index"));
      }
    }
  }
}

bool VdbGrid::standard_tree() const {
  return tree_type.starts_with(kTreePrefix) && tree_type.ends_with(kTreeSuffix) &&
         tree_type.size() > kTreePrefix.size() + kTreeSuffix.size();
}

std::string VdbGrid::type_name() const {
  return standard_tree()
             ? tree_type.substr(kTreePrefix.size(),
                                tree_type.size() - kTreePrefix.size() - kTreeSuffix.size())
             : tree_type;
}

std::string VdbGrid::meta_text(std::string_view key) const {
  const auto at = meta.find(key);
  if (at == meta.end() || at->second.type != "string") {
    return {};
  }
  const std::span<const std::byte> bytes = at->second.bytes;
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

namespace {

/// The bytes of a number, where there are as many as it has.
template <class T>
std::optional<T> number_in(const VdbMetaMap& meta, std::string_view key) {
  const auto at = meta.find(key);
  T value{};
  if (at == meta.end() || at->second.bytes.size() != sizeof value) {
    return std::nullopt;
  }
  std::memcpy(&value, at->second.bytes.data(), sizeof value);
  return value;
}

}  // namespace

std::optional<std::int64_t> VdbGrid::meta_int64(std::string_view key) const {
  return number_in<std::int64_t>(meta, key);
}

std::optional<std::int32_t> VdbGrid::meta_int32(std::string_view key) const {
  return number_in<std::int32_t>(meta, key);
}

std::optional<double> VdbGrid::meta_double(std::string_view key) const {
  return number_in<double>(meta, key);
}

std::optional<std::array<std::int32_t, 3>> VdbGrid::meta_vec3i(std::string_view key) const {
  return number_in<std::array<std::int32_t, 3>>(meta, key);
}

bool looks_like_vdb(std::string_view head) {
  return head.substr(0, 8) == std::string_view(" BDV\0\0\0\0", 8);
}

VdbLayout read_vdb_layout(std::span<const std::byte> file, std::string_view place) {
  VdbCursor cursor(file, 0, place);
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  if (!looks_like_vdb(text)) {
    throw Error(ErrorKind::input, place, "not a VDB file: it does not begin with the magic number");
  }
  cursor.take(8, "the header");
  VdbLayout layout;
  layout.file_version = cursor.number<std::uint32_t>("the header");
  if (layout.file_version < kOldest || layout.file_version > kNewest) {
    throw Error(ErrorKind::input, place,
                fmt::format("VDB file version {}, but {} to {} can be read", layout.file_version,
                            kOldest, kNewest));
  }
  layout.library_major = cursor.number<std::uint32_t>("the header");
  layout.library_minor = cursor.number<std::uint32_t>("the header");
  layout.has_offsets = cursor.number<std::uint8_t>("the header") != 0;
  cursor.take(kUuidBytes, "the header");
  read_meta_map(cursor);
  const auto n_grids = cursor.number<std::int32_t>("the header");
  if (n_grids < 0) {
    damaged_vdb(place, fmt::format("{} grids", n_grids));
  }
  layout.n_grids = static_cast<std::uint32_t>(n_grids);
  layout.first_descriptor = cursor.at();
  return layout;
}

VdbGrid read_vdb_grid(std::span<const std::byte> file, const VdbLayout& layout, std::size_t at,
                      std::string_view place) {
  VdbCursor cursor(file, at, place);
  constexpr std::string_view kWhat = "the list of grids";
  VdbGrid grid;
  grid.unique_name = cursor.text(kWhat);
  grid.name = grid.unique_name.substr(0, grid.unique_name.find(kNumberFollows));
  grid.tree_type = cursor.text(kWhat);
  if (grid.tree_type.ends_with(kHalfSuffix)) {
    grid.as_half = true;
    grid.tree_type.resize(grid.tree_type.size() - kHalfSuffix.size());
  }
  grid.instance_of = cursor.text(kWhat);
  const auto begin = cursor.number<std::uint64_t>(kWhat);
  cursor.number<std::uint64_t>(kWhat);  // where the tree's buffers begin
  const auto end = cursor.number<std::uint64_t>(kWhat);
  if (layout.has_offsets) {
    if (end > file.size()) {
      throw Error(
          ErrorKind::input, place,
          fmt::format("cut off: {} bytes, but its grids need at least {}", file.size(), end),
          "fetch or write the file again");
    }
    if (begin < cursor.at() || end < begin) {
      damaged_vdb(place, "grids overlap");
    }
    cursor.move_to(static_cast<std::size_t>(begin));
    grid.end = static_cast<std::size_t>(end);
  }
  grid.begin = cursor.at();
  grid.compression = cursor.number<std::uint32_t>("a grid");
  grid.meta = read_meta_map(cursor);
  grid.body = cursor.at();
  VdbCursor(file, grid.body, place).text("a grid's transform");
  return grid;
}

}  // namespace mc::source
