// SPDX-License-Identifier: MIT
#pragma once

#include "mc/sink.hpp"

/// Object File Format (Geomview): counts, positions, faces, as text.
extern const mc::SinkFormat kOffFormat;
