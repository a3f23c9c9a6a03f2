// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "validate/lab.h"
#include "validate/validate.h"

namespace thaw::player {
namespace {

void spinningBlob(Findings& found) {
    Lab lab(0.004f, 4000, {0, 0, 0});
    thawMaterialDef m = Lab::plain(1000, 1);
    m.cohesion = 6;
    lab.body(lab.material(m), scene::makeSphere(0.02f), {0, 0, 0}, Lab::kLiquid, [](thawBodyDef& d) {
        d.velocity = {0.1f, 0.05f, 0};
        d.angularVelocity = {0, 0, 3};
    });
    const Momentum before = momentumOf(lab.particles());
    lab.step(600);
    const Momentum after = momentumOf(lab.particles());
    double p[3], l[3];
    for (int k = 0; k < 3; ++k) p[k] = after.p[k] - before.p[k], l[k] = after.l[k] - before.l[k];
    found.atMost("linear momentum, change / whole", 1e-5, lengthOf(p) / lengthOf(before.p));
    found.atMost("angular momentum, change / whole", 1e-2, lengthOf(l) / lengthOf(before.l));
}

} // namespace

CaseList liquidCases() {
    return {{"spinning-blob", "sphere of 1 Pa s, r 20 mm at 4 mm, drifts and spins freely for 10 s", spinningBlob}};
}

} // namespace thaw::player
