// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/renderer.h"

#include <cstdint>
#include <vector>

namespace thaw::test {

/// A burning candle made by formula, so that pictures can be tested without a simulation: a body of revolution with a
/// melt pool, drips that run down its wall, and a puddle. Radius 2.2 cm, height 9 cm, standing on y = 0. Hot and liquid
/// on top.
struct SyntheticCandle {
    std::vector<float> positions, normals, temperatures, liquidFractions;
    std::vector<uint8_t> materials;
    std::vector<uint32_t> indices;

    SyntheticCandle(int around = 288, int along = 220);
    thawSurfaceView view() const;
    /// The candle with wick, flame and a table.
    view::Scene scene() const;
    /// A camera that shows all of it.
    static view::Camera camera(float aspect);
};

/// The same candle as particles on a lattice, without drips: coarse inside, hot, liquid and moving at the top.
struct SyntheticParticles {
    static constexpr float kSpacing = 0.004f; // m
    std::vector<float> positions, velocities, normals, temperatures, liquidFractions, sizes;
    std::vector<uint8_t> materials, levels;

    SyntheticParticles();
    thawParticleView view() const;
};

} // namespace thaw::test
