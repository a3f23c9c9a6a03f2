// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace thaw {

// Particles as one array per number, readable seven past the last.
struct FillArrays {
    const float *x, *y, *z, *inverse, *amplitude; // m; inverse: 1 / radius^2
};

struct FillBox {
    float center[3], half[3]; // m
};

// Copies the particles of runs that reach into the box, with inverse sharper in place of inverse, to arrays of `stride`
// one after the other, x, y, z and inverse, and their rows, in their order; returns how many.
int copyNear(const FillArrays& from, const uint32_t* fromRows, const int* begins, const int* ends, int runs,
             const FillBox& box, float sharper, float* to, int stride, uint32_t* rows);

// Weights t^3, t = 1 - r^2 inverse, of those of `count` where t is above 0, and which they are, in their order;
// returns how many. Reads, and writes, up to seven more.
int weigh(const float* near, int stride, int count, float x, float y, float z, float* weights, uint32_t* which);

} // namespace thaw
