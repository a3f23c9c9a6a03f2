// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "heat/radiation.h"

#include "base/kernel.h"
#include "heat/visibility.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr int kRayBlock = 128;
constexpr double kPi = 3.14159265358979323846;

// Particles::rayMemory remembers, from the last time rays were cast for a particle, which of the first kRemembered
// sources it saw and how long ago that is: (1 + age) 2^16 + one bit per source, a whole number below 2^22 and so exact
// in a float; 0 when nothing is known. Rays to the sources beyond are cast in every step.
constexpr int kRemembered = 16;
float remember(int age, uint32_t seen) { return static_cast<float>((static_cast<uint32_t>(1 + age) << 16) | seen); }
bool known(float memory) { return memory >= 65536; }
int ageOf(float memory) { return static_cast<int>(static_cast<uint32_t>(memory) >> 16) - 1; }
uint32_t seenOf(float memory) { return static_cast<uint32_t>(memory) & 0xffffu; }
constexpr int kOldest = 60;
// What moves is looked at this many times as often as what stands still.
constexpr int kMoverAge = 3;
constexpr uint8_t kNoRay = 0, kUnknown = 255;

// Of the melt as it shades itself, in spacings. A square lattice of spheres is closed from 0.71 on.
constexpr float kShadeRadius = 0.75f;
// Rays leave from above the steps that a tilted surface of a lattice has, and do not see what is closer than kSkip.
constexpr float kRaise = 1.0f, kSkip = 1.5f;
// A drop alone, which faces nowhere: its cross-section is a quarter of its surface.
constexpr float kDropCosine = 0.25f;

// How a source looks from an exposed particle.
struct View {
    float flux; // W/m^2 if nothing is in the way; 0 when the particle faces away
    Ray ray;
};

View look(const HeatSource& source, Vec3 x, Vec4 normal, float spacing) {
    const Vec3 n = normal.xyz();
    const bool drop = dot(n, n) < 0.25f;
    View v;
    v.ray.surface = x + (0.5f * spacing) * n;
    const Vec3 way = source.position - v.ray.surface;
    v.ray.distance = length(way);
    // A source that touches the surface shines straight on it.
    const bool touching = v.ray.distance < 1e-3f * source.radius;
    v.ray.direction = touching ? normalizeOr(n, {0, 1, 0}) : normalizeOr(way, {0, 1, 0});
    v.ray.raised = x + (kRaise * spacing) * (drop ? v.ray.direction : n);
    v.ray.skip = kSkip * spacing;
    const float cosine = drop ? kDropCosine : std::max(0.0f, dot(n, v.ray.direction));
    // Nearer than its own size a particle would take more than the half of all power that its plane can catch.
    const float d2 = std::max({v.ray.distance * v.ray.distance, source.radius * source.radius,
                               normal.w * static_cast<float>(0.5 / kPi), 1e-12f});
    v.flux = source.power * cosine / (4 * static_cast<float>(kPi) * d2);
    return v;
}

bool shines(const HeatSource& s) { return s.alive && s.enabled && s.power != 0; }

} // namespace

struct Radiation::Impl {
    explicit Impl(Allocator& a)
        : allocator(a), exposed(a), spheres(a), sphereIds(a), priority(a), power(a), blockRays(a) {}

    Allocator& allocator;
    std::unique_ptr<Visibility> visibility;

    Array<int> exposed; // rows
    Array<Vec4> spheres;
    Array<uint32_t> sphereIds;
    Array<uint8_t> priority; // per exposed: kNoRay, 1 + age, kUnknown
    Array<float> power;      // per row, W absorbed
    Array<int> blockRays;
};

Radiation::Radiation(Allocator& allocator) : impl_(std::make_unique<Impl>(allocator)) {}
Radiation::~Radiation() = default;

const float* Radiation::power() const { return impl_->power.data(); }

void Radiation::run(const HeatFrame& f, HeatStats& stats) {
    Impl& m = *impl_;
    Particles& p = f.particles;
    const size_t count = static_cast<size_t>(p.count);
    m.power.assign(count, 0.0f);
    m.exposed.clear(), m.exposed.reserve(count);
    for (int i = 0; i < p.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if ((p.flags[k] & kSurface) && p.normal[k].w > 0)
            m.exposed.push(i);
        else
            p.rayMemory[k] = 0;
    }
    const int exposed = static_cast<int>(m.exposed.size());
    if (exposed == 0) return;

    // The surface of a melt grows for as long as it melts: room for all at once.
    m.spheres.reserve(count), m.sphereIds.reserve(count), m.priority.reserve(count);
    m.spheres.resizeRaw(m.exposed.size()), m.sphereIds.resizeRaw(m.exposed.size());
    m.priority.resizeRaw(m.exposed.size());
    m.blockRays.reserve(static_cast<size_t>(Tasks::blockCount(p.count, kRayBlock)));
    m.blockRays.assign(static_cast<size_t>(Tasks::blockCount(exposed, kRayBlock)), 0);
    const auto spacingOf = [&](size_t row) { return p.position[row].w * (1 / kSupport); };
    f.tasks.forBlocks(exposed, kRayBlock, [&](int begin, int end, int, int) {
        for (int e = begin; e < end; ++e) {
            const size_t at = static_cast<size_t>(e), row = static_cast<size_t>(m.exposed[at]);
            const Vec4 x = p.position[row];
            const float dx = spacingOf(row);
            m.spheres[at] = {x.x, x.y, x.z, kShadeRadius * dx}, m.sphereIds[at] = p.id[row];
            bool lit = false;
            for (int s = 0; s < f.sourceCount && !lit; ++s)
                lit = shines(f.sources[s]) && look(f.sources[s], x.xyz(), p.normal[row], dx).flux != 0;
            const float memory = p.rayMemory[row];
            m.priority[at] = !lit ? kNoRay : known(memory) ? static_cast<uint8_t>(1 + ageOf(memory)) : kUnknown;
        }
    });

    // Who gets rays: all that are not known yet, then the oldest memories, those of one age in the order of rows.
    int ofAge[256] = {};
    for (uint8_t a : m.priority) ++ofAge[a];
    const int lit = exposed - ofAge[kNoRay];
    int left = static_cast<int>(std::ceil(f.rayRefresh * static_cast<float>(lit))) - ofAge[kUnknown];
    int threshold = kUnknown;
    while (threshold > 1 && left >= ofAge[threshold - 1] && left > 0) left -= ofAge[--threshold];
    // Down to `threshold` all; of the age below, the first `left`.
    int refreshed = 0;
    for (uint8_t& a : m.priority) {
        if (a == kNoRay) continue;
        bool chosen = a >= threshold;
        if (!chosen && a == threshold - 1 && left > 0) chosen = true, --left;
        a = chosen ? kUnknown : static_cast<uint8_t>(a);
        refreshed += chosen;
    }
    stats.raysReduced = refreshed < lit;

    bool beyond = false;
    for (int s = kRemembered; s < f.sourceCount; ++s) beyond |= shines(f.sources[s]);
    if (refreshed > 0 || (beyond && lit > 0)) {
        if (!m.visibility) m.visibility = std::make_unique<Visibility>(m.allocator);
        m.visibility->setColliders(f.colliders, f.colliderCount, f.colliderVersion);
        m.visibility->setSpheres(m.spheres.data(), m.sphereIds.data(), exposed, p.count);
    }
    f.tasks.forBlocks(exposed, kRayBlock, [&](int begin, int end, int block, int) {
        float received[kRayBlock] = {};
        uint32_t seen[kRayBlock] = {};
        int rays = 0;
        for (int s = 0; s < f.sourceCount; ++s) {
            if (!shines(f.sources[s])) continue;
            Ray packet[8];
            float flux[8];
            int owner[8], n = 0;
            const auto flush = [&] {
                bool blocked[8];
                m.visibility->cast(packet, n, blocked);
                for (int k = 0; k < n; ++k) {
                    if (blocked[k]) continue;
                    received[owner[k]] += flux[k];
                    if (s < kRemembered) seen[owner[k]] |= 1u << s;
                }
                rays += n, n = 0;
            };
            for (int e = begin; e < end; ++e) {
                const size_t at = static_cast<size_t>(e);
                if (m.priority[at] == kNoRay) continue;
                const size_t row = static_cast<size_t>(m.exposed[at]);
                const bool fresh = m.priority[at] == kUnknown || s >= kRemembered;
                if (!fresh && !(seenOf(p.rayMemory[row]) >> s & 1)) continue;
                const View v = look(f.sources[s], p.position[row].xyz(), p.normal[row], spacingOf(row));
                if (v.flux == 0) continue;
                if (!fresh) {
                    received[e - begin] += v.flux;
                    continue;
                }
                packet[n] = v.ray, flux[n] = v.flux, owner[n] = e - begin;
                if (++n == 8) flush();
            }
            if (n > 0) flush();
        }
        for (int e = begin; e < end; ++e) {
            const size_t at = static_cast<size_t>(e), row = static_cast<size_t>(m.exposed[at]);
            float& memory = p.rayMemory[row];
            if (m.priority[at] == kNoRay)
                memory = 0;
            else if (m.priority[at] == kUnknown)
                memory = remember(0, seen[e - begin]);
            else {
                const int age = ageOf(memory) + (p.still(m.exposed[at]) ? 1 : kMoverAge);
                memory = remember(std::min(kOldest, age), seenOf(memory));
            }
            m.power[row] = received[e - begin] * f.materials[p.material[row]].def.absorptivity * p.normal[row].w;
        }
        m.blockRays[static_cast<size_t>(block)] = rays;
    });
    for (int r : m.blockRays) stats.rays += r;
}

} // namespace thaw
