// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "heat/sphere_tree.h"

#include "base/math.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

// What fills up leaves and nodes: out of every ray's reach.
constexpr float kNowhere = 1e15f;
// So that no rounding in a box decides what a sphere's own test decides.
constexpr float kRoom = 1e-4f, kRounding = 1e-6f;

size_t eighths(size_t n) { return (n + 7) / 8; }

// Of 10 bits, two free ones after each.
uint32_t spread(uint32_t v) {
    v = (v | v << 16) & 0x030000ffu, v = (v | v << 8) & 0x0300f00fu;
    v = (v | v << 4) & 0x030c30c3u;
    return (v | v << 2) & 0x09249249u;
}

void setBox(BoxNode& node, size_t k, const Box& box) {
    const float lower[3] = {box.lower.x, box.lower.y, box.lower.z}, upper[3] = {box.upper.x, box.upper.y, box.upper.z};
    for (int a = 0; a < 3; ++a) node.lower[a][k] = lower[a], node.upper[a][k] = upper[a];
}
Box boxOf(const BoxNode& node) {
    Box all;
    for (size_t k = 0; k < 8; ++k) {
        if (node.lower[0][k] >= kNowhere) continue;
        all.grow(Vec3{node.lower[0][k], node.lower[1][k], node.lower[2][k]});
        all.grow(Vec3{node.upper[0][k], node.upper[1][k], node.upper[2][k]});
    }
    return all;
}

} // namespace

void SphereTree::reserve(int most) {
    const size_t n = static_cast<size_t>(most);
    keys_.reserve(n), keysBack_.reserve(n), leaves_.reserve(eighths(n));
    size_t nodes = 0, level = eighths(n);
    do nodes += level = eighths(level);
    while (level > 1);
    nodes_.reserve(nodes);
}

// Along a Z curve of 1024 cells an edge; stable, 10 bits at a time.
void SphereTree::sort(const Vec4* spheres, int count) {
    const size_t n = static_cast<size_t>(count);
    keys_.resizeRaw(n), keysBack_.resizeRaw(n);
    Box box;
    for (size_t i = 0; i < n; ++i) box.grow(spheres[i].xyz());
    const Vec3 size = box.upper - box.lower;
    const float scale = 1023 / std::max({size.x, size.y, size.z, 1e-30f});
    uint32_t counts[3][1024] = {};
    for (size_t i = 0; i < n; ++i) {
        const Vec3 q = scale * (spheres[i].xyz() - box.lower);
        const uint32_t along = spread(static_cast<uint32_t>(q.x)) << 2 | spread(static_cast<uint32_t>(q.y)) << 1 |
                               spread(static_cast<uint32_t>(q.z));
        keys_[i] = {along, static_cast<int>(i)};
        for (int pass = 0; pass < 3; ++pass) ++counts[pass][along >> (10 * pass) & 1023u];
    }
    for (int pass = 0; pass < 3; ++pass) {
        uint32_t at = 0;
        for (uint32_t& c : counts[pass]) {
            const uint32_t begin = at;
            at += c, c = begin;
        }
        for (const Key& k : keys_) keysBack_[counts[pass][k.along >> (10 * pass) & 1023u]++] = k;
        keys_.swap(keysBack_);
    }
}

void SphereTree::build(const Vec4* spheres, int count) {
    levels_ = 0;
    leaves_.clear(), nodes_.clear();
    if (count == 0) return;
    sort(spheres, count);
    const size_t n = static_cast<size_t>(count);
    const Box nowhere{{kNowhere, kNowhere, kNowhere}, {kNowhere, kNowhere, kNowhere}};
    leaves_.resizeRaw(eighths(n));
    nodes_.resizeRaw(eighths(leaves_.size()));
    for (size_t at = 0; at < 8 * nodes_.size(); ++at) {
        BoxNode& node = nodes_[at / 8];
        if (at >= leaves_.size()) {
            setBox(node, at % 8, nowhere);
            continue;
        }
        SphereLeaf& leaf = leaves_[at];
        Box box;
        for (size_t k = 0; k < 8; ++k) {
            if (8 * at + k >= n) {
                leaf.x[k] = leaf.y[k] = leaf.z[k] = kNowhere, leaf.square[k] = 0;
                continue;
            }
            const Vec4& s = spheres[keys_[8 * at + k].index];
            leaf.x[k] = s.x, leaf.y[k] = s.y, leaf.z[k] = s.z, leaf.square[k] = s.w * s.w;
            const float reach = (1 + kRoom) * s.w + kRounding * std::max({std::abs(s.x), std::abs(s.y), std::abs(s.z)});
            box.grow(s.xyz() - Vec3{reach, reach, reach}), box.grow(s.xyz() + Vec3{reach, reach, reach});
        }
        setBox(node, at % 8, box);
    }
    size_t below = 0, size = nodes_.size();
    first_[0] = 0, levels_ = 1;
    while (size > 1) {
        const size_t begin = nodes_.size(), next = eighths(size);
        nodes_.resizeRaw(begin + next);
        for (size_t at = 0; at < 8 * next; ++at)
            setBox(nodes_[begin + at / 8], at % 8, at < size ? boxOf(nodes_[below + at]) : nowhere);
        first_[levels_++] = static_cast<int>(begin);
        below = begin, size = next;
    }
}

bool SphereTree::blocks(const SphereRay& ray) const {
    return levels_ > 0 && sphereTreeBlocks({leaves_.data(), nodes_.data(), first_, levels_}, ray);
}

} // namespace thaw
