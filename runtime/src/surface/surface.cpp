// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/surface.h"

#include "surface/cubes.h"

#include <algorithm>
#include <cstring>

namespace thaw {
namespace {

constexpr int kSide = SurfaceField::kSide, kNodes = SurfaceField::kNodes;
constexpr int kWide = kSide + 1,
              kWideNodes = kWide * kWide * kWide; // a block's cells have their last corners next door

// Shading shows bumps that the outline does not: two passes hide them on disordered particles, three flatten drips.
constexpr int kNormalPasses = 2;
constexpr int kMostSeen = 16; // materials around a vertex that are told apart

int nodeAt(int x, int y, int z) { return (z * kSide + y) * kSide + x; }
int wideAt(int x, int y, int z) { return (z * kWide + y) * kWide + x; }
constexpr int kWideStep[3] = {1, kWide, kWide* kWide};

// One channel on the nodes of all the block's cells.
void readWide(const SurfaceField& field, int block, SurfaceField::Channel channel, float* out) {
    const auto& upper = field.block(block).upper;
    for (int z = 0; z < kWide; ++z)
        for (int y = 0; y < kWide; ++y) {
            int yz = (y == kSide) << 1 | (z == kSide) << 2, from = nodeAt(0, y % kSide, z % kSide);
            float* row = out + wideAt(0, y, z);
            if (upper[yz] < 0)
                std::fill(row, row + kSide, 0.0f);
            else
                std::copy_n(field.values(upper[yz], channel) + from, kSide, row);
            row[kSide] = upper[yz + 1] < 0 ? 0 : field.values(upper[yz + 1], channel)[from];
        }
}

bool inside(float fill) { return fill >= SurfaceField::kIso; }

// Which corners of the cell are inside, a bit each.
int cubeCase(const float* fill, int node) {
    int bits = 0;
    for (int c = 0; c < 8; ++c)
        bits |= inside(fill[node + (c & 1) * kWideStep[0] + (c >> 1 & 1) * kWideStep[1] + (c >> 2) * kWideStep[2]])
                << c;
    return bits;
}

// f(x, y, z, axis) for the edges of the block's own nodes that cross the surface, in the order of their vertices.
template <class F> void forCrossings(const float* fill, F&& f) {
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                int node = wideAt(x, y, z);
                bool here = inside(fill[node]);
                for (int axis = 0; axis < 3; ++axis)
                    if (here != inside(fill[node + kWideStep[axis]])) f(x, y, z, axis);
            }
}

// The four with the largest sums, of equals the one with the lower index, as shares.
void mix(uint8_t* seen, int kinds, const float* sums, Surface::Mixture& out) {
    out = {};
    const int used = std::min(kinds, 4);
    float all = 0;
    for (int k = 0; k < used; ++k) {
        for (int n = k + 1; n < kinds; ++n) {
            const float a = sums[seen[n]], b = sums[seen[k]];
            if (a > b || (a == b && seen[n] < seen[k])) std::swap(seen[n], seen[k]);
        }
        all += sums[seen[k]];
    }
    int left = 255;
    for (int k = used - 1; k >= 0; --k) {
        const int share = k == 0 ? left : std::min(left, int(255 * sums[seen[k]] / all + 0.5f));
        if (share > 0) out.material[k] = seen[k], out.share[k] = uint8_t(share), left -= share;
    }
}

template <class F> void forCells(const float* fill, F&& f) {
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x)
                if (int bits = cubeCase(fill, wideAt(x, y, z)); bits != 0 && bits != 255) f(x, y, z, bits);
}

} // namespace

Surface::Surface(Allocator& allocator)
    : positions(allocator), normals(allocator), temperatures(allocator), liquidFractions(allocator),
      materials(allocator), bodies(allocator), mixtures(allocator), indices(allocator), field_(allocator),
      smoother_(allocator), meshes_(allocator), edgeVertices_(allocator), last_(allocator), mobility_(allocator) {}

void Surface::clear() {
    positions.clear(), normals.clear(), temperatures.clear(), liquidFractions.clear(), materials.clear(),
        bodies.clear(), mixtures.clear(), indices.clear();
}

void Surface::extract(const SurfaceInput& input, float cellSize, int smoothing, Tasks& tasks) {
    if (same(input, cellSize, smoothing)) return;
    try {
        last_.smoothing = -1;
        makeMesh(input, cellSize, tasks);
        smoother_.connect(positions.size(), indices);
        smoother_.smooth(positions, mobility_, smoothing, tasks);
        smoother_.normals(positions, normals, kNormalPasses, tasks);
        remember(input, cellSize, smoothing);
        ++made_;
    } catch (...) {
        clear();
        throw;
    }
}

bool Surface::same(const SurfaceInput& input, float cellSize, int smoothing) const {
    const size_t n = size_t(std::max(input.count, 0));
    const auto equal = [n](const auto& kept, const auto* given) {
        return n == 0 || std::memcmp(kept.data(), given, n * sizeof *given) == 0;
    };
    return last_.smoothing == smoothing && last_.cellSize == cellSize && last_.spacing == input.spacing &&
           last_.position.size() == n && equal(last_.position, input.positions) &&
           equal(last_.temperature, input.temperatures) && equal(last_.liquidFraction, input.liquidFractions) &&
           equal(last_.material, input.materials) && equal(last_.body, input.bodies);
}

void Surface::remember(const SurfaceInput& input, float cellSize, int smoothing) {
    const size_t n = size_t(std::max(input.count, 0));
    const auto keep = [n](auto& to, const auto* from) {
        to.resizeRaw(n);
        if (n > 0) std::memcpy(to.data(), from, n * sizeof *from);
    };
    keep(last_.position, input.positions), keep(last_.temperature, input.temperatures);
    keep(last_.liquidFraction, input.liquidFractions), keep(last_.material, input.materials);
    keep(last_.body, input.bodies);
    last_.spacing = input.spacing, last_.cellSize = cellSize, last_.smoothing = smoothing;
}

void Surface::makeMesh(const SurfaceInput& input, float cellSize, Tasks& tasks) {
    clear();
    field_.build(input, cellSize * input.spacing, tasks);
    int blocks = field_.blockCount();
    meshes_.resizeRaw(blocks);
    edgeVertices_.resizeRaw(size_t(blocks) * 3 * kNodes);
    tasks.forBlocks(blocks, 4, [&](int begin, int end, int, int) {
        for (int b = begin; b < end; ++b) count(b);
    });

    uint32_t vertexSum = 0, indexSum = 0;
    for (BlockMesh& m : meshes_) {
        m.vertexBegin = vertexSum, m.indexBegin = indexSum;
        vertexSum += m.vertexCount, indexSum += m.indexCount;
    }
    temperatures.resizeRaw(vertexSum);
    liquidFractions.resizeRaw(vertexSum);
    materials.resizeRaw(vertexSum), bodies.resizeRaw(vertexSum), mixtures.resizeRaw(vertexSum);
    mobility_.resizeRaw(vertexSum);
    positions.resizeRaw(vertexSum);
    indices.resizeRaw(indexSum);
    tasks.forBlocks(blocks, 4, [&](int begin, int end, int, int) {
        for (int b = begin; b < end; ++b)
            if (meshes_[b].vertexCount + meshes_[b].indexCount) emit(b, input);
    });
}

void Surface::count(int block) {
    BlockMesh& mesh = meshes_[block];
    mesh = {};
    float fill[kWideNodes];
    readWide(field_, block, SurfaceField::kFill, fill);
    int insideCount = 0;
    for (float f : fill) insideCount += inside(f);
    if (insideCount == 0 || insideCount == kWideNodes) return;
    uint16_t* edges = edgeVertices_.data() + size_t(block) * 3 * kNodes;
    forCrossings(fill, [&](int x, int y, int z, int axis) {
        edges[axis * kNodes + nodeAt(x, y, z)] = uint16_t(mesh.vertexCount++);
    });
    forCells(fill, [&](int, int, int, int bits) { mesh.indexCount += 3u * cubeCases().triangleCount[bits]; });
}

void Surface::emit(int block, const SurfaceInput& input) {
    const SurfaceField::Block& place = field_.block(block);
    const BlockMesh& mesh = meshes_[block];
    float fill[kWideNodes], temperature[kWideNodes], liquid[kWideNodes], company[kWideNodes];
    readWide(field_, block, SurfaceField::kFill, fill);
    readWide(field_, block, SurfaceField::kTemperature, temperature);
    readWide(field_, block, SurfaceField::kLiquid, liquid);
    readWide(field_, block, SurfaceField::kCompany, company);

    const int32_t* members = field_.members(place);
    int memberCount = place.end - place.begin;
    bool oneOrigin = true;
    for (int k = 1; k < memberCount; ++k)
        oneOrigin &= input.materials[members[k]] == input.materials[members[0]] &&
                     input.bodies[members[k]] == input.bodies[members[0]];
    // The nearest particle, and what of each material is around.
    auto look = [&](Vec3 p, Mixture& mixture) {
        float best = INFINITY, sums[256];
        int32_t at = members[0];
        uint8_t seen[kMostSeen];
        int kinds = 0;
        for (int k = 0; k < memberCount; ++k) {
            const int32_t i = members[k];
            const Vec3 d = input.positions[i].xyz() - p;
            const float d2 = dot(d, d), radius = field_.radius(i), t = 1 - d2 / (radius * radius);
            if (d2 < best) best = d2, at = i;
            if (!(t > 0)) continue;
            const uint8_t material = input.materials[i];
            int n = 0;
            while (n < kinds && seen[n] != material) ++n;
            if (n == kMostSeen) continue;
            if (n == kinds) seen[kinds++] = material, sums[material] = 0;
            sums[material] += t * t * t;
        }
        if (kinds == 0) seen[kinds++] = input.materials[at], sums[input.materials[at]] = 1;
        mix(seen, kinds, sums, mixture);
        return at;
    };

    uint32_t v = mesh.vertexBegin;
    forCrossings(fill, [&](int x, int y, int z, int axis) {
        int a = wideAt(x, y, z), b = a + kWideStep[axis];
        // Clear of the nodes, so that no triangle is without area.
        float t = std::clamp((SurfaceField::kIso - fill[a]) / (fill[b] - fill[a]), 0.02f, 0.98f);
        auto mean = [&](const float* sums) {
            return (sums[a] + t * (sums[b] - sums[a])) / (fill[a] + t * (fill[b] - fill[a]));
        };
        double at[3] = {double(place.x) * kSide + x, double(place.y) * kSide + y, double(place.z) * kSide + z};
        at[axis] += t;
        double cell = field_.cell();
        positions[v] = {float(at[0] * cell), float(at[1] * cell), float(at[2] * cell)};
        temperatures[v] = mean(temperature);
        liquidFractions[v] = std::clamp(mean(liquid), 0.0f, 1.0f);
        mobility_[v] = SurfaceField::mobility(mean(company));
        mixtures[v] = {{input.materials[members[0]]}, {255}};
        const int32_t origin = oneOrigin ? members[0] : look(positions[v], mixtures[v]);
        materials[v] = input.materials[origin], bodies[v] = input.bodies[origin];
        ++v;
    });

    const CubeCases& cases = cubeCases();
    uint32_t* out = indices.data() + mesh.indexBegin;
    forCells(fill, [&](int x, int y, int z, int bits) {
        for (int k = 0; k < 3 * cases.triangleCount[bits]; ++k) {
            int edge = cases.triangles[bits][k], corner = cases.edgeStart[edge];
            int ex = x + (corner & 1), ey = y + (corner >> 1 & 1), ez = z + (corner >> 2);
            int owner = place.upper[(ex == kSide) | (ey == kSide) << 1 | (ez == kSide) << 2];
            size_t slot = size_t(owner) * 3 * kNodes + (edge / 4) * kNodes + nodeAt(ex % kSide, ey % kSide, ez % kSide);
            *out++ = meshes_[owner].vertexBegin + edgeVertices_[slot];
        }
    });
}

} // namespace thaw
