// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

#include "view/math.h"

#include <span>
#include <string>

namespace thaw::view {

/// Binary little-endian PLY with, per vertex: x y z nx ny nz, red green blue (the material's colour in sRGB),
/// temperature (K), liquid_fraction (0..1) and material (index). colors: linear RGB per material; a missing one is
/// light grey. False, with the reason in error, when the file cannot be written whole.
bool writePly(const std::string& path, const thawSurfaceView& surface, std::span<const Vec3> colors,
              std::string& error);

/// Wavefront OBJ with normals; the vertex lines carry red green blue (0..1, sRGB) behind x y z, as Blender and MeshLab
/// read.
bool writeObj(const std::string& path, const thawSurfaceView& surface, std::span<const Vec3> colors,
              std::string& error);

} // namespace thaw::view
