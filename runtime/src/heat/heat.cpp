// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// Heat of one step, split in two: conduction moves heat between particles, then each surface particle settles with what
// it absorbs and loses. Each part alone is monotone at any time step, and what it moves is booked as the difference of
// the enthalpies in double, so the ledger closes whatever the step.
#include "heat/heat.h"

#include "heat/conduction_solve.h"
#include "heat/contact.h"
#include "heat/radiation.h"

#include <algorithm>
#include <cmath>

namespace thaw {
namespace {

constexpr int kRowBlock = 512;
constexpr double kStefanBoltzmann = 5.670374419e-8; // W/(m^2 K^4), CODATA 2018
constexpr double kHottest = 1e5;                    // K, nothing gets hotter; the range of every temperature in the API

// A part of a step takes a flat surface's own heat over ambient to 1 / (1 + kPart) of it at the most: conduction brings
// more from below only in the next part. In one part a ball of 8 spacings that glows for an hour in steps of 83 s cools
// 2.6 to 3.9 % too little, so 0.2 to 0.7 %.
constexpr double kPart = 0.02;
constexpr int kMostParts = 16;

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
Settled settle(const Material& m, double H, const Surroundings& s, bool unseeded) {
    const double Ta = s.temperature;
    const double slowest = std::min(m.def.specificHeatSolid, m.def.specificHeatLiquid);
    const auto slope = [&](double T) { return s.factor * (radiative(m, T, Ta) + s.convection); };
    double result, lost;
    const double g = slope(std::max(0.0, m.kelvin(H, unseeded)));
    const double floor = unseeded ? m.enthalpy(0, true) : m.enthalpyFloor();
    if (g < 0.02 * slowest && H >= floor) {
        // f is linear on each side of the plateau and on it: three pieces, one root.
        const double solid = g * (m.def.solidus - Ta), liquid = m.latent + g * (m.def.liquidus - Ta);
        if (H < solid && !unseeded)
            result = (H - solid) / (1 + g / m.def.specificHeatSolid);
        else if (H >= liquid || unseeded)
            result = m.latent + (H - liquid) / (1 + g / m.def.specificHeatLiquid);
        else
            result = m.latent * (H - solid) / (liquid - solid);
        lost = H - result;
    } else {
        const double ambient = m.enthalpy(static_cast<float>(Ta), unseeded);
        const auto f = [&](double h) {
            const double T = std::max(0.0, m.kelvin(h, unseeded));
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
    const double q = radiative(m, std::max(0.0, m.kelvin(result, unseeded)), Ta);
    return {result, lost, q + s.convection > 0 ? q / (q + s.convection) : 0};
}

// Temperatures and liquid fractions where a material undercools. Solid is what was solid before this step, so that it
// spreads by one support in a step, in any order of the rows.
void seed(const HeatFrame& f) {
    Particles& p = f.particles;
    const auto forRows = [&](auto&& row) {
        f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int, int) {
            for (int i = begin; i < end; ++i) row(i, static_cast<size_t>(i), f.materials[p.material[i]]);
        });
    };
    forRows([&](int i, size_t k, const Material& m) {
        const bool was = p.flags[k] & kUnseeded;
        bool stays =
            m.def.undercooling > 0 && (was || p.enthalpy[k] >= m.latent) && p.enthalpy[k] > m.undercooledEnthalpy();
        if (stays)
            forNeighbors(f.neighbors, i, [&](uint32_t j) {
                stays =
                    j >= static_cast<uint32_t>(p.count) || p.material[j] != p.material[k] || p.liquidFraction[j] >= 1;
                return stays;
            });
        p.flags[k] = static_cast<uint8_t>((p.flags[k] & ~kUnseeded) | (stays ? kUnseeded : 0));
    });
    forRows([&](int, size_t k, const Material& m) {
        const bool unseeded = p.flags[k] & kUnseeded;
        p.temperature[k] = std::max(0.0f, static_cast<float>(m.kelvin(p.enthalpy[k], unseeded)));
        p.liquidFraction[k] = m.liquidFraction(p.enthalpy[k], unseeded);
    });
}

} // namespace

struct Heat::Impl {
    explicit Impl(Allocator& a) : radiation(a), contact(a), conduction(a), booking(a) {}

    Radiation radiation;
    Contact contact;
    Conduction conduction;
    Array<Booking> booking; // per block

    bool begun = false, absorbing = false, settled = false; // settled: loss() has absorbed

    void begin(HeatStats& stats) {
        if (begun) return;
        begun = true, absorbing = settled = false, stats = {};
    }
    void book(HeatStats& stats, int blocks) const {
        for (int b = 0; b < blocks; ++b) {
            const Booking& k = booking[static_cast<size_t>(b)];
            stats.absorbed += k.absorbed, stats.emitted += k.emitted, stats.convected += k.convected;
        }
    }
};

int Heat::parts(const HeatFrame& f, int materialCount, float hottest) {
    const double T = std::max(hottest, f.ambient), cube = T * T * T;
    double fastest = 0;
    for (int k = 0; k < materialCount; ++k) {
        const thawMaterialDef& d = f.materials[k].def;
        const double transfer = 4 * d.emissivity * kStefanBoltzmann * cube + static_cast<double>(f.convection);
        const double heat = static_cast<double>(d.density) * std::min(d.specificHeatSolid, d.specificHeatLiquid);
        fastest = std::max(fastest, transfer / (heat * f.spacing));
    }
    return static_cast<int>(std::clamp(std::ceil(f.dt * fastest / kPart), 1.0, static_cast<double>(kMostParts)));
}

Heat::Heat(Allocator& allocator) : impl_(std::make_unique<Impl>(allocator)) {}
Heat::~Heat() = default;

bool Heat::names(uint64_t form) const { return impl_->radiation.names(form); }

void Heat::state(StateIo& io, const ColliderForms& forms, size_t rows, uint64_t surfaceVersion) {
    impl_->radiation.state(io, forms, rows, surfaceVersion);
}

const float* Heat::power() const { return impl_->radiation.power(); }

void Heat::radiation(const HeatFrame& f) {
    Impl& m = *impl_;
    m.begin(stats_);
    m.absorbing = true;
    m.radiation.run(f, stats_);
}

void Heat::conduction(const HeatFrame& f) {
    Impl& m = *impl_;
    m.begin(stats_);
    stats_.contact += m.conduction.run(f, m.contact.find(f));
    stats_.cyclesWanted += m.conduction.cyclesWanted(), stats_.passes += m.conduction.passes();
    stats_.sleeping = m.conduction.sleeping();
}

void Heat::loss(const HeatFrame& f) {
    Impl& m = *impl_;
    Particles& p = f.particles;
    m.begin(stats_);
    const int blocks = Tasks::blockCount(p.count, kRowBlock);
    m.booking.resizeRaw(static_cast<size_t>(blocks));
    const float* power = m.radiation.power();
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int block, int) {
        Booking sum;
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            const double mass = p.velocity[k].w, area = p.normal[k].w;
            if (!(p.flags[k] & kSurface) || !(area > 0) || !(mass > 0)) continue;
            const Material& material = f.materials[p.material[k]];
            const double before = p.enthalpy[k];
            const double fed = m.absorbing ? before + power[k] * f.dt / mass : before;
            const Settled s =
                settle(material, fed, {f.ambient, f.convection, f.dt * area / mass}, p.flags[k] & kUnseeded);
            const double after = std::min(s.enthalpy, material.enthalpy(static_cast<float>(kHottest)));
            const double lost = mass * s.lost;
            sum.absorbed += mass * (after - before) + lost;
            sum.emitted += s.share * lost, sum.convected += (1 - s.share) * lost;
            p.enthalpy[k] = after;
        }
        m.booking[static_cast<size_t>(block)] = sum;
    });
    m.settled = true;
    m.book(stats_, blocks);
}

void Heat::integrate(const HeatFrame& f) {
    Impl& m = *impl_;
    Particles& p = f.particles;
    m.begin(stats_);
    const int blocks = Tasks::blockCount(p.count, kRowBlock);
    m.booking.resizeRaw(static_cast<size_t>(blocks));
    const float* power = m.radiation.power();
    f.tasks.forBlocks(p.count, kRowBlock, [&](int begin, int end, int block, int) {
        Booking sum;
        for (int i = begin; i < end; ++i) {
            const size_t k = static_cast<size_t>(i);
            const Material& material = f.materials[p.material[k]];
            const double mass = p.velocity[k].w, before = p.enthalpy[k];
            double H = before;
            if (m.absorbing && !m.settled && mass > 0) H += power[k] * f.dt / mass;
            // Beyond the bounds a source neither cools nor heats: what it did not move is not booked.
            H = std::clamp(H, material.enthalpyFloor(), material.enthalpy(static_cast<float>(kHottest)));
            sum.absorbed += mass * (H - before);
            p.enthalpy[k] = H;
            if (f.undercools) continue;
            p.temperature[k] = std::max(0.0f, material.temperature(H));
            p.liquidFraction[k] = material.liquidFraction(H);
        }
        m.booking[static_cast<size_t>(block)] = sum;
    });
    m.book(stats_, blocks);
    if (f.undercools) seed(f);
    m.begun = false;
}

} // namespace thaw
