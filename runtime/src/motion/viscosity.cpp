// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/math.h"
#include "motion/motion.h"
#include "motion/numbers.h"
#include "motion/pairs.h"
#include "motion/rigid_liquid.h"
#include "motion/walls.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr float kTolerance = 1e-2f; // of the change that gravity makes in a step
// With elastic solids: what is left over is a share of their weight that nothing carries.
constexpr float kElasticTolerance = 3e-3f;
// How often what is pressed against walls is found again with the velocities that come of it.
constexpr int kGripRounds = 3;
constexpr float kLeastGravity = 1; // m/s^2, for that measure where there is none
// What turns liquid starts stiff and softens by this much a step: half of it gone after seven.
// Of a block born liquid in a tank, 0.02 / 0.3 Pa s, 12 spacings deep, the worst mean compression is 5.6 / 5.4 % with
// 0.8, 3.9 / 3.7 % with 0.9 (7.9 / 7.8 % with 0.6): pressure has to take over from viscosity while it fades.
constexpr float kSofteningLog = -0.105360516f; // ln 0.9
// Where less than this many spacings of liquid press on it, it has nothing to wait for: melt on a face of wax would
// creep for half a second before it runs.
constexpr float kShallow = 4, kShallowSofteningLog = -0.223143551f; // ln 0.8
// Stiff is a viscosity above so many rho dx^2 / dt.
constexpr float kStiffFrom = 10;
// How much thicker or thinner a melt with a yield stress gets in a step, and the share of the lattice's neighbours that
// a shear rate is taken from at least.
constexpr float kThickening = 1.25f, kLeastStrainShare = 0.1f;

// Inverts the symmetric block xx yy zz, xy xz yz in place. In double: a particle that is tied to held ones in two
// directions and free in the third has a block whose small end single precision loses.
void invert(Vec4& diagonal, Vec4& cross) {
    const double least = 1e-6 * (static_cast<double>(diagonal.x) + diagonal.y + diagonal.z);
    const double a = diagonal.x + least, b = diagonal.y + least, c = diagonal.z + least;
    const double d = cross.x, e = cross.y, f = cross.z;
    const double A = b * c - f * f, B = e * f - d * c, C = d * f - b * e, s = 1 / (a * A + d * B + e * C);
    diagonal = {static_cast<float>(s * A), static_cast<float>(s * (a * c - e * e)),
                static_cast<float>(s * (a * b - d * d)), 0};
    cross = {static_cast<float>(s * B), static_cast<float>(s * C), static_cast<float>(s * (d * e - a * f)), 0};
}

} // namespace

// What a wall's no-slip does to a mover, kg. Slip: the velocity is the wall's that far behind it (Navier).
Motion::WallShear Motion::wallShear(const MotionFrame& f, size_t i, size_t c) const {
    const bool rim = contactOf_[c] == kRim;
    const WallTable& table = wallTable();
    const float h = f.particles.position[i].w, nearest = kWallStandoff / kSupport, q = contact_[c].w / h,
                near = std::max(q, nearest);
    float tangent = kSupport * firstLayer(q * kSupport) / near;
    const float normal = WallTable::lookup(table.normal, std::max(q, 0.0f));
    if (rim)
        tangent = 0;
    else if (slippery_)
        tangent *= near * h / (near * h + f.colliders[contactOf_[c]].slipLength);
    const float weight = f.dt * trait_[i].x * shearMoment() * f.volume[i] / (h * h);
    return {weight * tangent, weight * (normal - tangent)};
}

// image = (M + drag + pairs) velocity, for the movers of the groups; `walls`: 0 for what they grip.
void Motion::applyViscosity(const MotionFrame& f, const Vec4* velocity, int begin, int end, bool walls) {
    const Particles& p = f.particles;
    pairViscosity(
        {PairLists(f.neighbors), p.position.data(), trait_.data(), coefficient_.data(), velocity, image_.data()}, begin,
        end);
    const int last = std::min(8 * end, p.moverCount);
    for (int r = 8 * begin; r < last; ++r) {
        const size_t i = static_cast<size_t>(r);
        if (!contactCount_[i]) continue;
        const Vec3 v = velocity[i].xyz();
        const Vec4 a = wallDrag_[2 * i], b = wallDrag_[2 * i + 1];
        image_[i].setXyz(image_[i].xyz() + Vec3{a.x * v.x + b.x * v.y + b.y * v.z, b.x * v.x + a.y * v.y + b.z * v.z,
                                                b.y * v.x + b.z * v.y + a.z * v.z});
    }
    if (f.guide)
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            image_[i].setXyz(image_[i].xyz() + f.guide[i].w * trait_[i].z * f.guided(i, velocity[i].xyz()));
        }
    for (int r = last; r < 8 * end; ++r) image_[static_cast<size_t>(r)] = {};
    if (!bonded_) return;
    for (int r = 8 * begin; r < last && f.coupling; ++r) {
        const size_t i = static_cast<size_t>(r);
        if (const SoftContacts::Contact* c = f.coupling->softOf(i))
            image_[i].setXyz(image_[i].xyz() + c->drag(f.dt, velocity[i].xyz() - velocity[c->row].xyz()));
    }
    if (!walls) return;
    for (int r = 8 * begin; r < last; ++r) {
        const size_t i = static_cast<size_t>(r);
        if (!gripped(i)) continue;
        image_[i].setXyz(slides(i) ? freeOf(i, image_[i].xyz() + slide_[i].drag * velocity[i].xyz()) : Vec3{});
    }
}

// What a yield stress adds to the viscosity of the next step in Pa s, from the shear rate that this solve ended with.
// Into image_.x, for the rows that have one.
void Motion::thicken(const MotionFrame& f) {
    const Particles& p = f.particles;
    const float least = kWallStandoff / kSupport;
    const float perRate = 5 * latticeSum() / shearMoment(), lattice = strainMoment() / latticeSum();
    f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int, int) {
        const int last = std::min(8 * end, p.moverCount);
        const auto yields = [&](size_t i) { return f.materials[p.material[i]].def.yieldStress > 0; };
        bool any = false;
        for (int r = 8 * begin; r < last && !any; ++r) any = yields(static_cast<size_t>(r));
        if (!any) return;
        pairStrain({PairLists(f.neighbors), p.position.data(), p.velocity.data(), image_.data()}, begin, end);
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            if (!yields(i)) continue;
            const Vec3 v = p.velocity[i].xyz();
            const float h = p.position[i].w, share = std::max(kLeastStrainShare, image_[i].y / lattice);
            float rate = std::sqrt(perRate * image_[i].x / share);
            // A plug that slides on a wall has its shear between the wall and the first layer alone, where half of the
            // neighbours know nothing of it.
            for (size_t c = i * kContacts, n = c + contactCount_[i]; c < n; ++c) {
                const Vec4 k = contact_[c];
                if (!(k.w < h)) continue;
                const Vec3 slip = wallsMove_ ? v - wallVelocity_[c].xyz() : v,
                           along = slip - dot(k.xyz(), slip) * k.xyz();
                rate = std::max(rate, length(along) / std::max(k.w, least * h));
            }
            const Vec4 held = held_[i];
            if (held.w < INFINITY) {
                const Vec3 slip = heldMoves_ ? v - heldVelocity_[i].xyz() : v;
                const Vec3 along = slip - dot(held.xyz(), slip) * held.xyz();
                rate = std::max(rate, length(along) / (std::max(held.w, 0.0f) + 0.5f * h / kSupport));
            }
            const Material& m = f.materials[p.material[i]];
            const float mu = m.viscosity(p.liquidFraction[i]);
            const float old = mu + p.velocityChange[i].w;
            image_[i].x = std::clamp(mu + m.yieldViscosity(mu, rate), old / kThickening, old * kThickening) - mu;
            image_[i].x = std::max(0.0f, image_[i].x);
        }
    });
}

// What the guide's drag did to momentum and, on the mean of the velocities before and after, to kinetic energy.
void Motion::bookGuide(const MotionFrame& f) {
    const Particles& p = f.particles;
    for (int r = 0; r < p.moverCount; ++r) {
        const size_t i = static_cast<size_t>(r);
        const Vec4 g = f.guide[i], v = p.velocity[i], u = before_[i];
        if (!(g.w > 0)) continue;
        const double weight = static_cast<double>(g.w) * trait_[i].z;
        const Vec3 change = f.guided(i, g.xyz() - v.xyz());
        const double J[3] = {weight * change.x, weight * change.y, weight * change.z};
        for (int a = 0; a < 3; ++a) stats_.guideImpulse[a] += J[a];
        stats_.guideEnergy += 0.5 * (J[0] * (static_cast<double>(u.x) + v.x) + J[1] * (static_cast<double>(u.y) + v.y) +
                                     J[2] * (static_cast<double>(u.z) + v.z));
    }
}

// The same of what rims held back, and of what was pressed against them.
void Motion::bookRims(const MotionFrame& f) {
    const Particles& p = f.particles;
    for (int r = 0; r < p.moverCount; ++r) {
        const size_t i = static_cast<size_t>(r);
        for (size_t c = i * kContacts, n = c + contactCount_[i]; c < n; ++c) {
            if (contactOf_[c] != kRim) continue;
            const Vec3 v = p.velocity[i].xyz(), k = kick_[c].xyz();
            const double m = trait_[i].z, J[3] = {m * k.x, m * k.y, m * k.z};
            for (int a = 0; a < 3; ++a) stats_.guideImpulse[a] += J[a];
            stats_.guideEnergy += J[0] * (v.x - 0.5 * k.x) + J[1] * (v.y - 0.5 * k.y) + J[2] * (v.z - 0.5 * k.z);
        }
    }
}

void Motion::viscosity(const MotionFrame& f) {
    Particles& p = f.particles;
    if (p.moverCount == 0) return;
    const float scale = std::max(length(f.gravity), kLeastGravity) * f.dt;
    const auto forMovers = [&](auto&& body) {
        f.tasks.forBlocks(f.neighbors.moverGroups, kBlock, [&](int begin, int end, int block, int) {
            sums_[static_cast<size_t>(block)] = {};
            body(begin, end, std::min(8 * end, p.moverCount), sums_[static_cast<size_t>(block)]);
        });
    };
    const auto total = [&](double BlockSums::*which) {
        double sum = 0;
        for (const BlockSums& s : sums_) sum += s.*which;
        return sum;
    };

    // No-slip walls as if the liquid went on behind them with the velocity mirrored linearly, and the diagonal blocks.
    //
    // The start is what the last solve did to the velocities, but where something stiff or held is about it is the
    // velocity before this step, in which that keeps its shape. The iterations are capped, and what they leave of a
    // start that strains something stiff comes out as speed: a crumb of 1e4 Pa s that had just been cut loose and
    // touched something held got 1.2 m/s out of one frame of gravity. Of a bunny that melts, 15 s, 15 particles passed
    // 0.7 m/s, the fastest 1.7 m/s; with the velocity before for all that move 9 and 1.22, all of them drops in free
    // fall.
    const float foldTime = pressureFold(f.subSteps) * f.dt;
    forMovers([&](int begin, int end, int last, BlockSums& sums) {
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            const float mass = trait_[i].z, h = p.position[i].w;
            Vec4 diagonal = inverse_[i], cross = cross_[i];
            diagonal.setXyz(diagonal.xyz() + Vec3{mass, mass, mass});
            if (contactCount_[i]) {
                Vec4 a, b;
                Vec3 push;
                const size_t first = i * kContacts;
                for (size_t c = first, n = landing_[i].w < 0 || p.bondSlot[i] ? first : first + contactCount_[i]; c < n;
                     ++c) { // elastic solids have friction instead
                    const Vec4 k = contact_[c];
                    if (k.w >= h) continue;
                    const WallShear w = wallShear(f, i, c);
                    const float t = w.tangent, s = w.normal;
                    if (wallsMove_) push += w.on(k.xyz(), wallVelocity_[c].xyz());
                    a.x += t + s * k.x * k.x, a.y += t + s * k.y * k.y, a.z += t + s * k.z * k.z;
                    b.x += s * k.x * k.y, b.y += s * k.x * k.z, b.z += s * k.y * k.z;
                }
                wallDrag_[2 * i] = a, wallDrag_[2 * i + 1] = b;
                if (wallsMove_) wallPush_[i] = {push.x, push.y, push.z, 0};
                diagonal.setXyz(diagonal.xyz() + a.xyz()), cross.setXyz(cross.xyz() + b.xyz());
            }
            if (f.guide) {
                const float drag = f.guide[i].w * mass;
                const Vec3 n = f.unguided ? f.unguided[i].xyz() : Vec3{};
                diagonal.setXyz(diagonal.xyz() + drag * Vec3{1 - n.x * n.x, 1 - n.y * n.y, 1 - n.z * n.z});
                cross.setXyz(cross.xyz() - drag * Vec3{n.x * n.y, n.x * n.z, n.y * n.z});
            }
            if (bonded_ && f.coupling)
                if (const SoftContacts::Contact* c = f.coupling->softOf(i)) {
                    const Vec3 x = c->drag(f.dt, {1, 0, 0}), y = c->drag(f.dt, {0, 1, 0}), z = c->drag(f.dt, {0, 0, 1});
                    diagonal.setXyz(diagonal.xyz() + Vec3{x.x, y.y, z.z});
                    cross.setXyz(cross.xyz() + Vec3{x.y, x.z, y.z});
                }
            if (bonded_ && contactCount_[i]) block_[2 * i] = diagonal, block_[2 * i + 1] = cross;
            invert(diagonal, cross);
            inverse_[i] = diagonal, cross_[i] = cross;
            before_[i] = p.velocity[i];
            const float spacing = h / kSupport, folded = foldTime * trait_[i].w,
                        own = std::sqrt(std::max(0.0f, trait_[i].x * trait_[i].x - folded * folded)) * shearMoment();
            const bool stiff = own * f.dt * f.volume[i] > kStiffFrom * mass * spacing * spacing;
            const Vec3 start =
                stiff || held_[i].w < INFINITY ? target_[i].xyz() : p.velocity[i].xyz() + p.velocityChange[i].xyz();
            p.velocity[i].setXyz(start);
            const double allowed = static_cast<double>(mass) * scale;
            sums.a += allowed * allowed;
        }
        for (int r = last; r < 8 * end; ++r) {
            const size_t i = static_cast<size_t>(r);
            inverse_[i] = cross_[i] = residual_[i] = {};
        }
    });
    RigidLiquid* const pieces = f.coupling && f.coupling->any() ? f.coupling : nullptr;
    if (pieces) pieces->prime(f);
    const double tolerance = static_cast<double>(bonded_ ? kElasticTolerance : kTolerance);
    const double allowed = tolerance * tolerance * total(&BlockSums::a);

    // What velocities leave undone; what walls hold has no say in the iterations that follow.
    const auto findResidual = [&] {
        forMovers([&](int begin, int end, int last, BlockSums&) {
            applyViscosity(f, p.velocity.data(), begin, end, false);
            for (int r = 8 * begin; r < last; ++r) {
                const size_t i = static_cast<size_t>(r);
                Vec3 res = trait_[i].z * before_[i].xyz() - image_[i].xyz();
                if (wallsMove_ && contactCount_[i]) res += wallPush_[i].xyz();
                if (f.guide) res += f.guide[i].w * trait_[i].z * f.guided(i, f.guide[i].xyz());
                if (bonded_ && f.coupling)
                    if (const SoftContacts::Contact* c = f.coupling->softOf(i)) res += c->push(f.dt);
                residual_[i] = {res.x, res.y, res.z, 0};
            }
        });
    };
    double rz = 0, rr = 0;
    int iteration = 0;
    for (int round = 0; round < (bonded_ ? kGripRounds : 1); ++round) {
        // A body in flight moves as one: its own stiffness keeps that out of reach of the iterations.
        if (bonded_ && round == 0) {
            returnMomentum(f, false);
            for (size_t i = 0; i < static_cast<size_t>(p.moverCount); ++i)
                if (piece_[i] == kAfloat) piece_[i] = kUnknown;
        }
        if (pieces && round > 0) pieces->show(f);
        const bool touches = pieces && pieces->decideSoft(f);
        findResidual();
        if (bonded_) {
            if (round == 0)
                findBodies(f);
            else
                weighBodies(f);
            const bool changed = regrip(f);
            if (round > 0 && !changed && !touches) break;
            if (changed) findResidual();
            leaveGripped(f);
            if (moveAsOne(f)) findResidual(), leaveGripped(f);
        }
        forMovers([&](int begin, int, int last, BlockSums& sums) {
            for (int r = 8 * begin; r < last; ++r) {
                const size_t i = static_cast<size_t>(r);
                const Vec3 res = residual_[i].xyz();
                const Vec4 m = inverse_[i], c = cross_[i];
                const Vec3 z{m.x * res.x + c.x * res.y + c.y * res.z, c.x * res.x + m.y * res.y + c.z * res.z,
                             c.y * res.x + c.z * res.y + m.z * res.z};
                direction_[i] = {z.x, z.y, z.z, 0};
                sums.a += static_cast<double>(dot(res, z)), sums.b += static_cast<double>(dot(res, res));
            }
        });
        rz = total(&BlockSums::a), rr = total(&BlockSums::b);
        if (pieces) {
            const Dots dots = pieces->start(f, direction_.data());
            rz += dots.a, rr += dots.b;
        }

        // Forces as in the last step are a good start, but velocities that the iterations do not reach go on
        // accelerating with it: at 1e5 Pa s a free cylinder gained a third of its speed every step. Where the
        // velocities before the step would have been the better start, the best point on the way to them is taken,
        // which dissipates no more than those did: that bounds them.
        if (round == 0 && rr > allowed) {
            forMovers([&](int begin, int, int last, BlockSums&) {
                for (int r = 8 * begin; r < last; ++r) {
                    const size_t i = static_cast<size_t>(r);
                    const Vec3 back = target_[i].xyz() - p.velocity[i].xyz(), way = gripped(i) ? freeOf(i, back) : back;
                    direction_[i] = {way.x, way.y, way.z, 0};
                }
            });
            if (pieces) pieces->aimBack(f, direction_.data());
            forMovers([&](int begin, int end, int, BlockSums& sums) {
                applyViscosity(f, direction_.data(), begin, end, true);
                sums.a = innerProduct(direction_.data(), image_.data(), 8 * begin, 8 * end);
                sums.b = innerProduct(direction_.data(), residual_.data(), 8 * begin, 8 * end);
            });
            const double curvature = total(&BlockSums::a) + (pieces ? pieces->curvature(f, direction_.data()) : 0),
                         slope = total(&BlockSums::b) + (pieces ? pieces->slope() : 0);
            const double back = slope > 0.5 * curvature && curvature > 0 ? slope / curvature : 0;
            forMovers([&](int begin, int end, int, BlockSums& sums) {
                const Dots dots = advance(static_cast<float>(back), direction_.data(), image_.data(), inverse_.data(),
                                          cross_.data(), p.velocity.data(), residual_.data(), 8 * begin, 8 * end);
                turn(0, image_.data(), direction_.data(), 8 * begin, 8 * end);
                sums.a = dots.a, sums.b = dots.b;
            });
            rz = total(&BlockSums::a), rr = total(&BlockSums::b);
            if (pieces) {
                const Dots dots = pieces->advance(back);
                rz += dots.a, rr += dots.b;
                pieces->turn(f, 0, direction_.data());
            }
        }

        for (int n = 0; n < f.viscosityIterations && rr > allowed && rz > 0; ++n, ++iteration) {
            if (n >= f.leastViscosity && f.safePoints && f.safePoints->late()) break;
            forMovers([&](int begin, int end, int, BlockSums& sums) {
                applyViscosity(f, direction_.data(), begin, end, true);
                sums.a = innerProduct(direction_.data(), image_.data(), 8 * begin, 8 * end);
            });
            const double curvature = total(&BlockSums::a) + (pieces ? pieces->curvature(f, direction_.data()) : 0);
            if (!(curvature > 0)) break;
            forMovers([&](int begin, int end, int, BlockSums& sums) {
                const Dots dots =
                    advance(static_cast<float>(rz / curvature), direction_.data(), image_.data(), inverse_.data(),
                            cross_.data(), p.velocity.data(), residual_.data(), 8 * begin, 8 * end);
                sums.a = dots.a, sums.b = dots.b;
            });
            double next = total(&BlockSums::a);
            rr = total(&BlockSums::b);
            if (pieces) {
                const Dots dots = pieces->advance(rz / curvature);
                next += dots.a, rr += dots.b;
            }
            const float keep = static_cast<float>(next / rz);
            rz = next;
            if (!(rr > allowed)) continue;
            forMovers([&](int begin, int end, int, BlockSums&) {
                turn(keep, image_.data(), direction_.data(), 8 * begin, 8 * end);
            });
            if (pieces) pieces->turn(f, static_cast<double>(keep), direction_.data());
        }
    }
    stats_.viscosityIterations = iteration;
    stats_.iterationsClipped = rr > allowed;

    // A solve that met a number that is not finite must not spread it.
    const bool sound = std::isfinite(rr) && std::isfinite(rz);

    if (sound && pieces) pieces->show(f);
    if (sound && bonded_ && reporting_) findResidual(), reportGrip(f);
    if (sound && pieces) returnShared(f);
    if (sound) returnMomentum(f, wallsMove_ || reporting_ || heldMoves_ || f.guide);
    if (sound && f.guide) bookGuide(f);
    if (pieces) pieces->finish(f, sound);
    if (sound) reportHeldDrag(f);
    if (sound && kicks())
        forMovers([&](int begin, int, int last, BlockSums&) {
            for (int r = 8 * begin; r < last; ++r) {
                const size_t i = static_cast<size_t>(r);
                if (landing_[i].w < 0 || p.bondSlot[i]) continue;
                for (size_t c = i * kContacts, n = c + contactCount_[i]; c < n; ++c) {
                    if (contact_[c].w >= p.position[i].w) continue;
                    const Vec3 wall = wallsMove_ ? wallVelocity_[c].xyz() : Vec3{};
                    kick(c, (1 / trait_[i].z) * wallShear(f, i, c).on(contact_[c].xyz(), wall - p.velocity[i].xyz()));
                }
            }
        });
    bool yielding = false;
    if (sound) forMaterials(p, p.moverCount, [&](uint8_t m) { yielding |= f.materials[m].def.yieldStress > 0; });
    if (yielding) thicken(f);
    const float share = 1 / static_cast<float>(std::max(1, f.subSteps));
    const float deepSoften = detExp(share * kSofteningLog), shallowSoften = detExp(share * kShallowSofteningLog);
    const float shallow = kShallow * length(f.gravity) / kSupport; // Pa, times density and support
    forMovers([&](int begin, int, int last, BlockSums&) {
        for (int r = 8 * begin; r < last; ++r) {
            const size_t i = static_cast<size_t>(r);
            if (!sound) p.velocity[i] = before_[i];
            const Vec3 change = p.velocity[i].xyz() - before_[i].xyz();
            const bool yields = yielding && f.materials[p.material[i]].def.yieldStress > 0;
            const float soften =
                p.pressure[i] * f.invDensity[i] > shallow * p.position[i].w ? deepSoften : shallowSoften;
            p.velocityChange[i] = {change.x, change.y, change.z, yields ? image_[i].x : soften * p.velocityChange[i].w};
            if (touches(i) && !gripped(i)) holdAtWalls(f, i);
        }
    });
    if (pieces) pieces->settle(f);
}

} // namespace thaw
