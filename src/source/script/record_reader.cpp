// SPDX-License-Identifier: MIT
#include "source/script/record_reader.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "source/json/write_json.hpp"
#include "source/script/brush.hpp"
#include "source/script/stroke.hpp"

// A rule for each operation says which keys it has; small functions read them. A key that the
// record lacks may come from the header's defaults.

namespace mc::source {

struct RecordReader::Rule {
  const char* name;
  RecordKind kind = RecordKind::edit;
  EditOp op = EditOp::add;
  Amount amount = Amount::none;
  bool brush = false;     // shape, falloff, path
  bool symmetry = false;  // mirror, radial, mask
  bool blend = false;
};

const std::vector<RecordReader::Rule>& RecordReader::rules() {
  using enum EditOp;
  static const std::vector<Rule> kRules{
      {"add", RecordKind::edit, add, Amount::value, true, true, true},
      {"subtract", RecordKind::edit, subtract, Amount::value, true, true, true},
      {"set", RecordKind::edit, set, Amount::part, true, true},
      {"fill", RecordKind::edit, fill},
      {"smooth", RecordKind::edit, smooth, Amount::part, true, true},
      {"flatten", RecordKind::edit, flatten, Amount::part, true, true},
      {"inflate", RecordKind::edit, inflate, Amount::signed_value, true, true},
      {"noise", RecordKind::edit, noise, Amount::signed_value, true, true},
      {"revert", RecordKind::edit, revert, Amount::part, true, true},
      {"stamp", RecordKind::edit, stamp, Amount::value, true, true, true},
      {"paint", RecordKind::edit, paint, Amount::none, true, true},
      {"group", RecordKind::group},
      {"undo", RecordKind::undo},
      {"redo", RecordKind::redo},
      {"write", RecordKind::write},
  };
  return kRules;
}

namespace {

const JsonValue& empty_object() {
  static const JsonValue kEmpty = [] {
    JsonValue value;
    value.kind = JsonKind::object;
    return value;
  }();
  return kEmpty;
}

}  // namespace

RecordReader::RecordReader(const JsonDocument& document, ScriptContext& context)
    : document_(document),
      context_(context),
      defaults_(document, context.defaults == nullptr ? empty_object() : *context.defaults,
                "the defaults") {}

ObjectReader& RecordReader::holder(ObjectReader& keys, const char* key) {
  if (keys.optional(key) != nullptr || defaults_.value().find(key) == nullptr) return keys;
  used_.push_back(key);
  return defaults_;
}

const JsonValue* RecordReader::setting(ObjectReader& keys, const char* key) {
  return holder(keys, key).optional(key);
}

const RecordReader::Rule* RecordReader::rule_of(const JsonValue& value) const {
  ObjectReader keys(document_, value, "a record");
  const JsonValue* op = keys.required("op");
  if (op == nullptr) return nullptr;
  const auto at = std::ranges::find_if(rules(), [&](const Rule& rule) {
    return op->kind == JsonKind::string && rule.name == op->text;
  });
  if (at != rules().end()) return &*at;
  std::vector<std::string> names;
  for (const Rule& rule : rules()) names.emplace_back(rule.name);
  document_.fault(*op,
                  op->kind == JsonKind::string
                      ? "there is no op " + in_quotes(op->text) + "; " + suggestion(op->text, names)
                      : as_found(*op) + ": expected the name of an op");
  return nullptr;
}

ScriptRecord RecordReader::read(const JsonValue& value) {
  ScriptRecord record;
  const Rule* rule = rule_of(value);
  if (rule == nullptr) return record;
  if (level_ == 0) n_dabs_ = 0;
  const std::vector<const char*> used_around = std::exchange(used_, {});
  record.op = rule->name;
  record.kind = rule->kind;
  const std::string what = "a record of op " + in_quotes(record.op);
  ObjectReader keys(document_, value, what.c_str());
  keys.optional("op");
  switch (rule->kind) {
    case RecordKind::edit:
      fill_edit(record, keys, *rule);
      break;
    case RecordKind::group:
      fill_group(record, keys);
      break;
    case RecordKind::write:
      record.path = keys.text("path", false).value_or("");
      if (const JsonValue* at = value.find("path"); at != nullptr && record.path == "-") {
        document_.fault(*at, "is \"-\": expected the name of a file");
      }
      break;
    default:
      record.count = static_cast<std::size_t>(keys.integer("count", 1, 1, 1000000000));
  }
  read_hashes(record, keys);
  keys.finish();
  if (document_.faults.empty()) record.text = text_of(record, value);
  used_ = used_around;
  return record;
}

void RecordReader::fill_group(ScriptRecord& record, ObjectReader& keys) {
  record.name = keys.text("name", true).value_or("");
  const JsonValue* edits = keys.required("edits");
  if (edits == nullptr) return;
  if (edits->kind != JsonKind::array) {
    return document_.fault(*edits, as_found(*edits) + ": expected an array of edits");
  }
  if (level_ >= Script::kMostNesting) {
    return document_.fault(
        *edits, "groups nest deeper than " + std::to_string(Script::kMostNesting) + " levels here");
  }
  ++level_;
  for (const JsonValue& item : edits->items) {
    ScriptRecord member = read(item);
    if (member.kind != RecordKind::edit && member.kind != RecordKind::group) {
      document_.fault(item, "is " + in_quotes(member.op) + ": expected only edits in a group");
    }
    record.members.push_back(std::move(member));
  }
  --level_;
}

void RecordReader::fill_edit(ScriptRecord& record, ObjectReader& keys, const Rule& rule) {
  Edit& edit = record.edit;
  edit.op = rule.op;
  edit.clamp = context_.header.clamp;
  // Only a brush that adds up is soft by default; the others are sharp, and reach as far as they
  // do.
  edit.falloff.type = FalloffType::none;
  if (rule.blend) fill_blend(edit, keys);
  if (rule.brush) fill_brush(edit, keys);
  if (rule.symmetry) fill_symmetry(edit, keys);
  const bool part = rule.amount == Amount::part || edit.blend == Blend::csg;
  if (rule.amount != Amount::none) {
    fill_amount(edit, keys, part ? Amount::part : rule.amount);
  }
  constexpr NumberRange kValue{-1.7976931348623157e308, 1.7976931348623157e308, false,
                               "a finite number"};
  if (rule.op == EditOp::set || rule.op == EditOp::fill) {
    edit.value = keys.number("value", std::nullopt, kValue);
  } else if (rule.op == EditOp::smooth) {
    fill_smoothing(edit, keys);
  } else if (rule.op == EditOp::flatten) {
    fill_plane(edit, keys);
  } else if (rule.op == EditOp::noise) {
    const JsonValue* noise = keys.required("noise");
    if (noise != nullptr) edit.noise = read_node(document_, context_, *noise);
  } else if (rule.op == EditOp::stamp) {
    fill_stamp(edit, keys);
  } else if (rule.op == EditOp::paint) {
    fill_paint(edit, keys);
  }
  check_dabs(edit, keys.value());
}

void RecordReader::fill_brush(Edit& edit, ObjectReader& keys) {
  if (const JsonValue* path = keys.optional("path")) edit.path = read_path(document_, *path);
  // A stamp is a shape itself; where it has one as well, that bounds it.
  const bool may_lack = edit.op == EditOp::stamp && !edit.path;
  const JsonValue* shape = may_lack ? keys.optional("shape") : keys.required("shape");
  const bool on_path = keys.value().find("path") != nullptr;
  if (shape != nullptr) edit.shape = read_shape(document_, context_, *shape, on_path);
  if (edit.path && edit.path->mode == PathMode::dabs && !(path_radius(edit.shape) > 0)) {
    if (shape != nullptr) {
      document_.fault(*shape, "has no radius to space dabs by: expected a \"radius\" above 0");
    }
    edit.path.reset();
  }
  if (edit.op == EditOp::stamp) {
    edit.falloff.type = shape == nullptr ? FalloffType::none : FalloffType::hard;
  } else if (edit.blend == Blend::accumulate && edit.op != EditOp::paint) {
    edit.falloff.type = FalloffType::smoothstep;
  }
  // A default would keep csg within the shape; a stamp without a shape has nothing to fall off.
  const bool own = edit.blend == Blend::csg || shape == nullptr;
  if (const JsonValue* falloff = own ? keys.optional("falloff") : setting(keys, "falloff")) {
    edit.falloff = read_falloff(document_, *falloff);
    if (shape == nullptr && edit.op == EditOp::stamp) {
      document_.fault(*falloff, "has no shape to fall off in: expected a \"shape\" with it");
    }
  }
}

void RecordReader::fill_symmetry(Edit& edit, ObjectReader& keys) {
  if (const JsonValue* mirror = setting(keys, "mirror")) {
    edit.mirror = read_mirror(document_, *mirror);
  }
  if (const JsonValue* radial = setting(keys, "radial")) {
    edit.radial = read_radial(document_, *radial);
  }
  if (const JsonValue* mask = setting(keys, "mask")) {
    edit.mask = read_node(document_, context_, *mask);
  }
}

void RecordReader::fill_blend(Edit& edit, ObjectReader& keys) {
  const std::size_t usual = edit.op == EditOp::stamp ? 1 : 0;
  edit.blend = Blend(holder(keys, "blend").choice("blend", usual, {"accumulate", "csg"}));
  if (edit.blend == Blend::csg) {
    edit.smooth = holder(keys, "smooth").number("smooth", 0, kLengthOrZero);
  } else if (const JsonValue* at = keys.optional("smooth")) {
    document_.fault(*at, R"(is the radius of a "csg" blend: expected "blend": "csg" with it)");
  }
}

void RecordReader::fill_amount(Edit& edit, ObjectReader& keys, Amount amount) {
  constexpr NumberRange kSigned{-3.4028234663852886e38, 3.4028234663852886e38, false,
                                "a number within +-3.4e38"};
  const NumberRange& range = amount == Amount::part    ? kPart
                             : amount == Amount::value ? kFloatNotNegative
                                                       : kSigned;
  const JsonValue* strength = keys.optional("strength");
  const JsonValue* rate = keys.optional("rate");
  const JsonValue* duration = keys.optional("duration");
  const bool own_rate = rate != nullptr || duration != nullptr;
  const JsonValue& usual = defaults_.value();
  if (strength != nullptr && own_rate) {
    return document_.fault(*strength,
                           "is given beside \"rate\" or \"duration\": expected either "
                           "\"strength\", or \"rate\" and \"duration\"");
  }
  const bool usual_rate = usual.find("rate") != nullptr || usual.find("duration") != nullptr;
  if (own_rate || (strength == nullptr && usual_rate)) return fill_rate(edit, keys, range);
  ObjectReader& from = holder(keys, "strength");
  if (&from == &defaults_ && amount == Amount::part && !(usual.find("strength")->number <= 1)) {
    return document_.fault(keys.value(),
                           "takes the default \"strength\", which is above 1: expected a "
                           "\"strength\" from 0 to 1");
  }
  edit.strength = from.number("strength", 1, range);
}

void RecordReader::fill_rate(Edit& edit, ObjectReader& keys, const NumberRange& range) {
  constexpr NumberRange kDuration{0, 1e9, true, "a number above 0, at most 1e9 (seconds)"};
  constexpr NumberRange kRate{-3.4028234663852886e38, 3.4028234663852886e38, false,
                              "a number within +-3.4e38"};
  const double rate = holder(keys, "rate").number("rate", std::nullopt, kRate);
  const double duration = holder(keys, "duration").number("duration", std::nullopt, kDuration);
  const double steps = std::max(1.0, std::floor(duration / context_.header.dt + 0.5));
  if (steps > Script::kMostSteps) {
    return document_.fault(keys.value(), "takes more than " + std::to_string(Script::kMostSteps) +
                                             R"( steps of "dt": expected a shorter "duration")");
  }
  edit.steps = static_cast<std::uint32_t>(steps);
  edit.strength = rate * context_.header.dt;
  if (!(edit.strength >= range.lo && edit.strength <= range.hi)) {
    edit.strength = 1;
    document_.fault(
        keys.value(),
        std::string(R"(has a step of "rate" times "dt" out of range: expected )") + range.text);
  }
}

void RecordReader::fill_smoothing(Edit& edit, ObjectReader& keys) {
  constexpr NumberRange kSamples{0, 16, true, "a number above 0, at most 16 (samples)"};
  edit.kernel =
      SmoothKernel(holder(keys, "kernel").choice("kernel", 1, {"box", "gaussian", "median"}));
  edit.kernel_radius = holder(keys, "radius").number("radius", 1, kSamples);
  edit.iterations = static_cast<std::uint32_t>(
      holder(keys, "iterations").integer("iterations", 1, 1, Script::kMostIterations));
}

void RecordReader::fill_plane(Edit& edit, ObjectReader& keys) {
  const JsonValue* plane = keys.optional("plane");
  if (plane == nullptr) return;
  ObjectReader own(document_, *plane, "a plane");
  FlattenPlane made;
  made.point = own.numbers<3>("point", std::nullopt, kPlace);
  made.normal = read_direction(document_, own, "normal");
  own.finish();
  edit.plane = made;
}

void RecordReader::fill_paint(Edit& edit, ObjectReader& keys) {
  edit.material = static_cast<std::uint16_t>(keys.integer("material", std::nullopt, 0, 0xFFFF));
}

void RecordReader::check_dabs(const Edit& edit, const JsonValue& at) {
  if (!document_.faults.empty()) return;
  const double n = most_dabs(edit);
  n_dabs_ += n;
  constexpr double kMost = Script::kMostDabs;
  if (!(n <= kMost) || !(n_dabs_ <= 10 * kMost)) {
    document_.fault(at, (n <= kMost ? "brings the dabs of its group above "
                                    : std::string("makes more dabs than ")) +
                            std::to_string(Script::kMostDabs * (n <= kMost ? 10 : 1)) +
                            ": expected a shorter path, a wider \"spacing\" or fewer copies");
  }
}

void RecordReader::read_hashes(ScriptRecord& record, ObjectReader& keys) {
  for (const auto& [key, to] : {std::pair{"before", &record.before}, {"after", &record.after}}) {
    const JsonValue* found = keys.optional(key);
    if (found == nullptr) continue;
    const bool good = found->kind == JsonKind::string && found->text.size() == 16 &&
                      found->text.find_first_not_of("0123456789abcdef") == std::string::npos;
    if (!good) {
      document_.fault(*found, as_found(*found) + ": expected a hash of 16 hexadecimal digits");
      continue;
    }
    *to = std::stoull(found->text, nullptr, 16);
  }
}

std::string RecordReader::text_of(const ScriptRecord& record, const JsonValue& value) const {
  std::string out = "{";
  const auto add = [&](std::string_view key) -> std::string& {
    if (out.size() > 1) out += ',';
    write_json_text(key, out);
    return out += ':';
  };
  for (const JsonMember& member : value.members) {
    if (member.key == "before" || member.key == "after" || is_ignored_key(member.key)) continue;
    add(member.key);
    if (member.key != "edits") {
      write_json(member.value, out);
      continue;
    }
    const char* separator = "[";
    for (const ScriptRecord& inner : record.members) {
      out += separator + inner.text;
      separator = ",";
    }
    out += record.members.empty() ? "[]" : "]";
  }
  for (const char* key : used_) {
    add(key);
    write_json(*defaults_.value().find(key), out);
  }
  return out += '}';
}

void RecordReader::check_defaults(const JsonValue& defaults) {
  ObjectReader keys(document_, defaults, "the defaults");
  Edit edit;
  if (const JsonValue* at = keys.optional("falloff")) edit.falloff = read_falloff(document_, *at);
  if (const JsonValue* at = keys.optional("mirror")) edit.mirror = read_mirror(document_, *at);
  if (const JsonValue* at = keys.optional("radial")) edit.radial = read_radial(document_, *at);
  if (const JsonValue* at = keys.optional("mask")) edit.mask = read_node(document_, context_, *at);
  edit.blend = Blend(keys.choice("blend", 0, {"accumulate", "csg"}));
  keys.number("smooth", 0, kLengthOrZero);
  fill_amount(edit, keys, Amount::signed_value);
  fill_smoothing(edit, keys);
  keys.finish();
}

}  // namespace mc::source
