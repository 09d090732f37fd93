// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mc/base.hpp"

// The one place where exceptions end.

namespace mc::cli {

struct Failure {
  int status = 1;                  ///< the exit status
  std::vector<std::string> lines;  ///< without "mc: error: "
};

/// An error as it is shown: with the option that remedies it.
Failure failure_of(const Error& error);

/// Does the work; what it throws becomes a Failure.
std::optional<Failure> attempt(const std::function<void()>& work);

}  // namespace mc::cli
