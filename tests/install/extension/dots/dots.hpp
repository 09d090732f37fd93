// SPDX-License-Identifier: MIT
#pragma once

#include "mc/source.hpp"

/// Text volumes: "dots NX NY NZ", then a line "I J K VALUE" for each sample that is not 0.
extern const mc::SourceFormat kDotsFormat;
