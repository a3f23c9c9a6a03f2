// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/surface.h"

#include "surface/cubes.h"

#include <algorithm>
#include <cstring>

namespace thaw {
namespace {

constexpr int kSide = SurfaceField::kSide, kNodes = SurfaceField::kNodes;
constexpr int kWide = kSide + 1;           // a block's cells have their last corners next door
constexpr int kPart = kSide / 2;           // of a block's side
constexpr uint64_t kPartMask = 0x0f0f0f0f; // nodes of a part in a plane

// Not __builtin_popcountll, which is a call on the baseline.
uint32_t countBits(uint64_t v) {
    v -= v >> 1 & 0x5555555555555555u;
    v = (v & 0x3333333333333333u) + (v >> 2 & 0x3333333333333333u);
    return uint32_t(((v + (v >> 4)) & 0x0f0f0f0f0f0f0f0fu) * 0x0101010101010101u >> 56);
}

int nodeAt(int x, int y, int z) { return (z * kSide + y) * kSide + x; }

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
    : SurfaceMesh(allocator), field_(allocator), links_(allocator), smoother_(allocator), blender_(allocator),
      meshes_(allocator), changed_(allocator), vertexPool_(allocator), trianglePool_(allocator), marked_(allocator),
      spans_(allocator), raw_(allocator), origins_(allocator), rawMixtures_(allocator), rawMaterials_(allocator),
      rawBodies_(allocator), codes_(allocator), edgeVertices_(allocator), floats_(allocator), ints_(allocator),
      warmth_(allocator) {}

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
            const bool all = change != SurfaceField::Change::blocks || smoothing != smoothing_;
            smoothing_ = -1;
            if (change != SurfaceField::Change::nothing)
                meshBlocks(input, change == SurfaceField::Change::everything, tasks);
            finishShape(all || smoothing > MeshSmoother::kKept, smoothing, tasks);
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
    if (all) meshes_.clear(), vertexPool_.clear(), trianglePool_.clear(), links_.clear();
    meshes_.resize(slots);
    edgeVertices_.resizeRaw(slots * 3 * kNodes);
    if (!all && field_.rowsMoved()) followRows();
    changed_.clear();
    int most = 0;
    for (size_t slot = 0; slot < slots; ++slot) {
        const SurfaceField::Block& block = field_.block(int(slot));
        if (block.changed) changed_.push(int32_t(slot)), most = std::max(most, block.around);
        meshes_[slot].moved = false;
        if (!block.alive) meshes_[slot].vertexCount = meshes_[slot].triangleCount = 0;
    }
    tasks.forBlocks(int(changed_.size()), 4, [&](int begin, int end, int, int) {
        for (int k = begin; k < end; ++k) count(changed_[k]);
    });
    for (BlockMesh& mesh : meshes_) {
        vertexPool_.fit(mesh.vertices, mesh.vertexCount + (mesh.vertexCount > 0));
        trianglePool_.fit(mesh.triangles, mesh.triangleCount);
    }
    const size_t vertices = vertexPool_.size();
    raw_.resizeRaw(vertices), origins_.resizeRaw(vertices), rawMixtures_.resizeRaw(vertices);
    rawMaterials_.resizeRaw(vertices), rawBodies_.resizeRaw(vertices);
    codes_.resizeRaw(3 * trianglePool_.size());
    stride_ = most + 8;
    floats_.resizeRaw(size_t(tasks.workerCount()) * OriginFinder::kFloats * stride_);
    ints_.resizeRaw(size_t(tasks.workerCount()) * OriginFinder::kInts * stride_);
    tasks.forBlocks(int(changed_.size()), 4, [&](int begin, int end, int, int worker) {
        for (int k = begin; k < end; ++k)
            if (meshes_[changed_[k]].vertexCount + meshes_[changed_[k]].triangleCount) emit(changed_[k], input, worker);
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
    uint32_t vertices = 0, triangles = 0;
    if (const Crossings crossings(field_, slot); crossings.any) {
        for (const auto& axis : crossings.edges)
            for (uint64_t plane : axis) vertices += countBits(plane);
        const CubeCases& cases = cubeCases();
        crossings.forCells([&](int, int, int, unsigned corners) { triangles += cases.triangleCount[corners]; });
    }
    mesh.moved = mesh.vertexCount != vertices || mesh.triangleCount != triangles;
    mesh.vertexCount = vertices, mesh.triangleCount = triangles;
}

void Surface::emit(int slot, const SurfaceInput& input, int worker) {
    BlockMesh& mesh = meshes_[slot];
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
    uint16_t* out = codes_.data() + 3 * size_t(mesh.triangles.begin);
    const auto write = [&](int code) {
        mesh.moved |= *out != code;
        *out++ = uint16_t(code);
    };
    crossings.forCells([&](int x, int y, int z, unsigned corners) {
        const uint8_t* triangles = cases.triangles[corners];
        const int count = 3 * cases.triangleCount[corners];
        if (std::max({x, y, z}) < kSide - 1) {
            const int cell = nodeAt(x, y, z);
            for (int k = 0; k < count; ++k) write(cell + kEdgeCodes.fromCell[triangles[k]]);
            return;
        }
        for (int k = 0; k < count; ++k) {
            const int edge = triangles[k], corner = cases.edgeStart[edge];
            const int ex = x + (corner & 1), ey = y + (corner >> 1 & 1), ez = z + (corner >> 2);
            const int owner = ex >> 3 | ey >> 3 << 1 | ez >> 3 << 2;
            write((owner * 4 + edge / 4) * kNodes + nodeAt(ex & 7, ey & 7, ez & 7));
        }
    });
    const Mixture* mixture = rawMixtures_.data() + mesh.vertices.begin;
    const bool plain = mesh.vertexCount > 0 && std::all_of(mixture, mixture + mesh.vertexCount, [&](const Mixture& m) {
                           return m.share[0] == 255 && m.material[0] == mixture->material[0];
                       });
    mesh.plain = plain ? mixture->material[0] : -1;
}

void Surface::emitVertex(int slot, int x, int y, int z, int axis, const OriginFinder& finder, const SurfaceInput& input,
                         uint32_t to) {
    const SurfaceField::Block& block = field_.block(slot);
    int next[3] = {x, y, z};
    ++next[axis];
    const int other = MeshLinks::upper(block, (next[0] == kSide) | (next[1] == kSide) << 1 | (next[2] == kSide) << 2);
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
    const Vec4 own{p.x, p.y, p.z, SurfaceField::mobility(company)};
    rawMaterials_[to] = input.materials[origins.row[nearest]];
    rawBodies_[to] = input.bodies[origins.row[nearest]];
    Mixture mixture{{input.materials[origins.row[0]]}, {255}};
    if (!oneMaterial) mixOf(origins, input.materials, mixture);
    BlockMesh& mesh = meshes_[slot];
    mesh.moved = mesh.moved || std::memcmp(&raw_[to], &own, sizeof own) != 0 ||
                 std::memcmp(&rawMixtures_[to], &mixture, sizeof mixture) != 0;
    raw_[to] = own, rawMixtures_[to] = mixture;
}

// A vertex shows in another's position, normal and mixture over less than a block: those in blocks that are not next to
// one that has moved are what they would be anew, after each step.
void Surface::markNear(bool all) {
    static_assert(MeshSmoother::reach(MeshSmoother::kKept) < kSide && MixtureBlender::kPasses < kSide);
    marked_.assign(meshes_.size(), all);
    if (!all)
        for (int32_t slot : field_.order())
            if (meshes_[slot].moved)
                for (int32_t near : field_.block(slot).near)
                    if (near >= 0) marked_[near] = 1;
    spans_.clear();
    for (int32_t slot : field_.order())
        if (marked_[slot] && meshes_[slot].vertexCount + meshes_[slot].triangleCount > 0)
            spans_.push(meshes_[slot].span());
}

// Of one material there is nothing to blend.
void Surface::blend(Tasks& tasks) {
    int material = -1;
    bool one = true;
    for (int32_t slot : field_.order())
        if (const BlockMesh& mesh = meshes_[slot]; mesh.vertexCount > 0) {
            one = one && mesh.plain >= 0 && (material < 0 || mesh.plain == material);
            material = mesh.plain;
        }
    if (!one && !blended_) markNear(true);
    if (!one) blender_.blend(links_.corners(), rawMixtures_, spans_, tasks);
    blended_ = !one;
}

// Smooths what has moved, and what is near it.
void Surface::finishShape(bool all, int smoothing, Tasks& tasks) {
    markNear(all);
    links_.link(field_, meshes_, codes_, edgeVertices_, marked_, tasks);
    smoother_.smooth(links_.corners(), links_.points(), raw_, trianglePool_.size(), spans_, smoothing, tasks);
    blend(tasks);
    assemble(tasks);
}

// Puts what the blocks have side by side.
void Surface::assemble(Tasks& tasks) {
    const Array<int32_t>& order = field_.order();
    uint32_t vertexSum = 0, triangleSum = 0;
    for (int32_t slot : order) {
        BlockMesh& mesh = meshes_[slot];
        mesh.vertexBegin = vertexSum, mesh.triangleBegin = triangleSum;
        vertexSum += mesh.vertexCount, triangleSum += mesh.triangleCount;
    }
    positions.resizeRaw(vertexSum), normals.resizeRaw(vertexSum);
    temperatures.resizeRaw(vertexSum), liquidFractions.resizeRaw(vertexSum);
    materials.resizeRaw(vertexSum), bodies.resizeRaw(vertexSum), mixtures.resizeRaw(vertexSum);
    indices.resizeRaw(3 * triangleSum);
    tasks.forBlocks(int(order.size()), 16, [&](int begin, int end, int, int) {
        for (int b = begin; b < end; ++b) {
            const BlockMesh& mesh = meshes_[order[b]];
            const uint32_t first = mesh.vertices.begin;
            for (uint32_t k = 0; k < mesh.vertexCount; ++k) {
                positions[mesh.vertexBegin + k] = smoother_.positions()[first + k].xyz();
                normals[mesh.vertexBegin + k] = smoother_.normals()[first + k].xyz();
            }
            std::copy_n(rawMaterials_.data() + first, mesh.vertexCount, materials.data() + mesh.vertexBegin);
            std::copy_n(rawBodies_.data() + first, mesh.vertexCount, bodies.data() + mesh.vertexBegin);
            std::copy_n((blended_ ? blender_.mixtures() : rawMixtures_.data()) + first, mesh.vertexCount,
                        mixtures.data() + mesh.vertexBegin);
            if (mesh.triangleCount == 0) continue;
            uint32_t shifts[8];
            for (int n = 0; n < 8; ++n) {
                const int owner = MeshLinks::upper(field_.block(order[b]), n);
                shifts[n] = owner < 0 ? 0 : meshes_[owner].vertexBegin - meshes_[owner].vertices.begin;
            }
            const size_t from = 3 * size_t(mesh.triangles.begin), to = 3 * size_t(mesh.triangleBegin);
            for (size_t k = 0; k < 3 * size_t(mesh.triangleCount); ++k)
                indices[to + k] = links_.points()[from + k] + shifts[MeshLinks::ownerOf(codes_[from + k])];
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
