// SPDX-License-Identifier: MIT
#include "source/json/write_json.hpp"

// Strings hold UTF-8 and leave as such; only what JSON forbids is escaped.

namespace mc::source {

void write_json_text(std::string_view text, std::string& out) {
  constexpr std::string_view kHex = "0123456789abcdef";
  out += '"';
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out.append({'\\', c});
    } else if (byte < 0x20) {
      out += "\\u00";
      out.append({kHex[byte >> 4], kHex[byte & 15]});
    } else {
      out += c;
    }
  }
  out += '"';
}

void write_json(const JsonValue& value, std::string& out) {
  const char* separator = "";
  switch (value.kind) {
    case JsonKind::null:
      out += "null";
      return;
    case JsonKind::boolean:
      out += value.boolean ? "true" : "false";
      return;
    case JsonKind::number:
      out += value.text;
      return;
    case JsonKind::string:
      return write_json_text(value.text, out);
    case JsonKind::array:
      out += '[';
      for (const JsonValue& item : value.items) {
        out += separator;
        separator = ",";
        write_json(item, out);
      }
      out += ']';
      return;
    default:
      out += '{';
      for (const JsonMember& member : value.members) {
        out += separator;
        separator = ",";
        write_json_text(member.key, out);
        out += ':';
        write_json(member.value, out);
      }
      out += '}';
  }
}

}  // namespace mc::source
