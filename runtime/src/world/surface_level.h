// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/state_io.h"

#include <cstdint>

namespace thaw {

// Chooses how coarse the mesh is, before it is made, so that making it takes no longer than it may: at once coarser
// when what the last meshes took would not fit, finer after a second in which that would have fitted.
class SurfaceLevel {
public:
    enum class Prices { learnt, fixed }; // of what it took; of what was meshed, the same on every machine
    explicit SurfaceLevel(Prices prices) : prices_(prices) {}

    static constexpr int kCoarsest = 3;
    static float cells(int level); // as wide as those of level 0: 2^(level / 3)

    // milliseconds: that a mesh may take, nominal ones by fixed prices; 0: any. Of the
    // levels that it may have, the finest goes before the coarsest.
    int choose(float milliseconds, int finest, int coarsest);

    struct Made {
        int level = 0;
        float milliseconds = 0;
        int64_t blocks = 0, vertices = 0; // meshed, in all
    };
    void learn(const Made& made);
    void state(StateIo& io);

private:
    Prices prices_;
    float demand_ = 0; // ms of level 0; the most of late, which fades
    float last_ = 0;
    int level_ = 0, lastLevel_ = -1, roomy_ = 0;
};

} // namespace thaw
