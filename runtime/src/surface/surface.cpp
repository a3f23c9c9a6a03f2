// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/surface.h"

#include "surface/cubes.h"
#include "surface/mixtures.h"

#include <algorithm>
#include <cstring>

namespace thaw {
namespace {

constexpr int kSide = SurfaceField::kSide, kNodes = SurfaceField::kNodes;
constexpr int kWide = kSide + 1; // a block's cells have their last corners next door
constexpr int kPart = kSide / 2; // vertices of a part of a block look for their origins together

// Shading shows bumps that the outline does not: two passes hide them on disordered particles, three flatten drips.
constexpr int kNormalPasses = 2;
constexpr int kMixturePasses = 2; // a particle of another material is as wide as two cells

// Not __builtin_popcount, which is a call on the baseline.
int countBits(unsigned eight) {
    eight = (eight & 0x55) + (eight >> 1 & 0x55);
    eight = (eight & 0x33) + (eight >> 2 & 0x33);
    return int((eight & 0xf) + (eight >> 4));
}

int nodeAt(int x, int y, int z) { return (z * kSide + y) * kSide + x; }

// Block at (+1 if bit 0, +1 if bit 1, +1 if bit 2) of another.
int upper(const SurfaceField::Block& block, int bits) {
    return block.near[SurfaceField::nearAt(bits & 1, bits >> 1 & 1, bits >> 2 & 1)];
}

// Which nodes of a block's cells are inside: bit x of [z][y].
struct Inside {
    uint16_t rows[kWide][kWide];
    bool some = false, every = true;

    Inside(const SurfaceField& field, int slot) {
        const SurfaceField::Block& block = field.block(slot);
        for (int z = 0; z < kWide; ++z)
            for (int y = 0; y < kWide; ++y) {
                const int yz = (y == kSide) << 1 | (z == kSide) << 2, row = z % kSide * kSide + y % kSide;
                const int left = upper(block, yz), right = upper(block, yz | 1);
                unsigned bits = left < 0 ? 0 : field.inside(left)[row];
                if (right >= 0) bits |= (field.inside(right)[row] & 1u) << kSide;
                rows[z][y] = uint16_t(bits);
                some |= bits != 0, every &= bits == 0x1ff;
            }
    }
    // Of the edges along axis that start in row (y, z): those that cross the surface.
    unsigned crossings(int y, int z, int axis) const {
        const unsigned here = rows[z][y];
        const unsigned there = axis == 0 ? here >> 1 : axis == 1 ? rows[z][y + 1] : rows[z + 1][y];
        return (here ^ there) & 0xff;
    }
    // f(x, corners) for the cells of row (y, z) that the surface goes through; a bit for each corner.
    template <class F> void forCells(int y, int z, F&& f) const {
        const unsigned a = rows[z][y], b = rows[z][y + 1], c = rows[z + 1][y], d = rows[z + 1][y + 1];
        const unsigned any = a | b | c | d, all = a & b & c & d;
        for (unsigned cells = (any | any >> 1) & ~(all & all >> 1) & 0xff; cells != 0; cells &= cells - 1) {
            const int x = __builtin_ctz(cells);
            f(x, (a >> x & 3) | (b >> x & 3) << 2 | (c >> x & 3) << 4 | (d >> x & 3) << 6);
        }
    }
};

} // namespace

Surface::Surface(Allocator& allocator)
    : SurfaceMesh(allocator), field_(allocator), smoother_(allocator), meshes_(allocator), changed_(allocator),
      vertexPool_(allocator), codePool_(allocator), raw_(allocator), origins_(allocator), rawMixtures_(allocator),
      rawMaterials_(allocator), rawBodies_(allocator), codes_(allocator), edgeVertices_(allocator), floats_(allocator),
      ints_(allocator), smoothed_(allocator), unitNormals_(allocator), blended_(allocator), warmth_(allocator) {}

void Surface::drop() {
    clear();
    field_.clear();
    smoothing_ = -1;
}

void Surface::extract(const SurfaceInput& input, float cellSize, int smoothing, Tasks& tasks) {
    try {
        const SurfaceField::Change change = field_.update(input, cellSize * input.spacing, tasks);
        const bool otherShape = change != SurfaceField::Change::nothing || smoothing != smoothing_;
        if (!keepWarmth(input) && !otherShape) return;
        if (otherShape) {
            smoothing_ = -1;
            if (change != SurfaceField::Change::nothing)
                meshBlocks(input, change == SurfaceField::Change::everything, tasks);
            assemble(tasks);
            smoother_.connect(smoothed_.size(), indices);
            blendMixtures(smoother_.corners(), mixtures, blended_, kMixturePasses, tasks);
            smoother_.smooth(smoothed_, smoothing, tasks);
            smoother_.normals(smoothed_, unitNormals_, kNormalPasses, tasks);
            for (size_t v = 0; v < smoothed_.size(); ++v)
                positions[v] = smoothed_[v].xyz(), normals[v] = unitNormals_[v].xyz();
            smoothing_ = smoothing;
        }
        setWarmth(tasks);
        ++made_;
    } catch (...) {
        drop();
        throw;
    }
}

// Meshes the blocks that have changed.
void Surface::meshBlocks(const SurfaceInput& input, bool all, Tasks& tasks) {
    const size_t slots = size_t(field_.slotCount());
    if (all) meshes_.clear(), vertexPool_.clear(), codePool_.clear();
    meshes_.resize(slots);
    edgeVertices_.resizeRaw(slots * 3 * kNodes);
    changed_.clear();
    int most = 0;
    for (size_t slot = 0; slot < slots; ++slot) {
        const SurfaceField::Block& block = field_.block(int(slot));
        if (block.changed) changed_.push(int32_t(slot)), most = std::max(most, block.around);
        if (!block.alive) meshes_[slot].vertexCount = meshes_[slot].codeCount = 0;
    }
    tasks.forBlocks(int(changed_.size()), 4, [&](int begin, int end, int, int) {
        for (int k = begin; k < end; ++k) count(changed_[k]);
    });
    for (BlockMesh& mesh : meshes_)
        vertexPool_.fit(mesh.vertices, mesh.vertexCount), codePool_.fit(mesh.codes, mesh.codeCount);
    const size_t vertices = vertexPool_.size();
    raw_.resizeRaw(vertices), origins_.resizeRaw(vertices), rawMixtures_.resizeRaw(vertices);
    rawMaterials_.resizeRaw(vertices), rawBodies_.resizeRaw(vertices);
    codes_.resizeRaw(codePool_.size());
    stride_ = most + 8;
    floats_.resizeRaw(size_t(tasks.workerCount()) * OriginFinder::kFloats * stride_);
    ints_.resizeRaw(size_t(tasks.workerCount()) * OriginFinder::kInts * stride_);
    tasks.forBlocks(int(changed_.size()), 4, [&](int begin, int end, int, int worker) {
        for (int k = begin; k < end; ++k)
            if (meshes_[changed_[k]].vertexCount + meshes_[changed_[k]].codeCount) emit(changed_[k], input, worker);
    });
    blocksMeshed_ += int64_t(changed_.size());
}

void Surface::count(int slot) {
    BlockMesh& mesh = meshes_[slot];
    mesh.vertexCount = mesh.codeCount = 0;
    const Inside inside(field_, slot);
    if (!inside.some || inside.every) return;
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y) {
            for (int axis = 0; axis < 3; ++axis) mesh.vertexCount += uint32_t(countBits(inside.crossings(y, z, axis)));
            inside.forCells(y, z,
                            [&](int, unsigned corners) { mesh.codeCount += 3u * cubeCases().triangleCount[corners]; });
        }
}

void Surface::emit(int slot, const SurfaceInput& input, int worker) {
    const BlockMesh& mesh = meshes_[slot];
    const Inside inside(field_, slot);
    OriginFinder finder(field_, floats_.data() + size_t(worker) * OriginFinder::kFloats * stride_,
                        ints_.data() + size_t(worker) * OriginFinder::kInts * stride_, stride_);
    uint16_t* edges = edgeVertices_.data() + size_t(slot) * 3 * kNodes;
    uint32_t vertex = 0;
    for (int part = 0; part < 8; ++part) {
        const int first[3] = {(part & 1) * kPart, (part >> 1 & 1) * kPart, (part >> 2) * kPart};
        const float lower[3] = {float(first[0]), float(first[1]), float(first[2])};
        const float higher[3] = {lower[0] + kPart, lower[1] + kPart, lower[2] + kPart};
        bool looked = false;
        for (int z = first[2]; z < first[2] + kPart; ++z)
            for (int y = first[1]; y < first[1] + kPart; ++y)
                for (int axis = 0; axis < 3; ++axis) {
                    unsigned crossings = inside.crossings(y, z, axis) & (0xfu << first[0]);
                    if (crossings != 0 && !looked) finder.look(slot, lower, higher), looked = true;
                    for (; crossings != 0; crossings &= crossings - 1) {
                        const int x = __builtin_ctz(crossings);
                        emitVertex(slot, x, y, z, axis, finder, input, mesh.vertices.begin + vertex);
                        edges[axis * kNodes + nodeAt(x, y, z)] = uint16_t(vertex++);
                    }
                }
    }

    const CubeCases& cases = cubeCases();
    uint16_t* out = codes_.data() + mesh.codes.begin;
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            inside.forCells(y, z, [&](int x, unsigned corners) {
                for (int k = 0; k < 3 * cases.triangleCount[corners]; ++k) {
                    const int edge = cases.triangles[corners][k], corner = cases.edgeStart[edge];
                    const int ex = x + (corner & 1), ey = y + (corner >> 1 & 1), ez = z + (corner >> 2);
                    const int owner = (ex == kSide) | (ey == kSide) << 1 | (ez == kSide) << 2;
                    *out++ = uint16_t((owner * 4 + edge / 4) * kNodes + nodeAt(ex % kSide, ey % kSide, ez % kSide));
                }
            });
}

void Surface::emitVertex(int slot, int x, int y, int z, int axis, const OriginFinder& finder, const SurfaceInput& input,
                         uint32_t to) {
    const SurfaceField::Block& block = field_.block(slot);
    int next[3] = {x, y, z};
    ++next[axis];
    const int other = upper(block, (next[0] == kSide) | (next[1] == kSide) << 1 | (next[2] == kSide) << 2);
    const float fill = field_.value(slot, nodeAt(x, y, z));
    const float nextFill =
        other < 0 ? 0 : field_.value(other, nodeAt(next[0] % kSide, next[1] % kSide, next[2] % kSide));
    // Clear of the nodes, so that no triangle is without area.
    const float t = std::clamp((SurfaceField::kIso - fill) / (nextFill - fill), 0.02f, 0.98f);
    double at[3] = {double(block.x) * kSide + x, double(block.y) * kSide + y, double(block.z) * kSide + z};
    at[axis] += double(t);
    const double cell = field_.cell();
    const Vec3 p{float(at[0] * cell), float(at[1] * cell), float(at[2] * cell)};

    Origins& origins = origins_[to];
    finder.find(p, origins);
    float company = 0;
    int nearest = 0;
    bool oneMaterial = true;
    for (int k = 0; k < Origins::kMost; ++k) {
        company += origins.share[k] * field_.company(origins.row[k]);
        if (origins.share[k] > origins.share[nearest]) nearest = k;
        oneMaterial &= input.materials[origins.row[k]] == input.materials[origins.row[0]];
    }
    raw_[to] = {p.x, p.y, p.z, SurfaceField::mobility(company)};
    rawMaterials_[to] = input.materials[origins.row[nearest]];
    rawBodies_[to] = input.bodies[origins.row[nearest]];
    if (oneMaterial)
        rawMixtures_[to] = {{input.materials[origins.row[0]]}, {255}};
    else
        mixOf(origins, input.materials, rawMixtures_[to]);
}

// Puts what the blocks have side by side.
void Surface::assemble(Tasks& tasks) {
    const Array<int32_t>& order = field_.order();
    uint32_t vertexSum = 0, codeSum = 0;
    for (int32_t slot : order) {
        BlockMesh& mesh = meshes_[slot];
        mesh.vertexBegin = vertexSum, mesh.codeBegin = codeSum;
        vertexSum += mesh.vertexCount, codeSum += mesh.codeCount;
    }
    positions.resizeRaw(vertexSum), normals.resizeRaw(vertexSum), smoothed_.resizeRaw(vertexSum);
    temperatures.resizeRaw(vertexSum), liquidFractions.resizeRaw(vertexSum);
    materials.resizeRaw(vertexSum), bodies.resizeRaw(vertexSum), mixtures.resizeRaw(vertexSum);
    indices.resizeRaw(codeSum);
    tasks.forBlocks(int(order.size()), 16, [&](int begin, int end, int, int) {
        for (int b = begin; b < end; ++b) {
            const BlockMesh& mesh = meshes_[order[b]];
            const auto copy = [&](const auto& from, auto& to) {
                std::copy_n(from.data() + mesh.vertices.begin, mesh.vertexCount, to.data() + mesh.vertexBegin);
            };
            copy(raw_, smoothed_), copy(rawMaterials_, materials), copy(rawBodies_, bodies);
            copy(rawMixtures_, mixtures);
            if (mesh.codeCount == 0) continue;
            const uint16_t* edges[8];
            uint32_t firsts[8];
            for (int n = 0; n < 8; ++n) {
                const int owner = upper(field_.block(order[b]), n);
                edges[n] = owner < 0 ? nullptr : edgeVertices_.data() + size_t(owner) * 3 * kNodes;
                firsts[n] = owner < 0 ? 0 : meshes_[owner].vertexBegin;
            }
            for (uint32_t k = 0; k < mesh.codeCount; ++k) {
                const unsigned code = codes_[mesh.codes.begin + k], owner = code / (4 * kNodes);
                indices[mesh.codeBegin + k] = firsts[owner] + edges[owner][code % (4 * kNodes)];
            }
        }
    });
}

// Keeps what the particles' temperatures and phases are; false when they are what they were.
bool Surface::keepWarmth(const SurfaceInput& input) {
    const size_t count = size_t(std::max(input.count, 0));
    bool other = warmth_.size() != count;
    warmth_.resizeRaw(count);
    for (size_t i = 0; i < count; ++i) {
        const Warmth now{input.temperatures[i], input.liquidFractions[i]};
        other |= std::memcmp(&warmth_[i], &now, sizeof now) != 0;
        warmth_[i] = now;
    }
    return other;
}

void Surface::setWarmth(Tasks& tasks) {
    const Array<int32_t>& order = field_.order();
    tasks.forBlocks(int(order.size()), 16, [&](int begin, int end, int, int) {
        for (int b = begin; b < end; ++b) {
            const BlockMesh& mesh = meshes_[order[b]];
            for (uint32_t k = 0; k < mesh.vertexCount; ++k) {
                const Origins& from = origins_[mesh.vertices.begin + k];
                float temperature = 0, liquid = 0;
                for (int n = 0; n < Origins::kMost; ++n) {
                    const Warmth& w = warmth_[from.row[n]];
                    temperature += from.share[n] * w.temperature, liquid += from.share[n] * w.liquidFraction;
                }
                temperatures[mesh.vertexBegin + k] = temperature;
                liquidFractions[mesh.vertexBegin + k] = std::clamp(liquid, 0.0f, 1.0f);
            }
        }
    });
}

} // namespace thaw
