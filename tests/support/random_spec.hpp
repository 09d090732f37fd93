// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "graph/node_types.hpp"

// Valid mc-volume documents from bytes, by the table of node types: whatever the bytes, the loader
// must take the document, unless it expands past the limit of operations.

namespace mc::tests {

/// A node type whose keys depend on each other, and keys that make it valid, `key=code`, with `?`
/// after the code where the key may be left out. Codes: n node, r number, p above 0, f from 0 to
/// 1, v three numbers, V three above 0, D dims but xyz, o octaves, l lacunarity, g gain, c
/// copies, t three angles, E two rising numbers, R two unequal ones, L a rising list, M a matrix
/// with an inverse, C two radii, h a small one, w below 0, W 0 or more; or the choices themselves:
/// a|b.
struct DependentKeys {
  std::string_view type;
  std::string_view keys;
};

inline constexpr DependentKeys kDependentKeys[] = {
    {"clamp", "source=n min=w max=W"},
    {"remap", "source=n from=R to=R"},
    {"smoothstep", "source=n edges=E"},
    {"terrace", "source=n step=p offset=r? ramp=f?"},
    {"terrace", "source=n levels=L ramp=f?"},
    {"unity-perlin2d", "frequency=p? dims=D?"},
    {"unity-perlin2d", "x=n y=n"},
    {"warp", "source=n warp=n amplitude=r?"},
    {"warp", "source=n warp=n mode=progressive|independent octaves=o? lacunarity=l? gain=g?"},
    {"rotate", "source=n degrees=r axis=x|y|z? center=v?"},
    {"rotate", "source=n degrees=t"},
    {"scale", "source=n factor=V center=v? values=keep|scale?"},
    {"affine", "source=n matrix=M"},
    {"repeat", "source=n period=p copies=c?"},
    {"plane", "normal=V? offset=r?"},
    {"roundbox", "size=V radius=h center=v?"},
    {"cone", "radius=C height=p center=v? axis=x|y|z?"},
};

class RandomSpec {
 public:
  /// How nodes of one type may look: its row, and keys in its place where they depend on each
  /// other.
  struct Grammar {
    std::string_view type;
    const graph::NodeRow* row = nullptr;
    std::string_view keys{};
  };

  explicit RandomSpec(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// Of all types that need no file.
  static const std::vector<Grammar>& grammars() {
    static const std::vector<Grammar> kAll = [] {
      std::vector<Grammar> all;
      for (const DependentKeys& keys : kDependentKeys)
        all.push_back({keys.type, nullptr, keys.keys});
      for (const graph::NodeRow* row : graph::node_rows()) {
        const auto known = [&](const Grammar& grammar) { return grammar.type == row->name; };
        if (row->check_samples == nullptr && std::ranges::none_of(all, known)) {
          all.push_back({row->name, row});
        }
      }
      return all;
    }();
    return kAll;
  }

  /// The document; a grid of 9 x 6 x 5 samples around the origin.
  std::string text() {
    std::string out = R"({"format": "mc-volume", "version": 1, "seed": )" + whole(5) +
                      R"(, "convention": )" + (below(2) == 0 ? R"("density")" : R"("sdf")") +
                      R"(, "iso": )" + in_16ths(-8, 8) +
                      R"(, "grid": {"samples": [9, 6, 5], "spacing": [0.5, 0.75, 0.875], )" +
                      R"("origin": [-2, -1.875, -1.75]}, "nodes": {"$": 0)";
    const std::uint32_t n_named = below(6);
    for (std::uint32_t n = 0; n < n_named; ++n) {
      const std::string name = "n" + std::to_string(n);
      out += ", \"" + name + "\": " + object(0);
      names_.push_back(name);
    }
    out += "}, \"field\": " + object(0);
    if (below(3) == 0) out += ", \"material\": " + object(0);
    if (below(3) == 1) out += ", \"attributes\": {\"heat\": " + object(0) + "}";
    return out + "}";
  }

 private:
  static constexpr int kDeepest = 3;

  /// 0 when the bytes have run out, so that every document ends.
  std::uint32_t below(std::uint32_t n) {
    const std::uint32_t byte = at_ < bytes_.size() ? bytes_[at_++] : 0;
    return byte % n;
  }
  std::string whole(std::uint32_t n) { return std::to_string(below(n)); }
  /// A multiple of 1/16 from lo to hi sixteenths.
  std::string in_16ths(int lo, int hi) {
    return std::to_string((lo + static_cast<int>(below(static_cast<std::uint32_t>(hi - lo + 1)))) /
                          16.0);
  }
  std::string real() { return in_16ths(-48, 48); }
  std::string positive() { return in_16ths(1, 48); }

  template <class F>
  std::string list(std::size_t n, F item) {
    std::string out;
    for (std::size_t i = 0; i < n; ++i) out += (i == 0 ? "" : ", ") + item(i);
    return "[" + out + "]";
  }
  /// Numbers that rise by 1/16 to 2 a step.
  std::vector<std::string> rising(std::size_t n) {
    std::vector<std::string> out;
    int at = static_cast<int>(below(64)) - 48;
    for (std::size_t i = 0; i < n; ++i) {
      out.push_back(std::to_string(at / 16.0));
      at += 1 + static_cast<int>(below(32));
    }
    return out;
  }

  std::string node(int depth) {
    const std::uint32_t kind = below(8);
    if (kind == 0 || depth >= kDeepest) return std::array{R"("x")", R"("y")", R"("z")"}[below(3)];
    if (kind == 1) return real();
    if (kind <= 3 && !names_.empty()) {
      return "\"" + names_[below(static_cast<std::uint32_t>(names_.size()))] + "\"";
    }
    return object(depth);
  }

  std::string object(int depth) {
    const Grammar& grammar = grammars()[below(static_cast<std::uint32_t>(grammars().size()))];
    std::string out = R"({"type": ")" + std::string(grammar.type) + "\"";
    return out +
           (grammar.row != nullptr ? keys_of(*grammar.row, depth + 1)
                                   : keys_of(grammar.keys, depth + 1)) +
           "}";
  }

  std::string keys_of(const graph::NodeRow& row, int depth) {
    std::string out;
    for (const graph::NodeKey& key : row.keys) {
      if (!key.required && below(2) == 1) continue;
      if (key.kind == graph::KeyKind::inputs && below(2) == 1) {
        const std::string a = node(depth);
        out += ", \"a\": " + a + ", \"b\": " + node(depth);
      } else {
        out += std::string(", \"") + key.name + "\": " + value_of(key, depth);
      }
    }
    return out;
  }

  std::string value_of(const graph::NodeKey& key, int depth) {
    switch (key.kind) {
      case graph::KeyKind::node:
        return node(depth);
      case graph::KeyKind::inputs:
        return list(1 + below(3), [&](std::size_t) { return node(depth); });
      case graph::KeyKind::integer:
        return std::to_string(static_cast<std::uint32_t>(key.range->lo) + below(4));
      case graph::KeyKind::number:
        return within(*key.range);
      case graph::KeyKind::choice: {
        const auto n =
            std::ranges::count_if(key.choices, [](const char* w) { return w != nullptr; });
        return '"' + std::string(key.choices[below(static_cast<std::uint32_t>(n))]) + '"';
      }
      case graph::KeyKind::points:
        return points();
      case graph::KeyKind::levels:
        return levels(2 + below(4), false);
      default:
        return list(key.count, [&](std::size_t) { return within(*key.range); });
    }
  }

  /// A multiple of 1/16 in the range, at most 3 on each side of 0.
  std::string within(const NumberRange& range) {
    const double lo = std::max(range.lo, -3.0);
    const int least = static_cast<int>(std::ceil(lo * 16));
    return in_16ths(range.lo == kPositiveFloat.lo ? 1 : least,
                    static_cast<int>(std::min(range.hi, 3.0) * 16));
  }

  std::string keys_of(std::string_view rest, int depth) {
    std::string out;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find(' '), rest.size());
      std::string_view word = rest.substr(0, end);
      rest.remove_prefix(std::min(end + 1, rest.size()));
      const bool optional = word.ends_with('?');
      word.remove_suffix(optional ? 1 : 0);
      if (!optional || below(2) == 0) {
        const std::size_t equals = word.find('=');
        out += ", \"" + std::string(word.substr(0, equals)) +
               "\": " + value(word.substr(equals + 1), depth);
      }
    }
    return out;
  }

  std::string value(std::string_view code, int depth) {
    if (code.find('|') != std::string_view::npos) return choice(code);
    switch (code.front()) {
      case 'n':
        return node(depth);
      case 'p':
        return positive();
      case 'f':
        return in_16ths(0, 16);
      case 'h':
        return "0.015625";
      case 'w':
        return in_16ths(-32, -1);
      case 'W':
        return in_16ths(0, 32);
      case 'D':
        return choice("xy|xz|yz");
      case 'o':
        return std::to_string(1 + below(4));
      case 'l':
        return in_16ths(16, 48);
      case 'g':
        return in_16ths(0, 24);
      case 'c':
        return list(3, [&](std::size_t) { return whole(4); });
      case 'E':
      case 'R':
      case 'L':
        return levels(code.front() == 'L' ? 2 + below(4) : 2, code.front() == 'R');
      case 'M':
        return matrix();
      case 'C':
        return "[" + positive() + ", " + in_16ths(0, 32) + "]";
      case 'v':
      case 't':
        return list(3, [&](std::size_t) { return real(); });
      case 'V':
        return list(3, [&](std::size_t) { return positive(); });
      default:
        return real();
    }
  }

  std::string choice(std::string_view words) {
    std::vector<std::string_view> all;
    while (!words.empty()) {
      const std::size_t end = std::min(words.find('|'), words.size());
      all.push_back(words.substr(0, end));
      words.remove_prefix(std::min(end + 1, words.size()));
    }
    return "\"" + std::string(all[below(static_cast<std::uint32_t>(all.size()))]) + "\"";
  }

  std::string levels(std::size_t n, bool may_fall) {
    std::vector<std::string> numbers = rising(n);
    if (may_fall && below(2) == 1) std::swap(numbers.front(), numbers.back());
    return list(n, [&](std::size_t i) { return numbers[i]; });
  }

  std::string points() {
    const std::vector<std::string> x = rising(2 + below(4));
    return list(x.size(), [&](std::size_t i) { return "[" + x[i] + ", " + real() + "]"; });
  }

  /// The diagonal outweighs the rest of its row, so that there is an inverse.
  std::string matrix() {
    return list(12, [&](std::size_t i) {
      return i % 4 == 3 ? real() : i % 5 == 0 ? in_16ths(17, 48) : in_16ths(-8, 8);
    });
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::vector<std::string> names_;
};

}  // namespace mc::tests
