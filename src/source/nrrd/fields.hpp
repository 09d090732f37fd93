// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "source/nrrd/header.hpp"

// The lines of a NRRD header: "field: value", "key:=value", "# comment", an empty line at the end.

namespace mc::source {

class NrrdFields {
 public:
  /// Headers are cut off at 1 MiB: real ones have a few KiB, and slice lists of 10^4 names fit.
  static constexpr std::size_t kMostBytes = std::size_t{1} << 20U;

  /// Errors   input: no magic, a line that is no field, a field twice, no end within 1 MiB.
  NrrdFields(std::string_view text, std::string place);

  /// The value of a field; names are those of the format, in lower case, spellings made one.
  [[nodiscard]] std::optional<std::string> find(std::string_view name) const;
  /// Errors   input: missing.
  [[nodiscard]] std::string required(std::string_view name) const;
  /// Throws Error(input) at the field's line.
  [[noreturn]] void fail(std::string_view name, std::string_view fault,
                         std::string_view remedy = {}) const;

  /// The lines below `data file: LIST`.
  [[nodiscard]] const std::vector<std::string>& list_after_data_file() const { return list_; }
  /// "key:=value" pairs, which are each program's own; the first of a key.
  [[nodiscard]] const std::map<std::string, std::string, std::less<>>& pairs() const {
    return pairs_;
  }
  [[nodiscard]] const std::vector<std::string>& unknown() const { return unknown_; }
  [[nodiscard]] std::size_t size_bytes() const { return size_bytes_; }

 private:
  struct Value {
    std::string text;
    std::size_t line = 0;
  };
  void take_line(std::string_view line, std::size_t number);

  std::string place_;
  std::map<std::string, Value, std::less<>> values_;
  std::map<std::string, std::string, std::less<>> pairs_;
  std::vector<std::string> list_;
  std::vector<std::string> unknown_;
  std::size_t size_bytes_ = 0;
  bool in_list_ = false;
};

[[nodiscard]] std::vector<std::string> split_words(std::string_view text);
/// Whole numbers and nothing else. nullopt: something else.
[[nodiscard]] std::optional<std::vector<std::int64_t>> parse_integers(std::string_view text);
/// Numbers, "nan" included. nullopt: something else.
[[nodiscard]] std::optional<std::vector<double>> parse_numbers(std::string_view text);

/// Fills to_world, frame and units from the fields about space.
void set_nrrd_placement(const NrrdFields& fields, NrrdHeader& header);

}  // namespace mc::source
