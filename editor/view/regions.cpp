// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/regions.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace thaw::view {

namespace {

constexpr float kPi = 3.14159265f;
using Line = std::vector<Vec3>;

Line placed(const thawVec3* points, size_t count, Vec3 position, thawQuat rotation) {
    Line line;
    for (size_t i = 0; i < count; ++i) {
        const Vec3 p = rotate(rotation, points[i]) + position;
        if (line.empty() || length(p - line.back()) > 1e-7f) line.push_back(p);
    }
    return line;
}

// Centripetal Catmull-Rom through the points (E. Catmull, R. Rom, 1974; Barry and Goldman's pyramid, 1988).
Line spline(const Line& points) {
    constexpr int kSteps = 12;
    Line line;
    const auto at = [&](std::ptrdiff_t i) {
        const auto n = static_cast<std::ptrdiff_t>(points.size());
        if (i < 0) return points[0] * 2 - points[1];
        return i < n ? points[static_cast<size_t>(i)]
                     : points[static_cast<size_t>(n - 1)] * 2 - points[static_cast<size_t>(n - 2)];
    };
    for (size_t i = 0; i + 1 < points.size(); ++i) {
        std::array<Vec3, 4> p;
        std::array<float, 4> t{};
        for (size_t k = 0; k < 4; ++k) {
            p[k] = at(static_cast<std::ptrdiff_t>(i + k) - 1);
            if (k > 0) t[k] = t[k - 1] + std::sqrt(std::max(length(p[k] - p[k - 1]), 1e-9f));
        }
        for (int step = 0; step < kSteps; ++step) {
            const float u = t[1] + (t[2] - t[1]) * static_cast<float>(step) / kSteps;
            std::array<Vec3, 4> q = p;
            for (size_t level = 1; level < 4; ++level)
                for (size_t k = 0; k + level < 4; ++k) {
                    const size_t a = level == 3 ? 1 : k, b = level == 3 ? 2 : k + level;
                    const float f = (u - t[a]) / (t[b] - t[a]);
                    q[k] = q[k] * (1 - f) + q[k + 1] * f;
                }
            line.push_back(q[0]);
        }
    }
    line.push_back(points.back());
    return line;
}

// Rings about a line, joined; a closed one meets its beginning.
void addTube(TriangleMesh& mesh, const Line& line, float radius, int sides, bool closed) {
    const size_t n = line.size();
    if (n < 2) return;
    const auto first = static_cast<uint32_t>(mesh.positions.size() / 3);
    const size_t rings = closed ? n + 1 : n;
    Vec3 across{0, 0, 0};
    for (size_t j = 0; j < rings; ++j) {
        const size_t i = j % n;
        const Vec3 before = closed ? line[(i + n - 1) % n] : line[i > 0 ? i - 1 : 0];
        const Vec3 after = closed ? line[(i + 1) % n] : line[std::min(i + 1, n - 1)];
        const Vec3 along = normalize(after - before);
        across = j == 0 ? perpendicular(along) : normalize(across - along * dot(across, along), perpendicular(along));
        const Vec3 side = cross(along, across);
        for (int k = 0; k <= sides; ++k) {
            const float a = 2 * kPi * static_cast<float>(k) / static_cast<float>(sides);
            const Vec3 normal = across * std::cos(a) + side * std::sin(a), p = line[i] + normal * radius;
            mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
            mesh.normals.insert(mesh.normals.end(), {normal.x, normal.y, normal.z});
        }
    }
    const auto row = static_cast<uint32_t>(sides + 1);
    for (uint32_t j = 0; j + 1 < rings; ++j)
        for (uint32_t k = 0; k < static_cast<uint32_t>(sides); ++k) {
            const uint32_t a = first + j * row + k, b = a + row;
            mesh.indices.insert(mesh.indices.end(), {a, a + 1, b, b, a + 1, b + 1});
        }
}

void addCone(TriangleMesh& mesh, Vec3 tip, Vec3 along, float radius, float height) {
    constexpr uint32_t kSides = 16;
    const auto first = static_cast<uint32_t>(mesh.positions.size() / 3);
    const Vec3 across = perpendicular(along), side = cross(along, across), foot = tip - along * height;
    for (uint32_t k = 0; k < kSides; ++k) {
        const float a = 2 * kPi * static_cast<float>(k) / kSides;
        const Vec3 out = across * std::cos(a) + side * std::sin(a);
        const Vec3 normal = normalize(out * height + along * radius), rim = foot + out * radius;
        for (const Vec3& p : {rim, tip, foot}) mesh.positions.insert(mesh.positions.end(), {p.x, p.y, p.z});
        for (const Vec3& m : {normal, normal, along * -1}) mesh.normals.insert(mesh.normals.end(), {m.x, m.y, m.z});
        const uint32_t i = first + 3 * k, j = first + 3 * ((k + 1) % kSides);
        mesh.indices.insert(mesh.indices.end(), {i, j, i + 1, i, i + 2, j});
    }
}

Region region(RegionKind kind, TriangleMesh mesh) {
    return {kind, std::make_shared<const TriangleMesh>(std::move(mesh))};
}

// Contours in their plane: x and y along it.
struct Drawing {
    Vec3 origin, right, up;
    struct Flat {
        float x, y;
    };
    std::vector<std::vector<Flat>> contours;

    Vec3 world(float x, float y) const { return origin + right * x + up * y; }
    // m outside of the shape, 0 inside of an odd number of contours.
    float distance(Flat p) const {
        float nearest = INFINITY;
        bool inside = false;
        for (const auto& c : contours)
            for (size_t i = 0, j = c.size() - 1; i < c.size(); j = i++) {
                const Flat a = c[j], b = c[i];
                if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)) inside = !inside;
                const float dx = b.x - a.x, dy = b.y - a.y;
                const float t =
                    std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / std::max(dx * dx + dy * dy, 1e-20f), 0.0f, 1.0f);
                nearest = std::min(nearest, std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy));
            }
        return inside ? 0 : nearest;
    }
};

// Where the distance is `reach`, as tubes: marching squares.
TriangleMesh reachLine(const Drawing& drawing, float reach, float size, float thickness) {
    constexpr int kCells = 72;
    const float half = size + 1.1f * reach, step = 2 * half / kCells;
    std::vector<float> field(size_t(kCells + 1) * (kCells + 1));
    for (int j = 0; j <= kCells; ++j)
        for (int i = 0; i <= kCells; ++i)
            field[size_t(j) * (kCells + 1) + size_t(i)] =
                drawing.distance({static_cast<float>(i) * step - half, static_cast<float>(j) * step - half}) - reach;
    TriangleMesh mesh;
    for (int j = 0; j < kCells; ++j)
        for (int i = 0; i < kCells; ++i) {
            Line ends;
            constexpr int kCorner[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
            for (int k = 0; k < 4; ++k) {
                const int ai = i + kCorner[k][0], aj = j + kCorner[k][1], bi = i + kCorner[k + 1][0],
                          bj = j + kCorner[k + 1][1];
                const float a = field[size_t(aj) * (kCells + 1) + size_t(ai)],
                            b = field[size_t(bj) * (kCells + 1) + size_t(bi)];
                if ((a < 0) == (b < 0)) continue;
                const float t = a / (a - b);
                ends.push_back(drawing.world((static_cast<float>(ai) + t * static_cast<float>(bi - ai)) * step - half,
                                             (static_cast<float>(aj) + t * static_cast<float>(bj - aj)) * step - half));
            }
            for (size_t k = 0; k + 1 < ends.size(); k += 2) addTube(mesh, {ends[k], ends[k + 1]}, thickness, 6, false);
        }
    return mesh;
}

} // namespace

Vec3 regionColor(RegionKind kind) {
    switch (kind) {
    case RegionKind::path:
        return {0.093f, 0.456f, 0.815f}; // sky blue
    case RegionKind::direction:
        return {0.90f, 0.90f, 0.88f};
    case RegionKind::contour:
        return {0.791f, 0.347f, 0.0f}; // orange
    case RegionKind::reach:
        return {0.871f, 0.776f, 0.054f}; // yellow
    default:
        return {0.0f, 0.342f, 0.171f}; // bluish green
    }
}

const char* regionName(RegionKind kind) {
    constexpr const char* kNames[kRegionKinds] = {"path", "its way", "contour", "its reach", "target"};
    return kNames[static_cast<int>(kind)];
}

std::vector<Region> pathRegions(const thawPathDef& def, Vec3 position, thawQuat rotation) {
    Line line = placed(def.points, static_cast<size_t>(std::max(def.pointCount, 0)), position, rotation);
    if (line.size() < 2) return {};
    if (def.smooth && line.size() > 2) line = spline(line);
    TriangleMesh tube, arrows;
    addTube(tube, line, def.radius, 24, false);
    addTube(arrows, line, 0.07f * def.radius, 8, false);
    float way = 0;
    for (size_t i = 1; i < line.size(); ++i) way += length(line[i] - line[i - 1]);
    const float gap = std::max(4 * def.radius, way / 8), height = std::min(1.2f * def.radius, 0.5f * way);
    float next = std::min(gap, way), done = 0;
    for (size_t i = 1; i < line.size(); ++i) {
        const float part = length(line[i] - line[i - 1]);
        const Vec3 along = normalize(line[i] - line[i - 1]);
        for (; next <= done + part * 1.0001f; next += gap)
            addCone(arrows, line[i - 1] + along * (next - done), along, 0.42f * def.radius, height);
        done += part;
    }
    return {region(RegionKind::path, std::move(tube)), region(RegionKind::direction, std::move(arrows))};
}

std::vector<Region> shapeRegions(const thawShapeDef& def, Vec3 position, thawQuat rotation) {
    if (def.contourCount <= 0) {
        TriangleMesh mesh = makeMesh(def.mesh);
        for (size_t i = 0; i + 2 < mesh.positions.size(); i += 3) {
            float *p = &mesh.positions[i], *n = &mesh.normals[i];
            const Vec3 q =
                rotate(rotation, rotate(def.rotation, Vec3{p[0], p[1], p[2]} * def.scale) + def.position) + position;
            const Vec3 m = rotate(rotation, rotate(def.rotation, {n[0], n[1], n[2]}));
            p[0] = q.x, p[1] = q.y, p[2] = q.z, n[0] = m.x, n[1] = m.y, n[2] = m.z;
        }
        return mesh.indices.empty() ? std::vector<Region>{}
                                    : std::vector<Region>{region(RegionKind::target, std::move(mesh))};
    }
    std::vector<Line> lines;
    Bounds bounds;
    Vec3 normal = def.normal;
    const thawVec3* at = def.points;
    for (int c = 0; c < def.contourCount; at += def.contourSizes[c++]) {
        lines.push_back(placed(at, static_cast<size_t>(def.contourSizes[c]), {0, 0, 0}, {0, 0, 0, 1}));
        for (const Vec3& p : lines.back()) bounds.add(p);
    }
    if (!(length(normal) > 0)) {
        // M. E. Newell's normal of each contour; holes may run the other way round.
        for (const Line& line : lines) {
            Vec3 sum{0, 0, 0};
            for (size_t i = 0; i < line.size(); ++i)
                sum = sum + cross(line[i] - line[0], line[(i + 1) % line.size()] - line[0]);
            normal = normal + sum * (dot(sum, normal) < 0 ? -1.0f : 1.0f);
        }
    }
    normal = normalize(rotate(rotation, normal));
    Drawing drawing;
    drawing.origin = rotate(rotation, bounds.center()) + position;
    drawing.right = perpendicular(normal), drawing.up = cross(normal, drawing.right);
    const float size = bounds.radius(), thickness = 0.012f * size;
    TriangleMesh contours;
    for (Line& line : lines) {
        for (Vec3& p : line) p = rotate(rotation, p) + position;
        addTube(contours, line, thickness, 8, true);
        // For the reach a few hundred corners are enough.
        std::vector<Drawing::Flat> flat;
        for (size_t i = 0, stride = line.size() / 400 + 1; i < line.size(); i += stride)
            flat.push_back({dot(line[i] - drawing.origin, drawing.right), dot(line[i] - drawing.origin, drawing.up)});
        if (flat.size() >= 3) drawing.contours.push_back(std::move(flat));
    }
    float half = 0;
    for (const auto& c : drawing.contours)
        for (const auto& p : c) half = std::max({half, std::fabs(p.x), std::fabs(p.y)});
    const float reach = def.reach > 0 ? def.reach : half;
    std::vector<Region> out{region(RegionKind::contour, std::move(contours))};
    TriangleMesh outer = reachLine(drawing, reach, size, 0.6f * thickness);
    if (!outer.indices.empty()) out.push_back(region(RegionKind::reach, std::move(outer)));
    return out;
}

} // namespace thaw::view
