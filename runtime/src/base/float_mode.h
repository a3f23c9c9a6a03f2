// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace thaw {

// Rounding, denormals and exception masks of the calling thread. Workers take over the caller's: a host that flushes
// denormals on its own thread only would otherwise get bits that depend on who ran which block.
struct FloatMode {
#if defined(__SSE2__)
    unsigned word = _mm_getcsr() & ~0x3fu; // without the sticky status flags
    void apply() const { _mm_setcsr(word); }
#else
    void apply() const {}
#endif
};

} // namespace thaw
