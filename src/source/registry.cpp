// SPDX-License-Identifier: MIT
#include "mc/source.hpp"
