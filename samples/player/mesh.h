// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "thaw/thaw.h"

#include <cstdint>
#include <string>
#include <vector>

namespace thaw::scene {

// Triangles that own their memory, in metres.
struct TriMesh {
    std::vector<float> vertices;   // x y z of each vertex
    std::vector<uint32_t> indices; // three per triangle, counter-clockwise from outside

    size_t vertexCount() const { return vertices.size() / 3; }
    size_t triangleCount() const { return indices.size() / 3; }
    // View for the library; valid as long as the vectors are not changed.
    thawMesh view() const;
    uint32_t addVertex(double x, double y, double z);
    void addTriangle(uint32_t a, uint32_t b, uint32_t c);
};

struct Bounds {
    thawVec3 lower{}, upper{};
};

// Zero bounds for an empty mesh.
Bounds boundsOf(const TriMesh& mesh);
// Enclosed volume by the divergence theorem, m^3. Negative when the faces look inward; meaningless with large holes.
double volumeOf(const TriMesh& mesh);

thawVec3 rotate(const thawQuat& rotation, const thawVec3& v);
// Rotation about x, then y, then z.
thawQuat quatFromDegrees(double x, double y, double z);

TriMesh makeBox(const thawVec3& size); // full edge lengths
TriMesh makeSphere(float radius);
TriMesh makeCylinder(float radius, float height); // axis y, centred
TriMesh makeCone(float radius, float height);     // tip up, centred on half its height
TriMesh makeTorus(float radius, float tubeRadius);

// Turns a closed profile about the y axis. profile: (radius, height) pairs from the axis at the bottom, outside, to the
// axis at the top; the first and last radius are taken as zero.
struct ProfilePoint {
    double radius, height;
};
TriMesh makeLathe(const std::vector<ProfilePoint>& profile, int segments);

// A used candle: slightly bent and uneven, a rim that has sagged, drips set on its side, a shallow cup at the top.
// About 0.12 m high and 0.017 m in radius, its foot on y = 0. Always the same.
TriMesh makeCandle();
// A saucer, 0.055 m in radius and 0.011 m high, its foot on y = 0, its well at y = 0.003.
TriMesh makeSaucer();
// A waffle cone, its tip on y = 0, 0.118 m high, 0.0295 m in radius at its rim, with a shallow bed for what lies on it.
TriMesh makeWaffleCone();
// What a spoon has scooped: a ball of 0.027 m about (0, 0.135, 0) with a skirt and a rough face, for that cone; and a
// smaller one of 0.024 m on top of it, about (0.002, 0.168, 0).
TriMesh makeLowerScoop();
TriMesh makeUpperScoop();
// Both in one mesh.
TriMesh makeScoops();
// A star of five arms, upright on two of them, 0.068 m wide and 0.028 m deep at its middle, its foot on y = 0; 2,000
// triangles.
TriMesh makeStar();
// A bunny of chocolate, sitting upright and looking along +x: 0.15 m high with its ears, flat below, its foot on y = 0.
TriMesh makeBunny();
// A frying pan to look at: 0.27 m across its rim, its inside on y = 0, its handle along +x; the handle runs into the
// rim.
TriMesh makePan();

// Reads OBJ, PLY, STL, glTF or GLB: all meshes of the file joined, node transforms applied, equal vertices welded.
// Throws std::runtime_error with one line that does not name the file.
TriMesh importMesh(const std::string& path);
// OBJ text, micrometre steps. Throws std::runtime_error when the file cannot be written.
void writeObj(const std::string& path, const TriMesh& mesh, const std::string& comment);

} // namespace thaw::scene
