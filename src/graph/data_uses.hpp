// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "graph/program.hpp"

namespace mc::graph {

/// What the instructions of a program read: one use for all nodes that read the same samples in the
/// same way.
class DataUses {
 public:
  /// Precondition: the node has a raster or a volume.
  /// Cost     O(samples) where the use is new: their range is found.
  const DataUse* of(const Node& node);
  [[nodiscard]] std::vector<std::shared_ptr<const DataUse>> take();

 private:
  using Key = std::tuple<const void*, Wrap, Filter, std::optional<float>>;

  std::vector<std::shared_ptr<const DataUse>> uses_;
  std::map<Key, const DataUse*> known_;
};

}  // namespace mc::graph
