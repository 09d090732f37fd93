// SPDX-License-Identifier: MIT
#pragma once

namespace mc {

/// Limits of a number; `text` says them, as in "a number above 0".
struct NumberRange {
  double lo = -1.7976931348623157e308;
  double hi = 1.7976931348623157e308;
  bool lo_excluded = false;
  const char* text = "a number";
};

/// Numbers that a float32 can hold.
inline constexpr NumberRange kAnyFloat{-3.4028234663852886e38, 3.4028234663852886e38, false,
                                       "a number within +-3.4e38 (float32)"};
inline constexpr NumberRange kPositiveFloat{1.1754943508222875e-38, 3.4028234663852886e38, false,
                                            "a number above 0 (1.2e-38 to 3.4e38, float32)"};
inline constexpr NumberRange kFloatNotNegative{0, 3.4028234663852886e38, false,
                                               "a number from 0 to 3.4e38 (float32)"};

}  // namespace mc
