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
constexpr int kWide = kSide + 1;           // a block's cells have their last corners next door
constexpr int kPart = kSide / 2;           // of a block's side
constexpr uint64_t kPartMask = 0x0f0f0f0f; // nodes of a part in a plane

// Shading shows bumps that the outline does not: two passes hide them on disordered particles, three flatten drips.
constexpr int kNormalPasses = 2;
constexpr int kMixturePasses = 2; // a particle of another material is as wide as two cells

// Not __builtin_popcountll, which is a call on the baseline.
uint32_t countBits(uint64_t v) {
    v -= v >> 1 & 0x5555555555555555u;
    v = (v & 0x3333333333333333u) + (v >> 2 & 0x3333333333333333u);
    return uint32_t(((v + (v >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u >> 56);
}

int nodeAt(int x, int y, int z) { return (z * kSide + y) * kSide + x; }

// Block at (+1 if bit 0, +1 if bit 1, +1 if bit 2) of another.
int upper(const SurfaceField::Block& block, int bits) {
    return block.near[SurfaceField::nearAt(bits & 1, bits >> 1 & 1, bits >> 2 & 1)];
}

// Where the surface goes through a block: in bit 8 y + x of [z].
struct Crossings {
    SurfaceField::NodeBits nodes;
    uint64_t edges[3][kSide]; // by axis: those that start at the node
    uint64_t cells[kSide];    // those that start at the node
    bool any = false;

    Crossings(const SurfaceField& field, int slot) {
        field.insideBits(slot, nodes);
        Plane lower(nodes.rows[0]);
        for (int z = 0; z < kSide; ++z) {
            const Plane higher(nodes.rows[z + 1]);
            edges[0][z] = lower.here ^ lower.nextX, edges[1][z] = lower.here ^ lower.nextY;
            edges[2][z] = lower.here ^ higher.here;
            cells[z] = (lower.some | higher.some) & ~(lower.every & higher.every);
            any |= cells[z] != 0;
            lower = higher;
        }
    }
    // A bit for each corner of a cell.
    unsigned corners(int x, int y, int z) const {
        const auto two = [&](int ny, int nz) { return unsigned(nodes.rows[nz][ny] >> x & 3); };
        return two(y, z) | two(y + 1, z) << 2 | two(y, z + 1) << 4 | two(y + 1, z + 1) << 6;
    }
    // f(x, y, z, corners) for the cells that the surface goes through.
    template <class F> void forCells(F&& f) const {
        for (int z = 0; z < kSide; ++z)
            for (uint64_t left = cells[z]; left != 0; left &= left - 1) {
                const int at = __builtin_ctzll(left);
                f(at & 7, at >> 3, z, corners(at & 7, at >> 3, z));
            }
    }

private:
    struct Plane {
        uint64_t here = 0, nextX = 0, nextY = 0, some, every; // some, every: of the four of a cell in this plane
        explicit Plane(const uint16_t rows[kWide]) {
            for (int y = 0; y < kSide; ++y) {
                here |= uint64_t(rows[y] & 0xff) << 8 * y, nextX |= uint64_t(rows[y] >> 1) << 8 * y;
                nextY |= uint64_t(rows[y + 1] & 0xff) << 8 * y;
            }
            const uint64_t nextXY = nextX >> 8 | uint64_t(rows[kSide] >> 1) << 56;
            some = here | nextX | nextY | nextXY, every = here & nextX & nextY & nextXY;
        }
    };
};

// How the corners of triangles are named, as edges: which upper block, axis and node. Of an edge of the cube, from the
// cell's own code, where all of it is in the cell's block.
struct EdgeCodes {
    uint16_t fromCell[12];
    EdgeCodes() {
        for (int edge = 0; edge < 12; ++edge) {
            const int corner = cubeCases().edgeStart[edge];
            fromCell[edge] = uint16_t(edge / 4 * kNodes + nodeAt(corner & 1, corner >> 1 & 1, corner >> 2));
        }
    }
};
const EdgeCodes kEdgeCodes;

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
    if (!all && field_.rowsMoved()) followRows();
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

// Blocks that keep their mesh find their particles in other rows.
void Surface::followRows() {
    for (size_t slot = 0; slot < meshes_.size(); ++slot) {
        const BlockMesh& mesh = meshes_[slot];
        if (!field_.block(int(slot)).alive || field_.block(int(slot)).changed) continue;
        for (uint32_t k = 0; k < mesh.vertexCount; ++k)
            for (uint32_t& row : origins_[mesh.vertices.begin + k].row) row = field_.rowNow(row);
    }
}

void Surface::count(int slot) {
    BlockMesh& mesh = meshes_[slot];
    mesh.vertexCount = mesh.codeCount = 0;
    const Crossings crossings(field_, slot);
    if (!crossings.any) return;
    for (const auto& axis : crossings.edges)
        for (uint64_t plane : axis) mesh.vertexCount += countBits(plane);
    const CubeCases& cases = cubeCases();
    crossings.forCells([&](int, int, int, unsigned corners) { mesh.codeCount += 3u * cases.triangleCount[corners]; });
}

void Surface::emit(int slot, const SurfaceInput& input, int worker) {
    const BlockMesh& mesh = meshes_[slot];
    const Crossings crossings(field_, slot);
    OriginFinder finder(field_, floats_.data() + size_t(worker) * OriginFinder::kFloats * stride_,
                        ints_.data() + size_t(worker) * OriginFinder::kInts * stride_, stride_);
    uint16_t* edges = edgeVertices_.data() + size_t(slot) * 3 * kNodes;
    uint32_t vertex = 0;
    // Vertices of a part of a block look for their origins together.
    for (int part = 0; part < 8; ++part) {
        const int x0 = (part & 1) * kPart, y0 = (part >> 1 & 1) * kPart, z0 = (part >> 2) * kPart;
        const uint64_t mask = kPartMask << (8 * y0 + x0);
        uint64_t all = 0;
        int zBegin = z0 + kPart, zEnd = z0;
        for (int z = z0; z < z0 + kPart; ++z) {
            const uint64_t here = (crossings.edges[0][z] | crossings.edges[1][z] | crossings.edges[2][z]) & mask;
            if (here != 0) all |= here, zBegin = std::min(zBegin, z), zEnd = z + 1;
        }
        if (all == 0) continue;
        uint64_t column = all | all >> 32;
        column = (column | column >> 16) & 0xffff, column = (column | column >> 8) & 0xff;
        const float lower[3] = {float(__builtin_ctzll(column)), float(__builtin_ctzll(all) / 8), float(zBegin)};
        const float upper[3] = {float(64 - __builtin_clzll(column)), float((63 - __builtin_clzll(all)) / 8 + 1),
                                float(zEnd)};
        finder.look(slot, lower, upper);
        for (int z = zBegin; z < zEnd; ++z)
            for (int axis = 0; axis < 3; ++axis)
                for (uint64_t left = crossings.edges[axis][z] & mask; left != 0; left &= left - 1) {
                    const int at = __builtin_ctzll(left);
                    emitVertex(slot, at & 7, at >> 3, z, axis, finder, input, mesh.vertices.begin + vertex);
                    edges[axis * kNodes + z * kSide * kSide + at] = uint16_t(vertex++);
                }
    }

    const CubeCases& cases = cubeCases();
    uint16_t* out = codes_.data() + mesh.codes.begin;
    crossings.forCells([&](int x, int y, int z, unsigned corners) {
        const uint8_t* triangles = cases.triangles[corners];
        const int count = 3 * cases.triangleCount[corners];
        if (std::max({x, y, z}) < kSide - 1) {
            const int cell = nodeAt(x, y, z);
            for (int k = 0; k < count; ++k) *out++ = uint16_t(cell + kEdgeCodes.fromCell[triangles[k]]);
            return;
        }
        for (int k = 0; k < count; ++k) {
            const int edge = triangles[k], corner = cases.edgeStart[edge];
            const int ex = x + (corner & 1), ey = y + (corner >> 1 & 1), ez = z + (corner >> 2);
            const int owner = ex >> 3 | ey >> 3 << 1 | ez >> 3 << 2;
            *out++ = uint16_t((owner * 4 + edge / 4) * kNodes + nodeAt(ex & 7, ey & 7, ez & 7));
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
    const double cell = field_.cell();
    const auto place = [&](int32_t first, int node, int a) {
        return float((double(first) * kSide + node + (axis == a ? double(t) : 0.0)) * cell);
    };
    const Vec3 p{place(block.x, x, 0), place(block.y, y, 1), place(block.z, z, 2)};

    Origins& origins = origins_[to];
    const int found = finder.find(p, origins);
    float company = 0;
    int nearest = 0;
    bool oneMaterial = true;
    for (int k = 0; k < found; ++k) {
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
