// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "mc/graph.hpp"

// The files that an mc-volume document names: pictures.

namespace mc::source {

class SpecFiles {
 public:
  /// Samples that the files of one document may have together: 1 GiB of float32.
  static constexpr std::uint64_t kMostSamples = std::uint64_t{1} << 28;

  /// `document` is the document's own path: names in it are relative to its folder.
  explicit SpecFiles(const std::string& document);

  /// One channel of a picture, top row first. PNG numbers are divided by the greatest of their
  /// type, so that white is 1; EXR numbers are taken as they are. A picture that is named again is
  /// read once. Errors   input: missing, no picture, damaged, no such channel; limit: more samples
  /// than
  ///          kMostSamples.
  std::shared_ptr<const Raster> picture(const std::string& path,
                                        const std::optional<std::string>& channel);

 private:
  using Key = std::pair<std::string, std::optional<std::string>>;

  [[nodiscard]] std::string resolved(const std::string& path) const;
  void take(std::uint64_t n_samples, const std::string& place);

  std::string folder_;
  std::uint64_t left_ = kMostSamples;
  std::map<Key, std::shared_ptr<const Raster>> pictures_;
};

}  // namespace mc::source
