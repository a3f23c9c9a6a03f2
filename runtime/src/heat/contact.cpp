// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "heat/contact.h"

#include "base/kernel.h"

#include <algorithm>
#include <atomic>
#include <cmath>

namespace thaw {
namespace {

constexpr int kBlock = 512;
// In spacings: whole up to the first, none from the second on. The integral over the distance is one spacing, so that a
// body whose layers do not follow the wall touches it with its real area as well.
constexpr float kWhole = 0.8f, kNone = 1.2f;
// A particle pressed into a wall conducts no better than this near.
constexpr float kNearest = 0.25f;
// Missing share of the support at a face, see neighbors/exposure.cpp.
constexpr float kFaceMissing = 0.158159f;

} // namespace

bool Contact::any(const Collider* colliders, int count) {
    return std::any_of(colliders, colliders + count, [](const Collider& c) { return c.heats(); });
}

const WallContact* Contact::find(const HeatFrame& f) {
    if (!any(f.colliders, f.colliderCount)) return nullptr;
    const Particles& p = f.particles;
    rows_.reserve(static_cast<size_t>(p.capacity));
    rows_.resizeRaw(static_cast<size_t>(p.count));
    std::atomic<bool> touched{false};
    f.tasks.forBlocks(p.count, kBlock, [&](int begin, int end, int, int) {
        Box around;
        float reach = 0;
        for (int i = begin; i < end; ++i) {
            const Vec4 x = p.position[static_cast<size_t>(i)];
            around.grow(x.xyz()), reach = std::max(reach, kNone / kSupport * x.w);
        }
        WallFinder walls;
        walls.gather(f.colliders, nullptr, f.colliderCount, around, reach);
        bool touches = false;
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            WallContact& row = rows_[k] = {};
            if (walls.empty()) continue;
            const float spacing = p.position[k].w / kSupport;
            double sum = 0, heat = 0;
            walls.forNear(p.position[k].xyz(), kNone * spacing, [&](float distance, Vec3, const Collider& c) {
                const float share = std::clamp((kNone - distance / spacing) / (kNone - kWhole), 0.0f, 1.0f);
                if (share == 0 || !c.heats()) return;
                const Material& m = f.materials[p.material[k]];
                const double conductivity = m.conductivity(m.liquidFraction(p.enthalpy[k], p.flags[k] & kUnseeded));
                const double area = static_cast<double>(share) * f.volume[k] / spacing;
                // The wall's 1 / h is 0 for a perfect contact, the melt's is infinite when it does not conduct.
                const double g = area / (1 / static_cast<double>(c.conductance) +
                                         std::max(kNearest * spacing, distance) / conductivity);
                sum += g, heat += g * c.temperature;
                row.covered *= 1 - kFaceMissing * share;
            });
            if (!(sum > 0)) continue;
            row.conductance = static_cast<float>(sum), row.temperature = static_cast<float>(heat / sum);
            touches = true;
        }
        if (touches) touched.store(true, std::memory_order_relaxed);
    });
    return touched.load() ? rows_.data() : nullptr;
}

} // namespace thaw
