// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#include "view/mesh_io.h"

#include "view/color_map.h"

#include <bit>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <initializer_list>
#include <memory>

namespace thaw::view {

namespace {

struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

bool save(const std::string& path, const std::string& bytes, std::string& error) {
    std::unique_ptr<std::FILE, Closer> file(std::fopen(path.c_str(), "wb"));
    if (!file) return error = "cannot open " + path + " for writing", false;
    const bool whole = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
    if (!whole || std::fflush(file.get()) != 0) return error = "cannot write all of " + path, false;
    return true;
}

bool usable(const thawSurfaceView& surface, std::string& error) {
    if (surface.vertexCount > 0 && surface.triangleCount > 0 && surface.positions && surface.normals && surface.indices)
        return true;
    error = "the surface is empty";
    return false;
}

Vec3 colorOf(const thawSurfaceView& surface, std::span<const Vec3> colors, size_t vertex) {
    const size_t material = surface.materials ? surface.materials[vertex] : 0;
    return material < colors.size() ? colors[material] : Vec3{0.6f, 0.6f, 0.6f};
}

void put(std::string& out, uint32_t word) {
    const char bytes[4] = {static_cast<char>(word & 255), static_cast<char>(word >> 8 & 255),
                           static_cast<char>(word >> 16 & 255), static_cast<char>(word >> 24 & 255)};
    out.append(bytes, 4);
}
void put(std::string& out, float value) { put(out, std::bit_cast<uint32_t>(value)); }

} // namespace

bool writePly(const std::string& path, const thawSurfaceView& surface, std::span<const Vec3> colors,
              std::string& error) {
    if (!usable(surface, error)) return false;
    const auto vertices = static_cast<size_t>(surface.vertexCount),
               triangles = static_cast<size_t>(surface.triangleCount);
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment surface of a thaw world, metres and kelvin\n";
    out += "element vertex " + std::to_string(vertices) + "\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) out += std::string("property float ") + name + "\n";
    for (const char* name : {"red", "green", "blue"}) out += std::string("property uchar ") + name + "\n";
    out += "property float temperature\nproperty float liquid_fraction\nproperty uchar material\n";
    out += "element face " + std::to_string(triangles) + "\nproperty list uchar int vertex_indices\nend_header\n";
    out.reserve(out.size() + vertices * 36 + triangles * 13);
    for (size_t i = 0; i < vertices; ++i) {
        for (size_t k = 0; k < 3; ++k) put(out, surface.positions[i * 3 + k]);
        for (size_t k = 0; k < 3; ++k) put(out, surface.normals[i * 3 + k]);
        const Vec3 color = colorOf(surface, colors, i);
        for (const float channel : {color.x, color.y, color.z}) out += static_cast<char>(encodeSrgb(channel));
        put(out, surface.temperatures ? surface.temperatures[i] : 0.0f);
        put(out, surface.liquidFractions ? surface.liquidFractions[i] : 0.0f);
        out += static_cast<char>(surface.materials ? surface.materials[i] : 0);
    }
    for (size_t t = 0; t < triangles; ++t) {
        out += static_cast<char>(3);
        for (size_t k = 0; k < 3; ++k) put(out, surface.indices[t * 3 + k]);
    }
    return save(path, out, error);
}

bool writeObj(const std::string& path, const thawSurfaceView& surface, std::span<const Vec3> colors,
              std::string& error) {
    if (!usable(surface, error)) return false;
    std::string out = "# surface of a thaw world, metres\no thaw_surface\n";
    // to_chars and not printf: a host with a locale of commas would write "1,5".
    char digits[32];
    const auto add = [&](const char* head, std::initializer_list<float> values) {
        out += head;
        for (const float v : values) {
            out += ' ';
            out.append(digits, std::to_chars(digits, digits + sizeof digits, v).ptr);
        }
    };
    const auto vertices = static_cast<size_t>(surface.vertexCount),
               triangles = static_cast<size_t>(surface.triangleCount);
    for (size_t i = 0; i < vertices; ++i) {
        const float* p = surface.positions + i * 3;
        const Vec3 c = colorOf(surface, colors, i);
        add("v", {p[0], p[1], p[2], encodeSrgb(c.x) / 255.0f, encodeSrgb(c.y) / 255.0f, encodeSrgb(c.z) / 255.0f});
        out += '\n';
    }
    for (size_t i = 0; i < vertices; ++i) {
        const float* n = surface.normals + i * 3;
        add("vn", {n[0], n[1], n[2]});
        out += '\n';
    }
    for (size_t t = 0; t < triangles; ++t) {
        out += 'f';
        for (size_t k = 0; k < 3; ++k) {
            const std::string index = std::to_string(surface.indices[t * 3 + k] + 1);
            out += ' ' + index + "//" + index;
        }
        out += '\n';
    }
    return save(path, out, error);
}

} // namespace thaw::view
