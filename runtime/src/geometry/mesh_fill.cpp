// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Filling goes in four steps. Lengths are in units of the spacing from step 2 on.
//  1. Cubic lattice points in and around the mesh; the ones to keep are chosen by the share of their cell that is
//  inside,
//     dithered, so that every region gets the number of particles that its volume asks for.
//  2. Relaxation of the outer four layers: particles push each other with the gradient of the solver's kernel, the
//  missing
//     half space pushes back as if it were filled too, and nobody gets nearer to the surface than half a spacing.
//     (Packing by the kernel gradient: Colagrossi et al. 2012.) Deeper inside, the lattice stays.
//  3. Surface points with no particle nearby (corners, tips, parts thinner than a spacing) call the nearest particle or
//     get one of their own.
//  4. Pairs that stayed too close are pushed apart; of those that cannot be, one is taken out.
#include "geometry/mesh_fill.h"
#include "geometry/distance_grid.h"
#include "geometry/triangle_tree.h"

#include <algorithm>
#include <cstdio>

namespace thaw {

namespace {

constexpr float kSupport = 2.2f; // of the kernel, in spacings
constexpr float kDepth = 0.5f;   // of the outermost layer
constexpr float kMinDistance = 0.75f;
constexpr float kReach = 0.93f;                    // a surface point farther from all particles is bare
constexpr float kMoveAll = 3.0f, kMoveNone = 4.0f; // depth where mobility starts to fade, and where it is gone
constexpr float kBandInside = 1.8f, kBandOutside = 1.0f;
// Of a particle that was called to an edge or corner, which half a spacing along each face would leave 0.87 away.
constexpr float kCornerDepth = 0.42f;
constexpr float kEdgePitch = 0.92f; // least distance of two of them
constexpr float kLeastDepth = 0.3f; // where separating pairs may push a particle to
constexpr float kSkin = 0.4f;       // neighbour lists stay valid while nobody moved more than half of it
constexpr int kBlock = 512;

// Gradient of Wendland C2 (3D, support 2.2) per distance: dW/dr / r, negative.
inline float kernelSlope(float r) {
    constexpr float kSigma = 21.0f / (2 * 3.14159265f * kSupport * kSupport * kSupport);
    float q = r * (1 / kSupport), u = 1 - q;
    return -20 * kSigma / (kSupport * kSupport) * u * u * u;
}

// Push of ghost layers at depth -0.5, -1.5, ... on a particle at this depth. A plane of particles at distance z, one
// per unit area, pushes with -d/dz of the integral of W over it, which is 2 pi z W(z).
inline float wallPush(float depth) {
    constexpr float kPi = 3.14159265f, kSigma = 21.0f / (2 * kPi * kSupport * kSupport * kSupport);
    float push = 0;
    for (float z = depth + 0.5f; z < kSupport; z += 1) {
        float q = std::max(z, 0.0f) * (1 / kSupport), u = (1 - q) * (1 - q);
        push += 2 * kPi * z * kSigma * u * u * (4 * q + 1);
    }
    return push;
}

// Ordered dither in (0, 1), every 8 x 8 x 8 points of it spread evenly at all scales.
inline float dither(int x, int y, int z) {
    static const int kCorner[8] = {0, 5, 6, 3, 7, 2, 1, 4}; // opposite corners of a cube follow each other
    int value = 0;
    for (int bit = 0; bit < 3; ++bit)
        value = value * 8 + kCorner[((x >> bit) & 1) | ((y >> bit) & 1) << 1 | ((z >> bit) & 1) << 2];
    return (float(value) + 0.5f) / 512;
}

// Particles by cells of a regular grid.
struct Cells {
    Vec3 origin;
    float inverse = 1;
    int nx = 1, ny = 1, nz = 1;
    std::vector<uint32_t> start, items;

    int clampCell(float v, int n) const { return v > 0 ? std::min(int(v), n - 1) : 0; }
    size_t cellOf(Vec3 p) const {
        Vec3 u = inverse * (p - origin);
        return size_t(clampCell(u.x, nx)) +
               size_t(nx) * (size_t(clampCell(u.y, ny)) + size_t(ny) * size_t(clampCell(u.z, nz)));
    }
    void build(const std::vector<Vec3>& points, float size) {
        Box box;
        for (Vec3 p : points) box.grow(p);
        if (points.empty()) box.grow({});
        Vec3 e = box.upper - box.lower;
        // Thin things in large boxes: cells grow rather than fill the memory.
        double limit = 4.0 * double(points.size()) + 4096;
        for (;; size *= 1.26f) {
            double x = std::floor(e.x / size) + 1, y = std::floor(e.y / size) + 1, z = std::floor(e.z / size) + 1;
            nx = int(std::min(x, 1e6)), ny = int(std::min(y, 1e6)), nz = int(std::min(z, 1e6));
            if (x * y * z <= limit) break;
        }
        origin = box.lower, inverse = 1 / size;
        start.assign(size_t(nx) * size_t(ny) * size_t(nz) + 1, 0), items.resize(points.size());
        for (Vec3 p : points) ++start[cellOf(p) + 1];
        for (size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
        std::vector<uint32_t> at(start.begin(), start.end() - 1);
        for (uint32_t i = 0; i < points.size(); ++i) items[at[cellOf(points[i])]++] = i;
    }
    // Calls f(index) for everything in cells that touch the ball.
    template <class F> void forNear(Vec3 p, float radius, F&& f) const {
        Vec3 lo = inverse * (p - origin - Vec3{radius, radius, radius}),
             hi = inverse * (p - origin + Vec3{radius, radius, radius});
        int x0 = clampCell(lo.x, nx), x1 = clampCell(hi.x, nx);
        for (int z = clampCell(lo.z, nz); z <= clampCell(hi.z, nz); ++z)
            for (int y = clampCell(lo.y, ny); y <= clampCell(hi.y, ny); ++y) {
                size_t row = size_t(nx) * (size_t(y) + size_t(ny) * size_t(z));
                for (uint32_t k = start[row + size_t(x0)]; k < start[row + size_t(x1) + 1]; ++k) f(items[k]);
            }
    }
};

struct Filler {
    const CleanMesh& mesh;
    float spacing;
    Tasks& tasks;
    TriangleTree tree;
    BrickGrid grid;
    Vec3 center;              // local = (world - center) / spacing
    std::vector<Vec3> points; // local
    std::vector<Vec3> next;
    std::vector<float> mobility; // 1 near the surface, 0 deep inside
    size_t pinned = 0;           // the first ones: on sharp edges
    size_t inserted = 0;
    Vec3 firstPlane, planeStep{1, 1, 1}; // of the last lattice, local

    Filler(const CleanMesh& m, float s, Tasks& t) : mesh(m), spacing(s), tasks(t), tree(m.vertices, m.indices) {
        center = 0.5f * (mesh.bounds.lower + mesh.bounds.upper);
        grid = makeBrickGrid(mesh, tree, cellSize(mesh, spacing), kBandInside * spacing, kBandOutside * spacing, tasks);
    }

    // Half a spacing resolves everything that holds a layer of particles; sheets and wicks need their own thickness.
    static float cellSize(const CleanMesh& mesh, float spacing) {
        double thickness = 2 * mesh.report.volume / std::max(mesh.report.area, 1e-30);
        return std::min(0.5f, std::max(0.1f, float(thickness / double(spacing)) * 0.25f)) * spacing;
    }

    // In spacings; gradient points up the distance, to the surface.
    float depthAt(Vec3 p, Vec3& gradient) const { return -grid.sample(center + spacing * p, gradient) / spacing; }

    // Chooses how many lattice planes per axis: when the box of the mesh can be divided evenly without changing the
    // density by more than 1 %, it is, and boxes get perfect layers.
    // whole: no point outside, as a lattice of whole layers has none; one chosen there leaves a hole inside.
    void makeLattice(size_t count, bool whole) {
        Vec3 size = (1 / spacing) * (mesh.bounds.upper - mesh.bounds.lower);
        const float extent[3] = {size.x, size.y, size.z};
        float step[3] = {1, 1, 1}, best = 0.01f;
        for (int choice = 0; choice < 8; ++choice) {
            float s[3], density = 1;
            bool good = true;
            for (int a = 0; a < 3; ++a) {
                float planes = std::floor(extent[a]) + float((choice >> a) & 1);
                good = good && planes >= 1;
                s[a] = extent[a] / std::max(planes, 1.0f);
                good = good && std::abs(s[a] - 1) < 0.06f;
                density *= s[a];
            }
            if (good && std::abs(density - 1) < best) best = std::abs(density - 1), std::copy(s, s + 3, step);
        }
        int n[3];
        float first[3];
        for (int a = 0; a < 3; ++a) {
            n[a] = std::max(1, int(std::lround(extent[a] / step[a])));
            first[a] = -0.5f * float(n[a] - 1) * step[a];
            n[a] += 2, first[a] -= step[a]; // one more on both sides, for what the rounding left
        }
        planeStep = {step[0], step[1], step[2]};
        firstPlane = {first[0] + step[0], first[1] + step[1], first[2] + step[2]};
        struct Candidate {
            Vec3 p;
            float key;
        };
        Cells cells; // of the particles on edges: they push lattice points out of their place
        cells.build(points, 1);
        auto occupied = [&](Vec3 p) {
            bool found = false;
            cells.forNear(p, 0.7f, [&](uint32_t j) {
                Vec3 d = points[j] - p;
                found |= dot(d, d) < 0.7f * 0.7f;
            });
            return found;
        };
        count -= std::min(count, pinned);
        std::vector<std::vector<Candidate>> slabs(static_cast<size_t>(n[2]));
        tasks.forBlocks(n[2], 1, [&](int begin, int end, int, int) {
            for (int z = begin; z < end; ++z)
                for (int y = 0; y < n[1]; ++y)
                    for (int x = 0; x < n[0]; ++x) {
                        Vec3 p{first[0] + float(x) * step[0], first[1] + float(y) * step[1],
                               first[2] + float(z) * step[2]},
                            g;
                        float d = depthAt(p, g);
                        if (whole && d <= 0) continue;
                        // A plane at distance d cuts a cell of edge 1; across a diagonal it reaches further than 0.5.
                        float reach = 0.5f * (std::abs(g.x) + std::abs(g.y) + std::abs(g.z));
                        float share = reach > 0.25f ? 0.5f + 0.5f * d / reach : d > 0 ? 1.0f : 0.0f;
                        if (d > 0.45f) share = 1; // a place for the outermost layer, also at an edge
                        if (share > 0.02f && !(d < 1.5f && occupied(p)))
                            slabs[size_t(z)].push_back({p, std::min(share, 1.0f) - dither(x, y, z)});
                    }
        });
        std::vector<Candidate> all;
        for (auto& slab : slabs) all.insert(all.end(), slab.begin(), slab.end());
        std::vector<uint32_t> order(all.size());
        for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
        count = std::min(count, order.size());
        if (count < order.size())
            std::nth_element(
                order.begin(), order.begin() + std::ptrdiff_t(count), order.end(),
                [&](uint32_t l, uint32_t r) { return all[l].key != all[r].key ? all[l].key > all[r].key : l < r; });
        order.resize(count);
        std::sort(order.begin(), order.end());
        for (uint32_t i : order) points.push_back(all[i].p);
        makeMobility();
    }

    // Of a point that is inside.
    float exactDepth(Vec3 p) const { return std::sqrt(tree.nearest(center + spacing * p).distance2) / spacing; }

    // Gradient of the depth over 0.4 around p: where the nearest face changes (corners, edges) it points between the
    // faces.
    Vec3 wideGradient(Vec3 p) const {
        constexpr float kWide = 0.4f;
        Vec3 g;
        auto slope = [&](Vec3 e) { return (depthAt(p + e, g) - depthAt(p - e, g)) / (2 * kWide); };
        return {-slope({kWide, 0, 0}), -slope({0, kWide, 0}), -slope({0, 0, kWide})};
    }

    // Moves p inward until it is `target` deep, or as deep as it gets where the part is thinner.
    Vec3 sink(Vec3 p, float target) const {
        Vec3 g;
        float d = depthAt(p, g);
        auto climb = [&] { // one step down the distance, halved until it helps
            float slope2 = dot(g, g);
            if (slope2 < 0.04f) return false; // the middle of a thin part
            float l = std::sqrt(slope2), step = std::min((target - d) / std::max(l, 0.5f), 0.7f);
            for (int half = 0; half < 3; ++half, step *= 0.5f) {
                Vec3 to = p - (step / l) * g, gTo;
                float dTo = depthAt(to, gTo);
                if (dTo > d + 1e-4f) return p = to, d = dTo, g = gTo, true;
            }
            return false;
        };
        for (int i = 0; i < 6 && d < target; ++i) {
            if (climb()) continue;
            g = wideGradient(p);
            if (!climb()) break;
        }
        return p;
    }

    // From where each lattice point starts: by the exact distance, since the bricks know only the outermost layers.
    void makeMobility() {
        mobility.resize(points.size());
        tasks.forBlocks(int(points.size() - pinned), kBlock, [&](int begin, int end, int, int) {
            uint32_t hint = TriangleTree::kNoHint;
            for (int i = begin; i < end; ++i) {
                size_t k = pinned + size_t(i);
                Vec3 g, p = points[k];
                float d = depthAt(p, g);
                if (d > 0.9f * kBandInside) {
                    TriangleTree::Nearest near = tree.nearest(center + spacing * p, hint);
                    hint = near.triangle, d = std::sqrt(near.distance2) / spacing;
                }
                mobility[k] = std::min(1.0f, std::max(0.0f, (kMoveNone - d) / (kMoveNone - kMoveAll)));
            }
        });
    }

    struct Lists {
        std::vector<uint32_t> who;   // particles that move
        std::vector<float> mobility; // of each of them
        std::vector<uint32_t> start, neighbors;
        std::vector<Vec3> made; // positions then
    };

    void makeLists(Lists& lists, float radius) {
        lists.who.clear(), lists.mobility.clear(), lists.made = points;
        for (uint32_t i = 0; i < points.size(); ++i)
            if (mobility[i] > 0) lists.who.push_back(i), lists.mobility.push_back(mobility[i]);
        Cells cells;
        cells.build(points, 0.5f * radius);
        int count = int(lists.who.size()), blocks = Tasks::blockCount(count, kBlock);
        lists.start.assign(size_t(count) + 1, 0);
        std::vector<std::vector<uint32_t>> found(static_cast<size_t>(blocks));
        tasks.forBlocks(count, kBlock, [&](int begin, int end, int block, int) {
            std::vector<uint32_t>& list = found[size_t(block)];
            for (int k = begin; k < end; ++k) {
                uint32_t i = lists.who[size_t(k)];
                Vec3 p = points[i];
                cells.forNear(p, radius, [&](uint32_t j) {
                    Vec3 d = points[j] - p;
                    if (j != i && dot(d, d) < radius * radius) list.push_back(j), ++lists.start[size_t(k) + 1];
                });
            }
        });
        for (size_t k = 1; k < lists.start.size(); ++k) lists.start[k] += lists.start[k - 1];
        lists.neighbors.clear();
        for (auto& list : found) lists.neighbors.insert(lists.neighbors.end(), list.begin(), list.end());
    }

    // One Jacobi sweep; returns how far the farthest is from where the lists were made. separate: only pairs closer
    // than that are pushed, none other.
    float sweep(const Lists& lists, float rate, float limit, float separate) {
        next = points;
        int count = int(lists.who.size());
        std::vector<float> farthest(size_t(Tasks::blockCount(count, kBlock)), 0.0f);
        tasks.forBlocks(count, kBlock, [&](int begin, int end, int block, int) {
            for (int k = begin; k < end; ++k) {
                uint32_t i = lists.who[size_t(k)];
                Vec3 p = points[i], push;
                for (uint32_t n = lists.start[size_t(k)]; n < lists.start[size_t(k) + 1]; ++n) {
                    Vec3 d = p - points[lists.neighbors[n]];
                    float r2 = dot(d, d);
                    if (separate > 0) {
                        if (r2 >= separate * separate) continue;
                        float r = std::sqrt(r2);
                        push += r > 1e-6f ? 0.5f * (separate - r) / r * d : Vec3{};
                    } else if (r2 < kSupport * kSupport) {
                        float r = std::sqrt(r2), f = -kernelSlope(r);
                        // The slope of the kernel vanishes toward r = 0; this keeps pairs from forming.
                        if (r < 1) f += 0.35f * (1 - r) / std::max(r, 0.05f);
                        push += f * d;
                    }
                }
                Vec3 g;
                if (separate <= 0) {
                    float depth = depthAt(p, g);
                    if (depth < kSupport) push += -wallPush(depth) * normalizeOr(g, {});
                }
                push = rate * lists.mobility[size_t(k)] * push;
                float l = length(push);
                if (l > limit) push = (limit / l) * push;
                Vec3 to = sink(p + push, separate > 0 ? kLeastDepth : kDepth);
                next[i] = to;
                farthest[size_t(block)] = std::max(farthest[size_t(block)], length(to - lists.made[i]));
            }
        });
        points.swap(next);
        float most = 0;
        for (float f : farthest) most = std::max(most, f);
        return most;
    }

    void relax(int sweeps, float rate, float separate) {
        Lists lists;
        float moved = kSkin, radius = (separate > 0 ? separate : kSupport) + kSkin;
        for (int s = 0; s < sweeps; ++s) {
            if (moved >= 0.5f * kSkin) makeLists(lists, radius);
            // Long steps first, then short ones: with constant ones the layers keep swinging.
            float fade = 1 - float(s) / float(sweeps);
            moved = sweep(lists, rate * (0.4f + 0.6f * fade), 0.02f + 0.13f * fade, separate);
        }
    }

    struct Sample {
        Vec3 p, normal; // local
    };

    // Evenly spread over the surface: large triangles get rows of points from edge to edge, so that corners are there,
    // of small ones every few get one.
    std::vector<Sample> surfaceSamples() const {
        double area = mesh.report.area / (double(spacing) * spacing), each = std::max(0.16, area / 4e6),
               carry = 0.5 * each;
        float pitch = 0.5f * std::sqrt(float(each)); // of the rows: edges are divided by it
        std::vector<Sample> samples;
        samples.reserve(size_t(area / each) + 16);
        for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
            Vec3 v[3];
            for (size_t k = 0; k < 3; ++k) v[k] = (1 / spacing) * (mesh.vertices[mesh.indices[t + k]] - center);
            Vec3 n = cross(v[1] - v[0], v[2] - v[0]);
            double own = 0.5 * double(length(n));
            n = normalizeOr(n, {0, 1, 0});
            if (own <= each) {
                carry += own;
                if (carry >= each) carry -= each, samples.push_back({(1.0f / 3) * (v[0] + v[1] + v[2]), n});
                continue;
            }
            int base = 0; // the longest edge runs from corner base to the next
            for (int k = 1; k < 3; ++k)
                if (length(v[(k + 1) % 3] - v[k]) > length(v[(base + 1) % 3] - v[base])) base = k;
            Vec3 a = v[base], b = v[(base + 1) % 3], c = v[(base + 2) % 3];
            int rows = std::max(1, int(std::ceil(2 * float(own) / length(b - a) / pitch)));
            for (int j = 0; j <= rows; ++j) {
                float f = float(j) / float(rows);
                Vec3 from = a + f * (c - a), to = b + f * (c - b);
                int steps = std::max(1, int(std::ceil(length(to - from) / pitch)));
                for (int i = 0; i <= steps; ++i) samples.push_back({from + (float(i) / float(steps)) * (to - from), n});
            }
        }
        return samples;
    }

    // Particles along sharp edges and in corners come first and stay: relaxation alone leaves holes there, since a
    // planar wall is not what is missing at an edge. Corners before edges, so that edges are divided from their ends.
    void placeOnEdges(const std::vector<Sample>& samples) {
        constexpr float kSharp =
            0.55f; // from the surface point to the place below it; on a smooth surface kCornerDepth
        struct Place {
            Vec3 p;
            int rank;
        };
        std::vector<Place> places(samples.size());
        tasks.forBlocks(int(samples.size()), kBlock, [&](int begin, int end, int, int) {
            for (int i = begin; i < end; ++i) {
                const Sample& sample = samples[size_t(i)];
                Vec3 g, p = sink(sample.p - 0.02f * sample.normal, kCornerDepth);
                float far = length(p - sample.p);
                if (far > kSharp) { // the bricks round corners off: back toward the corner as far as it goes
                    float in = 0, out = 1;
                    for (int k = 0; k < 6; ++k) {
                        float t = 0.5f * (in + out);
                        (exactDepth(p + t * (sample.p - p)) >= kCornerDepth ? in : out) = t;
                    }
                    p = p + in * (sample.p - p);
                    far = length(p - sample.p);
                }
                bool good = far > kSharp && far < 1.2f && exactDepth(p) > 0.9f * kCornerDepth && depthAt(p, g) > 0.1f;
                places[size_t(i)] = {p, good ? int(far * 32) : -1};
            }
        });
        std::vector<uint32_t> order;
        for (uint32_t i = 0; i < places.size(); ++i)
            if (places[i].rank >= 0) order.push_back(i);
        std::sort(order.begin(), order.end(), [&](uint32_t l, uint32_t r) {
            return places[l].rank != places[r].rank ? places[l].rank > places[r].rank : l < r;
        });
        std::vector<Vec3> candidates(order.size());
        for (size_t k = 0; k < order.size(); ++k) candidates[k] = places[order[k]].p;
        Cells cells;
        cells.build(candidates, 1);
        std::vector<uint8_t> taken(candidates.size(), 0);
        for (uint32_t k = 0; k < candidates.size(); ++k) {
            bool free = true;
            cells.forNear(candidates[k], kEdgePitch, [&](uint32_t j) {
                Vec3 d = candidates[j] - candidates[k];
                if (taken[j] && dot(d, d) < kEdgePitch * kEdgePitch) free = false;
            });
            taken[k] = free;
            if (free) points.push_back(candidates[k]), mobility.push_back(0);
        }
        pinned = points.size();
    }

    std::vector<uint8_t> findBare(const std::vector<Sample>& samples, const Cells& cells, float reach) const {
        std::vector<uint8_t> bare(samples.size());
        tasks.forBlocks(int(samples.size()), kBlock, [&](int begin, int end, int, int) {
            for (int i = begin; i < end; ++i) {
                bool covered = false;
                Vec3 p = samples[size_t(i)].p;
                cells.forNear(p, reach, [&](uint32_t j) {
                    Vec3 d = points[j] - p;
                    covered |= dot(d, d) < reach * reach;
                });
                bare[size_t(i)] = !covered;
            }
        });
        return bare;
    }

    // A lattice that meets every face at half a spacing, as in a box of whole layers, is left alone.
    bool perfect(const std::vector<Sample>& samples) const {
        for (Vec3 p : points) {
            Vec3 g;
            if (depthAt(p, g) < kDepth - 0.05f && exactDepth(p) < kDepth - 0.05f) return false;
        }
        Cells cells;
        cells.build(points, 1);
        std::vector<uint8_t> bare = findBare(samples, cells, kReach);
        return std::find(bare.begin(), bare.end(), uint8_t(1)) == bare.end();
    }

    // One round over the surface points that have no particle within `reach`: the nearest particle is called, or one is
    // added. Returns how many there were.
    size_t cover(const std::vector<Sample>& samples, float reach) {
        // An inserted particle is at least this far from all others. In a sheet that is thinner than two layers there
        // is no room to push the others away to.
        const float room = grid.cell < 0.499f * spacing ? 0.8f : 0.7f;
        Cells cells;
        cells.build(points, 1);
        std::vector<uint8_t> bare = findBare(samples, cells, reach);
        constexpr uint32_t kNone = 0xffffffffu;
        size_t old = points.size(), count = 0;
        std::vector<uint32_t> head, link; // the added ones by cell
        std::vector<uint8_t> called(old, 0);
        auto nearestTo = [&](Vec3 p, float radius, float& distance) {
            uint32_t best = kNone;
            float best2 = radius * radius;
            auto look = [&](uint32_t j) {
                Vec3 d = points[j] - p;
                float d2 = dot(d, d);
                if (d2 < best2 || (d2 == best2 && j < best)) best2 = d2, best = j;
            };
            cells.forNear(p, radius, look);
            if (!head.empty()) {
                int reachCells = int(std::ceil(radius * cells.inverse));
                for (int z = -reachCells; z <= reachCells; ++z)
                    for (int y = -reachCells; y <= reachCells; ++y)
                        for (int x = -reachCells; x <= reachCells; ++x) {
                            Vec3 u = cells.inverse * (p - cells.origin) + Vec3{float(x), float(y), float(z)};
                            if (u.x <= -1 || u.y <= -1 || u.z <= -1) continue;
                            size_t c = size_t(cells.clampCell(u.x, cells.nx)) +
                                       size_t(cells.nx) * (size_t(cells.clampCell(u.y, cells.ny)) +
                                                           size_t(cells.ny) * size_t(cells.clampCell(u.z, cells.nz)));
                            for (uint32_t j = head[c]; j != kNone; j = link[j - old]) look(j);
                        }
            }
            distance = std::sqrt(best2);
            return best;
        };
        for (size_t i = 0; i < samples.size(); ++i) {
            if (!bare[i]) continue;
            ++count;
            float distance;
            if (nearestTo(samples[i].p, reach, distance) != kNone) continue;
            Vec3 g, place = sink(samples[i].p - 0.05f * samples[i].normal, kCornerDepth);
            if (depthAt(place, g) < 0.02f) continue;
            uint32_t j = nearestTo(place, 2, distance);
            if (j == kNone || distance >= room) {
                if (head.empty()) head.assign(cells.start.size() - 1, kNone);
                uint32_t k = uint32_t(points.size());
                size_t c = cells.cellOf(place);
                points.push_back(place), mobility.push_back(1), link.push_back(head[c]), head[c] = k;
                ++inserted;
            } else if (j < old && !called[j] && mobility[j] > 0) {
                called[j] = 1, points[j] = sink(points[j] + 0.6f * (place - points[j]), kDepth);
            }
        }
        return count;
    }

    // Takes out what is not inside after all, and one of each pair that is too close: the later one.
    void prune() {
        std::vector<uint8_t> drop(points.size(), 0);
        tasks.forBlocks(int(points.size()), kBlock, [&](int begin, int end, int, int) {
            for (int i = begin; i < end; ++i) {
                Vec3 g, p = points[size_t(i)];
                float d = depthAt(p, g);
                if (d < 0.3f) drop[size_t(i)] = tree.winding(center + spacing * p) <= 0.5f;
            }
        });
        Cells cells;
        cells.build(points, 1);
        for (uint32_t i = 0; i < points.size(); ++i) {
            if (drop[i]) continue;
            cells.forNear(points[i], kMinDistance, [&](uint32_t j) {
                Vec3 d = points[j] - points[i];
                if (j < i && !drop[j] && dot(d, d) < 1.01f * kMinDistance * kMinDistance) drop[i] = 1;
            });
        }
        size_t kept = 0;
        for (size_t i = 0; i < points.size(); ++i)
            if (!drop[i]) points[kept++] = points[i];
        points.resize(kept);
    }
};

std::string number(const char* text, double a, double b) {
    char buffer[256];
    std::snprintf(buffer, sizeof buffer, text, a, b);
    return buffer;
}

} // namespace

thawResult fillMesh(const CleanMesh& mesh, float spacing, int maxParticles, Tasks& tasks, std::vector<Vec3>& out,
                    float& particleVolume, std::string& message, FillLattice* lattice) {
    out.clear(), message.clear(), particleVolume = 0;
    if (!(spacing > 0) || !std::isfinite(spacing)) {
        message = number("spacing = %g m must be > 0", double(spacing), 0);
        return thawResult_invalidArgument;
    }
    double volume = mesh.report.volume, cell = double(spacing) * spacing * spacing, expected = volume / cell;
    if (mesh.indices.empty() || !(expected >= 0.4)) {
        message = number("nothing fits: the mesh encloses %.3g m^3, a particle at this spacing (%g m) fills ", volume,
                         double(spacing)) +
                  number("%.3g m^3", cell, 0);
        return thawResult_badMesh;
    }
    auto tooMany = [&](double count) {
        message = number("mesh needs %.0f particles, but only %.0f are free", count, double(maxParticles)) +
                  number(" (volume %.3g m^3 at spacing %g m)", volume, double(spacing));
        return thawResult_capacity;
    };
    if (expected > 1.02 * double(maxParticles) + 1) return tooMany(std::round(expected));
    // 2^27 bricks are 512 MB of table, a cube of 2000 spacings.
    if (brickCount(mesh, Filler::cellSize(mesh, spacing), kBandOutside * spacing) > double(1 << 27)) {
        message = number("mesh is too large for its spacing: %.3g spacings of %g m",
                         double(length(mesh.bounds.upper - mesh.bounds.lower)) / double(spacing), double(spacing));
        return thawResult_capacity;
    }
    Filler fill(mesh, spacing, tasks);
    size_t count = size_t(std::max(1.0, std::round(expected)));
    std::vector<Filler::Sample> samples = fill.surfaceSamples();
    fill.makeLattice(count, true);
    if (!fill.perfect(samples)) {
        fill.points.clear(), fill.mobility.clear();
        fill.placeOnEdges(samples);
        fill.makeLattice(count, false);
        fill.relax(36, 0.5f, 0);
        for (int round = 0; round < 4; ++round) {
            if (fill.cover(samples, kReach) == 0) break;
            fill.relax(4, 0.5f, 0.9f);
        }
        fill.relax(8, 0.7f, 0.85f);
    }
    fill.prune();
    if (fill.points.empty()) {
        message = number("nothing fits: the mesh encloses %.3g m^3, but is thinner than its spacing of %g m everywhere",
                         volume, double(spacing));
        return thawResult_badMesh;
    }
    if (fill.points.size() > size_t(std::max(maxParticles, 0))) return tooMany(double(fill.points.size()));
    Cells cells;
    cells.build(fill.points, 1);
    std::vector<uint8_t> bare = fill.findBare(samples, cells, 1.5f);
    double thin = double(std::count(bare.begin(), bare.end(), uint8_t(1))) / double(std::max<size_t>(bare.size(), 1));
    if (thin > 0)
        message = number("%.2g %% of the surface belongs to parts that are too thin to hold a particle at spacing %g m",
                         100 * thin, double(spacing));
    for (Vec3 p : fill.points) out.push_back(fill.center + spacing * p);
    particleVolume = float(volume / double(out.size()));
    if (lattice) *lattice = {fill.center + spacing * fill.firstPlane, spacing * fill.planeStep, spacing};
    return thawResult_ok;
}

} // namespace thaw
