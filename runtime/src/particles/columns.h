// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/state_io.h"
#include "particles/particles.h"

namespace thaw {

// The rows [0, count) of every field. Images hold them field by field (a Vec4 by its four), each as short as it gets:
// one value where all are the same, only those that are not 0 and who they are, or all of them.

// Hashes or saves them. features: whether anybody reads those; else they are not hashed.
void columns(StateIo& io, Particles& p, bool features);
// Reads so many rows of an image into the second copies that the sort has, and looks whether a world with io.limits can
// have them.
void readColumns(StateIo& io, Particles& p, size_t rows, float spacing);
// A field of a part's own; in memory of its own, also while the image is only checked.
void sparse(StateIo& io, float* values, size_t n);
// Brings in what was read.
void takeColumns(Particles& p, int count, int movers);

} // namespace thaw
