// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "bench/kernels.h"
#include "bench/kicks.h"
#include "bench/motion.h"
#include "bench_registry.h"

namespace {
const thaw::player::BenchRegistration kKernels("kernels", "Nanoseconds a particle of the passes of a frame",
                                               thawBenchKernels);
const thaw::player::BenchRegistration kMotion("motion", "Nanoseconds a particle of the motion, beside the density pass",
                                              thawBenchMotion);
const thaw::player::BenchRegistration kKicks("kicks", "What one split or merge does to a liquid at rest",
                                             thawBenchKicks);
} // namespace
