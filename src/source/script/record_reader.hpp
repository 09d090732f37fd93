// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "source/script/context.hpp"
#include "source/script/script.hpp"

// One record of a script, from its JSON.

namespace mc::source {

class RecordReader {
 public:
  /// Both are borrowed.
  RecordReader(const JsonDocument& document, ScriptContext& context);

  /// A record, or, where it has faults, something harmless.
  ScriptRecord read(const JsonValue& value);
  /// Notes the faults of the header's "defaults".
  void check_defaults(const JsonValue& defaults);

 private:
  struct Rule;
  /// How an amount is meant: units of the value, never negative; with a sign; a part of 1.
  enum class Amount : std::uint8_t { none, value, signed_value, part };

  static const std::vector<Rule>& rules();
  [[nodiscard]] const Rule* rule_of(const JsonValue& value) const;
  void fill_group(ScriptRecord& record, ObjectReader& keys);
  void fill_edit(ScriptRecord& record, ObjectReader& keys, const Rule& rule);
  void fill_brush(Edit& edit, ObjectReader& keys);
  void fill_symmetry(Edit& edit, ObjectReader& keys);
  void fill_blend(Edit& edit, ObjectReader& keys);
  void fill_amount(Edit& edit, ObjectReader& keys, Amount amount);
  void fill_rate(Edit& edit, ObjectReader& keys, const NumberRange& range);
  void fill_smoothing(Edit& edit, ObjectReader& keys);
  void fill_plane(Edit& edit, ObjectReader& keys);
  void fill_stamp(Edit& edit, ObjectReader& keys);
  void place_stamp(Edit& edit, ObjectReader& keys, const Affine& to_index);
  void fill_paint(Edit& edit, ObjectReader& keys);
  void check_dabs(const Edit& edit, const JsonValue& at);
  void read_hashes(ScriptRecord& record, ObjectReader& keys);

  /// Who has a setting: the record, else the header's defaults, which then count as used.
  ObjectReader& holder(ObjectReader& keys, const char* key);
  const JsonValue* setting(ObjectReader& keys, const char* key);
  [[nodiscard]] std::string text_of(const ScriptRecord& record, const JsonValue& value) const;

  const JsonDocument& document_;
  ScriptContext& context_;
  ObjectReader defaults_;
  std::vector<const char*> used_;  // keys of the defaults that the record took
  std::size_t level_ = 0;          // groups around it
  double n_dabs_ = 0;              // so far, of the outermost record
};

}  // namespace mc::source
