// SPDX-License-Identifier: MIT
#include "source/vdb/choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "field/volume_names.hpp"
#include "mc/base.hpp"
#include "source/text.hpp"

namespace mc::source {

namespace {

/// "density", "temperature"; the first dozen where there are more.
std::string list_names(std::span<const VdbGrid> grids) {
  constexpr std::size_t kMost = 12;
  std::string out;
  for (const VdbGrid& grid : grids.first(std::min(kMost, grids.size()))) {
    out += (out.empty() ? "" : ", ") + quoted_text(grid.shown_name());
  }
  return grids.size() > kMost ? fmt::format("{} and {} more", out, grids.size() - kMost) : out;
}

/// "#3" is 3; nullopt: anything else.
std::optional<std::size_t> position_in(std::string_view wanted) {
  std::size_t n = 0;
  if (!wanted.starts_with('#')) {
    return std::nullopt;
  }
  const auto [end, error] = std::from_chars(wanted.data() + 1, wanted.data() + wanted.size(), n);
  return error == std::errc() && end == wanted.data() + wanted.size() ? std::optional(n)
                                                                      : std::nullopt;
}

std::size_t find_grid(std::span<const VdbGrid> grids, const std::string& wanted,
                      std::string_view place) {
  const auto at = [&](auto&& matches) {
    return static_cast<std::size_t>(std::ranges::find_if(grids, matches) - grids.begin());
  };
  std::size_t found = at([&](const VdbGrid& g) { return g.numbered_name() == wanted; });
  if (found == grids.size()) {
    found = at([&](const VdbGrid& g) { return g.name == wanted; });
  }
  if (found == grids.size()) {
    found = std::min(position_in(wanted).value_or(grids.size()), grids.size());
  }
  if (found == grids.size()) {
    throw Error(ErrorKind::input, place,
                fmt::format("no grid {}: it has {}", quoted_text(wanted), list_names(grids)),
                "choose one with --grid NAME, NAME[n] or #n");
  }
  return found;
}

}  // namespace

std::optional<SampleType> scalar_type(const VdbGrid& grid) {
  if (!grid.standard_tree()) {
    return std::nullopt;
  }
  const std::string type = grid.type_name();
  if (type == "bool" || type == "mask") return SampleType::u8;
  if (type == "float") return SampleType::f32;
  if (type == "double") return SampleType::f64;
  if (type == "int32") return SampleType::i32;
  if (type == "int64") return SampleType::i64;
  return std::nullopt;
}

std::string refusal(const VdbGrid& grid) {
  if (scalar_type(grid)) {
    return {};
  }
  if (!grid.standard_tree()) {
    return fmt::format("tree of type {}, but only trees of 5-4-3 levels can be meshed",
                       quoted_text(grid.type_name()));
  }
  std::string type = quoted_text(grid.type_name());
  return fmt::format("type {}, but only scalar grids can be meshed",
                     type.substr(1, type.size() - 2));
}

VolumeClass volume_class(const VdbGrid& grid) {
  if (scalar_type(grid) == SampleType::u8) {
    return VolumeClass::mask;
  }
  if (const auto ours = field::class_named(grid.meta_text("mc_class"));
      ours && *ours != VolumeClass::unknown) {
    return *ours;
  }
  const std::string stored = grid.meta_text("class");
  return stored == "level set"    ? VolumeClass::level_set
         : stored == "fog volume" ? VolumeClass::fog
                                  : VolumeClass::unknown;
}

std::size_t choose_grid(std::span<const VdbGrid> grids, const std::optional<std::string>& wanted,
                        std::string_view place) {
  if (grids.empty()) {
    throw Error(ErrorKind::input, place, "a VDB file without grids");
  }
  std::size_t chosen = 0;
  if (wanted) {
    chosen = find_grid(grids, *wanted, place);
  } else {
    const auto first = std::ranges::find_if(grids, [](const auto& g) { return !!scalar_type(g); });
    chosen = first == grids.end() ? 0 : static_cast<std::size_t>(first - grids.begin());
  }
  if (const std::string why = refusal(grids[chosen]); !why.empty()) {
    throw Error(ErrorKind::input, place,
                fmt::format("grid {}: {}", quoted_text(grids[chosen].shown_name()), why));
  }
  return chosen;
}

}  // namespace mc::source
