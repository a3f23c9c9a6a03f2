// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "control/paths.h"

#include "base/kernel.h"
#include "base/math.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace thaw {
namespace {

constexpr int kRowBlock = 256;
constexpr uint32_t kTurns = 4;      // what follows nothing is looked at every so many steps
constexpr float kCore = 0.35f;      // radii: within, nothing pulls a stream together
constexpr float kLost = 1.25f;      // reaches: farther off it follows no more
constexpr float kReturn = 0.06f;    // s to come back to the core from nearby
constexpr float kReturnMost = 4;    // radii a second, or twice the speed of the path: no faster from far
constexpr float kLookAhead = 0.25f; // radii: the way there is the way to go, which rounds bends
constexpr float kShareGain = 8;     // radii of bias for a share that is all wrong
constexpr float kStart = 3;         // radii of a path that are its start
constexpr float kBeadTime = 0.12f;  // s in which beads come together
constexpr float kFrontShare = 0.05f;
constexpr int kBins = 128;
constexpr int kHops = 5; // from here on it is in the air

bool isControl(uint32_t id) { return (id * 2654435761u) >> 29 == 0; }

} // namespace

void Path::arrive(double kilograms) {
    arrived += kilograms;
    if (arrival < 0 && arrived > static_cast<double>(kFrontShare) * captured) arrival = time - since;
}

// A smooth odd wave: 0 in the middle and at the ends.
float Path::toBead(float along) const {
    if (!(beadSpacing > 0)) return 0;
    const double waves = (static_cast<double>(along) - phase) / static_cast<double>(beadSpacing);
    const float x = static_cast<float>(waves - std::round(waves));
    return -beadSpacing / kBeadTime * x * (1 - 4 * x * x);
}

bool Paths::any() const {
    for (const Path& p : paths)
        if (p.on()) return true;
    return false;
}

void Paths::forget(Particles& p, size_t slot) {
    for (size_t i = 0; i < static_cast<size_t>(p.count); ++i) {
        if (p.follows[i] == slot + 1) p.follows[i] = 0;
        if (p.follows[i] == 0 && p.along[i] == -static_cast<float>(slot + 1)) p.along[i] = 0;
    }
}

// Of the paths of the highest priority within their reach: the nearest; where several go the same way, which is a fork
// ahead, the one that the particle is nearer to there, by how much each has got of its share.
bool Paths::capture(const ControlFrame& f, size_t row, Vec3 x) {
    constexpr int kMost = 8;
    struct Candidate {
        size_t slot;
        Foot foot;
        float distance;
    };
    Candidate found[kMost];
    int count = 0, priority = 0;
    for (size_t s = 0; s < paths.size(); ++s) {
        const Path& path = paths[s];
        if (!path.on() || (count > 0 && path.priority < priority)) continue;
        const Vec3 at = OwnSpace(path.collider, f.colliders).into(x);
        Foot foot;
        if (f.particles.along[row] == -static_cast<float>(s + 1) || !path.line->nearest(at, foot) ||
            foot.along > path.line->length() - kCore * path.radius)
            continue;
        if (count > 0 && path.priority > priority) count = 0;
        priority = path.priority;
        if (count < kMost) found[count++] = {s, foot, length(at - foot.point)};
    }
    if (count == 0) return false;
    int best = 0;
    for (int k = 1; k < count; ++k)
        if (found[k].distance < found[best].distance) best = k;
    if (count > 1) {
        const Candidate& nearest = found[best];
        const Path& stem = paths[nearest.slot];
        // Those that run along with the nearest one here.
        int fork[kMost], forks = 0;
        for (int k = 0; k < count; ++k) {
            const Path& path = paths[found[k].slot];
            if (path.collider == stem.collider && dot(found[k].foot.tangent, nearest.foot.tangent) > 0.5f &&
                length(found[k].foot.point - nearest.foot.point) < stem.radius)
                fork[forks++] = k;
        }
        if (forks > 1) {
            // Where they have parted by a radius.
            Vec3 ahead[kMost], middle;
            for (float look = 2 * stem.radius;; look *= 2) {
                middle = {};
                float apart = 0, longest = 0;
                for (int k = 0; k < forks; ++k) {
                    const Candidate& c = found[fork[k]];
                    ahead[k] = paths[c.slot].line->at(c.foot.along + look).point;
                    middle += (1 / static_cast<float>(forks)) * ahead[k];
                    longest = std::max(longest, paths[c.slot].line->length() - c.foot.along);
                    for (int l = 0; l < k; ++l) apart = std::max(apart, length(ahead[k] - ahead[l]));
                }
                if (apart > stem.radius || look > longest) break;
            }
            const Vec3 at = OwnSpace(stem.collider, f.colliders).into(x), side = at - nearest.foot.point;
            float highest = -INFINITY;
            for (int k = 0; k < forks; ++k) {
                const Vec3 way = ahead[k] - middle, t = nearest.foot.tangent;
                const Vec3 across = normalizeOr(way - dot(way, t) * t, {});
                const float score = dot(side, across) / stem.radius + paths[found[fork[k]].slot].bias;
                if (score > highest) highest = score, best = fork[k];
            }
        }
    }
    Particles& p = f.particles;
    p.follows[row] = static_cast<uint16_t>(found[best].slot + 1), p.along[row] = found[best].foot.along;
    distance_[row] = found[best].distance;
    return true;
}

void Paths::track(const ControlFrame& f) {
    Particles& p = f.particles;
    const size_t movers = static_cast<size_t>(p.moverCount);
    distance_.resizeRaw(movers);
    for (Path& path : paths)
        if (path.alive && path.enabled) path.time += static_cast<double>(f.dt);
    // Marked in own_.w, counted in the order of rows: 1 captured, 2 spilled, 3 arrived; .x: by which path.
    own_.resizeRaw(movers);
    const uint32_t turn = static_cast<uint32_t>(f.step % kTurns);
    f.tasks.forBlocks(p.moverCount, kRowBlock, [&](int begin, int end, int, int) {
        for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            own_[i] = {};
            const Vec3 x = p.position[i].xyz();
            const uint16_t slot = pathOf(p.follows[i]);
            if (p.follows[i] & kShapeBit) {
                distance_[i] = 0;
                continue;
            }
            if (slot == 0) {
                if (p.id[i] % kTurns == turn && !p.bondSlot[i] && capture(f, i, x)) own_[i].w = 1;
                continue;
            }
            const Path& path = paths[slot - 1u];
            if (!path.on()) {
                distance_[i] = 0;
                continue;
            }
            // Near where it was: a path that crosses itself is followed on.
            const Vec3 at = OwnSpace(path.collider, f.colliders).into(x);
            const float s = p.along[i], r = path.radius;
            const Foot foot = path.line->nearest(at, s - 0.5f * r, s + r);
            p.along[i] = foot.along;
            distance_[i] = length(at - foot.point);
            const float rest = path.line->length() - foot.along;
            const bool past = rest <= 0 || (rest < kCore * r && dot(at - path.line->at(foot.along + rest).point,
                                                                    foot.tangent) > -0.25f * r);
            if (distance_[i] > kLost * path.reach || past) {
                own_[i] = {static_cast<float>(slot), 0, 0, past ? 3.0f : 2.0f};
                p.follows[i] = 0;
                if (past) p.along[i] = -static_cast<float>(slot); // and does not follow it again
            }
        }
    });
    countHops(f);
    for (Path& path : paths) path.mass = path.distance = 0;
    for (size_t i = 0; i < movers; ++i) {
        const double m = p.velocity[i].w;
        if (own_[i].w > 1.5f) {
            Path& path = paths[static_cast<size_t>(own_[i].x) - 1];
            if (own_[i].w > 2.5f) {
                path.arrive(m);
            } else {
                path.spilled += m;
            }
        }
        if (!pathOf(p.follows[i])) continue;
        Path& path = paths[p.follows[i] - 1u];
        if (own_[i].w == 1) {
            path.captured += m;
            if (path.since < 0) path.since = path.time;
        }
        path.mass += m, path.distance += m * static_cast<double>(distance_[i]);
    }
    for (Path& path : paths) path.distance = path.mass > 0 ? path.distance / path.mass : 0;
    steer(f);
}

// What replaces the feedback of thesis 3.30 to 3.32: speed by the time that is left or by how far the melt lags, and at
// forks the mass that each has got.
void Paths::steer(const ControlFrame& f) {
    const Particles& p = f.particles;
    double captured = 0, shares = 0;
    for (const Path& path : paths)
        if (path.alive && path.enabled) captured += path.captured, shares += static_cast<double>(path.share);
    for (size_t s = 0; s < paths.size(); ++s) {
        Path& path = paths[s];
        if (!path.alive || !path.enabled) continue;
        double bins[kBins] = {}, along = 0;
        const float length = path.line->length();
        const OwnSpace space(path.collider, f.colliders);
        for (size_t i = 0; i < static_cast<size_t>(p.moverCount); ++i) {
            if (p.follows[i] != s + 1) continue;
            const double m = p.velocity[i].w;
            bins[std::min(kBins - 1, static_cast<int>(p.along[i] / length * kBins))] += m;
            const Foot foot = path.line->at(p.along[i]);
            const Vec3 v = p.velocity[i].xyz() - space.velocityAt(p.position[i].xyz());
            along += m * static_cast<double>(dot(v, space.turn(foot.tangent)));
        }
        double ahead = path.arrived;
        int bin = kBins;
        while (bin > 0 && ahead < static_cast<double>(kFrontShare) * (path.mass + path.arrived)) ahead += bins[--bin];
        path.front = path.mass + path.arrived > 0 ? length * static_cast<float>(bin) / kBins : 0;
        if (path.share > 0 && captured > 0 && shares > 0)
            path.bias =
                kShareGain * static_cast<float>(static_cast<double>(path.share) / shares - path.captured / captured);
        if (path.arrivalTime > 0 && path.since >= 0) {
            const float left = path.arrivalTime - static_cast<float>(path.time - path.since);
            const float mean = length / path.arrivalTime, need = (length - path.front) / std::max(left, 0.1f);
            path.asked = path.arrival < 0 && path.front < length ? std::clamp(need, 0.25f * mean, 4 * mean) : mean;
        } else {
            path.asked = path.arrivalTime > 0 ? length / path.arrivalTime : path.speed;
        }
        // A drag lags by what gravity and walls do in the meantime.
        const float lag = path.mass > 0 && path.asked > 0 ? path.asked - static_cast<float>(along / path.mass) : 0;
        path.phase += static_cast<double>(f.dt * path.asked);
        path.boost = std::clamp(path.boost + path.strength * 3 * f.dt * lag, -path.asked, path.asked);
    }
}

// How many neighbours lie between what follows and what stands, one more in each step where nothing does.
void Paths::countHops(const ControlFrame& f) {
    Particles& p = f.particles;
    hops_.resizeRaw(static_cast<size_t>(p.moverCount));
    f.tasks.forBlocks(p.moverCount, kRowBlock, [&](int begin, int end, int, int) {
        for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            hops_[i] = 0;
            if (!pathOf(p.follows[i])) continue;
            int least = 254;
            forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
                if (j >= static_cast<uint32_t>(p.count)) return false;
                least = j >= static_cast<uint32_t>(p.moverCount) ? -1 : std::min<int>(least, p.hops[j]);
                return least >= 0;
            });
            for (int c = 0; c < f.colliderCount && least >= 0; ++c) {
                Vec3 normal;
                if (f.colliders[c].alive && f.colliders[c].distance(p.position[i].xyz(), normal) < p.position[i].w)
                    least = -1;
            }
            hops_[i] = static_cast<uint8_t>(least + 1);
        }
    });
    std::copy(hops_.begin(), hops_.end(), p.hops.begin());
}

Paths::Aim Paths::aim(const ControlFrame& f, size_t i) const {
    const Particles& p = f.particles;
    const Path& path = paths[p.follows[i] - 1u];
    if (!path.on()) return {};
    const OwnSpace space(path.collider, f.colliders);
    const Vec3 x = p.position[i].xyz();
    Vec3 mean = p.velocity[i].xyz(), outward = p.normal[i].xyz();
    float weight = 1;
    forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
        if (j >= static_cast<uint32_t>(p.moverCount)) return false;
        const float h = 0.5f * (p.position[i].w + p.position[j].w),
                    w = wendlandShape(length(p.position[j].xyz() - x) / h);
        mean += w * p.velocity[j].xyz(), weight += w, outward += w * p.normal[j].xyz();
        return true;
    });
    mean = (1 / weight) * mean;
    const Foot foot = path.line->at(p.along[i]);
    const Vec3 t = space.turn(
        normalizeOr(foot.tangent + path.line->at(foot.along + kLookAhead * path.radius).tangent, foot.tangent));
    Vec3 off = x - space.out(foot.point);
    off -= dot(off, t) * t;
    // Across the surface a stream is as thick as it is, up to a radius, and digs itself in as deep as it likes: nothing
    // is pulled out of the surface to where the path was drawn.
    const Vec3 n = normalizeOr(outward, {});
    const float across = dot(off, n);
    off -= std::min(across, path.radius) * n;
    // What melts at its start sinks: it is not lifted back there, else it leaps from the rim of a candle's cup.
    if (const Vec3 down = normalizeOr(f.gravity, {}); foot.along < kStart * path.radius)
        off -= std::max(0.0f, dot(off, down) - kCore * path.radius) * down;
    const float d = length(off), core = kCore * path.radius;
    const Vec3 moving = space.velocityAt(x);
    const float u = path.asked > 0 ? path.asked + path.boost : dot(mean - moving, t);
    // From far it comes first and flows along then.
    const float beside = std::clamp((d - path.radius) / std::max(path.reach - path.radius, 1e-6f), 0.0f, 1.0f);
    Vec3 target = moving + ((u + path.toBead(foot.along)) * (1 - 0.8f * beside)) * t;
    if (d > core) {
        const float back = std::min((d - core) / kReturn, std::max(2 * u, kReturnMost * path.radius));
        // Along the surface and no slower for that: what hangs on the far side of a candle comes round it.
        Vec3 way = -off;
        if (d > path.radius) way -= dot(way, n) * n;
        way = normalizeOr(way, {});
        // Against what does not give way no harder than gravity: pushed and pressed back, a pool at rest would boil.
        const float rest = length(f.gravity) * f.dt / dragOf(path.strength, f.dt);
        target += std::min(back, std::max(rest, 2 * dot(mean - moving, way))) * way;
    }
    const float far = std::clamp((d / path.reach - 1) / (kLost - 1), 0.0f, 1.0f), fade = 1 - far * far;
    const float s = path.strength, drag = dragOf(s, f.dt);
    // A path across a slope: of the weight it carries what its strength is, else the stream hangs below it by 5 mm.
    // In the air it carries none: where the surface sank away beneath a path, drops hung about its old place.
    if (p.hops[i] < kHops) {
        const Vec3 g = f.gravity - dot(f.gravity, t) * t;
        target -= (s * f.dt / drag) * g;
    } else {
        const Vec3 down = normalizeOr(f.gravity, {});
        target += (dot(mean - target, down) + f.dt * length(f.gravity)) * down;
    }
    return {target, mean, drag * fade};
}

void Paths::guide(const ControlFrame& f, Vec4* guide) {
    const Particles& p = f.particles;
    const size_t movers = static_cast<size_t>(p.moverCount);
    own_.resizeRaw(movers), mean_.resizeRaw(movers);
    f.tasks.forBlocks(p.moverCount, kRowBlock, [&](int begin, int end, int, int) {
        for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            own_[i] = {0, 0, 0, -1};
            if (!pathOf(p.follows[i]) || !isControl(p.id[i])) continue;
            const Aim a = aim(f, i);
            own_[i] = {a.target.x, a.target.y, a.target.z, a.weight}, mean_[i] = {a.mean.x, a.mean.y, a.mean.z, 0};
        }
    });
    f.tasks.forBlocks(p.moverCount, kRowBlock, [&](int begin, int end, int, int) {
        for (size_t i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
            if (!pathOf(p.follows[i])) continue;
            Vec3 target, mean;
            float drag = 0, weight = 0;
            const auto add = [&](float w, size_t j) {
                target += w * own_[j].xyz(), mean += w * mean_[j].xyz(), drag += w * own_[j].w, weight += w;
            };
            if (own_[i].w >= 0) add(1, i);
            forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
                if (j >= static_cast<uint32_t>(p.moverCount)) return false;
                if (own_[j].w < 0 || p.follows[j] != p.follows[i]) return true;
                const float h = 0.5f * (p.position[i].w + p.position[j].w);
                add(wendlandShape(length(p.position[j].xyz() - p.position[i].xyz()) / h), j);
                return true;
            });
            if (weight > 1e-3f) {
                target = (1 / weight) * target, mean = (1 / weight) * mean, drag /= weight;
            } else { // alone: a drop, or the edge of a stream
                const Aim a = aim(f, i);
                target = a.target, mean = a.mean, drag = a.weight;
            }
            target += (1 - paths[p.follows[i] - 1u].strength) * (p.velocity[i].xyz() - mean);
            guide[i] = {target.x, target.y, target.z, drag};
        }
    });
}

void Paths::pathState(StateIo& io, Path& p) {
    io(p.alive);
    if (!p.alive) {
        if (io.restores()) p = {};
        return;
    }
    io(p.enabled);
    io.index(p.collider, io.limits.colliders + 1);
    io(p.radius, p.reach, p.strength, p.speed, p.arrivalTime, p.share, p.beadSpacing, p.startAbsorptivity, p.priority);
    io(p.captured, p.arrived, p.since, p.arrival, p.time, p.phase, p.asked, p.boost, p.bias);
    io.report(p.spilled, p.mass, p.distance, p.front);
    if (io.hashes()) return io.mix(p.line->hash());
    uint64_t hash = p.line ? p.line->hash() : 0;
    io(hash);
    if (io.saves()) return const_cast<PathLine&>(*p.line).state(io); // which only looks
    // The line that is there, where it is the same.
    PathLine read;
    read.state(io);
    if (!io.good()) return;
    for (const Path& other : paths)
        if (other.line && other.line->hash() == hash && other.line->reach() == read.reach() &&
            other.line->points().size() == read.points().size()) {
            p.line = other.line;
            return;
        }
    p.line = std::make_shared<PathLine>(std::move(read));
}

void Paths::state(StateIo& io) {
    io.staged(paths, stage_, io.limits.paths, [&](Path& p) { pathState(io, p); });
}

} // namespace thaw
