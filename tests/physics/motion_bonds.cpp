// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "stability/motion_fixture.h"

#include <doctest/doctest.h>

using namespace thaw;

namespace {

// 10 x 10 x 10 particles of an elastic material on the lattice, bonded, then deformed.
struct Block {
    static constexpr float kModulus = 1e5f;
    MotionScene scene;
    Bonds bonds;

    explicit Block(const thawMaterialDef& material) : scene(0.004f, material), bonds(scene.allocator) {
        scene.gravity = {};
        const float dx = scene.spacing;
        for (int k = 0; k < 10; ++k)
            for (int j = 0; j < 10; ++j)
                for (int i = 0; i < 10; ++i)
                    scene.add({(static_cast<float>(i) + 0.5f) * dx, (static_cast<float>(j) + 0.5f) * dx,
                               (static_cast<float>(k) + 0.5f) * dx},
                              false, {}, 0);
        scene.weigh();
        bonds.bondAll(frame());
    }
    static thawMaterialDef elastic() {
        thawMaterialDef d = MotionScene::liquid(1);
        d.setFraction = 0.35f, d.releaseFraction = 0.6f;
        d.youngModulus = kModulus;
        return d;
    }
    BondFrame frame() { return scene.bondFrame(); }
    // x += gamma y
    void shear(float gamma) {
        Particles& p = scene.particles;
        for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) p.position[i].x += gamma * p.position[i].y;
    }
    // Mean of the von Mises stress of particles that have all of their neighbours, Pa.
    double inside() {
        const Particles& p = scene.particles;
        double sum = 0;
        int n = 0;
        for (int i = 0; i < p.count; ++i) {
            const Vec4 x = p.position[static_cast<size_t>(i)];
            const float low = 2 * scene.spacing, high = 8 * scene.spacing;
            if (x.y < low || x.y > high || x.z < low || x.z > high || x.x < low || x.x > high) continue;
            sum += static_cast<double>(bonds.stress(frame(), static_cast<uint32_t>(i)).mises), ++n;
        }
        return sum / n;
    }
};

} // namespace

TEST_CASE("bonds: simple shear gives the shear stress of an isotropic solid with Poisson's ratio 1/4") {
    Block b(Block::elastic());
    b.bonds.lay(b.frame());
    CHECK(b.inside() == doctest::Approx(0).scale(1));
    b.shear(0.01f);
    const double expected = std::sqrt(3.0) * 0.01 * static_cast<double>(Block::kModulus) / 2.5;
    CHECK(b.inside() == doctest::Approx(expected).epsilon(0.01));
}

TEST_CASE("bonds: the shear stress of a Maxwell solid under constant strain falls as e^(-t / tau)") {
    thawMaterialDef m = Block::elastic();
    m.relaxationTime = 0.5f;
    Block b(m);
    b.bonds.lay(b.frame());
    b.shear(0.01f);
    const double start = b.inside();
    for (int frame = 1; frame <= 90; ++frame) {
        b.bonds.relax(b.frame());
        if (frame % 30) continue;
        CHECK(b.inside() == doctest::Approx(start * std::exp(-frame / 60.0 / 0.5)).epsilon(0.05));
    }
}

TEST_CASE("bonds: stress above the yield comes down to it in a step, below it stays") {
    thawMaterialDef m = Block::elastic();
    m.solidYieldStress = 400;
    for (const float gamma : {0.004f, 0.02f}) {
        Block b(m);
        b.bonds.lay(b.frame());
        b.shear(gamma);
        const double start = b.inside();
        for (int n = 0; n < 5; ++n) b.bonds.relax(b.frame());
        CHECK(b.inside() == doctest::Approx(std::min(start, 400.0)).epsilon(gamma < 0.01f ? 1e-3 : 0.1));
    }
}

TEST_CASE("bonds: stiffness falls with the square of what is solid, and is gone where it lets go") {
    Block b(Block::elastic());
    b.bonds.lay(b.frame());
    b.shear(0.01f);
    const double cold = b.inside();
    Particles& p = b.scene.particles;
    for (const float phi : {0.15f, 0.3f, 0.6f}) {
        for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) p.liquidFraction[i] = phi;
        const double share = 1 - static_cast<double>(phi) / 0.6;
        CHECK(b.inside() == doctest::Approx(cold * share * share).epsilon(1e-4).scale(1e-3 * cold));
    }
}

TEST_CASE("bonds: what is stretched beyond the break strain loses its bonds, not at once") {
    thawMaterialDef m = Block::elastic();
    m.breakStrain = 0.05f;
    Block b(m);
    b.bonds.lay(b.frame());
    b.shear(0.3f);
    const double start = b.inside();
    b.bonds.relax(b.frame());
    const double next = b.inside();
    CHECK(next < start);
    CHECK(next > 0.7 * start);
    for (int n = 0; n < 10; ++n) b.bonds.relax(b.frame());
    CHECK(b.inside() < 0.6 * start);
}

TEST_CASE("bonds: particles that go leave no bond behind") {
    Block b(Block::elastic());
    Particles& p = b.scene.particles;
    // Every other particle melts, then all of them.
    for (size_t i = 0; i < static_cast<size_t>(p.count); i += 2) p.liquidFraction[i] = 1;
    CHECK(b.bonds.update(b.frame()).released == 500);
    CHECK(b.bonds.any());
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) p.liquidFraction[i] = 1;
    CHECK(b.bonds.update(b.frame()).released == 500);
    CHECK_FALSE(b.bonds.any());
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) CHECK(p.bondSlot[i] == 0);
    // Cold again: all of it sets.
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) p.liquidFraction[i] = 0;
    CHECK(b.bonds.update(b.frame()).set == 1000);
}
