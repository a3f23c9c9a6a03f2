// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/tasks.h"
#include "thaw/thaw.h"

#include <array>

namespace thaw {

// What a host's vertices may hold, and where they have it.
struct SurfaceAttribute {
    const char* name; // of the offset
    int offset, bytes, align;
    const void* (*source)(const thawSurfaceView& view); // those of all vertices, side by side
};
std::array<SurfaceAttribute, 7> surfaceAttributes(const thawSurfaceBuffers& buffers);

// Buffers that are large enough and fit.
void writeSurface(const thawSurfaceView& view, const thawSurfaceBuffers& buffers, Tasks& tasks);

} // namespace thaw
