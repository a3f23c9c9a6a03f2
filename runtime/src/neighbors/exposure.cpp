// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// How much of a particle is surface, from what the density pass already summed.
//
// The missing share u = 1 - sum V W / s0 of a particle's support says how many of its six sides are bare: 0.158 for one
// (a face of the lattice), 0.293 two (an edge), 0.405 three (a corner), 0.69 all (a drop alone). But the tilted or
// curved surface of a lattice is a staircase, and its steps look like edges although together they are no larger than
// the smooth surface; and the layers along a curved body are half a spacing inside and denser than the lattice. kArea
// is the least-squares fit, over all of these, of area in units of V^(2/3) to u: filled balls, tori, cylinders, cones
// and a candle, cubes and rotated cubes, lattices cut by spheres of radius 5 to 20 spacings, balls of shells, films.
// Their areas are within 4 %. Before the fit had filled bodies in it, those were 6 to 17 % too small.
#include "neighbors/exposure.h"

#include "base/kernel.h"
#include "base/math.h"

#include <algorithm>
#include <atomic>

namespace thaw {
namespace {

constexpr int kBlock = 512;

// One point of a piecewise linear function.
struct Node {
    float at, value;
};
constexpr Node kArea[] = {{0.09f, 0.0f},   {0.12f, 0.553f}, {0.158f, 1.02f},  {0.2f, 1.188f},  {0.245f, 1.321f},
                          {0.293f, 1.79f}, {0.35f, 1.935f}, {0.405f, 2.488f}, {0.52f, 3.432f}, {0.692f, 4.836f}};
// Of the same fit, by slope (see kBySlope): what comes to it where a particle is denser than its slope allows in the
// lattice, whole from 4 % on, at most half as much again.
constexpr Node kDense[] = {{0.3f, 0.0f}, {0.7f, 0.323f}, {1.0f, 0.257f}, {1.272f, 0.196f}, {1.8f, -0.397f}};
constexpr float kDenser = 0.04f, kMostDense = 1.5f;
// What faces nowhere: a film of one layer in the air, a thread, a drop.
constexpr Node kFaceless[] = {{0.25f, 0.0f}, {0.316f, 2.0f}, {0.541f, 3.545f}, {0.694f, 4.836f}};

template <size_t N> float interpolate(const Node (&nodes)[N], float at) {
    if (at <= nodes[0].at) return nodes[0].value;
    for (size_t k = 1; k < N; ++k)
        if (at < nodes[k].at) {
            const Node &a = nodes[k - 1], &b = nodes[k];
            return a.value + (b.value - a.value) * (at - a.at) / (b.at - a.at);
        }
    return nodes[N - 1].value;
}

// A lattice face at kSupport: missing share, and |sum V grad W / s0| times h.
constexpr float kFaceMissing = 0.158159f;
constexpr float kFaceGradient = 1.071f;
// Below: the holes and the disorder of a liquid's inside, unless more than an edge is missing.
constexpr float kLeastGradient = 0.35f;
constexpr float kSurelyBare = 0.28f;
// Below, the surface faces nowhere: a drop alone, a film in the air.
constexpr float kLeastDirection = 0.2f;

// The same missing share by |sum V grad W| h / sum V W, which does not change when everything comes closer: the top
// layer of a liquid sinks into the one below until its own density is that of the inside (pressure does not pull), a
// film on what is solid by a third of a spacing, and the missing share alone would call it covered.
constexpr Node kBySlope[] = {{0.0f, 0.0f}, {1.272f, 0.158f}, {1.803f, 0.293f}, {2.208f, 0.405f}};
// A wall in contact stands in for the layers of the lattice that it replaces, wherever between the standoff and one
// spacing the particle rests: the density map, made for pressure, would call a particle at 0.3 spacings overfull.
constexpr float kContactReach = 1.5f;
float contact(float distanceInSpacings) { return std::clamp((kContactReach - distanceInSpacings) / 0.7f, 0.0f, 1.0f); }

bool covered(float share, Vec3 gradient, float h) {
    return 1 - share <= kArea[0].at && length(gradient) * h < kLeastGradient;
}

struct Size {
    float support;     // m
    float edge;        // m, of the cube of its volume
    float thinner = 1; // how much less volume than the cube of its spacing it has
};

// Whether a particle is bare, by the share of its support that is filled and the gradient of that; then its area in m^2
// and the direction outward, zero where it faces nowhere.
bool isBare(float share, Vec3 gradient, const Size& size, Vec3 x, const WallFinder& walls, float& area, Vec3& outward) {
    const float h = size.support;
    if (covered(share, gradient, h)) return false;
    walls.forNear(x, kContactReach / kSupport * h, [&](float distance, Vec3 n, const Collider&) {
        const float a = contact(distance * (kSupport / h));
        if (a == 0) return;
        // Divided, not added: the shares of bare sides multiply to a good approximation.
        share /= 1 - kFaceMissing * a;
        gradient = gradient - (kFaceGradient * a / h) * n;
    });
    const float steep = length(gradient) * h;
    const float slope = steep / share, bySlope = interpolate(kBySlope, slope);
    const bool faceless = steep < kLeastGradient;
    // A film in the air of one layer has the volume of its thickness: how full its support is says nothing about how
    // thick it is, only how many there are.
    const float missing = faceless ? 1 - share * size.thinner : std::max(1 - share, bySlope);
    // Less bare than that is the disorder of a liquid's inside: 1000 of the candle's 3400 at the surface were, and took
    // rays.
    if (missing < kArea[0].at || (faceless && missing < kSurelyBare)) return false;
    float sides;
    if (faceless) {
        sides = interpolate(kFaceless, missing);
    } else {
        const float denser = std::max(0.0f, share / (1 - bySlope) - 1) / kDenser;
        sides = interpolate(kArea, missing) + std::min(denser, kMostDense) * interpolate(kDense, slope);
    }
    if (!(sides > 0)) return false;
    const float side = faceless ? h / kSupport : size.edge;
    area = sides * side * side;
    outward = steep > kLeastDirection ? normalizeOr(-gradient, {}) : Vec3{};
    return true;
}

// Of the finest points of a row.
bool isBareByReference(const Particles& p, size_t i, const Reference& reference, const Size& size,
                       const WallFinder& walls, float& area, Vec3& outward) {
    const float finer = kSupport / supportOf(1, p.level[i]);
    const Size each{size.support * finer, size.edge * finer, size.thinner};
    Vec3 sum;
    area = 0;
    reference.forPoints(p, i, [&](Vec3 x, uint32_t k) {
        float own;
        Vec3 normal;
        if (isBare(reference.point[k].w, reference.slope[k].xyz(), each, x, walls, own, normal))
            area += own, sum = sum + own * normal;
    });
    outward = normalizeOr(sum, {});
    return area > 0;
}

} // namespace

int findExposure(Particles& particles, const Neighbors& neighbors, const float* volume, const Collider* colliders,
                 int colliderCount, const Reference* reference, Tasks& tasks) {
    std::atomic<int> total{0};
    const auto besideCoarse = [&](int i) {
        bool coarse = false;
        forNeighbors(neighbors, i, [&](uint32_t j) {
            coarse = particles.level[j] > 0; // of the dummies 0
            return !coarse;
        });
        return coarse;
    };
    tasks.forBlocks(particles.count, kBlock, [&](int begin, int end, int, int) {
        Box around;
        float reach = 0;
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            const Vec4 x = particles.position[k];
            around.grow(x.xyz());
            // The points of a coarse one are nearer to a wall than its middle.
            reach = std::max(reach, (kContactReach + (particles.level[k] > 0 ? 0.6f : 0.0f)) / kSupport * x.w);
        }
        WallFinder walls;
        walls.gather(colliders, nullptr, colliderCount, around, reach);
        int exposed = 0;
        float lastVolume = 0;
        Size size{0, 0}; // most rows are of one
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            particles.normal[k] = {};
            particles.flags[k] = static_cast<uint8_t>(particles.flags[k] & ~kSurface);
            float area = 0;
            Vec3 outward;
            bool bare;
            const float h = particles.position[k].w;
            if (volume[k] != lastVolume || h != size.support) {
                lastVolume = volume[k];
                const float spacing = h / kSupport;
                size = {h, detCbrt(lastVolume), lastVolume > 0 ? spacing * spacing * spacing / lastVolume : 1.0f};
            }
            if (reference && particles.level[k] > 0 && particles.fine[k]) {
                bare = isBareByReference(particles, k, *reference, size, walls, area, outward);
            } else {
                bare = isBare(neighbors.volumeFraction[k], neighbors.gradientSum[k].xyz(), size,
                              particles.position[k].xyz(), walls, area, outward);
                if (reference && particles.fine[k]) {
                    const size_t point = particles.fine[k] - 1;
                    const bool outside = bare || !covered(reference->point[point].w, reference->slope[point].xyz(), h);
                    if (outside && besideCoarse(i))
                        bare = isBareByReference(particles, k, *reference, size, walls, area, outward);
                }
            }
            if (!bare) continue;
            particles.normal[k] = {outward.x, outward.y, outward.z, area};
            particles.flags[k] = static_cast<uint8_t>(particles.flags[k] | kSurface);
            ++exposed;
        }
        total.fetch_add(exposed, std::memory_order_relaxed);
    });
    return total.load();
}

} // namespace thaw
