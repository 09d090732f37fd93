// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mc/graph.hpp"
#include "mc/source.hpp"

// The files that an mc-volume document names: pictures and volumes.

namespace mc::source {

/// What a document that is read as another one's volume stands in.
struct SpecNesting {
  /// Samples that the files of one document may have together: 1 GiB of float32, and half of the
  /// memory.
  static constexpr std::uint64_t kMostSamples = std::uint64_t{1} << 28;
  static constexpr std::uint64_t most_samples(std::uint64_t memory_bytes) {
    return std::min(kMostSamples, memory_bytes / 2 / sizeof(float));
  }
  static constexpr std::size_t kMostDocuments = 8;

  std::vector<std::string> open{};  ///< the documents around it, as whole paths, outermost first
  std::uint64_t left = kMostSamples;
  std::string root{};               ///< SourceOptions::root
  SourceFormats further_formats{};  ///< SourceOptions::further_formats
};

/// A volume that a document names, and what is solid in it.
struct NamedVolume {
  std::shared_ptr<const SampledVolume> samples{};
  std::optional<double> iso{};  ///< unset where it does not say
  bool above = true;            ///< samples above iso are solid, else those below
};

class SpecFiles {
 public:
  /// `document` is the document's own path: names in it are relative to its folder.
  /// Errors   usage: `within` holds it already; limit: it is one more than kMostDocuments.
  SpecFiles(const std::string& document, const SpecNesting& within);

  /// One channel of a picture, top row first. PNG numbers are divided by the greatest of their
  /// type, so that white is 1; EXR numbers are taken as they are. A picture that is named again is
  /// read once.
  /// Errors   input: missing, no picture, damaged, no such channel; limit: more samples than are
  ///          left.
  std::shared_ptr<const Raster> picture(const std::string& path,
                                        const std::optional<std::string>& channel);

  /// A volume of any kind, made dense. One that is named again is read once.
  /// Errors   those of open_named() and read_volume(); usage: stdin; limit: more samples than are
  ///          left.
  const NamedVolume& named_volume(const std::string& path, const std::optional<std::string>& grid);
  std::shared_ptr<const SampledVolume> volume(const std::string& path,
                                              const std::optional<std::string>& grid) {
    return named_volume(path, grid).samples;
  }

  /// Of all that was read.
  [[nodiscard]] std::uint64_t bytes() const { return (most_ - inside_.left) * sizeof(float); }

 private:
  using Key = std::pair<std::string, std::optional<std::string>>;

  [[nodiscard]] std::string resolved(const std::string& path) const;
  void take(std::uint64_t n_samples, const std::string& place);

  std::string folder_;
  SpecNesting inside_;  ///< what this document's own volumes stand in
  std::uint64_t most_;  ///< samples, of which inside_.left are left
  std::map<Key, std::shared_ptr<const Raster>> pictures_;
  std::map<Key, NamedVolume> volumes_;
};

}  // namespace mc::source
