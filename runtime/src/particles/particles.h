// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/memory.h"
#include "base/types.h"

#include <cstdint>

namespace thaw {

enum ParticleFlag : uint8_t {
    kFixed = 1 << 0,    // solid and held
    kSurface = 1 << 1,  // exposed to air
    kAsleep = 1 << 2,   // fixed for as long as nothing pulls at its bonds
    kRigid = 1 << 3,    // fixed, but to a rigid piece: moves with it
    kUnseeded = 1 << 4, // molten through, of a material that undercools, and no solid touches it: stays liquid
    kMoulded = 1 << 5   // a shape that it fills holds it, as good as a wall
};

// What Levels knows of how near the surface and the medial axis are, in eighths of a spacing (FeatureSize).
struct Feature {
    uint8_t depth, medial, size, above;
    bool operator==(const Feature&) const = default;
};

// Every per-particle quantity that lives from step to step: one list, used by sort, hash and removal alike.
//   type, name: meaning
#define THAW_PARTICLE_FIELDS(X)                                                                                        \
    X(Vec4, position)       /* xyz m; w support radius h = kSupport * spacing of its level, m */                       \
    X(Vec4, velocity)       /* xyz m/s; w mass kg */                                                                   \
    X(Vec4, velocityChange) /* xyz m/s, what the last viscosity solve did (its warm start); w Pa s >= 0, of a start in \
                               stiffness or a yield stress; fixed rows: 0, w 1..0 after it set (SeparationPass) */     \
    X(Vec4, normal)         /* xyz outward unit normal, w exposed area m^2; zero inside */                             \
    X(double, enthalpy)     /* J/kg above the material's solidus; double: a frame adds 1e-8 of it */                   \
    X(float, temperature)   /* K, from enthalpy */                                                                     \
    X(float, liquidFraction) /* 0..1, from enthalpy */                                                                 \
    X(float, pressure)       /* Pa, warm start of the next step */                                                     \
    X(float, stiffness)      /* Jacobi coefficient of the last step, 0 when there was none */                          \
    X(uint64_t, rayShares)   /* of the first 8 sources, a byte each: see radiation.cpp */                              \
    X(float, blend)          /* density error of a mover that a split or merge made, which fades (settled()) */        \
    X(float, rayChange)      /* W/m^2 that may have changed since the last look */                                     \
    X(uint8_t, rayAge)       /* 1 + steps since the last look at the sources; 0 never */                               \
    X(uint32_t, id)          /* stable, never reused */                                                                \
    X(uint32_t, bondSlot)    /* where its bonds are (Bonds), 0 none */                                                 \
    X(uint32_t, fine) /* first of its points in Reference + 1; 0: it has none, or not the ones it was filled with */   \
    X(float, along)   /* m on the path that it follows; J/kg that the shape which cools it left it, or 0 */            \
    X(uint8_t, hops)  /* of what follows a path: from neighbour to neighbour to what it lies on; grows in the air */   \
    X(uint16_t, follows) /* path or shape that guides it (pathOf, shapeOf); 0: none */                                 \
    X(uint16_t, body)                                                                                                  \
    X(uint16_t, piece)  /* rigid piece that a fixed row is part of, its slot + 1; 0: held, or a mover */               \
    X(uint16_t, anchor) /* fixed: 1 + the collider that it hangs on, of those that are told apart; else 0 */           \
    X(uint8_t, material)                                                                                               \
    X(uint8_t, level)   /* mass 2^level of the finest */                                                               \
    X(uint8_t, want)    /* eighths of a spacing to what must be fine, of solids that could be coarse (Levels) */       \
    X(Feature, feature) /* of what flows, where a body may be coarse */                                                \
    X(uint8_t, absorbs) /* 1 + 254 x painted absorptivity; 0: that of the material */                                  \
    X(uint8_t, flags)

// Particles::blend of what is about to split or merge, or lies beside it: kPending and the density error that the
// pressure saw before. What the event itself does to the error is none at first, and a fifth of it becomes one in a
// step of 1/60 s: else the pressure takes it back at once, with four times the kick (BAKEOFF2 B2).
inline constexpr float kPending = 8;
inline float settled(float blend, float error, float dt) {
    if (blend >= 0.5f * kPending) return error - (blend - kPending);
    const float rest = blend * (1 - (dt < 1.0f / 12 ? 12 * dt : 1));
    return rest > 1e-4f || rest < -1e-4f ? rest : 0;
}

// Particles::follows: slot + 1 of a path, or of a shape with this bit.
inline constexpr uint16_t kShapeBit = 0x8000;
inline uint16_t pathOf(uint16_t follows) { return follows & kShapeBit ? uint16_t{0} : follows; }
inline uint16_t shapeOf(uint16_t follows) {
    return follows & kShapeBit ? static_cast<uint16_t>(follows & ~kShapeBit) : uint16_t{0};
}

inline uint8_t paintedAbsorptivity(float a) { return static_cast<uint8_t>(1.5f + 254 * a); }
inline float absorptivity(uint8_t painted, float material) {
    return painted == 0 ? material : static_cast<float>(painted - 1) * (1.0f / 254);
}

// Structure of arrays. Rows are kept sorted: the movers [0, moverCount) first, then the fixed [moverCount, count), each
// in cell order. kPadding rows after the last one are dummies far away with no mass, so that groups of 8 may read past
// the end.
struct Particles {
    static constexpr int kPadding = 16;
    static constexpr float kFar = 1e15f; // squares stay finite

    explicit Particles(Allocator& a)
        :
#define X(type, name) name(a), name##Back(a),
          THAW_PARTICLE_FIELDS(X)
#undef X
              capacity(0) {
    }

    int count = 0, moverCount = 0;

#define X(type, name) Array<type> name, name##Back; // Back: where the sort writes before it swaps
    THAW_PARTICLE_FIELDS(X)
#undef X
    int capacity;

    void allocate(int maxParticles) {
        capacity = maxParticles;
        size_t n = static_cast<size_t>(maxParticles) + kPadding;
#define X(type, name) name.resize(n), name##Back.resize(n);
        THAW_PARTICLE_FIELDS(X)
#undef X
        pad();
    }
    void copyRow(size_t to, size_t from) {
#define X(type, name) name[to] = name[from];
        THAW_PARTICLE_FIELDS(X)
#undef X
    }
    void clearRow(size_t row) {
#define X(type, name) name[row] = type{};
        THAW_PARTICLE_FIELDS(X)
#undef X
    }
    // Writes the dummies after the last row.
    void pad() {
        for (int i = count; i < count + kPadding; ++i) {
            size_t k = static_cast<size_t>(i);
            clearRow(k);
            position[k] = {kFar, kFar, kFar, 0};
            flags[k] = kFixed;
        }
    }
    bool fixed(int i) const { return flags[static_cast<size_t>(i)] & kFixed; }
    // Fixed, and neither part of a piece on its way nor carried along.
    bool still(int i) const {
        const Vec4& v = velocity[static_cast<size_t>(i)];
        return fixed(i) && v.x == 0 && v.y == 0 && v.z == 0;
    }
};

// Calls f(m) at least once for every material m among the first `rows` rows; rows in cell order mostly share theirs
// with the one before.
template <class F> void forMaterials(const Particles& p, int rows, F&& f) {
    int last = -1;
    for (int r = 0; r < rows; ++r) {
        const uint8_t m = p.material[static_cast<size_t>(r)];
        if (m != last) f(m), last = m;
    }
}

} // namespace thaw
