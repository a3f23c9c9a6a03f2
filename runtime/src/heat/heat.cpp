// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Heat of one step, split in two: conduction moves heat between particles, then each surface particle settles with what
// it absorbs and loses. Each part alone is monotone at any time step, and what it moves is booked as the difference of
// the enthalpies in double, so the ledger closes whatever the step.
#include "heat/heat.h"

#include "base/kernel.h"
#include "heat/conduction.h"
#include "heat/visibility.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr int kRowBlock = 512;
constexpr int kGroupBlock = kRowBlock / 8;
constexpr int kRayBlock = 128;
constexpr double kStefanBoltzmann = 5.670374419e-8; // W/(m^2 K^4), CODATA 2018
constexpr double kHottest = 1e5;                    // K, nothing gets hotter; the range of every temperature in the API
constexpr double kPi = 3.14159265358979323846;

// Explicit steps are monotone up to dt sum(weights) / (m c) = 1. Super-time-stepping (Runge-Kutta-Legendre or
// -Gegenbauer) is 3-10 times cheaper beyond, and was tried: a hot spot in three dimensions leaves its neighbours colder
// than before it came, with every number of stages.
constexpr double kExplicit = 0.9;
constexpr int kSubCycles = 8;
// More sub-cycles than that cost more than conjugate gradients.
constexpr int kImplicitIterations = 30;
constexpr double kImplicitTolerance = 1e-3;

// Particles::rayMemory remembers, from the last time rays were cast for a particle, which of the first kRemembered
// sources it saw and how long ago that is: (1 + age) 2^16 + one bit per source, a whole number below 2^22 and so exact
// in a float; 0 when nothing is known. Rays to the sources beyond are cast in every step.
constexpr int kRemembered = 16;
float remember(int age, uint32_t seen) { return static_cast<float>((static_cast<uint32_t>(1 + age) << 16) | seen); }
bool known(float memory) { return memory >= 65536; }
int ageOf(float memory) { return static_cast<int>(static_cast<uint32_t>(memory) >> 16) - 1; }
uint32_t seenOf(float memory) { return static_cast<uint32_t>(memory) & 0xffffu; }
constexpr int kOldest = 60;
// What moves is looked at this many times as often as what stands still.
constexpr int kMoverAge = 3;
constexpr uint8_t kNoRay = 0, kUnknown = 255;

// Of the melt as it shades itself, in spacings. A square lattice of spheres is closed from 0.71 on.
constexpr float kShadeRadius = 0.75f;
// Rays leave from above the steps that a tilted surface of a lattice has, and do not see what is closer than kSkip.
constexpr float kRaise = 1.0f, kSkip = 1.5f;
// A drop alone, which faces nowhere: its cross-section is a quarter of its surface.
constexpr float kDropCosine = 0.25f;

struct Booking {
    double absorbed = 0, emitted = 0, convected = 0;
};

// Enthalpy after dt of exchange with the surroundings, from H: the root of
//   f(H') = H' - H + g(T') (T' - Ta),   g(T) = dt A / m [eps sigma (T^2 + Ta^2)(T + Ta) + hc],
// backward Euler, which lies between H and the enthalpy at ambient however long dt is.
struct Surroundings {
    double temperature, convection, factor; // K, W/(m^2 K), dt A / m
};
double radiative(const Material& m, double T, double Ta) {
    return m.def.emissivity * kStefanBoltzmann * (T * T + Ta * Ta) * (T + Ta);
}
struct Settled {
    double enthalpy, lost, share; // J/kg, J/kg, and how much of the loss is emission
};
Settled settle(const Material& m, double H, const Surroundings& s) {
    const double Ta = s.temperature;
    const double slowest = std::min(m.def.specificHeatSolid, m.def.specificHeatLiquid);
    const auto slope = [&](double T) { return s.factor * (radiative(m, T, Ta) + s.convection); };
    double result, lost;
    const double g = slope(std::max(0.0, m.kelvin(H)));
    if (g < 0.02 * slowest && H >= m.enthalpyFloor()) {
        // f is linear on each side of the plateau and on it: three pieces, one root.
        const double solid = g * (m.def.solidus - Ta), liquid = m.latent + g * (m.def.liquidus - Ta);
        if (H < solid)
            result = (H - solid) / (1 + g / m.def.specificHeatSolid);
        else if (H >= liquid)
            result = m.latent + (H - liquid) / (1 + g / m.def.specificHeatLiquid);
        else
            result = m.latent * (H - solid) / (liquid - solid);
        lost = H - result;
    } else {
        const double floor = m.enthalpyFloor(), ambient = m.enthalpy(static_cast<float>(Ta));
        const auto f = [&](double h) {
            const double T = std::max(0.0, m.kelvin(h));
            return h - H + slope(T) * (T - Ta);
        };
        double low = std::max(floor, std::min(H, ambient)), high = std::max(floor, std::max(H, ambient));
        // Cooled by a source below what the surroundings can make good: it stays at 0 K and takes what they give.
        const bool stuck = f(low) > 0 && low == floor;
        if (stuck) high = low;
        for (int k = 0; k < 80 && high - low > 1e-9 * (std::abs(low) + std::abs(high)); ++k) {
            const double middle = 0.5 * (low + high);
            (f(middle) < 0 ? low : high) = middle;
        }
        result = 0.5 * (low + high);
        lost = stuck ? slope(0) * -Ta : H - result;
    }
    const double q = radiative(m, std::max(0.0, m.kelvin(result)), Ta);
    return {result, lost, q + s.convection > 0 ? q / (q + s.convection) : 0};
}

} // namespace

struct Heat::Impl {
    explicit Impl(Allocator& a)
        : allocator(a), exposed(a), spheres(a), sphereIds(a), priority(a), power(a), state(a), flow(a), weight(a),
          direction(a), residual(a), solution(a), heat(a), exchange(a), inverse(a), booking(a), blockSums(a),
          blockRays(a) {}

    Allocator& allocator;
    std::unique_ptr<Visibility> visibility;

    Array<int> exposed; // rows
    Array<Vec4> spheres;
    Array<uint32_t> sphereIds;
    Array<uint8_t> priority; // per exposed: kNoRay, 1 + age, kUnknown
    Array<float> power;      // per row, W absorbed

    Array<Vec4> state;                                                   // see ConductionPass
    Array<float> flow, weight;                                           // of the pair pass
    Array<float> direction, residual, solution, heat, exchange, inverse; // of the conjugate gradients
    Array<Booking> booking;                                              // per block
    struct Sums {
        double a, b;
        float low, high;
    };
    Array<Sums> blockSums;
    Array<int> blockRays;

    bool begun = false, absorbing = false;

    void begin(HeatStats& stats) {
        if (begun) return;
        begun = true, absorbing = false, stats = {};
    }
    void book(HeatStats& stats, int blocks) const {
        for (int b = 0; b < blocks; ++b) {
            const Booking& k = booking[static_cast<size_t>(b)];
            stats.absorbed += k.absorbed, stats.emitted += k.emitted, stats.convected += k.convected;
        }
    }

    void pairPass(const HeatFrame& f, bool weights);
    void fillState(const HeatFrame& f);
    double fastest(const HeatFrame& f);
    void explicitStep(const HeatFrame& f, double dt);
    void implicitStep(const HeatFrame& f);
    template <class F> Sums sumRows(const HeatFrame& f, F&& row);
};

Heat::Heat(Allocator& allocator) : impl_(std::make_unique<Impl>(allocator)) {}
Heat::~Heat() = default;

// ---- radiation -----------------------------------------------------------------------------------------------------

namespace {

// How a source looks from an exposed particle.
struct View {
    float flux; // W/m^2 if nothing is in the way; 0 when the particle faces away
    Ray ray;
};

View look(const HeatSource& source, Vec3 x, Vec4 normal, float spacing) {
    const Vec3 n = normal.xyz();
    const bool drop = dot(n, n) < 0.25f;
    View v;
    v.ray.surface = x + (0.5f * spacing) * n;
    const Vec3 way = source.position - v.ray.surface;
    v.ray.distance = length(way);
    // A source that touches the surface shines straight on it.
    const bool touching = v.ray.distance < 1e-3f * source.radius;
    v.ray.direction = touching ? normalizeOr(n, {0, 1, 0}) : normalizeOr(way, {0, 1, 0});
    v.ray.raised = x + (kRaise * spacing) * (drop ? v.ray.direction : n);
    v.ray.skip = kSkip * spacing;
    const float cosine = drop ? kDropCosine : std::max(0.0f, dot(n, v.ray.direction));
    // Nearer than its own size a particle would take more than the half of all power that its plane can catch.
    const float d2 = std::max({v.ray.distance * v.ray.distance, source.radius * source.radius,
                               normal.w * static_cast<float>(0.5 / kPi), 1e-12f});
    v.flux = source.power * cosine / (4 * static_cast<float>(kPi) * d2);
    return v;
}

bool shines(const HeatSource& s) { return s.alive && s.enabled && s.power != 0; }

} // namespace

void Heat::radiation(const HeatFrame& f) {
    Impl& m = *impl_;
    Particles& p = f.particles;
    m.begin(stats_);
    m.absorbing = true;
    const size_t count = static_cast<size_t>(p.count);
    m.power.assign(count, 0.0f);
    m.exposed.clear(), m.exposed.reserve(count);
    for (int i = 0; i < p.count; ++i) {
        const size_t k = static_cast<size_t>(i);
        if ((p.flags[k] & kSurface) && p.normal[k].w > 0)
            m.exposed.push(i);
        else
            p.rayMemory[k] = 0;
    }
    const int exposed = static_cast<int>(m.exposed.size());
    if (exposed == 0) return;

    // The surface of a melt grows for as long as it melts: room for all at once.
    m.spheres.reserve(count), m.sphereIds.reserve(count), m.priority.reserve(count);
    m.spheres.resizeRaw(m.exposed.size()), m.sphereIds.resizeRaw(m.exposed.size());
    m.priority.resizeRaw(m.exposed.size());
    m.blockRays.reserve(static_cast<size_t>(Tasks::blockCount(p.count, kRayBlock)));
    m.blockRays.assign(static_cast<size_t>(Tasks::blockCount(exposed, kRayBlock)), 0);
    const auto spacingOf = [&](size_t row) { return p.position[row].w * (1 / kSupport); };
    f.tasks.forBlocks(exposed, kRayBlock, [&](int begin, int end, int, int) {
        for (int e = begin; e < end; ++e) {
            const size_t at = static_cast<size_t>(e), row = static_cast<size_t>(m.exposed[at]);
            const Vec4 x = p.position[row];
            const float dx = spacingOf(row);
            m.spheres[at] = {x.x, x.y, x.z, kShadeRadius * dx}, m.sphereIds[at] = p.id[row];
            bool lit = false;
            for (int s = 0; s < f.sourceCount && !lit; ++s)
                lit = shines(f.sources[s]) && look(f.sources[s], x.xyz(), p.normal[row], dx).flux != 0;
            const float memory = p.rayMemory[row];
            m.priority[at] = !lit ? kNoRay : known(memory) ? static_cast<uint8_t>(1 + ageOf(memory)) : kUnknown;
        }
    });

    // Who gets rays: all that are not known yet, then the oldest memories, those of one age in the order of rows.
    int ofAge[256] = {};
    for (uint8_t a : m.priority) ++ofAge[a];
    const int lit = exposed - ofAge[kNoRay];
    int left = static_cast<int>(std::ceil(f.rayRefresh * static_cast<float>(lit))) - ofAge[kUnknown];
    int threshold = kUnknown;
    while (threshold > 1 && left >= ofAge[threshold - 1] && left > 0) left -= ofAge[--threshold];
    // Down to `threshold` all; of the age below, the first `left`.
    int refreshed = 0;
    for (uint8_t& a : m.priority) {
        if (a == kNoRay) continue;
        bool chosen = a >= threshold;
        if (!chosen && a == threshold - 1 && left > 0) chosen = true, --left;
        a = chosen ? kUnknown : static_cast<uint8_t>(a);
        refreshed += chosen;
    }
    stats_.raysReduced = refreshed < lit;

    bool beyond = false;
    for (int s = kRemembered; s < f.sourceCount; ++s) beyond |= shines(f.sources[s]);
    if (refreshed > 0 || (beyond && lit > 0)) {
        if (!m.visibility) m.visibility = std::make_unique<Visibility>(m.allocator);
        m.visibility->setColliders(f.colliders, f.colliderCount, f.colliderVersion);
        m.visibility->setSpheres(m.spheres.data(), m.sphereIds.data(), exposed, p.count);
    }
    f.tasks.forBlocks(exposed, kRayBlock, [&](int begin, int end, int block, int) {
        float received[kRayBlock] = {};
        uint32_t seen[kRayBlock] = {};
        int rays = 0;
        for (int s = 0; s < f.sourceCount; ++s) {
            if (!shines(f.sources[s])) continue;
            Ray packet[8];
            float flux[8];
            int owner[8], n = 0;
            const auto flush = [&] {
                bool blocked[8];
                m.visibility->cast(packet, n, blocked);
                for (int k = 0; k < n; ++k) {
                    if (blocked[k]) continue;
                    received[owner[k]] += flux[k];
                    if (s < kRemembered) seen[owner[k]] |= 1u << s;
                }
                rays += n, n = 0;
            };
            for (int e = begin; e < end; ++e) {
                const size_t at = static_cast<size_t>(e);
                if (m.priority[at] == kNoRay) continue;
                const size_t row = static_cast<size_t>(m.exposed[at]);
                const bool fresh = m.priority[at] == kUnknown || s >= kRemembered;
                if (!fresh && !(seenOf(p.rayMemory[row]) >> s & 1)) continue;
                const View v = look(f.sources[s], p.position[row].xyz(), p.normal[row], spacingOf(row));
                if (v.flux == 0) continue;
                if (!fresh) {
                    received[e - begin] += v.flux;
                    continue;
                }
                packet[n] = v.ray, flux[n] = v.flux, owner[n] = e - begin;
                if (++n == 8) flush();
            }
            if (n > 0) flush();
        }
        for (int e = begin; e < end; ++e) {
            const size_t at = static_cast<size_t>(e), row = static_cast<size_t>(m.exposed[at]);
            float& memory = p.rayMemory[row];
            if (m.priority[at] == kNoRay)
                memory = 0;
            else if (m.priority[at] == kUnknown)
                memory = remember(0, seen[e - begin]);
            else {
                const int age = ageOf(memory) + (p.still(m.exposed[at]) ? 1 : kMoverAge);
                memory = remember(std::min(kOldest, age), seenOf(memory));
            }
            m.power[row] = received[e - begin] * f.materials[p.material[row]].def.absorptivity * p.normal[row].w;
        }
        m.blockRays[static_cast<size_t>(block)] = rays;
    });
    for (int r : m.blockRays) stats_.rays += r;
}

// ---- conduction ----------------------------------------------------------------------------------------------------

void Heat::Impl::fillState(const HeatFrame& f) {
    const Particles& p = f.particles;
    const int rows = 8 * f.neighbors.groupCount + Particles::kPadding;
    state.resizeRaw(static_cast<size_t>(rows)), flow.resizeRaw(static_cast<size_t>(rows));
    weight.resizeRaw(static_cast<size_t>(rows));
    f.tasks.forBlocks(rows, kRowBlock, [&](int begin, int end, int, int) {
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            state[k] = {};
            if (i >= p.count) continue;
            const Material& m = f.materials[p.material[k]];
            // Over ambient, so that what matters keeps its digits in float.
            state[k].x = static_cast<float>(m.kelvin(p.enthalpy[k]) - static_cast<double>(f.ambient));
            state[k].y = m.conductivity(m.liquidFraction(p.enthalpy[k]));
            state[k].z = 0.5f / std::clamp(f.neighbors.volumeFraction[k], 0.4f, 1.25f);
        }
    });
}

void Heat::Impl::pairPass(const HeatFrame& f, bool weights) {
    const Neighbors& n = f.neighbors;
    const ConductionPass pass{n.entries.data(),
                              n.gradient.data(),
                              n.first.data(),
                              n.width.data(),
                              state.data(),
                              flow.data(),
                              weights ? weight.data() : nullptr};
    f.tasks.forBlocks(n.groupCount, kGroupBlock,
                      [&](int begin, int end, int, int) { conductionPass(pass, begin, end); });
}

// row(i, sums) adds to its block's sums; they are added up in the order of blocks.
template <class F> Heat::Impl::Sums Heat::Impl::sumRows(const HeatFrame& f, F&& row) {
    const int blocks = Tasks::blockCount(f.particles.count, kRowBlock);
    blockSums.resizeRaw(static_cast<size_t>(blocks));
    f.tasks.forBlocks(f.particles.count, kRowBlock, [&](int begin, int end, int block, int) {
        Sums s{0, 0, INFINITY, -INFINITY};
        for (int i = begin; i < end; ++i) row(static_cast<size_t>(i), s);
        blockSums[static_cast<size_t>(block)] = s;
    });
    Sums total{0, 0, INFINITY, -INFINITY};
    for (const Sums& s : blockSums) {
        total.a += s.a, total.b += s.b;
        total.low = std::min(total.low, s.low), total.high = std::max(total.high, s.high);
    }
    return total;
}

namespace {

double leastHeat(const Material& m) {
    return std::min(static_cast<double>(m.def.specificHeatSolid), static_cast<double>(m.def.specificHeatLiquid));
}

} // namespace

// Largest rate 1/s at which a particle approaches its neighbours.
double Heat::Impl::fastest(const HeatFrame& f) {
    const Particles& p = f.particles;
    const float moment = conductionMoment();
    const Sums s = sumRows(f, [&](size_t k, Sums& sums) {
        const double mc = p.velocity[k].w * leastHeat(f.materials[p.material[k]]);
        if (mc > 0) sums.high = std::max(sums.high, static_cast<float>(f.volume[k] * weight[k] / (moment * mc)));
    });
    return std::max(0.0f, s.high);
}

void Heat::Impl::explicitStep(const HeatFrame& f, double dt) {
    Particles& p = f.particles;
    const double scale = dt / conductionMoment();
    // A pair's two halves are equal up to the rounding of V_i (V_j g); what is left over is taken back where it arose.
    const Sums s = sumRows(f, [&](size_t k, Sums& sums) {
        const double e = static_cast<double>(f.volume[k]) * flow[k];
        sums.a += e, sums.b += std::abs(e);
    });
    const double back = s.b > 0 ? s.a / s.b : 0;
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int, int) {
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            const double e = static_cast<double>(f.volume[k]) * flow[k];
            if (e != 0 && p.velocity[k].w > 0) p.enthalpy[k] += scale * (e - back * std::abs(e)) / p.velocity[k].w;
        }
    });
}

// Backward Euler by conjugate gradients with the heat capacity of the cheaper phase, which keeps enthalpies in bounds
// when a particle melts on the way. A solve that stops at its cap may leave the range of the temperatures it began
// with: it is clipped, and what the clipping made or lost is given back in proportion to the room left, which exists.
void Heat::Impl::implicitStep(const HeatFrame& f) {
    Particles& p = f.particles;
    const size_t rows = state.size();
    direction.assign(rows, 0.0f), residual.assign(rows, 0.0f), solution.assign(rows, 0.0f);
    heat.assign(rows, 0.0f), exchange.assign(rows, 0.0f), inverse.assign(rows, 0.0f);
    const double dt = f.dt / conductionMoment();
    // Rows without neighbours keep zeros everywhere and take no part.
    const auto active = [&](size_t k) { return inverse[k] > 0; };
    const Sums start = sumRows(f, [&](size_t k, Sums& s) {
        if (!(weight[k] > 0) || !(p.velocity[k].w > 0)) return;
        const double capacity = p.velocity[k].w * leastHeat(f.materials[p.material[k]]);
        heat[k] = static_cast<float>(capacity), exchange[k] = static_cast<float>(dt * f.volume[k]);
        inverse[k] = static_cast<float>(1 / (capacity + dt * f.volume[k] * weight[k]));
        solution[k] = state[k].x;
        s.low = std::min(s.low, state[k].x), s.high = std::max(s.high, state[k].x);
        residual[k] = exchange[k] * flow[k];
        direction[k] = residual[k] * inverse[k];
        s.a += static_cast<double>(residual[k]) * direction[k];
    });
    double rz = start.a;
    for (size_t k = 0; k < static_cast<size_t>(p.count); ++k) state[k].x = direction[k];
    for (int iteration = 0; iteration < kImplicitIterations && rz > kImplicitTolerance * kImplicitTolerance * start.a;
         ++iteration) {
        pairPass(f, false);
        const double pAp = sumRows(f, [&](size_t k, Sums& s) {
                               flow[k] = heat[k] * direction[k] - exchange[k] * flow[k];
                               s.a += static_cast<double>(direction[k]) * flow[k];
                           }).a;
        if (!(pAp > 0)) break;
        const float alpha = static_cast<float>(rz / pAp);
        const double next = sumRows(f, [&](size_t k, Sums& s) {
                                solution[k] += alpha * direction[k];
                                residual[k] -= alpha * flow[k];
                                s.a += static_cast<double>(residual[k]) * (residual[k] * inverse[k]);
                            }).a;
        const float beta = static_cast<float>(next / rz);
        rz = next;
        f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int, int) {
            for (int i = begin; i < end; ++i) {
                const size_t k = static_cast<size_t>(i);
                state[k].x = direction[k] = residual[k] * inverse[k] + beta * direction[k];
            }
        });
    }
    const auto capacity = [&](size_t k) { return static_cast<double>(heat[k]); };
    const auto kelvin = [&](size_t k) {
        return f.materials[p.material[k]].kelvin(p.enthalpy[k]) - static_cast<double>(f.ambient);
    };
    const double low = start.low, high = start.high;
    const auto clipped = [&](size_t k) { return std::clamp(static_cast<double>(solution[k]), low, high); };
    const double made = sumRows(f, [&](size_t k, Sums& s) {
                            if (active(k)) s.a += capacity(k) * (clipped(k) - kelvin(k));
                        }).a;
    const auto room = [&](size_t k) { return capacity(k) * (made > 0 ? clipped(k) - low : high - clipped(k)); };
    const double rooms = sumRows(f, [&](size_t k, Sums& s) {
                             if (active(k)) s.a += room(k);
                         }).a;
    // All alike to the last digit of float: nothing to conduct.
    if (!(rooms >= std::abs(made)) || rooms == 0) return;
    const double back = made / rooms;
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int, int) {
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            if (!active(k)) continue;
            const double e = capacity(k) * (clipped(k) - kelvin(k)) - back * room(k);
            p.enthalpy[k] += e / p.velocity[k].w;
        }
    });
}

void Heat::conduction(const HeatFrame& f) {
    Impl& m = *impl_;
    m.begin(stats_);
    if (f.particles.count == 0 || !(f.dt > 0)) return;
    m.fillState(f);
    m.pairPass(f, true);
    const double needed = std::ceil(f.dt * m.fastest(f) / kExplicit);
    if (needed > kSubCycles) {
        m.implicitStep(f);
        return;
    }
    const int cycles = std::max(1, static_cast<int>(needed));
    for (int c = 0; c < cycles; ++c) {
        if (c > 0) m.fillState(f), m.pairPass(f, false);
        m.explicitStep(f, f.dt / cycles);
    }
}

// ---- the surface ---------------------------------------------------------------------------------------------------

void Heat::loss(const HeatFrame& f) {
    Impl& m = *impl_;
    Particles& p = f.particles;
    m.begin(stats_);
    const int blocks = Tasks::blockCount(p.count, kRowBlock);
    m.booking.resizeRaw(static_cast<size_t>(blocks));
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int block, int) {
        Booking sum;
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            const double mass = p.velocity[k].w, area = p.normal[k].w;
            if (!(p.flags[k] & kSurface) || !(area > 0) || !(mass > 0)) continue;
            const Material& material = f.materials[p.material[k]];
            const double before = p.enthalpy[k];
            const double fed = m.absorbing ? before + m.power[k] * f.dt / mass : before;
            const Settled s = settle(material, fed, {f.ambient, f.convection, f.dt * area / mass});
            const double after = std::min(s.enthalpy, material.enthalpy(static_cast<float>(kHottest)));
            const double lost = mass * s.lost;
            sum.absorbed += mass * (after - before) + lost;
            sum.emitted += s.share * lost, sum.convected += (1 - s.share) * lost;
            p.enthalpy[k] = after;
        }
        m.booking[static_cast<size_t>(block)] = sum;
    });
    m.absorbing = false;
    m.book(stats_, blocks);
}

void Heat::integrate(const HeatFrame& f) {
    Impl& m = *impl_;
    Particles& p = f.particles;
    m.begin(stats_);
    const int blocks = Tasks::blockCount(p.count, kRowBlock);
    m.booking.resizeRaw(static_cast<size_t>(blocks));
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int block, int) {
        Booking sum;
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            const Material& material = f.materials[p.material[k]];
            const double mass = p.velocity[k].w, before = p.enthalpy[k];
            double H = before;
            if (m.absorbing && mass > 0) H += m.power[k] * f.dt / mass;
            // Beyond the bounds a source neither cools nor heats: what it did not move is not booked.
            H = std::clamp(H, material.enthalpyFloor(), material.enthalpy(static_cast<float>(kHottest)));
            sum.absorbed += mass * (H - before);
            p.enthalpy[k] = H;
            p.temperature[k] = std::max(0.0f, material.temperature(H));
            p.liquidFraction[k] = material.liquidFraction(H);
        }
        m.booking[static_cast<size_t>(block)] = sum;
    });
    m.book(stats_, blocks);
    m.begun = m.absorbing = false;
}

} // namespace thaw
