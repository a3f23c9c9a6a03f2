// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "geometry/mesh_fill.h"
#include "geometry/triangle_tree.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

namespace thaw {

namespace {

constexpr size_t kMaxVertices = 50000000, kMaxTriangles = 100000000;
constexpr float kMaxCoordinate = 1e4f; // m
constexpr uint32_t kNone = 0xffffffffu;

__attribute__((format(printf, 1, 2))) std::string format(const char* text, ...) {
    char buffer[512];
    va_list list;
    va_start(list, text);
    std::vsnprintf(buffer, sizeof buffer, text, list);
    va_end(list);
    return buffer;
}

char axisName(Vec3 v, bool (*bad)(float)) { return bad(v.x) ? 'x' : bad(v.y) ? 'y' : 'z'; }
float axisValue(Vec3 v, char axis) { return axis == 'x' ? v.x : axis == 'y' ? v.y : v.z; }

struct Dvec {
    double x = 0, y = 0, z = 0;
};
Dvec operator-(Dvec a, Dvec b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Dvec toDouble(Vec3 v) { return {v.x, v.y, v.z}; }
Dvec cross(Dvec a, Dvec b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
double dot(Dvec a, Dvec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

double triangleArea(Vec3 a, Vec3 b, Vec3 c) {
    Dvec n = cross(toDouble(b) - toDouble(a), toDouble(c) - toDouble(a));
    return 0.5 * std::sqrt(dot(n, n));
}
// Signed volume of the tetrahedron with the apex o.
double apexVolume(Dvec o, Vec3 a, Vec3 b, Vec3 c) {
    return dot(toDouble(a) - o, cross(toDouble(b) - o, toDouble(c) - o)) / 6;
}

struct Cleaner {
    const thawMesh& mesh;
    const Transform& to;
    CleanMesh& out;
    std::string& message;

    std::vector<uint32_t>& tri = out.indices;
    thawMeshReport& report = out.report;
    std::vector<uint32_t> patch;    // of each triangle: pieces joined by edges of exactly two triangles
    std::vector<uint8_t> patchOpen; // of each patch: an edge of it has no partner
    std::vector<uint8_t> flipped;   // of each triangle, against the input

    Cleaner(const thawMesh& m, const Transform& t, CleanMesh& o, std::string& text)
        : mesh(m), to(t), out(o), message(text) {}

    thawResult fail(thawResult result, std::string text) {
        message = std::move(text);
        return result;
    }

    thawResult checkInput() {
        if (mesh.triangleCount == 0) return fail(thawResult_badMesh, "mesh has no triangles (triangleCount = 0)");
        if (mesh.vertexCount == 0) return fail(thawResult_badMesh, "mesh has no vertices (vertexCount = 0)");
        if (!mesh.vertices) return fail(thawResult_invalidArgument, "mesh.vertices is NULL");
        if (!mesh.indices) return fail(thawResult_invalidArgument, "mesh.indices is NULL");
        if (mesh.vertexCount > kMaxVertices)
            return fail(thawResult_invalidArgument,
                        format("mesh.vertexCount = %zu is more than %zu", mesh.vertexCount, kMaxVertices));
        if (mesh.triangleCount > kMaxTriangles)
            return fail(thawResult_invalidArgument,
                        format("mesh.triangleCount = %zu is more than %zu", mesh.triangleCount, kMaxTriangles));
        if (!isFinite(to.position)) return fail(thawResult_invalidArgument, "position of the mesh is not finite");
        if (!std::isfinite(to.scale) || to.scale <= 0)
            return fail(thawResult_invalidArgument, format("scale of the mesh = %g must be > 0", double(to.scale)));
        Quat q = to.rotation;
        double n = double(q.x) * q.x + double(q.y) * q.y + double(q.z) * q.z + double(q.w) * q.w;
        if (!std::isfinite(n) || n < 1e-12)
            return fail(thawResult_invalidArgument, "rotation of the mesh is no unit quaternion");
        for (size_t i = 0; i < 3 * mesh.triangleCount; ++i)
            if (mesh.indices[i] >= mesh.vertexCount)
                return fail(thawResult_invalidArgument,
                            format("index %zu names vertex %u of %zu", i, mesh.indices[i], mesh.vertexCount));
        for (size_t i = 0; i < mesh.vertexCount; ++i) {
            Vec3 v{mesh.vertices[3 * i], mesh.vertices[3 * i + 1], mesh.vertices[3 * i + 2]};
            if (!isFinite(v)) {
                char axis = axisName(v, [](float x) { return !std::isfinite(x); });
                double value = axisValue(v, axis); // printf writes the sign of a NaN, which means nothing
                return fail(thawResult_invalidArgument, format("vertex %zu is not finite (%c = %g)", i, axis,
                                                               std::isnan(value) ? std::abs(value) : value));
            }
        }
        return thawResult_ok;
    }

    // Rotates and scales in double, so that the only rounding is the last one.
    thawResult place(std::vector<Vec3>& placed) {
        Quat q = to.rotation;
        double n = std::sqrt(double(q.x) * q.x + double(q.y) * q.y + double(q.z) * q.z + double(q.w) * q.w);
        double x = q.x / n, y = q.y / n, z = q.z / n, w = q.w / n, s = to.scale;
        double m[3][3] = {{s * (1 - 2 * (y * y + z * z)), s * 2 * (x * y - z * w), s * 2 * (x * z + y * w)},
                          {s * 2 * (x * y + z * w), s * (1 - 2 * (x * x + z * z)), s * 2 * (y * z - x * w)},
                          {s * 2 * (x * z - y * w), s * 2 * (y * z + x * w), s * (1 - 2 * (x * x + y * y))}};
        std::vector<uint8_t> used(mesh.vertexCount, 0);
        for (size_t i = 0; i < 3 * mesh.triangleCount; ++i) used[mesh.indices[i]] = 1;
        placed.resize(mesh.vertexCount);
        Box box;
        for (size_t i = 0; i < mesh.vertexCount; ++i) {
            if (!used[i]) continue;
            double v[3] = {mesh.vertices[3 * i], mesh.vertices[3 * i + 1], mesh.vertices[3 * i + 2]};
            double p[3] = {to.position.x, to.position.y, to.position.z};
            for (int r = 0; r < 3; ++r)
                for (int c = 0; c < 3; ++c) p[r] += m[r][c] * v[c];
            placed[i] = {float(p[0]) + 0.0f, float(p[1]) + 0.0f, float(p[2]) + 0.0f};
            auto bad = [](float a) { return !(std::abs(a) <= kMaxCoordinate); };
            if (bad(placed[i].x) || bad(placed[i].y) || bad(placed[i].z)) {
                char axis = axisName(placed[i], bad);
                return fail(thawResult_invalidArgument,
                            format("vertex %zu lies at %c = %g m; coordinates may be at most %g m", i, axis,
                                   p[axis - 'x'], double(kMaxCoordinate)));
            }
            box.grow(placed[i]);
        }
        out.bounds = box;
        float far = 0, size = 0;
        for (int a = 0; a < 3; ++a) {
            char axis = char('x' + a);
            float lower = axisValue(box.lower, axis), upper = axisValue(box.upper, axis);
            far = std::max(far, std::max(std::abs(lower), std::abs(upper))), size = std::max(size, upper - lower);
        }
        if (size == 0) return fail(thawResult_badMesh, "all vertices of the mesh are at one point");
        // 256 steps across the longest side: fewer than that and float itself is the shape.
        if (double(size) < 256 * double(far) * 1.2e-7)
            return fail(thawResult_badMesh,
                        format("mesh is %g m large but lies %g m from the origin, where float resolves "
                               "only %.2g m",
                               double(size), double(far), double(far) * 1.2e-7));
        weld(placed, used, size, far);
        return thawResult_ok;
    }

    // Welds what is closer than 1e-6 of the size (or two steps of float), first come first kept. Cells of 16
    // tolerances: nearly every vertex has to look into one cell only.
    void weld(const std::vector<Vec3>& placed, const std::vector<uint8_t>& used, float size, float far) {
        double tolerance = std::max(1e-6 * size, 2.4e-7 * far), cell = 16 * tolerance;
        size_t table = 16;
        while (table < 2 * mesh.vertexCount) table *= 2;
        std::vector<uint32_t> head(table, kNone), next, remap(mesh.vertexCount, kNone);
        auto slot = [&](int64_t x, int64_t y, int64_t z) {
            uint64_t h = uint64_t(x) * 0x9e3779b97f4a7c15ull ^ uint64_t(y) * 0xc2b2ae3d27d4eb4full ^
                         uint64_t(z) * 0x165667b19e3779f9ull;
            h ^= h >> 29, h *= 0xbf58476d1ce4e5b9ull, h ^= h >> 32;
            return size_t(h) & (table - 1);
        };
        auto cellOf = [&](float value, float lower, double shift) {
            return int64_t(std::floor((double(value) - double(lower) + shift) / cell));
        };
        Vec3 o = out.bounds.lower;
        for (size_t i = 0; i < placed.size(); ++i) {
            if (!used[i]) continue;
            Vec3 p = placed[i];
            int64_t lo[3] = {cellOf(p.x, o.x, -tolerance), cellOf(p.y, o.y, -tolerance), cellOf(p.z, o.z, -tolerance)};
            int64_t hi[3] = {cellOf(p.x, o.x, tolerance), cellOf(p.y, o.y, tolerance), cellOf(p.z, o.z, tolerance)};
            uint32_t found = kNone;
            for (int64_t z = lo[2]; z <= hi[2]; ++z)
                for (int64_t y = lo[1]; y <= hi[1]; ++y)
                    for (int64_t x = lo[0]; x <= hi[0]; ++x)
                        for (uint32_t k = head[slot(x, y, z)]; k != kNone; k = next[k]) {
                            Vec3 d = out.vertices[k] - p;
                            if (double(dot(d, d)) <= tolerance * tolerance) found = std::min(found, k);
                        }
            if (found == kNone) {
                found = uint32_t(out.vertices.size());
                out.vertices.push_back(p);
                size_t h = slot(cellOf(p.x, o.x, 0), cellOf(p.y, o.y, 0), cellOf(p.z, o.z, 0));
                next.push_back(head[h]), head[h] = found;
            } else {
                ++report.duplicateVertices;
            }
            remap[i] = found;
        }
        tri.reserve(3 * mesh.triangleCount);
        for (size_t t = 0; t < mesh.triangleCount; ++t) {
            uint32_t a = remap[mesh.indices[3 * t]], b = remap[mesh.indices[3 * t + 1]],
                     c = remap[mesh.indices[3 * t + 2]];
            if (a == b || b == c || c == a)
                ++report.degenerateTriangles;
            else
                tri.push_back(a), tri.push_back(b), tri.push_back(c);
        }
    }

    // Triangles on the same three vertices. Of a mesh exported with both sides one side is kept; elsewhere opposite
    // twins are walls between touching solids and cancel, and equal twins count once.
    void dropTwins() {
        struct Key {
            uint32_t a, b, c, triangle;
            bool odd;
        };
        std::vector<Key> keys(tri.size() / 3);
        for (uint32_t t = 0; t < keys.size(); ++t) {
            Key k{tri[3 * t], tri[3 * t + 1], tri[3 * t + 2], t, false};
            if (k.a > k.b) std::swap(k.a, k.b), k.odd = !k.odd;
            if (k.b > k.c) std::swap(k.b, k.c), k.odd = !k.odd;
            if (k.a > k.b) std::swap(k.a, k.b), k.odd = !k.odd;
            keys[t] = k;
        }
        std::sort(keys.begin(), keys.end(), [](const Key& l, const Key& r) {
            if (l.a != r.a) return l.a < r.a;
            if (l.b != r.b) return l.b < r.b;
            return l.c != r.c ? l.c < r.c : l.triangle < r.triangle;
        });
        auto forTwins = [&](auto&& f) {
            for (size_t i = 0; i < keys.size();) {
                size_t j = i + 1, odd = keys[i].odd;
                for (; j < keys.size() && keys[j].a == keys[i].a && keys[j].b == keys[i].b && keys[j].c == keys[i].c;
                     ++j)
                    odd += keys[j].odd;
                if (j - i > 1) f(i, j, odd, j - i - odd);
                i = j;
            }
        };
        size_t opposed = 0, any = 0;
        forTwins(
            [&](size_t i, size_t j, size_t odd, size_t even) { any += j - i, opposed += odd && even ? j - i : 0; });
        if (any == 0) return;
        bool bothSides = 2 * opposed > keys.size();
        std::vector<uint8_t> keep(keys.size(), 1);
        forTwins([&](size_t i, size_t j, size_t odd, size_t even) {
            for (size_t k = i; k < j; ++k) keep[keys[k].triangle] = 0;
            if (!bothSides && odd == even) return;
            bool oddSide = bothSides ? keys[i].odd : odd > even;
            for (size_t k = i; k < j; ++k)
                if (keys[k].odd == oddSide) {
                    keep[keys[k].triangle] = 1;
                    break;
                }
        });
        size_t kept = 0;
        for (size_t t = 0; t < keep.size(); ++t) {
            if (!keep[t]) {
                ++report.degenerateTriangles;
                continue;
            }
            for (size_t k = 0; k < 3; ++k) tri[3 * kept + k] = tri[3 * t + k];
            ++kept;
        }
        tri.resize(3 * kept);
    }

    struct Edge {
        uint32_t a, b, slot; // a < b; slot = 3 triangle + corner
    };
    std::vector<Edge> edges;

    void collectEdges() {
        edges.resize(tri.size());
        for (uint32_t s = 0; s < tri.size(); ++s) {
            uint32_t a = tri[s], b = tri[s % 3 == 2 ? s - 2 : s + 1];
            edges[s] = {std::min(a, b), std::max(a, b), s};
        }
        std::sort(edges.begin(), edges.end(), [](const Edge& l, const Edge& r) {
            if (l.a != r.a) return l.a < r.a;
            return l.b != r.b ? l.b < r.b : l.slot < r.slot;
        });
    }
    bool forward(uint32_t slot) const { return tri[slot] < tri[slot % 3 == 2 ? slot - 2 : slot + 1]; }
    template <class F> void forEdges(F&& f) const {
        for (size_t i = 0; i < edges.size();) {
            size_t j = i + 1;
            while (j < edges.size() && edges[j].a == edges[i].a && edges[j].b == edges[i].b) ++j;
            f(i, j);
            i = j;
        }
    }

    // Makes neighbours agree inside each patch, then counts; which of the two sides is out is decided later.
    void makeConsistent() {
        uint32_t count = uint32_t(tri.size() / 3);
        std::vector<uint32_t> across(tri.size(), kNone), parent(count);
        for (uint32_t t = 0; t < count; ++t) parent[t] = t;
        auto root = [&](uint32_t t) {
            while (parent[t] != t) t = parent[t] = parent[parent[t]];
            return t;
        };
        forEdges([&](size_t i, size_t j) {
            for (size_t k = i + 1; k < j; ++k) {
                uint32_t l = root(edges[i].slot / 3), r = root(edges[k].slot / 3);
                parent[std::max(l, r)] = std::min(l, r);
            }
            if (j - i == 1) ++report.openEdges;
            if (j - i > 2) ++report.nonManifoldEdges;
            if (j - i != 2) return;
            uint32_t s = edges[i].slot, t = edges[i + 1].slot;
            across[s] = t, across[t] = s;
            if (forward(s) == forward(t)) ++report.inconsistentEdges;
        });
        for (uint32_t t = 0; t < count; ++t) report.components += root(t) == t;

        patch.assign(count, kNone), flipped.assign(count, 0), patchOpen.clear();
        std::vector<uint32_t> queue;
        for (uint32_t seed = 0; seed < count; ++seed) {
            if (patch[seed] != kNone) continue;
            uint32_t id = uint32_t(patchOpen.size());
            bool open = false;
            double kept = 0, against = 0;
            queue.assign(1, seed), patch[seed] = id;
            for (size_t q = 0; q < queue.size(); ++q) {
                uint32_t t = queue[q];
                (flipped[t] ? against : kept) += areaOf(t);
                for (uint32_t k = 0; k < 3; ++k) {
                    uint32_t s = 3 * t + k, o = across[s];
                    if (o == kNone) open = true;
                    if (o == kNone || patch[o / 3] != kNone) continue;
                    flipped[o / 3] = uint8_t(flipped[t] ^ uint8_t(forward(s) == forward(o)));
                    patch[o / 3] = id;
                    queue.push_back(o / 3);
                }
            }
            if (against > kept)
                for (uint32_t t : queue) flipped[t] ^= 1;
            patchOpen.push_back(open);
        }
        // Only now: forward() above compares the triangles as they came.
        for (uint32_t t = 0; t < count; ++t)
            if (flipped[t]) std::swap(tri[3 * t + 1], tri[3 * t + 2]);
    }

    double areaOf(uint32_t t) const {
        return triangleArea(out.vertices[tri[3 * t]], out.vertices[tri[3 * t + 1]], out.vertices[tri[3 * t + 2]]);
    }

    // Each patch that encloses something is turned outward, except cavities: patches that lie inside the rest and face
    // the other way than the majority. Patches that enclose nothing by themselves (a scan in pieces) follow the
    // majority.
    void orient() {
        size_t patches = patchOpen.size();
        struct Patch {
            Dvec center;
            double area = 0, volume = 0;
            uint32_t triangle = kNone;
            bool decisive = false, turn = false;
        };
        std::vector<Patch> all(patches);
        auto corner = [&](size_t t, size_t k) { return out.vertices[tri[3 * t + k]]; };
        for (size_t t = 0; t < patch.size(); ++t) {
            Patch& p = all[patch[t]];
            double area = areaOf(uint32_t(t));
            Vec3 c = (1.0f / 3) * (corner(t, 0) + corner(t, 1) + corner(t, 2));
            p.area += area, p.center.x += area * c.x, p.center.y += area * c.y, p.center.z += area * c.z;
            if (p.triangle == kNone) p.triangle = uint32_t(t);
        }
        for (Patch& p : all)
            if (p.area > 0) p.center = {p.center.x / p.area, p.center.y / p.area, p.center.z / p.area};
        Dvec middle = toDouble(0.5f * (out.bounds.lower + out.bounds.upper));
        double whole = 0, sum = 0;
        for (size_t t = 0; t < patch.size(); ++t) {
            Patch& p = all[patch[t]];
            p.volume += apexVolume(p.center, corner(t, 0), corner(t, 1), corner(t, 2));
            whole += apexVolume(middle, corner(t, 0), corner(t, 1), corner(t, 2));
        }
        bool any = false;
        for (size_t i = 0; i < patches; ++i) {
            Patch& p = all[i];
            // V / A^1.5 is 0.094 for a sphere, 0.068 for a cube and 0.02 for a plate 13 times as wide as thick.
            p.decisive = !patchOpen[i] || std::abs(p.volume) > 0.02 * std::pow(p.area, 1.5);
            if (p.decisive) any = true, sum += p.volume;
        }
        bool inverted = (any ? sum : whole) < 0;
        bool candidates = false;
        for (Patch& p : all) {
            p.turn = p.decisive ? p.volume < 0 : inverted;
            if (p.decisive && p.volume != 0 && (p.volume < 0) != inverted) candidates = true;
        }
        auto apply = [&](auto&& turn) {
            for (size_t t = 0; t < patch.size(); ++t)
                if (turn(all[patch[t]])) std::swap(tri[3 * t + 1], tri[3 * t + 2]);
        };
        apply([](const Patch& p) { return p.turn; });
        std::vector<uint8_t> cavity(patches, 0);
        if (candidates) {
            TriangleTree tree(out.vertices, tri);
            for (size_t i = 0; i < patches; ++i) {
                Patch& p = all[i];
                if (!p.decisive || p.volume == 0 || (p.volume < 0) == inverted) continue;
                // On its own face a closed patch counts 0.5; inside another solid it is 1.5.
                Vec3 c = (1.0f / 3) * (corner(p.triangle, 0) + corner(p.triangle, 1) + corner(p.triangle, 2));
                Vec3 n = normalizeOr(thaw::cross(corner(p.triangle, 1) - corner(p.triangle, 0),
                                                 corner(p.triangle, 2) - corner(p.triangle, 0)),
                                     {0, 1, 0});
                float step = 1e-3f * std::sqrt(float(p.area));
                cavity[i] = tree.winding(c + step * n) > 0.5f;
            }
            for (size_t t = 0; t < patch.size(); ++t)
                if (cavity[patch[t]]) std::swap(tri[3 * t + 1], tri[3 * t + 2]);
        }
        report.inverted = inverted;
        for (size_t i = 0; i < patches; ++i)
            if (all[i].decisive && all[i].volume < 0 && !cavity[i]) report.inverted = true;
    }

    // After orientation: an edge is balanced when as many triangles run along it as against it. All balanced: the
    // winding number is a whole number everywhere.
    void checkBalance() {
        out.watertight = true;
        forEdges([&](size_t i, size_t j) {
            int balance = 0;
            for (size_t k = i; k < j; ++k) {
                uint32_t s = edges[k].slot, t = 3 * (s / 3), v[3] = {tri[t], tri[t + 1], tri[t + 2]};
                bool along = false; // turning swapped corners, so the slot no longer names the edge
                for (int c = 0; c < 3; ++c) along |= v[c] == edges[i].a && v[(c + 1) % 3] == edges[i].b;
                balance += along ? 1 : -1;
            }
            if (balance != 0) out.watertight = false;
        });
    }

    void dropFlat() {
        size_t kept = 0;
        double area = 0;
        for (uint32_t t = 0; t < tri.size() / 3; ++t) {
            double a = areaOf(t);
            if (!(a > 0)) {
                ++report.degenerateTriangles;
                continue;
            }
            area += a;
            for (size_t k = 0; k < 3; ++k) tri[3 * kept + k] = tri[3 * t + k];
            ++kept;
        }
        tri.resize(3 * kept);
        report.area = area;
    }

    thawResult measure() {
        Vec3 size = out.bounds.upper - out.bounds.lower;
        double box = double(size.x) * size.y * size.z, longest = std::max(size.x, std::max(size.y, size.z));
        double flow = 0;
        Dvec middle = toDouble(0.5f * (out.bounds.lower + out.bounds.upper));
        for (size_t t = 0; t < tri.size(); t += 3)
            flow += apexVolume(middle, out.vertices[tri[t]], out.vertices[tri[t + 1]], out.vertices[tri[t + 2]]);

        TriangleTree tree(out.vertices, tri);
        size_t inside = 0, ambiguous = 0, overlapped = 0;
        int n = 0;
        auto count = [&](int perAxis) {
            n = perAxis, inside = ambiguous = overlapped = 0;
            for (int z = 0; z < n; ++z)
                for (int y = 0; y < n; ++y)
                    for (int x = 0; x < n; ++x) {
                        Vec3 f{(float(x) + 0.5f) / float(n), (float(y) + 0.5f) / float(n),
                               (float(z) + 0.5f) / float(n)};
                        float w = tree.winding(out.bounds.lower + Vec3{f.x * size.x, f.y * size.y, f.z * size.z});
                        inside += w > 0.5f, overlapped += w > 1.5f || w < -0.5f,
                            ambiguous += std::abs(w - 0.5f) < 0.25f;
                    }
        };
        count(32);
        bool rough = overlapped > inside / 500 || (!out.watertight && ambiguous > inside / 50);
        if (inside < 500 || rough) count(64);
        double sampled = box * double(inside) / (double(n) * n * n);
        report.volume = rough ? sampled : std::max(flow, 0.0);

        // 1e-6: below it the volume is rounding of the coordinates.
        bool empty = report.volume <= 1e-6 * report.area * longest;
        if (!out.watertight) {
            const char* why = report.openEdges ? "open by" : "has no clear inside at";
            unsigned edgesOpen =
                report.openEdges ? report.openEdges : report.nonManifoldEdges + report.inconsistentEdges;
            // Twice as much unclear as clear space: a sheet, not a body with holes.
            if (empty || inside == 0 || ambiguous > 2 * inside)
                return fail(thawResult_badMesh, format("mesh is %s %u edges and encloses no volume", why, edgesOpen));
            // Share of unclear space, measured: a cube without one of 12 triangles 0.07, without a face 0.20; a sphere
            // without a quarter 0.21, without 40 % of its height 0.41, without half 0.61.
            double share = double(ambiguous) / double(inside);
            if (share > 0.4)
                return fail(thawResult_badMesh,
                            format("mesh is %s %u edges: what is inside is ambiguous in a volume of %.0f %% of what it "
                                   "encloses; close the holes",
                                   why, edgesOpen, 100 * share));
        } else if (empty) {
            return fail(thawResult_badMesh, format("mesh encloses no volume (%.3g m^3 behind %.3g m^2 of triangles)",
                                                   report.volume, report.area));
        }
        return thawResult_ok;
    }

    thawResult run() {
        std::vector<Vec3> placed;
        thawResult result = checkInput();
        if (result == thawResult_ok) result = place(placed);
        if (result != thawResult_ok) return result;
        dropTwins();
        collectEdges();
        makeConsistent();
        orient();
        checkBalance();
        dropFlat();
        if (tri.empty())
            return fail(thawResult_badMesh,
                        format("mesh has no triangles with area (all %zu are degenerate)", mesh.triangleCount));
        return measure();
    }
};

} // namespace

thawResult cleanMesh(const thawMesh& mesh, const Transform& to, CleanMesh& out, std::string& message) {
    out = {};
    message.clear();
    return Cleaner(mesh, to, out, message).run();
}

} // namespace thaw
