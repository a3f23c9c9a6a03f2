// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "surface_fixture.h"

#include <cstring>

template <class T> bool sameBits(const thaw::Array<T>& a, const thaw::Array<T>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

inline bool sameBits(const thaw::Surface& a, const thaw::Surface& b) {
    return sameBits(a.positions, b.positions) && sameBits(a.normals, b.normals) &&
           sameBits(a.temperatures, b.temperatures) && sameBits(a.liquidFractions, b.liquidFractions) &&
           sameBits(a.materials, b.materials) && sameBits(a.bodies, b.bodies) && sameBits(a.mixtures, b.mixtures) &&
           sameBits(a.indices, b.indices);
}
