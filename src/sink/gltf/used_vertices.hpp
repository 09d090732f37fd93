// SPDX-License-Identifier: MIT
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace mc::sink {

/// Which vertices of a mesh a part of it uses, and how they are numbered there: in their order.
/// Memory   1.5 bits for each vertex from the least that is used to the greatest; triangles in
///          order name vertices that are near one another.
class UsedVertices {
 public:
  [[nodiscard]] bool has(std::uint64_t id) const {
    const std::uint64_t word = id / 64;
    return word >= first_ && word - first_ < words_.size() &&
           (words_[word - first_] >> (id % 64) & 1) != 0;
  }
  void add(std::uint64_t id) {
    if (has(id)) return;
    make_room(id / 64);
    words_[id / 64 - first_] |= std::uint64_t{1} << (id % 64);
    ++size_;
  }
  [[nodiscard]] std::uint64_t size() const { return size_; }
  void clear() {
    words_.clear();
    size_ = 0;
  }
  /// All have been added.
  void number() {
    before_.resize(words_.size());
    std::uint32_t n = 0;
    for (std::size_t w = 0; w < words_.size(); ++w) {
      before_[w] = n;
      n += static_cast<std::uint32_t>(std::popcount(words_[w]));
    }
  }
  /// Preconditions: numbered, used.
  [[nodiscard]] std::uint32_t number_of(std::uint64_t id) const {
    const std::size_t word = id / 64 - first_;
    const std::uint64_t below = (std::uint64_t{1} << (id % 64)) - 1;
    return before_[word] + static_cast<std::uint32_t>(std::popcount(words_[word] & below));
  }
  /// The range that holds all of them, to multiples of 64.
  [[nodiscard]] std::uint64_t begin() const { return first_ * 64; }
  [[nodiscard]] std::uint64_t end() const { return (first_ + words_.size()) * 64; }

 private:
  void make_room(std::uint64_t word) {
    if (words_.empty()) first_ = word;
    if (word < first_) {
      words_.insert(words_.begin(), static_cast<std::size_t>(first_ - word), 0);
      first_ = word;
    }
    if (word - first_ >= words_.size()) words_.resize(static_cast<std::size_t>(word - first_ + 1));
  }

  std::uint64_t first_ = 0, size_ = 0;
  std::vector<std::uint64_t> words_;   // of 64 vertices each, from first_ on
  std::vector<std::uint32_t> before_;  // vertices used before each word
};

}  // namespace mc::sink
