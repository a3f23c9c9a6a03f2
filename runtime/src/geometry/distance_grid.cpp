// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "geometry/distance_grid.h"

#include <algorithm>

namespace thaw {

namespace {

// NaN ends at low.
inline float clampTo(float value, float low, float high) { return value > low ? (value < high ? value : high) : low; }

// The eight nodes around a place as trilinear value and its exact gradient in units of value per cell.
inline float trilinear(const float* v, size_t dy, size_t dz, float fx, float fy, float fz, Vec3& gradient) {
    float c000 = v[0], c100 = v[1], c010 = v[dy], c110 = v[dy + 1];
    float c001 = v[dz], c101 = v[dz + 1], c011 = v[dz + dy], c111 = v[dz + dy + 1];
    float x00 = c100 - c000, x10 = c110 - c010, x01 = c101 - c001, x11 = c111 - c011;
    float a00 = c000 + fx * x00, a10 = c010 + fx * x10, a01 = c001 + fx * x01, a11 = c011 + fx * x11;
    float b0 = a00 + fy * (a10 - a00), b1 = a01 + fy * (a11 - a01);
    float gx0 = x00 + fy * (x10 - x00), gx1 = x01 + fy * (x11 - x01);
    float gy0 = a10 - a00, gy1 = a11 - a01;
    gradient = {gx0 + fz * (gx1 - gx0), gy0 + fz * (gy1 - gy0), b1 - b0};
    return b0 + fz * (b1 - b0);
}

// The distance of a node on a face comes out as up to some thousandths of a cell when the triangles are slender: with
// 1.001, bars of more than 125 spacings kept the side of such a node across the face, and had holes.
constexpr float kStep = 1.1f; // cells

// Decides inside or outside along a walk from node to node. A step that cannot have crossed a triangle keeps the side;
// only steps near the surface pay for a winding number. With holes the number drifts also where there is no triangle,
// so a side is kept for three steps at most, and only where it was clear.
class SideWalk {
public:
    SideWalk(const TriangleTree& tree, bool watertight) : tree_(&tree), watertight_(watertight) {}

    bool inside(Vec3 p, float distance, float stepLength) {
        bool keep = known_ && distance + last_ > stepLength && (watertight_ || (clear_ && steps_ < 3));
        if (!keep) {
            float w = tree_->winding(p);
            inside_ = w > 0.5f, clear_ = std::abs(w - 0.5f) > 0.4f, steps_ = 0;
        }
        known_ = true, last_ = distance, ++steps_;
        return inside_;
    }

private:
    const TriangleTree* tree_;
    bool watertight_, known_ = false, inside_ = false, clear_ = false;
    float last_ = 0;
    int steps_ = 0;
};

// Signed distances of n nodes per axis from `first` on, exact up to the band and cut there; `at(x, y, z)` says where
// they go.
template <class At>
void fillNodes(const TriangleTree& tree, bool watertight, Vec3 first, float cell, int nx, int ny, int nz, float band,
               At&& at) {
    struct Start {
        SideWalk walk;
        uint32_t hint;
    };
    Start slab{SideWalk(tree, watertight), TriangleTree::kNoHint};
    for (int z = 0; z < nz; ++z) {
        Start row = slab;
        for (int y = 0; y < ny; ++y) {
            Start node = row;
            for (int x = 0; x < nx; ++x) {
                Vec3 p = first + Vec3{float(x) * cell, float(y) * cell, float(z) * cell};
                TriangleTree::Nearest near = tree.nearest(p, node.hint, band * band);
                float d = std::sqrt(near.distance2);
                if (near.distance2 < band * band) node.hint = near.triangle;
                *at(x, y, z) = node.walk.inside(p, d, cell * kStep) ? -d : d;
                if (x == 0) row = node;
                if (x == 0 && y == 0) slab = node;
            }
        }
    }
}

// Across a hole the side changes without a triangle nearby. There the level 0.5 of the winding number is the surface:
// its crossings with grid edges are carried to the nodes around by sweeping (Danielsson 1980) as further nearest
// points.
void closeHoles(DistanceGrid& grid, const TriangleTree& tree) {
    int n[3] = {grid.nx, grid.ny, grid.nz};
    size_t stride[3] = {1, size_t(grid.nx), size_t(grid.nx) * size_t(grid.ny)};
    auto position = [&](int x, int y, int z) {
        return grid.origin + Vec3{float(x) * grid.cell, float(y) * grid.cell, float(z) * grid.cell};
    };
    std::vector<Vec3> nearest;
    auto forNodes = [&](auto&& f) {
        for (int z = 0; z < n[2]; ++z)
            for (int y = 0; y < n[1]; ++y)
                for (int x = 0; x < n[0]; ++x) f(x, y, z, size_t(x) + size_t(y) * stride[1] + size_t(z) * stride[2]);
    };
    auto offer = [&](size_t i, Vec3 p, Vec3 seed) {
        Vec3 d = seed - p, old = nearest[i] - p;
        if (!(dot(old, old) <= dot(d, d))) nearest[i] = seed; // also when old is not finite
    };
    forNodes([&](int x, int y, int z, size_t i) {
        int at[3] = {x, y, z};
        for (int a = 0; a < 3; ++a) {
            if (at[a] + 1 >= n[a]) continue;
            float l = grid.values[i], r = grid.values[i + stride[a]];
            if ((l < 0) == (r < 0) || std::abs(l) + std::abs(r) <= 1.01f * grid.cell) continue;
            Vec3 p = position(x, y, z), q = position(x + (a == 0), y + (a == 1), z + (a == 2));
            float wp = tree.winding(p), wq = tree.winding(q);
            float t = wq != wp ? clampTo((0.5f - wp) / (wq - wp), 0, 1) : 0.5f;
            if (nearest.empty()) nearest.assign(grid.values.size(), {INFINITY, INFINITY, INFINITY});
            Vec3 seed = p + t * (q - p);
            offer(i, p, seed), offer(i + stride[a], q, seed);
        }
    });
    if (nearest.empty()) return;
    for (int sweep = 0; sweep < 8; ++sweep) {
        int from[3], step[3];
        for (int a = 0; a < 3; ++a) step[a] = (sweep >> a) & 1 ? -1 : 1, from[a] = step[a] > 0 ? 0 : n[a] - 1;
        for (int z = from[2]; z >= 0 && z < n[2]; z += step[2])
            for (int y = from[1]; y >= 0 && y < n[1]; y += step[1])
                for (int x = from[0]; x >= 0 && x < n[0]; x += step[0]) {
                    size_t i = size_t(x) + size_t(y) * stride[1] + size_t(z) * stride[2];
                    int at[3] = {x, y, z};
                    for (int a = 0; a < 3; ++a) {
                        if (at[a] == from[a]) continue;
                        size_t j = step[a] > 0 ? i - stride[a] : i + stride[a];
                        if (std::isfinite(nearest[j].x)) offer(i, position(x, y, z), nearest[j]);
                    }
                }
    }
    forNodes([&](int x, int y, int z, size_t i) {
        if (!std::isfinite(nearest[i].x)) return;
        float d = length(nearest[i] - position(x, y, z)), v = grid.values[i];
        if (d < std::abs(v)) grid.values[i] = v < 0 ? -d : d;
    });
}

} // namespace

float DistanceGrid::sample(Vec3 p, Vec3& gradient) const {
    gradient = {0, 1, 0};
    if (values.empty() || !isFinite(p)) return INFINITY;
    float inverse = 1 / cell;
    Vec3 u = inverse * (p - origin);
    Vec3 c{clampTo(u.x, 0, float(nx - 1)), clampTo(u.y, 0, float(ny - 1)), clampTo(u.z, 0, float(nz - 1))};
    int x = std::min(int(c.x), nx - 2), y = std::min(int(c.y), ny - 2), z = std::min(int(c.z), nz - 2);
    size_t dy = size_t(nx), dz = dy * size_t(ny);
    Vec3 g;
    float d = trilinear(&values[size_t(x) + size_t(y) * dy + size_t(z) * dz], dy, dz, c.x - float(x), c.y - float(y),
                        c.z - float(z), g);
    gradient = normalizeOr(g, gradient);
    Vec3 beyond = cell * (u - c);
    float outside2 = dot(beyond, beyond);
    if (outside2 > 0) {
        if (!std::isfinite(outside2)) { // so far that squares overflow
            float l = std::max(std::abs(beyond.x), std::max(std::abs(beyond.y), std::abs(beyond.z)));
            gradient = normalizeOr((1 / l) * beyond, gradient);
            return l;
        }
        // The estimated nearest point is d down the gradient from where p meets the box.
        Vec3 away = beyond + std::max(d, 0.0f) * gradient;
        gradient = normalizeOr(away, gradient);
        return length(away);
    }
    return d;
}

float DistanceGrid::sample(Vec3 p) const {
    Vec3 gradient;
    return sample(p, gradient);
}

DistanceGrid makeDistanceGrid(const CleanMesh& mesh, float cell, float margin, size_t maxNodes, Tasks& tasks) {
    DistanceGrid grid;
    if (mesh.indices.empty() || mesh.bounds.empty()) return grid;
    Vec3 size = mesh.bounds.upper - mesh.bounds.lower;
    float longest = std::max(size.x, std::max(size.y, size.z));
    margin = margin > 0 ? margin : 0;
    size = size + Vec3{2 * margin, 2 * margin, 2 * margin};
    maxNodes = std::min<size_t>(std::max<size_t>(maxNodes, 27), size_t(1) << 30);
    cell = std::max(cell, longest * 1e-4f); // also when cell is NaN or not above zero
    double counts[3];
    auto nodes = [&] {
        const double extent[3] = {size.x, size.y, size.z};
        double all = 1;
        for (int a = 0; a < 3; ++a) counts[a] = std::max(2.0, std::ceil(extent[a] / cell - 1e-4) + 1), all *= counts[a];
        return all;
    };
    while (nodes() > double(maxNodes)) cell *= 1.01f;
    grid.cell = cell;
    grid.nx = int(counts[0]), grid.ny = int(counts[1]), grid.nz = int(counts[2]);
    // What the whole cells have too much is shared by both sides.
    grid.origin = 0.5f * (mesh.bounds.lower + mesh.bounds.upper) -
                  0.5f * cell * Vec3{float(grid.nx - 1), float(grid.ny - 1), float(grid.nz - 1)};
    grid.values.resize(size_t(grid.nx) * size_t(grid.ny) * size_t(grid.nz));

    TriangleTree tree(mesh.vertices, mesh.indices);
    constexpr int kBlock = 8;
    int bx = (grid.nx + kBlock - 1) / kBlock, by = (grid.ny + kBlock - 1) / kBlock,
        bz = (grid.nz + kBlock - 1) / kBlock;
    tasks.forBlocks(bx * by * bz, 1, [&](int begin, int end, int, int) {
        for (int b = begin; b < end; ++b) {
            int x0 = b % bx * kBlock, y0 = b / bx % by * kBlock, z0 = b / (bx * by) * kBlock;
            Vec3 first = grid.origin + Vec3{float(x0) * cell, float(y0) * cell, float(z0) * cell};
            fillNodes(tree, mesh.watertight, first, cell, std::min(kBlock, grid.nx - x0),
                      std::min(kBlock, grid.ny - y0), std::min(kBlock, grid.nz - z0), INFINITY,
                      [&](int x, int y, int z) {
                          return &grid.values[size_t(x0 + x) +
                                              size_t(grid.nx) * (size_t(y0 + y) + size_t(grid.ny) * size_t(z0 + z))];
                      });
        }
    });
    if (!mesh.watertight) closeHoles(grid, tree);
    return grid;
}

namespace {

void brickCounts(const CleanMesh& mesh, float cell, float bandOutside, double counts[3]) {
    Vec3 size = mesh.bounds.upper - mesh.bounds.lower;
    const double extent[3] = {size.x, size.y, size.z};
    for (int a = 0; a < 3; ++a)
        counts[a] =
            std::max(1.0, std::ceil((extent[a] + 2 * double(bandOutside)) / (BrickGrid::kCells * double(cell))));
}

} // namespace

double brickCount(const CleanMesh& mesh, float cell, float bandOutside) {
    double counts[3];
    brickCounts(mesh, cell, bandOutside, counts);
    return counts[0] * counts[1] * counts[2];
}

BrickGrid makeBrickGrid(const CleanMesh& mesh, const TriangleTree& tree, float cell, float bandInside,
                        float bandOutside, Tasks& tasks) {
    BrickGrid grid;
    constexpr int kNodes = BrickGrid::kNodes;
    constexpr size_t kBrick = size_t(kNodes) * kNodes * kNodes;
    double counts[3];
    brickCounts(mesh, cell, bandOutside, counts);
    grid.nx = int(counts[0]), grid.ny = int(counts[1]), grid.nz = int(counts[2]);
    grid.cell = cell, grid.bandInside = bandInside, grid.bandOutside = bandOutside;
    float edge = cell * BrickGrid::kCells;
    grid.origin = 0.5f * (mesh.bounds.lower + mesh.bounds.upper) -
                  0.5f * edge * Vec3{float(grid.nx), float(grid.ny), float(grid.nz)};
    grid.bricks.resize(size_t(grid.nx) * size_t(grid.ny) * size_t(grid.nz));
    auto indexOf = [&](int x, int y, int z) {
        return size_t(x) + size_t(grid.nx) * (size_t(y) + size_t(grid.ny) * size_t(z));
    };

    // Groups of 4 x 4 x 4 bricks first: most of a large box is far from any surface.
    constexpr int kGroup = 4;
    constexpr int32_t kNear = 0;
    auto side = [&](Vec3 center, float halfDiagonal) {
        float d = std::sqrt(tree.nearest(center).distance2) - halfDiagonal;
        if (d <= std::min(bandInside, bandOutside)) return kNear;
        float w = tree.winding(center);
        if (!mesh.watertight && std::abs(w - 0.5f) < 0.35f) return kNear;
        if (w > 0.5f) return d > bandInside ? BrickGrid::kInside : kNear;
        return d > bandOutside ? BrickGrid::kOutside : kNear;
    };
    int gx = (grid.nx + kGroup - 1) / kGroup, gy = (grid.ny + kGroup - 1) / kGroup,
        gz = (grid.nz + kGroup - 1) / kGroup;
    tasks.forBlocks(gx * gy * gz, 1, [&](int begin, int end, int, int) {
        for (int g = begin; g < end; ++g) {
            int x0 = g % gx * kGroup, y0 = g / gx % gy * kGroup, z0 = g / (gx * gy) * kGroup;
            Vec3 center = grid.origin + edge * Vec3{float(x0 + 2), float(y0 + 2), float(z0 + 2)};
            int32_t all = side(center, 0.867f * kGroup * edge);
            for (int z = z0; z < std::min(z0 + kGroup, grid.nz); ++z)
                for (int y = y0; y < std::min(y0 + kGroup, grid.ny); ++y)
                    for (int x = x0; x < std::min(x0 + kGroup, grid.nx); ++x) {
                        Vec3 c = grid.origin + edge * Vec3{float(x) + 0.5f, float(y) + 0.5f, float(z) + 0.5f};
                        grid.bricks[indexOf(x, y, z)] = all != kNear ? all : side(c, 0.867f * edge);
                    }
        }
    });
    std::vector<uint32_t> where;
    for (size_t i = 0; i < grid.bricks.size(); ++i)
        if (grid.bricks[i] == kNear) grid.bricks[i] = int32_t(where.size()), where.push_back(uint32_t(i));
    grid.values.resize(where.size() * kBrick);
    tasks.forBlocks(int(where.size()), 1, [&](int begin, int end, int, int) {
        for (int k = begin; k < end; ++k) {
            uint32_t i = where[size_t(k)];
            int x = int(i % uint32_t(grid.nx)), y = int(i / uint32_t(grid.nx) % uint32_t(grid.ny)),
                z = int(i / uint32_t(grid.nx) / uint32_t(grid.ny));
            float* values = &grid.values[size_t(k) * kBrick];
            fillNodes(tree, mesh.watertight, grid.origin + edge * Vec3{float(x), float(y), float(z)}, cell, kNodes,
                      kNodes, kNodes, std::max(bandInside, bandOutside),
                      [&](int a, int b, int c) { return values + a + kNodes * (b + kNodes * c); });
        }
    });
    return grid;
}

float BrickGrid::sample(Vec3 p, Vec3& gradient) const {
    gradient = {};
    Vec3 u = (1 / cell) * (p - origin);
    float top[3] = {float(nx * kCells), float(ny * kCells), float(nz * kCells)};
    if (!(u.x >= 0 && u.y >= 0 && u.z >= 0 && u.x <= top[0] && u.y <= top[1] && u.z <= top[2])) return bandOutside;
    int x = std::min(int(u.x), nx * kCells - 1), y = std::min(int(u.y), ny * kCells - 1),
        z = std::min(int(u.z), nz * kCells - 1);
    int32_t brick = bricks[size_t(x / kCells) + size_t(nx) * (size_t(y / kCells) + size_t(ny) * size_t(z / kCells))];
    if (brick < 0) return brick == kInside ? -bandInside : bandOutside;
    const float* v = &values[size_t(brick) * size_t(kNodes * kNodes * kNodes)];
    v += x % kCells + kNodes * (y % kCells + kNodes * (z % kCells));
    float d = trilinear(v, kNodes, kNodes * kNodes, u.x - float(x), u.y - float(y), u.z - float(z), gradient);
    gradient = (1 / cell) * gradient;
    return d;
}

void DistanceGrid::state(StateIo& io) {
    io(origin, cell, nx, ny, nz);
    io.block(values, size_t{1} << 26);
    const auto side = [](int n) { return n >= 0 && n < 1 << 20; };
    if (io.restores() && !(side(nx) && side(ny) && side(nz) && cell >= 0 &&
                           static_cast<double>(nx) * ny * nz == static_cast<double>(values.size())))
        io.fail("a grid of another size");
}

} // namespace thaw
