// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

namespace thaw {

// Candidates around a point, one array per number, readable seven past the last.
struct FillArrays {
    const float *x, *y, *z, *inverse, *amplitude; // inverse: 1 / radius^2
};

// Sum of amplitude (1 - r^2 inverse)^3 at (x, y, z) over up to nine runs [begins, ends), in their order; stops after
// the run that reaches enough.
float sumRuns(const FillArrays& from, const int* begins, const int* ends, int runs, float x, float y, float z,
              float enough);

// One particle, in cells from the block's first node, and what it carries.
struct FillSource {
    float x, y, z, radius, amplitude;
    float carried[3];
};

// Adds w = amplitude (1 - r^2 / radius^2)^3 to channel 0 and w carried[k] to channel k + 1 at the nodes of a block of
// 8^3; channels are 512 apart.
void splatSource(const FillSource& source, float* values);

} // namespace thaw
