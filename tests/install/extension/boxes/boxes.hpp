// SPDX-License-Identifier: MIT
#pragma once

#include "mc/method.hpp"

/// A box of one cell around each solid sample, without the faces between two of them: the cuberille
/// of Herman and Liu (1979). Samples on the volume's border count as not solid, so that the mesh is
/// closed.
extern const mc::Method kBoxesMethod;
