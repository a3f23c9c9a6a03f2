// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Particles::rayShares remembers of each of the first kRemembered sources which share of it was in sight at the last
// look, in 254ths; kNotSeen when the source was off or below the horizon then. Particles::rayChange adds up how much of
// the irradiance may be wrong by now: the possible irradiance of a source times the part of its view that what moved
// since then can have changed (the particle itself, the source, an occluder on the way to it). Who looks anew is chosen
// by that change times the age of the last look. Sources beyond the first kRemembered are looked at in every run.
#include "heat/radiation.h"

#include "base/kernel.h"
#include "base/math.h"
#include "heat/sources.h"
#include "heat/visibility.h"
#include "particles/columns.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace thaw {
namespace {

constexpr int kRayBlock = 128;
constexpr int kRemembered = 8;
constexpr uint32_t kNotSeen = 255, kAll = 254;
uint32_t shareOf(uint64_t shares, int source) { return static_cast<uint32_t>(shares >> (8 * source)) & 255u; }
uint64_t withShare(uint64_t shares, int source, uint32_t share) {
    return (shares & ~(uint64_t{255} << (8 * source))) | static_cast<uint64_t>(share) << (8 * source);
}
// A look is due when the share of the irradiance that may have changed, times the steps since the last look, passes
// this; of a change by a two-thousandth at last.
constexpr float kEnough = 0.05f;
// Way by a spacing, of the particle or of what shades, changes at most this share of what is seen, as a rule: few are
// at the edge of a shadow. What moves by a fifth of a spacing in a step looks in every one.
constexpr float kByWay = 0.25f;
// In more doubt than that, nobody asks what else moved. Where all may look, being due is enough.
constexpr float kSurely = 0.25f;
constexpr uint8_t kOldest = 100;
// An obstacle this many spacings off moves its shadow by one when the source moves by 1 / kLever of its distance.
constexpr float kLever = 40;
// The host's occluders may move unseen: a look every so many runs.
constexpr float kHostLooks = 30;

// Of the melt as it shades itself, in spacings. A square lattice of spheres is closed from 0.71 on.
constexpr float kShadeRadius = 0.75f;
// Rays leave from above the steps that a tilted surface of a lattice has, and do not see what is closer than kSkip.
constexpr float kRaise = 1.0f, kSkip = 1.5f;

constexpr int kBatch = 512; // rays that are cast together
struct Batch {
    Ray rays[kBatch];
    float weight[kBatch];
    int16_t owner[kBatch];
    bool blocked[kBatch];
    thawRay host[kBatch];
};

Ray rayTo(const Receiver& r, Vec3 center, Vec3 point, float spacing) {
    Ray ray;
    ray.surface = r.position;
    const Vec3 way = point - r.position;
    ray.distance = length(way);
    ray.direction = normalizeOr(way, normalizeOr(r.normal, {0, 1, 0}));
    ray.raised = center + (kRaise * spacing) * (r.drop() ? ray.direction : r.normal);
    ray.skip = kSkip * spacing;
    return ray;
}

// The way from a to b, which widens to `extent` on all sides of it at b.
struct Way {
    Vec3 from, way, inverse;
    float extent;
    Way(Vec3 a, Vec3 b, float extent_) : from(a), way(b - a), extent(extent_) {
        const auto turn = [](float v) { return std::abs(v) > 1e-30f ? 1 / v : 1e30f; };
        inverse = {turn(way.x), turn(way.y), turn(way.z)};
    }
    // Does it pass the box? Yes when in doubt.
    bool passes(const Box& box) const {
        float grow = extent;
        if (grow > 0) {
            // As wide as it is where the box ends.
            const Vec3 half = 0.5f * (box.upper - box.lower);
            const float l2 = dot(way, way),
                        last = dot(box.lower + half - from, way) +
                               (std::abs(half.x * way.x) + std::abs(half.y * way.y) + std::abs(half.z * way.z));
            if (last < l2) grow *= std::max(0.0f, last / l2);
        }
        float enter = 0, leave = 1;
        const auto slab = [&](float low, float high, float at, float inv) {
            const float u = (low - grow - at) * inv, v = (high + grow - at) * inv;
            const float near = u < v ? u : v, far = u < v ? v : u;
            enter = near > enter ? near : enter, leave = far < leave ? far : leave;
        };
        slab(box.lower.x, box.upper.x, from.x, inverse.x);
        slab(box.lower.y, box.upper.y, from.y, inverse.y);
        slab(box.lower.z, box.upper.z, from.z, inverse.z);
        return enter <= leave;
    }
};

// So many regions can be asked about for the price of a ray.
constexpr size_t kAskWorth = 16;
size_t askWorth(const HeatFrame& f, const Emitter& e) {
    return kAskWorth * static_cast<size_t>(e.area() ? f.raysPerSource : 1);
}

float uniform(uint64_t bits) { return static_cast<float>(bits & 0xffffff) * (1.0f / 16777216.0f); }

} // namespace

bool HeatSource::operator==(const HeatSource& o) const {
    const auto fields = [](const HeatSource& s) {
        return std::array<float, 16>{s.position.x,  s.position.y, s.position.z, s.power,  s.radius, s.rotation.x,
                                     s.rotation.y,  s.rotation.z, s.rotation.w, s.size.x, s.size.y, s.size.z,
                                     s.temperature, s.emissivity, s.irradiance, 0};
    };
    return fields(*this) == fields(o) && type == o.type && enabled == o.enabled && alive == o.alive;
}

struct Radiation::Impl {
    explicit Impl(Allocator& a)
        : allocator(a), exposed(a), spheres(a), sphereIds(a), moved(a), possible(a), importance(a), power(a),
          blockRays(a), emitters(a), known(a), batches(a) {}

    Allocator& allocator;
    std::unique_ptr<Visibility> visibility;

    Array<int> exposed; // rows
    Array<Vec4> spheres;
    Array<uint32_t> sphereIds;
    Array<float> moved;      // per exposed, m since the last run
    Array<float> possible;   // per exposed, W/m^2 with nothing in the way
    Array<float> importance; // per exposed: 0 not lit or nothing new, < 0 left for later, else it looks
    Array<float> power;      // per row, W absorbed
    Array<int> blockRays;

    struct Lit : Emitter {
        bool fresh;  // it was off at the last run
        float shift; // m, how far some point of it went since
    };
    Array<Lit> emitters;
    Array<HeatSource> known; // as of the last run
    Array<Batch> batches;    // per worker
    float ambient = NAN;
    uint64_t surfaceVersion = 0, colliderVersion = 0;
    bool settled = false; // nobody is left to look

    bool nothingChanged(const HeatFrame& f) const;
    void light(const HeatFrame& f);
    void findExposed(const HeatFrame& f);
    void weigh(const HeatFrame& f, int begin, int end);
    int choose(const HeatFrame& f, HeatStats& stats);
    int look(const HeatFrame& f, int begin, int end, Batch& batch);
    void cast(const HeatFrame& f, Batch& batch, int count, const int* rows);
    Receiver receiver(const HeatFrame& f, size_t row) const {
        const Vec4 x = f.particles.position[row], n = f.particles.normal[row];
        return {x.xyz() + (0.5f / kSupport * x.w) * n.xyz(), n.xyz(), n.w};
    }
    static float spacingOf(const HeatFrame& f, size_t row) { return f.particles.position[row].w * (1 / kSupport); }
};

Radiation::Radiation(Allocator& allocator) : impl_(std::make_unique<Impl>(allocator)) {}
Radiation::~Radiation() = default;

const float* Radiation::power() const { return impl_->power.data(); }

bool Radiation::names(uint64_t form) const { return impl_->visibility && impl_->visibility->names(form); }

void Radiation::state(StateIo& io, const ColliderForms& forms, size_t rows, uint64_t surfaceVersion) {
    Impl& m = *impl_;
    io.list(m.known, io.limits.sources, [&](HeatSource& s) { s.state(io); });
    io(m.ambient, m.settled);
    io.report(m.surfaceVersion, m.colliderVersion);
    // Nobody asks for what the next run finds anew; of rows that came or went since, there is nothing to keep.
    if (!io.hashes()) {
        const size_t kept =
            io.count(m.surfaceVersion == surfaceVersion && m.power.size() == rows ? rows : 0, io.limits.particles);
        if (io.checks()) m.power.reserve(kept);
        if (io.restores()) m.power.resizeRaw(kept);
        sparse(io, m.power.data(), kept);
    }
    const bool looks = io.flag(m.visibility != nullptr);
    if (io.reads() && io.good() && looks && !m.visibility) m.visibility = std::make_unique<Visibility>(m.allocator);
    if (io.restores() && !looks) m.visibility = nullptr;
    if (looks && io.good()) m.visibility->state(io, forms);
}

void HeatSource::state(StateIo& io) {
    io(alive);
    if (!alive) {
        if (io.restores()) *this = {};
        return;
    }
    io(position, power, radius, enabled);
    io.index(type, thawHeatSource_directional + 1);
    io(rotation, size, temperature, emissivity, irradiance);
}

bool Radiation::Impl::nothingChanged(const HeatFrame& f) const {
    return settled && f.surfaceVersion != 0 && f.surfaceVersion == surfaceVersion &&
           f.colliderVersion == colliderVersion && f.ambient == ambient && !(f.rays && f.rays->occluded) &&
           known.size() == static_cast<size_t>(f.sourceCount) && std::equal(known.begin(), known.end(), f.sources);
}

// Which sources are on, and how they moved.
void Radiation::Impl::light(const HeatFrame& f) {
    emitters.clear();
    for (int s = 0; s < f.sourceCount; ++s) {
        const HeatSource& source = f.sources[s];
        if (strengthOf(source, f.ambient) == 0) continue;
        Lit e{};
        static_cast<Emitter&>(e) = makeEmitter(source, s, f.ambient);
        const bool was = static_cast<size_t>(s) < known.size() && known[static_cast<size_t>(s)].type == source.type &&
                         strengthOf(known[static_cast<size_t>(s)], ambient) != 0;
        e.fresh = !was;
        if (was && !(known[static_cast<size_t>(s)] == source)) {
            const Emitter old = makeEmitter(known[static_cast<size_t>(s)], s, f.ambient);
            e.shift = length(e.center - old.center) + length(e.across - old.across) + length(e.along - old.along);
            if (e.type == thawHeatSource_directional) e.shift = length(e.axis - old.axis);
            if (e.type == thawHeatSource_point) e.shift = length(e.center - old.center);
        }
        emitters.push(e);
    }
    known.reserve(static_cast<size_t>(f.sourceCount)), known.clear();
    for (int s = 0; s < f.sourceCount; ++s) known.push(f.sources[s]);
    ambient = f.ambient;
}

void Radiation::Impl::findExposed(const HeatFrame& f) {
    Particles& p = f.particles;
    const size_t count = static_cast<size_t>(p.count);
    // The surface of a melt grows for as long as it melts: room for all at once.
    exposed.reserve(count), spheres.reserve(count), sphereIds.reserve(count), moved.reserve(count);
    possible.reserve(count), importance.reserve(count),
        blockRays.reserve(static_cast<size_t>(Tasks::blockCount(p.count, kRayBlock)));
    exposed.clear();
    for (int i = 0; i < p.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if ((p.flags[k] & kSurface) && p.normal[k].w > 0)
            exposed.push(i);
        else
            p.rayAge[k] = 0;
    }
    const size_t n = exposed.size();
    spheres.resizeRaw(n), sphereIds.resizeRaw(n), moved.resizeRaw(n), possible.resizeRaw(n), importance.resizeRaw(n);
    for (size_t at = 0; at < n; ++at) {
        const size_t row = static_cast<size_t>(exposed[at]);
        const Vec4 x = p.position[row];
        spheres[at] = {x.x, x.y, x.z, kShadeRadius * spacingOf(f, row)}, sphereIds[at] = p.id[row];
        moved[at] = 0;
    }
    blockRays.assign(static_cast<size_t>(Tasks::blockCount(static_cast<int>(n), kRayBlock)), 0);
}

// What the exposed [begin, end) get by what they know, and how much of that is in doubt.
void Radiation::Impl::weigh(const HeatFrame& f, int begin, int end) {
    Particles& p = f.particles;
    const bool host = f.rays && f.rays->occluded;
    for (int e = begin; e < end; ++e) {
        const size_t at = static_cast<size_t>(e), row = static_cast<size_t>(exposed[at]);
        const Receiver r = receiver(f, row);
        const float spacing = spacingOf(f, row), own = std::min(1.0f, kByWay * moved[at] / spacing);
        const bool unknown = p.rayAge[row] == 0;
        const float sure = f.rayRefresh < 1 ? kSurely : kEnough / std::max(1.0f, static_cast<float>(p.rayAge[row]));
        uint64_t shares = unknown ? ~uint64_t{0} : p.rayShares[row];
        float all = 0, received = 0, change = unknown ? 0.0f : p.rayChange[row], unseen = 0;
        for (const Lit& s : emitters) {
            const float flux = irradiance(s, r), size = std::abs(flux);
            if (size == 0) {
                if (s.index < kRemembered) shares = withShare(shares, s.index, kNotSeen);
                continue;
            }
            all += size;
            if (s.index >= kRemembered) continue;
            const uint32_t share = s.fresh ? kNotSeen : shareOf(shares, s.index);
            if (share == kNotSeen) {
                shares = withShare(shares, s.index, kNotSeen), unseen += size;
                continue;
            }
            received += flux * (static_cast<float>(share) * (1.0f / kAll));
            const Vec3 there = s.type == thawHeatSource_directional ? sample(s, r, 0, 0).point : s.center;
            float doubt = own + (host ? kEnough / kHostLooks : 0.0f);
            if (s.shift > 0) {
                const float far = s.type == thawHeatSource_directional ? 1.0f : length(there - r.position);
                doubt += std::min(1.0f, kLever * s.shift / std::max(far, 1e-6f));
            }
            const bool stirred = doubt < sure && visibility && !visibility->stirs().empty();
            if (stirred && f.rayRefresh >= 1 && visibility->stirs().size() > askWorth(f, s)) {
                doubt = sure;
            } else if (stirred) {
                // Against the melt, rays only see from their skip on.
                const Ray ray = rayTo(r, p.position[row].xyz(), there, spacing);
                const Way fromSurface(r.position, there, s.extent),
                    fromSkip(ray.raised + std::min(ray.skip, ray.distance) * ray.direction, there, s.extent);
                for (const Stir& stir : visibility->stirs()) {
                    if (!(stir.melt ? fromSkip : fromSurface).passes(stir.box)) continue;
                    doubt += std::min(1.0f, kByWay * stir.amount / spacing);
                    if (doubt >= sure) break;
                }
            }
            change += std::min(1.0f, doubt) * size;
        }
        const float age = static_cast<float>(p.rayAge[row]);
        importance[at] = 0;
        if (all == 0)
            p.rayAge[row] = 0;
        else if (unknown)
            importance[at] = INFINITY;
        else if ((change + unseen) * age >= kEnough * all)
            importance[at] = (change + unseen) * age;
        p.rayShares[row] = shares;
        p.rayChange[row] = std::min(change, 1e30f);
        if (!unknown && all > 0 && p.rayAge[row] < kOldest) ++p.rayAge[row];
        power[row] = received * f.absorptivityOf(row) * r.area;
        possible[at] = all;
    }
}

// Who looks anew: all who know nothing yet, then those with the largest change times age, of equal ones the first rows.
// Returns how many.
int Radiation::Impl::choose(const HeatFrame& f, HeatStats& stats) {
    // Buckets of a quarter of an octave.
    constexpr int kBuckets = 1024;
    const auto bucket = [](float v) { return static_cast<int>(std::bit_cast<uint32_t>(v) >> 21); };
    int counts[kBuckets] = {};
    int lit = 0, unknown = 0, wanted = 0;
    for (size_t at = 0; at < exposed.size(); ++at) {
        lit += possible[at] > 0;
        if (importance[at] == 0) continue;
        ++wanted;
        if (std::isinf(importance[at]))
            ++unknown;
        else
            ++counts[bucket(importance[at])];
    }
    int left = std::max(0, static_cast<int>(std::ceil(f.rayRefresh * static_cast<float>(lit))) - unknown);
    int threshold = kBuckets; // from here on all; of the bucket below the first `left`
    while (threshold > 0 && left >= counts[threshold - 1]) left -= counts[--threshold];
    int chosen = 0;
    for (float& v : importance) {
        if (v == 0) continue;
        const int b = std::isinf(v) ? kBuckets : bucket(v);
        bool looks = b >= threshold;
        if (!looks && b == threshold - 1 && left > 0) looks = true, --left;
        if (!looks) v = -v;
        chosen += looks;
    }
    stats.raysReduced = chosen < wanted;
    settled = chosen == wanted;
    return chosen;
}

void Radiation::Impl::cast(const HeatFrame& f, Batch& b, int count, const int* rows) {
    std::fill(b.blocked, b.blocked + count, false);
    const bool host = f.rays && f.rays->occluded;
    if (visibility)
        for (int k = 0; k < count; k += 8) visibility->cast(b.rays + k, std::min(8, count - k), b.blocked + k);
    if (!host) return;
    for (int k = 0; k < count; ++k) {
        const Ray& r = b.rays[k];
        b.host[k] = {{r.surface.x, r.surface.y, r.surface.z},
                     {r.direction.x, r.direction.y, r.direction.z},
                     r.distance,
                     f.particles.id[static_cast<size_t>(rows[b.owner[k]])]};
    }
    bool answers[kBatch] = {};
    f.rays->occluded(b.host, count, answers, f.rays->user);
    for (int k = 0; k < count; ++k) b.blocked[k] |= answers[k];
}

// Rays of the exposed [begin, end); returns how many.
int Radiation::Impl::look(const HeatFrame& f, int begin, int end, Batch& batch) {
    Particles& p = f.particles;
    int rays = 0;
    float gained[kRayBlock] = {};
    const int columns = std::max(1, static_cast<int>(std::sqrt(static_cast<float>(f.raysPerSource)) + 1e-3f));
    const int lines = f.raysPerSource / columns;
    for (const Lit& s : emitters) {
        const bool remembered = s.index < kRemembered;
        float seen[kRayBlock] = {}, all[kRayBlock] = {}, flux[kRayBlock] = {};
        int n = 0;
        const auto flush = [&] {
            cast(f, batch, n, exposed.data() + begin);
            for (int k = 0; k < n; ++k) {
                all[batch.owner[k]] += batch.weight[k];
                if (!batch.blocked[k]) seen[batch.owner[k]] += batch.weight[k];
            }
            rays += n, n = 0;
        };
        for (int e = begin; e < end; ++e) {
            const size_t at = static_cast<size_t>(e), row = static_cast<size_t>(exposed[at]);
            if (!(possible[at] > 0) || !(importance[at] > 0 || !remembered)) continue;
            const Receiver r = receiver(f, row);
            const int owner = e - begin;
            flux[owner] = irradiance(s, r);
            if (flux[owner] == 0) continue;
            const float spacing = spacingOf(f, row);
            const auto add = [&](Vec3 point, float weight) {
                batch.rays[n] = rayTo(r, p.position[row].xyz(), point, spacing);
                batch.weight[n] = weight, batch.owner[n] = static_cast<int16_t>(owner);
                ++n;
            };
            const int before = n;
            if (s.area()) {
                for (int c = 0; c < columns * lines; ++c) {
                    // The same places at every look, so that what rests does not flicker.
                    const uint64_t bits = hashCombine(hashCombine(0x52617973, p.id[row]),
                                                      static_cast<uint64_t>(s.index) << 8 | static_cast<uint64_t>(c));
                    const float u = (static_cast<float>(c % columns) + uniform(bits)) / static_cast<float>(columns);
                    const float v = (static_cast<float>(c / columns) + uniform(bits >> 32)) / static_cast<float>(lines);
                    const Sample to = sample(s, r, u, v);
                    if (to.weight > 0) add(to.point, to.weight);
                }
                // Only a sliver over the horizon.
                if (n == before) add(highest(s, r), 1);
            } else {
                add(sample(s, r, 0, 0).point, 1);
            }
            if (n + columns * lines > kBatch) flush();
        }
        if (n > 0) flush();
        for (int e = begin; e < end; ++e) {
            const int owner = e - begin;
            if (!(all[owner] > 0)) continue;
            const float ratio = seen[owner] / all[owner];
            const uint32_t share = seen[owner] == 0 ? 0
                                   : seen[owner] == all[owner]
                                       ? kAll
                                       : std::clamp(static_cast<uint32_t>(ratio * kAll + 0.5f), 1u, kAll - 1);
            gained[owner] += flux[owner] * (static_cast<float>(share) * (1.0f / kAll));
            const size_t row = static_cast<size_t>(exposed[static_cast<size_t>(e)]);
            if (remembered) p.rayShares[row] = withShare(p.rayShares[row], s.index, share);
        }
    }
    for (int e = begin; e < end; ++e) {
        const size_t at = static_cast<size_t>(e), row = static_cast<size_t>(exposed[at]);
        const float absorbs = f.absorptivityOf(row) * p.normal[row].w;
        const float gain = gained[e - begin] * absorbs;
        if (importance[at] > 0)
            power[row] = gain, p.rayAge[row] = 1, p.rayChange[row] = 0;
        else
            power[row] += gain; // of the sources that nobody remembers
    }
    return rays;
}

void Radiation::run(const HeatFrame& f, HeatStats& stats) {
    Impl& m = *impl_;
    if (m.nothingChanged(f)) return;
    m.power.reserve(static_cast<size_t>(f.particles.capacity));
    m.power.assign(static_cast<size_t>(f.particles.count), 0.0f);
    m.surfaceVersion = f.surfaceVersion, m.colliderVersion = f.colliderVersion;
    m.settled = true;
    m.light(f);
    m.findExposed(f);
    const int exposed = static_cast<int>(m.exposed.size());
    if (exposed == 0) return;
    const bool host = f.rays && f.rays->occluded;
    if (!m.visibility && !(host && f.rays->melt)) m.visibility = std::make_unique<Visibility>(m.allocator);
    if (m.visibility) {
        m.visibility->clearStirs();
        m.visibility->setColliders(f.colliders, host ? 0 : f.colliderCount, f.colliderVersion);
        m.visibility->setSpheres(m.spheres.data(), m.sphereIds.data(), exposed, f.particles.count, m.moved.data());
    }
    f.tasks.forBlocks(exposed, kRayBlock, [&](int begin, int end, int, int) { m.weigh(f, begin, end); });
    const int chosen = m.choose(f, stats);
    const bool beyond =
        std::any_of(m.emitters.begin(), m.emitters.end(), [](const Impl::Lit& s) { return s.index >= kRemembered; });
    if (chosen == 0 && !beyond) return;
    if (m.visibility) m.visibility->commit();
    m.batches.resize(host ? 1 : static_cast<size_t>(f.tasks.workerCount()));
    if (host) { // in its own thread
        for (int begin = 0; begin < exposed; begin += kRayBlock)
            stats.rays += m.look(f, begin, std::min(exposed, begin + kRayBlock), m.batches[0]);
        return;
    }
    f.tasks.forBlocks(exposed, kRayBlock, [&](int begin, int end, int block, int worker) {
        m.blockRays[static_cast<size_t>(block)] = m.look(f, begin, end, m.batches[static_cast<size_t>(worker)]);
    });
    for (int r : m.blockRays) stats.rays += r;
}

} // namespace thaw
