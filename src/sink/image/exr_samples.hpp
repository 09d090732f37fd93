// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

#include "mc/sink.hpp"

namespace mc::sink {

/// The type in which OpenEXR holds every sample of `type`: f16 for u8, i8 and f16; f32 for u16, i16
/// and f32; u32 for u32. Errors   limit: i32, i64 and f64, which it cannot hold.
[[nodiscard]] SampleType exr_type(SampleType type, std::string_view place);

/// The same numbers in that type.
[[nodiscard]] Picture exr_picture(const Picture& picture, std::string_view place);

}  // namespace mc::sink
