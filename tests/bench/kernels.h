// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/types.h"

// `thaw bench kernels`: nanoseconds a particle of the passes that every frame is made of. argv[0] is the name; see
// --help for the rest. Returns an exit code.
int thawBenchKernels(int argc, char** argv);

namespace thaw {

struct MatvecArgs {
    const Vec4 *position, *in;
    Vec4* out;
    const uint32_t *entries, *first, *width;
    const float* coefficient;
};

float benchMultiplyAdd(int turns); // 10 x 8 fused multiply-adds a turn
const char* benchTarget();
void benchMatvec(const MatvecArgs& a, int begin, int end);

} // namespace thaw
