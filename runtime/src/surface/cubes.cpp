// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/cubes.h"

#include <cassert>

namespace thaw {
namespace {

// Corners of the six faces, counter-clockwise seen from outside the cube.
constexpr int kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

int edgeBetween(const CubeCases& cases, int a, int b) {
    int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2, start = a < b ? a : b;
    for (int k = 0; k < 4; ++k)
        if (cases.edgeStart[4 * axis + k] == start) return 4 * axis + k;
    assert(false);
    return 0;
}

// Twice the edge's middle, so that all is whole numbers.
void middle(const CubeCases& cases, int edge, int out[3]) {
    for (int axis = 0; axis < 3; ++axis) out[axis] = axis == edge / 4 ? 1 : 2 * (cases.edgeStart[edge] >> axis & 1);
}

bool onOneFace(const CubeCases& cases, int e, int f) {
    int a[3], b[3];
    middle(cases, e, a), middle(cases, f, b);
    for (int axis = 0; axis < 3; ++axis)
        if (a[axis] == b[axis] && a[axis] != 1) return true;
    return false;
}

int distanceSquared(const CubeCases& cases, int e, int f) {
    int a[3], b[3], sum = 0;
    middle(cases, e, a), middle(cases, f, b);
    for (int axis = 0; axis < 3; ++axis) sum += (a[axis] - b[axis]) * (a[axis] - b[axis]);
    return sum;
}

constexpr int kForbidden = 1 << 20;

// Cuts the loop's corners first..last into triangles so that the inner edges are short and none lies in a face of the
// cube: the cube on the other side might draw the same edge, and it would have four triangles. Returns the cost.
int cut(const CubeCases& cases, const int* loop, int first, int last, int (*out)[3], int& count) {
    if (last - first < 2) return 0;
    int best = kForbidden, bestApex = -1;
    for (int apex = first + 1; apex < last; ++apex) {
        int cost = 0, ignored = 0;
        int scratch[CubeCases::kMaxTriangles][3];
        for (int side = 0; side < 2; ++side) {
            int a = side ? apex : first, b = side ? last : apex;
            if (b - a < 2) continue; // an edge of the loop
            cost += onOneFace(cases, loop[a], loop[b]) ? kForbidden : distanceSquared(cases, loop[a], loop[b]);
            cost += cut(cases, loop, a, b, scratch, ignored = 0);
        }
        if (cost < best) best = cost, bestApex = apex;
    }
    if (bestApex < 0) return kForbidden;
    out[count][0] = loop[first], out[count][1] = loop[bestApex], out[count][2] = loop[last];
    ++count;
    cut(cases, loop, first, bestApex, out, count);
    cut(cases, loop, bestApex, last, out, count);
    return best;
}

} // namespace

CubeCases::CubeCases() : triangleCount{}, triangles{} {
    for (int axis = 0; axis < 3; ++axis)
        for (int c = 0, k = 0; c < 8; ++c)
            if (!(c >> axis & 1)) edgeStart[4 * axis + k++] = uint8_t(c);

    for (int inside = 0; inside < 256; ++inside) {
        // On each face, each edge where its outline leaves the inside is joined to the next edge where it comes back.
        // Both cubes of a face join the same edges, so the mesh is closed; of two ways where the corners alternate it
        // is the one that joins the inside, which keeps thin films whole.
        int next[12];
        for (int& n : next) n = -1;
        for (const auto& face : kFaces) {
            for (int i = 0; i < 4; ++i) {
                if (!(inside >> face[i] & 1) || (inside >> face[(i + 1) % 4] & 1)) continue;
                int j = (i + 1) % 4;
                while (!(inside >> face[(j + 1) % 4] & 1)) j = (j + 1) % 4;
                int leave = edgeBetween(*this, face[i], face[(i + 1) % 4]);
                int back = edgeBetween(*this, face[j], face[(j + 1) % 4]);
                next[back] = leave;
            }
        }
        int found[kMaxTriangles][3], count = 0;
        bool used[12] = {};
        for (int start = 0; start < 12; ++start) {
            if (next[start] < 0 || used[start]) continue;
            int loop[12], size = 0;
            for (int e = start; !used[e]; e = next[e]) used[e] = true, loop[size++] = e;
            [[maybe_unused]] int cost = cut(*this, loop, 0, size - 1, found, count);
            assert(cost < kForbidden);
        }
        triangleCount[inside] = uint8_t(count);
        for (int t = 0; t < count; ++t)
            for (int k = 0; k < 3; ++k) triangles[inside][3 * t + k] = uint8_t(found[t][k]);
    }
}

const CubeCases& cubeCases() {
    static const CubeCases cases;
    return cases;
}

} // namespace thaw
