// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "motion/anchors.h"

#include "motion/carry.h"
#include "motion/links.h"
#include "motion/rigid_numbers.h"

namespace thaw {
namespace {

// A particle of a piece stands half a spacing off what it lies on and a spacing off its neighbours; nearer than this,
// what comes nearer still presses.
constexpr float kPressWall = 0.4f, kPressHeld = 0.8f;
constexpr float kStill = 1e-3f; // spacings in a sub-step
constexpr int kRowBlock = 256;

Vec3 motionOf(const AnchorFrame& f, uint16_t anchor, Vec3 x) {
    const int c = static_cast<int>(anchor) - 1;
    if (c < 0 || c >= f.colliderCount || !f.colliders[c].moves) return {};
    return f.colliders[c].displacement(x);
}

} // namespace

void Anchors::bounds(const AnchorFrame& f) {
    colliderBounds_.resizeRaw(static_cast<size_t>(f.colliderCount));
    for (int c = 0; c < f.colliderCount; ++c)
        if (f.colliders[c].alive) colliderBounds_[static_cast<size_t>(c)] = f.colliders[c].sweptBounds();
}

// Whether row, if it hung on `anchor`, would be pressed.
bool Anchors::pressedAt(const AnchorFrame& f, size_t i, uint16_t anchor) const {
    const Particles& p = f.particles;
    const Vec3 x = p.position[i].xyz();
    const float spacing = p.position[i].w / kSupport;
    const Vec3 own = motionOf(f, anchor, x);
    for (int c = 0; c < f.colliderCount; ++c) {
        const Collider& o = f.colliders[c];
        if (!o.alive || c + 1 == anchor) continue;
        if (!o.moves && !(dot(own, own) > 0)) continue;
        const Box& b = colliderBounds_[static_cast<size_t>(c)];
        if (x.x < b.lower.x - spacing || x.x > b.upper.x + spacing || x.y < b.lower.y - spacing ||
            x.y > b.upper.y + spacing || x.z < b.lower.z - spacing || x.z > b.upper.z + spacing)
            continue;
        Vec3 n;
        if (!(o.distance(x, n) < kPressWall * spacing)) continue;
        if (dot(n, (o.moves ? o.displacement(x) : Vec3{}) - own) > kStill * spacing) return true;
    }
    bool pressed = false;
    forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
        if (j >= static_cast<uint32_t>(p.count) || !(p.flags[j] & kFixed) || p.piece[j] || p.anchor[j] == p.anchor[i])
            return true;
        const Vec3 d = x - p.position[j].xyz();
        const float r = length(d);
        if (!(r > 0 && r < kPressHeld * spacing)) return true;
        pressed = dot(d, motionOf(f, p.anchor[j], x) - own) > kStill * spacing * r;
        return !pressed;
    });
    return pressed;
}

bool Anchors::pressed(const AnchorFrame& f) {
    bounds(f);
    found_.assign(static_cast<size_t>(Tasks::blockCount(f.particles.count, kRowBlock)), 0);
    f.tasks.forBlocks(f.particles.count, kRowBlock, [&](int begin, int end, int block, int) {
        for (int i = begin; i < end && !found_[static_cast<size_t>(block)]; ++i) {
            const size_t k = static_cast<size_t>(i);
            if ((f.particles.flags[k] & kFixed) && !f.particles.piece[k] && pressedAt(f, k, f.particles.anchor[k]))
                found_[static_cast<size_t>(block)] = 1;
        }
    });
    for (const uint8_t b : found_)
        if (b) return true;
    return false;
}

int Anchors::update(const AnchorFrame& f, bool fresh) {
    Particles& p = f.particles;
    bounds(f);
    state_.assign(static_cast<size_t>(p.count), 0);
    touched_.resizeRaw(static_cast<size_t>(f.colliderCount) + 1);
    queue_.reserve(static_cast<size_t>(p.capacity));
    int loose = 0;
    for (uint32_t seed = 0; seed < static_cast<uint32_t>(p.count); ++seed) {
        if (state_[seed] || !(p.flags[seed] & kFixed) || p.piece[seed]) continue;
        const uint16_t before = p.anchor[seed];
        for (int32_t& t : touched_) t = 0;
        uint16_t adopted = before;
        bool adopts = false;
        queue_.clear();
        queue_.push(seed), state_[seed] = 1;
        for (size_t head = 0; head < queue_.size(); ++head) {
            const uint32_t i = queue_[head];
            const Vec3 x = p.position[i].xyz();
            const float reach = kAnchor * p.position[i].w / kSupport;
            if (p.flags[i] & kMoulded) ++touched_[f.mouldOn[shapeOf(p.follows[i]) - 1]];
            for (int c = 0; c < f.colliderCount; ++c) {
                const Box& b = colliderBounds_[static_cast<size_t>(c)];
                if (!f.colliders[c].alive || x.x < b.lower.x - reach || x.x > b.upper.x + reach ||
                    x.y < b.lower.y - reach || x.y > b.upper.y + reach || x.z < b.lower.z - reach ||
                    x.z > b.upper.z + reach)
                    continue;
                Vec3 n;
                if (f.colliders[c].distance(x, n) < reach)
                    ++touched_[toldApart(f.colliders[c]) ? static_cast<size_t>(c) + 1 : 0];
            }
            forNeighbors(f.neighbors, static_cast<int>(i), [&](uint32_t j) {
                if (j >= static_cast<uint32_t>(p.count) || !(p.flags[j] & kFixed) || p.piece[j] || !linked(p, i, j))
                    return true;
                if (p.anchor[j] != before) {
                    if (!adopts || p.anchor[j] < adopted) adopted = p.anchor[j], adopts = true;
                } else if (!state_[j]) {
                    state_[j] = 1, queue_.push(j);
                }
                return true;
            });
        }
        uint16_t anchor = before;
        if (!touched_[before < touched_.size() ? before : 0] || (fresh && before == 0)) {
            // What most of it touches, else what it hangs on by others.
            size_t most = 0;
            for (size_t a = 1; a < touched_.size(); ++a)
                if (touched_[a] > touched_[most]) most = a;
            if (touched_[most] > 0)
                anchor = static_cast<uint16_t>(most);
            else if (adopts)
                anchor = adopted;
        }
        bool pressed = false, soft = false;
        for (const uint32_t i : queue_) pressed = pressed || pressedAt(f, i, anchor), soft |= p.bondSlot[i] != 0;
        const bool rigid =
            pressed && !soft && queue_.size() >= kLeastPiece && f.rigid.create(p, queue_.data(), queue_.size(), 0);
        for (const uint32_t i : queue_) {
            if (rigid) continue; // with the velocity that it has
            p.anchor[i] = anchor;
            if (!pressed) continue;
            p.flags[i] = static_cast<uint8_t>(p.flags[i] & ~(kFixed | kAsleep));
            p.anchor[i] = 0;
            p.velocityChange[i] = {};
            p.stiffness[i] = 0;
        }
        loose += pressed ? static_cast<int>(queue_.size()) : 0;
    }
    return loose;
}

} // namespace thaw
