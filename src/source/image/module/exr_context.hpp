// SPDX-License-Identifier: MIT
#pragma once

#include <openexr.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "source/image/module/image_file.hpp"

namespace mc::source {

/// An EXR file in memory, opened by OpenEXR's core library, whose errors come out as Error(input).
class ExrContext {
 public:
  ExrContext(std::string place, std::span<const std::byte> bytes);
  ~ExrContext();
  ExrContext(const ExrContext&) = delete;
  ExrContext& operator=(const ExrContext&) = delete;

  [[nodiscard]] exr_const_context_t get() const { return context_; }
  [[nodiscard]] const std::string& place() const { return place_; }
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }
  /// Throws where a call of the library on this thread did not succeed.
  void check(exr_result_t result) const;

 private:
  std::string place_;
  std::span<const std::byte> bytes_;
  exr_context_t context_ = nullptr;
};

/// What mc wrote beside a slice; nullopt where it did not.
[[nodiscard]] std::optional<SliceNote> slice_note(const ExrContext& file, int part);

}  // namespace mc::source
