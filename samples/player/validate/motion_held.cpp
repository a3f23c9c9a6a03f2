// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "report.h"
#include "validate/layer.h"
#include "validate/validate.h"

#include <cmath>

namespace thaw::player {
namespace {

void filmOnHeld(Findings& found) {
    struct Case {
        float spacing;
        int layers;
        float viscosity;
        double degrees;
    };
    for (const Case c :
         {Case{0.002f, 3, 3, 30}, Case{0.002f, 6, 5, 30}, Case{0.004f, 4, 10, 60}, Case{0.004f, 6, 20, 30}}) {
        thawMaterialDef m = Lab::plain(1000, c.viscosity);
        m.adhesion = 0;
        const double slope = c.degrees * kPi / 180;
        double speed[2] = {}, first[2] = {};
        for (const Layer::Ground ground : {Layer::kPlane, Layer::kHeld}) {
            Layer film(m, c.spacing, c.layers, slope, 128, 12, true, ground);
            film.lab.step(75);
            constexpr int kFrames = 20;
            film.lab.step(kFrames, [&](int) {
                const Layer::Middle now = film.middle(0.5 * film.length);
                // Of the theory at the thickness of now.
                speed[ground] += now.surface * 2 * static_cast<double>(c.viscosity) /
                                 (1000 * kG * std::sin(slope) * now.thickness * now.thickness) / kFrames;
                first[ground] += now.first / film.spacing / kFrames;
            });
        }
        const std::string name = formatted("%g mm, %d layers, %g Pa s, %g deg: ", static_cast<double>(c.spacing) * 1e3,
                                           c.layers, static_cast<double>(c.viscosity), c.degrees);
        found.within(name + "first layer over a collider, over held particles, spacings", first[0], first[1], 0.1);
        found.within(name + "speed / theory, the same", speed[0], speed[1], 0.1);
    }
}

} // namespace

CaseList heldCases() {
    return {{"film-on-held", "creeping film on held particles: as far off and as fast as on a collider", filmOnHeld}};
}

} // namespace thaw::player
