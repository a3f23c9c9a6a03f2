// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "mesh.h"

#include <functional>

namespace thaw::scene {

// A lattice of cubes that holds all of a form.
struct FieldLattice {
    double x, y, z; // m, its lowest corner
    double cell;    // m
    int nx, ny, nz; // cubes
};

// The surface where a field is 0, below 0 being inside: a vertex for each cube that it crosses (naive surface nets,
// after Gibson, MICCAI 1998). Closed where the field is above 0 all around the lattice and two cubes deep. Always the
// same for the same numbers.
TriMesh meshOfField(const FieldLattice& lattice, const std::function<double(double x, double y, double z)>& field);

// The lower of two distances, run into one over `blend` (m) where both are near.
double blendedMin(double a, double b, double blend);

} // namespace thaw::scene
