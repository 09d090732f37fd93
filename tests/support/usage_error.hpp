// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "mc/base.hpp"

namespace mc::tests {

/// The text of the usage error that `work` throws; "" and a failure if it throws none.
template <class Work>
std::string usage_error(Work&& work) {
  try {
    work();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::usage);
    return e.what();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

}  // namespace mc::tests
