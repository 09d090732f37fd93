// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/text.hpp"
#include "source/nrrd/fields.hpp"
#include "source/placement.hpp"
#include "source/text.hpp"

// Where a NRRD file puts its samples: "space directions" and "space origin" in a named space, or
// spacings and axis minima along the axes.

namespace mc::source {

namespace {

/// Values of a per-axis field for the three axes that remain. Empty: the field is not there.
std::vector<double> per_axis(const NrrdFields& fields, const NrrdHeader& header,
                             std::string_view name) {
  const std::optional<std::string> text = fields.find(name);
  if (!text) {
    return {};
  }
  auto numbers = parse_numbers(*text);
  const std::size_t lead = header.leading_axis ? 1 : 0;
  if (!numbers || numbers->size() != 3 + lead) {
    fields.fail(name, fmt::format("{} numbers were expected", 3 + lead));
  }
  numbers->erase(numbers->begin(), numbers->begin() + static_cast<std::ptrdiff_t>(lead));
  return *numbers;
}

/// Parses "(1,0,0) none (0,2.5,0)" into triples; none is left out.
std::vector<Vec3> parse_vectors(const NrrdFields& fields, std::string_view name) {
  std::vector<Vec3> vectors;
  const std::string text = fields.required(name);
  std::string_view rest = trimmed(text);
  while (!rest.empty()) {
    if (base::lower_case(rest.substr(0, 4)) == "none") {
      rest = trimmed(rest.substr(4));
      continue;
    }
    const std::size_t close = rest.find(')');
    if (rest.front() != '(' || close == std::string_view::npos) {
      fields.fail(name, "vectors such as (1,0,0) were expected");
    }
    std::string inside(rest.substr(1, close - 1));
    std::ranges::replace(inside, ',', ' ');
    const auto numbers = parse_numbers(inside);
    if (!numbers || numbers->size() != 3) {
      fields.fail(name, "vectors of three numbers were expected");
    }
    vectors.push_back({(*numbers)[0], (*numbers)[1], (*numbers)[2]});
    rest = trimmed(rest.substr(close + 1));
  }
  return vectors;
}

std::vector<std::string> centers(const NrrdFields& fields, const NrrdHeader& header) {
  std::vector<std::string> words =
      split_words(base::lower_case(fields.find("centers").value_or("")));
  if (header.leading_axis && !words.empty()) {
    words.erase(words.begin());
  }
  words.resize(3);
  return words;
}

/// Spacing and position of sample 0 along each axis: from spacings, else from minima and maxima. A
/// cell-centred axis has its first sample half a step inside its minimum.
Affine from_axes(const NrrdFields& fields, const NrrdHeader& header) {
  const std::vector<double> spacings = per_axis(fields, header, "spacings");
  const std::vector<double> mins = per_axis(fields, header, "axis mins");
  const std::vector<double> maxs = per_axis(fields, header, "axis maxs");
  const std::vector<std::string> centering = centers(fields, header);
  Vec3 spacing{1, 1, 1};
  Vec3 origin{0, 0, 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool cell = centering[axis] == "cell";
    if (!spacings.empty() && std::isfinite(spacings[axis])) {
      spacing[axis] = spacings[axis];
    } else if (!mins.empty() && !maxs.empty() && std::isfinite(maxs[axis] - mins[axis])) {
      spacing[axis] = (maxs[axis] - mins[axis]) / (header.dims[axis] - (cell ? 0 : 1));
    }
    if (!mins.empty() && std::isfinite(mins[axis])) {
      origin[axis] = mins[axis] + (cell ? 0.5 * spacing[axis] : 0.0);
    }
  }
  return Affine::scale_translate(spacing, origin);
}

void set_directions(const NrrdFields& fields, Affine& to_world) {
  const std::vector<Vec3> directions = parse_vectors(fields, "space directions");
  if (directions.size() != 3) {
    fields.fail("space directions",
                fmt::format("{} vectors, but three were expected", directions.size()));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t row = 0; row < 3; ++row) {
      to_world.m[4 * row + axis] = directions[axis][row];
    }
  }
}

/// Mirrors the world's x: what lay to the left counts to the right.
void flip_x(Affine& to_world) {
  for (std::size_t column = 0; column < 4; ++column) {
    double& m = to_world.m[column];
    m = m == 0 ? 0 : -m;
  }
}

void set_space(const NrrdFields& fields, NrrdHeader& header) {
  const std::string space = base::lower_case(fields.find("space").value_or(""));
  const auto is = [&](std::string_view name, std::string_view brief) {
    return space == name || space == brief;
  };
  if (is("right-anterior-superior", "ras")) {
    header.frame = Frame::ras;
  } else if (is("left-posterior-superior", "lps")) {
    header.frame = Frame::lps;
  } else if (is("left-anterior-superior", "las")) {
    header.frame = Frame::ras;
    flip_x(header.to_world);
  } else if (!space.empty() && !is("scanner-xyz", "scanner-xyz") &&
             !is("3d-right-handed", "3d-left-handed")) {
    fields.fail("space", fmt::format("{}: a space of three axes was expected, such as "
                                     "right-anterior-superior",
                                     quoted_text(space)));
  }
}

/// Millimetres where the frame is anatomical, unless the units are named.
void set_units(const NrrdFields& fields, NrrdHeader& header) {
  header.units = header.frame == Frame::none ? Units::unknown : Units::mm;
  std::optional<std::string> text = fields.find("space units");
  text = text ? text : fields.find("units");
  if (!text) {
    return;
  }
  const auto every = [&](std::string_view unit) {
    std::string rest = *text;
    std::ranges::replace(rest, '"', ' ');
    const std::vector<std::string> words = split_words(rest);
    return words.size() >= 3 &&
           std::all_of(words.end() - 3, words.end(), [&](const auto& w) { return w == unit; });
  };
  if (every("mm") || every("millimeter") || every("millimeters")) {
    header.units = Units::mm;
  } else if (every("m") || every("meter") || every("meters")) {
    header.units = Units::m;
  } else if (fields.find("space units")) {
    header.units = Units::unknown;
  }
}

}  // namespace

void set_nrrd_placement(const NrrdFields& fields, NrrdHeader& header) {
  if (fields.find("space dimension")) {
    const auto n = parse_integers(fields.required("space dimension"));
    if (!n || n->size() != 1 || n->front() != 3) {
      fields.fail("space dimension", "3 was expected");
    }
  }
  header.to_world = from_axes(fields, header);
  if (fields.find("space directions")) {
    set_directions(fields, header.to_world);
  }
  if (fields.find("space origin")) {
    const std::vector<Vec3> origin = parse_vectors(fields, "space origin");
    if (origin.size() != 1) {
      fields.fail("space origin", "one vector was expected");
    }
    for (std::size_t row = 0; row < 3; ++row) {
      header.to_world.m[4 * row + 3] = origin.front()[row];
    }
  }
  set_space(fields, header);
  set_units(fields, header);
}

}  // namespace mc::source
