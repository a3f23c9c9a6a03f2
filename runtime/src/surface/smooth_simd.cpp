// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/smooth_simd.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/smooth_simd.cpp"
#include "hwy/foreach_target.h"

#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
struct Row {
    float v[4];
};
HWY_INLINE Row loadRow(const Vec4& p) { return {{p.x, p.y, p.z, p.w}}; }
HWY_INLINE void storeRow(Row r, Vec4& p) { p = {r.v[0], r.v[1], r.v[2], r.v[3]}; }
HWY_INLINE Row add(Row a, Row b) { return {{a.v[0] + b.v[0], a.v[1] + b.v[1], a.v[2] + b.v[2], a.v[3] + b.v[3]}}; }
HWY_INLINE Row sub(Row a, Row b) { return {{a.v[0] - b.v[0], a.v[1] - b.v[1], a.v[2] - b.v[2], a.v[3] - b.v[3]}}; }
HWY_INLINE Row scale(Row a, float s) { return {{s * a.v[0], s * a.v[1], s * a.v[2], s * a.v[3]}}; }
#else
using TagRow = hn::FixedTag<float, 4>;
constexpr TagRow kRow{};
using Row = hn::Vec<TagRow>;
HWY_INLINE Row loadRow(const Vec4& p) { return hn::Load(kRow, &p.x); }
HWY_INLINE void storeRow(Row r, Vec4& p) { hn::Store(r, kRow, &p.x); }
HWY_INLINE Row add(Row a, Row b) { return hn::Add(a, b); }
HWY_INLINE Row sub(Row a, Row b) { return hn::Sub(a, b); }
HWY_INLINE Row scale(Row a, float s) { return hn::Mul(a, hn::Set(kRow, s)); }
#endif

HWY_INLINE Vec4 unit(const Vec4& v) {
    const float l = std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    if (!(l > 1e-20f)) return {0, 1, 0, 0};
    const float s = 1 / l;
    return {s * v.x, s * v.y, s * v.z, 0};
}

HWY_INLINE Vec4 triangleNormal(const uint32_t* corner, const Vec4* positions) {
    const Vec4 &p = positions[corner[0]], &q = positions[corner[1]], &r = positions[corner[2]];
    const float ax = q.x - p.x, ay = q.y - p.y, az = q.z - p.z, bx = r.x - p.x, by = r.y - p.y, bz = r.z - p.z;
    return {ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx, 0};
}

void moveToNeighborsLanes(const MeshCorners& mesh, const uint32_t* indices, const Vec4* from, Vec4* to, float step,
                          int begin, int end) {
    for (int v = begin; v < end; ++v) {
        const uint32_t first = mesh.begins[v], last = mesh.begins[v + 1];
        const Row here = loadRow(from[v]);
        Row sum = loadRow(from[mesh.next[first]]);
        for (uint32_t k = first + 1; k < last; ++k) sum = add(sum, loadRow(from[mesh.next[k]]));
        const float w = from[v].w;
        Row move = scale(sub(scale(sum, 1 / static_cast<float>(last - first)), here), step);
        if (w < 1) {
            Vec4 normal{};
            for (uint32_t k = first; k < last; ++k) {
                const Vec4 n = triangleNormal(indices + 3 * size_t(mesh.triangle[k]), from);
                normal = {normal.x + n.x, normal.y + n.y, normal.z + n.z, 0};
            }
            normal = unit(normal);
            Vec4 m;
            storeRow(move, m);
            const float along = (1 - w) * (m.x * normal.x + m.y * normal.y + m.z * normal.z);
            move = sub(move, scale(loadRow(normal), along));
        }
        storeRow(add(here, move), to[v]);
        to[v].w = w;
    }
}

void triangleNormalsLanes(const uint32_t* indices, const Vec4* positions, Vec4* out, int begin, int end) {
    for (int t = begin; t < end; ++t) out[t] = triangleNormal(indices + 3 * size_t(t), positions);
}

void normalsOfTrianglesLanes(const MeshCorners& mesh, const Vec4* triangles, Vec4* out, int begin, int end) {
    for (int v = begin; v < end; ++v) {
        const uint32_t first = mesh.begins[v], last = mesh.begins[v + 1];
        Row sum = loadRow(triangles[mesh.triangle[first]]);
        for (uint32_t k = first + 1; k < last; ++k) sum = add(sum, loadRow(triangles[mesh.triangle[k]]));
        Vec4 n;
        storeRow(sum, n);
        out[v] = unit(n);
    }
}

void meanNormalsLanes(const MeshCorners& mesh, const Vec4* from, Vec4* to, int begin, int end) {
    for (int v = begin; v < end; ++v) {
        Row sum = loadRow(from[v]);
        for (uint32_t k = mesh.begins[v]; k < mesh.begins[v + 1]; ++k) sum = add(sum, loadRow(from[mesh.next[k]]));
        Vec4 n;
        storeRow(sum, n);
        to[v] = unit(n);
    }
}

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace thaw {

HWY_EXPORT(moveToNeighborsLanes);
HWY_EXPORT(triangleNormalsLanes);
HWY_EXPORT(normalsOfTrianglesLanes);
HWY_EXPORT(meanNormalsLanes);

void moveToNeighbors(const MeshCorners& mesh, const uint32_t* indices, const Vec4* from, Vec4* to, float step,
                     int begin, int end) {
    HWY_DYNAMIC_DISPATCH(moveToNeighborsLanes)(mesh, indices, from, to, step, begin, end);
}

void triangleNormals(const uint32_t* indices, const Vec4* positions, Vec4* out, int begin, int end) {
    HWY_DYNAMIC_DISPATCH(triangleNormalsLanes)(indices, positions, out, begin, end);
}

void normalsOfTriangles(const MeshCorners& mesh, const Vec4* triangles, Vec4* out, int begin, int end) {
    HWY_DYNAMIC_DISPATCH(normalsOfTrianglesLanes)(mesh, triangles, out, begin, end);
}

void meanNormals(const MeshCorners& mesh, const Vec4* from, Vec4* to, int begin, int end) {
    HWY_DYNAMIC_DISPATCH(meanNormalsLanes)(mesh, from, to, begin, end);
}

} // namespace thaw
#endif
