// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "validate/lab.h"

#include <functional>

// What the cases of heat share.
namespace thaw::player {

// kg/m^3, J/(kg K), W/(m K), the same in both phases; neither absorbs nor emits, and what melts stays where it is.
thawMaterialDef stays(double density, double specificHeat, double conductivity);
// The same with two phases and a sharp melting point; latent heat in J/kg.
struct Melting {
    double density, kSolid, kLiquid, cSolid, cLiquid, latent, point;
};
thawMaterialDef stays(const Melting& m);

double areaOf(const scene::TriMesh& mesh);
double exposedArea(const Lab& lab); // m^2, of all particles

// A world without gravity, whose air takes no heat, with a bar along an axis between four insulating walls: sections of
// any materials and temperatures one after the other, each a body of its own.
class Bar {
public:
    // spacing in m, width of the cross-section in particles; axis 0..2: x, y, z
    Bar(float spacing, int width, int maxParticles, float timeScale, double ambient, int axis = 0);
    // Appends `layers` layers, filled with particles of a level; layers and width must be even where it is above 0. The
    // plan decides whether they keep it (lab.budget.work).
    void section(const thawMaterialDef& material, int layers, double temperature, int level = 0);
    void section(thawMaterialId material, int layers, double temperature, int level = 0);
    // A wall at this temperature where the bar begins, or where it ends now; perfect contact.
    void holdBegin(double temperature);
    void holdEnd(double temperature);
    // Heat seconds of n steps; steps until `seconds` of heat have passed, in whole steps.
    double stepSeconds() const { return timeScale_ / 60.0; }
    void run(double seconds);
    double time() const { return time_; } // s of heat

    int layers() const { return layers_; }
    // m from the beginning of a particle, by its index in the view
    double along(const thawParticleView& view, int particle) const {
        return static_cast<double>(view.positions[4 * particle + axis_]);
    }
    // Mean over a layer, counted from the bar's beginning.
    std::vector<double> temperatures() const;
    double molten() const; // layers, the sum of the mean liquid fractions
    Lab lab;

private:
    void hold(float x, float direction, double temperature);
    std::vector<double> means(const float* values) const;
    float spacing_, timeScale_;
    int width_, layers_ = 0, axis_;
    double time_ = 0;
};

} // namespace thaw::player
