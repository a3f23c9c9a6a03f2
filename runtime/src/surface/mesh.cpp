// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/mesh.h"

namespace thaw {
namespace {

template <class T> void copyArray(const Array<T>& from, Array<T>& to) {
    to.resizeRaw(from.size());
    if (!from.empty()) std::memcpy(static_cast<void*>(to.data()), from.data(), from.size() * sizeof(T));
}

} // namespace

void SurfaceMesh::clear() {
    positions.clear(), normals.clear(), temperatures.clear(), liquidFractions.clear();
    materials.clear(), bodies.clear(), mixtures.clear(), indices.clear();
}

void SurfaceMesh::copy(const SurfaceMesh& from) {
    copyArray(from.positions, positions), copyArray(from.normals, normals);
    copyArray(from.temperatures, temperatures), copyArray(from.liquidFractions, liquidFractions);
    copyArray(from.materials, materials), copyArray(from.bodies, bodies), copyArray(from.mixtures, mixtures);
    copyArray(from.indices, indices);
}

} // namespace thaw
