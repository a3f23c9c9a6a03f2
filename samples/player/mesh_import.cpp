// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "mesh.h"

#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

namespace thaw::scene {

namespace {
constexpr size_t kMaxFileBytes = size_t(1) << 30;
constexpr size_t kMaxTriangles = 100'000'000;
constexpr int kMaxNodeDepth = 256;
constexpr size_t kMaxNodes = 100'000;
constexpr size_t kMaxCorners = 10'000;

struct VertexKey {
    std::array<uint32_t, 3> bits;
    bool operator==(const VertexKey&) const = default;
};
struct VertexHash {
    size_t operator()(const VertexKey& key) const {
        uint64_t h = 0x9e3779b97f4a7c15ull;
        for (uint32_t b : key.bits) h = (h ^ b) * 0xff51afd7ed558ccdull, h ^= h >> 33;
        return size_t(h);
    }
};

// Cuts a polygon into triangles by clipping ears in the plane that fits it best. Not left to the importer: its own step
// ends the program on some damaged polygons.
void addPolygon(TriMesh& out, std::vector<uint32_t>& corners) {
    if (corners.size() > kMaxCorners) throw std::runtime_error("has a face with more than 10000 corners");
    auto point = [&](uint32_t v, int axis) { return double(out.vertices[size_t(v) * 3 + size_t(axis)]); };
    if (corners.size() > 3) {
        double normal[3] = {}; // Newell's
        for (size_t i = 0; i < corners.size(); ++i) {
            const uint32_t a = corners[i], b = corners[(i + 1) % corners.size()];
            for (int k = 0; k < 3; ++k)
                normal[k] +=
                    (point(a, (k + 1) % 3) - point(b, (k + 1) % 3)) * (point(a, (k + 2) % 3) + point(b, (k + 2) % 3));
        }
        int drop = 0;
        for (int k = 1; k < 3; ++k)
            if (std::abs(normal[k]) > std::abs(normal[drop])) drop = k;
        const int u = (drop + 1) % 3, v = (drop + 2) % 3;
        const double sign = normal[drop] < 0.0 ? -1.0 : 1.0;
        auto turn = [&](uint32_t a, uint32_t b, uint32_t c) {
            return sign * ((point(b, u) - point(a, u)) * (point(c, v) - point(a, v)) -
                           (point(b, v) - point(a, v)) * (point(c, u) - point(a, u)));
        };
        while (corners.size() > 3) {
            const size_t n = corners.size();
            size_t ear = 0; // when no ear is found (a crossed or flat polygon) any corner will do
            for (size_t i = 0; i < n; ++i) {
                const uint32_t a = corners[(i + n - 1) % n], b = corners[i], c = corners[(i + 1) % n];
                if (turn(a, b, c) <= 0.0) continue;
                bool empty = true;
                for (size_t j = 0; j < n && empty; ++j) {
                    const uint32_t p = corners[j];
                    empty =
                        p == a || p == b || p == c || turn(a, b, p) < 0.0 || turn(b, c, p) < 0.0 || turn(c, a, p) < 0.0;
                }
                if (!empty) continue;
                ear = i;
                break;
            }
            out.addTriangle(corners[(ear + n - 1) % n], corners[ear], corners[(ear + 1) % n]);
            corners.erase(corners.begin() + std::ptrdiff_t(ear));
        }
    }
    out.addTriangle(corners[0], corners[1], corners[2]);
}

// Joins every instance of every mesh; welds vertices that are equal to the bit (formats such as STL repeat them).
struct Joiner {
    const aiScene& source;
    TriMesh out;
    std::unordered_map<VertexKey, uint32_t, VertexHash> known;
    size_t nodes = 0;

    uint32_t weld(const aiVector3D& p) {
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            throw std::runtime_error("has a vertex that is not finite");
        const float v[3] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f}; // -0 becomes 0
        const VertexKey key{
            {std::bit_cast<uint32_t>(v[0]), std::bit_cast<uint32_t>(v[1]), std::bit_cast<uint32_t>(v[2])}};
        const auto [it, fresh] = known.try_emplace(key, uint32_t(out.vertexCount()));
        if (fresh) out.vertices.insert(out.vertices.end(), v, v + 3);
        return it->second;
    }

    void addMesh(const aiMesh& mesh, const aiMatrix4x4& transform) {
        const bool mirrored = aiMatrix3x3(transform).Determinant() < 0.0f;
        std::vector<uint32_t> corners;
        for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
            const aiFace& face = mesh.mFaces[f];
            if (face.mNumIndices < 3) continue; // points and lines enclose nothing
            corners.clear();
            for (unsigned k = 0; k < face.mNumIndices; ++k) {
                if (face.mIndices[k] >= mesh.mNumVertices) throw std::runtime_error("has a face that names no vertex");
                corners.push_back(weld(transform * mesh.mVertices[face.mIndices[k]]));
            }
            if (mirrored) std::reverse(corners.begin(), corners.end());
            addPolygon(out, corners);
            if (out.triangleCount() > kMaxTriangles) throw std::runtime_error("has more than 100000000 triangles");
        }
    }

    void addNode(const aiNode& node, const aiMatrix4x4& parent, int depth) {
        if (depth > kMaxNodeDepth || ++nodes > kMaxNodes) throw std::runtime_error("has too many nodes");
        const aiMatrix4x4 transform = parent * node.mTransformation;
        for (unsigned i = 0; i < node.mNumMeshes; ++i)
            if (node.mMeshes[i] < source.mNumMeshes) addMesh(*source.mMeshes[node.mMeshes[i]], transform);
        for (unsigned i = 0; i < node.mNumChildren; ++i) addNode(*node.mChildren[i], transform, depth + 1);
    }
};

std::string oneLine(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](unsigned char c) { return c < 32 || c == 127; }, ' ');
    if (text.size() > 160) text = text.substr(0, 157) + "...";
    return text;
}
// The importer takes memory for as many elements as a PLY header promises, before it looks whether they are there
// (minutes and gigabytes for a file of 80 bytes). An element takes at least a byte.
void checkPlyHeader(const std::string& path, uintmax_t bytes) {
    std::ifstream in(path, std::ios::binary);
    std::string line;
    for (int lines = 0; lines < 1000 && std::getline(in, line); ++lines) {
        std::istringstream words(line);
        std::string word, name, count;
        words >> word >> name >> count;
        if (word == "end_header") return;
        if (word != "element") continue;
        uint64_t value = 0;
        const auto result = std::from_chars(count.data(), count.data() + count.size(), value);
        if (result.ec != std::errc() || result.ptr != count.data() + count.size())
            throw std::runtime_error("cannot be read: element count '" + oneLine(count) + "'");
        if (value > bytes)
            throw std::runtime_error("cannot be read: ends before its " + std::to_string(value) + " " + oneLine(name) +
                                     " elements");
    }
    throw std::runtime_error("cannot be read: no end of its header");
}
} // namespace

TriMesh importMesh(const std::string& path) {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) throw std::runtime_error("no such file");
    if (!fs::is_regular_file(status)) throw std::runtime_error("is not a file");
    const auto bytes = fs::file_size(path, error);
    if (error) throw std::runtime_error("cannot be read");
    if (bytes == 0) throw std::runtime_error("is empty");
    if (bytes > kMaxFileBytes) throw std::runtime_error("is larger than 1 GiB");

    std::string extension = fs::path(path).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(c >= 'A' && c <= 'Z' ? c + 32 : c); });
    constexpr const char* kKnown[] = {".obj", ".ply", ".stl", ".gltf", ".glb"};
    if (std::none_of(std::begin(kKnown), std::end(kKnown), [&](const char* k) { return extension == k; }))
        throw std::runtime_error("unknown mesh format '" + oneLine(extension) + "' (known: obj, ply, stl, gltf, glb)");

    if (extension == ".ply") checkPlyHeader(path, bytes);

    Assimp::Importer importer;
    const aiScene* source = nullptr;
    try {
        source = importer.ReadFile(path, 0);
    } catch (const std::exception& e) { // some importers let theirs through
        throw std::runtime_error(oneLine(std::string("cannot be read: ") + e.what()));
    }
    if (!source || !source->mRootNode) {
        const std::string reason = importer.GetErrorString();
        throw std::runtime_error(oneLine("cannot be read: " + (reason.empty() ? "not a mesh" : reason)));
    }
    Joiner joiner{*source, {}, {}, 0};
    joiner.addNode(*source->mRootNode, aiMatrix4x4(), 0);
    if (joiner.out.indices.empty()) throw std::runtime_error("holds no triangles");
    return std::move(joiner.out);
}

} // namespace thaw::scene
