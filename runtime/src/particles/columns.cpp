// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "particles/columns.h"

#include "particles/reference.h"

#include <bit>
#include <cmath>

namespace thaw {
namespace {

enum Coding : uint8_t { kSame, kAll, kSome }; // kSome: a bit per row that is not 0, then those

// A field, or one of the four numbers of a Vec4: every `stride`th byte holds one. By their bits, so that -0 and what is
// no number come back.
template <class Bits> Bits load(const unsigned char* from) {
    Bits v;
    std::memcpy(&v, from, sizeof v);
    return v;
}

template <class Bits> void write(StateIo& io, const unsigned char* from, size_t stride, size_t n) {
    Bits first = load<Bits>(from), differ = 0;
    size_t some = 0;
    for (size_t i = 0; i < n; ++i) {
        const Bits v = load<Bits>(from + i * stride);
        differ = static_cast<Bits>(differ | (v ^ first)), some += v != 0;
    }
    const size_t words = (n + 63) / 64, sparse = 8 * words + some * sizeof(Bits), dense = n * sizeof(Bits);
    uint8_t coding = differ == 0 ? kSame : sparse < dense ? kSome : kAll;
    io(coding);
    if (coding == kSame) return io(first);
    unsigned char* to = io.room(coding == kSome ? sparse : dense);
    if (!to) return;
    if (coding == kAll) {
        if (stride == sizeof(Bits)) {
            std::memcpy(to, from, dense);
        } else {
            for (size_t i = 0; i < n; ++i) std::memcpy(to + i * sizeof(Bits), from + i * stride, sizeof(Bits));
        }
        return;
    }
    unsigned char* values = to + 8 * words;
    for (size_t w = 0; w < words; ++w) {
        const unsigned char* at = from + 64 * w * stride;
        const size_t rows = std::min<size_t>(64, n - 64 * w);
        uint64_t mask = 0;
        for (size_t k = 0; k < rows; ++k) mask |= static_cast<uint64_t>(load<Bits>(at + k * stride) != 0) << k;
        std::memcpy(to + 8 * w, &mask, 8);
        for (; mask; mask &= mask - 1, values += sizeof(Bits))
            std::memcpy(values, at + static_cast<size_t>(std::countr_zero(mask)) * stride, sizeof(Bits));
    }
}

template <class Bits> void read(StateIo& io, unsigned char* to, size_t stride, size_t n) {
    const unsigned char* head = io.look(1);
    if (!head) return;
    // Without a place to go to it is only passed.
    const auto put = [&](size_t row, const unsigned char* from) {
        if (to) std::memcpy(to + row * stride, from, sizeof(Bits));
    };
    if (*head == kSame) {
        if (const unsigned char* from = io.look(sizeof(Bits)))
            for (size_t i = 0; i < n; ++i) put(i, from);
    } else if (*head == kAll) {
        const unsigned char* from = io.look(n * sizeof(Bits));
        if (!from || !to) return;
        if (stride == sizeof(Bits)) return void(std::memcpy(to, from, n * sizeof(Bits)));
        for (size_t i = 0; i < n; ++i) put(i, from + i * sizeof(Bits));
    } else if (*head == kSome) {
        const size_t words = (n + 63) / 64;
        const unsigned char* masks = io.look(8 * words);
        if (!masks) return;
        const Bits zero = 0;
        for (size_t w = 0; w < words; ++w) {
            const size_t begin = 64 * w, rows = std::min<size_t>(64, n - begin);
            uint64_t mask = load<uint64_t>(masks + 8 * w);
            if (rows < 64 && mask >> rows) return io.fail("a row that there is not");
            const unsigned char* from = io.look(static_cast<size_t>(std::popcount(mask)) * sizeof(Bits));
            if (!from) return;
            for (size_t k = 0; k < rows && to; ++k) std::memcpy(to + (begin + k) * stride, &zero, sizeof zero);
            for (; mask; mask &= mask - 1, from += sizeof(Bits))
                put(begin + static_cast<size_t>(std::countr_zero(mask)), from);
        }
    } else {
        io.fail("a coding that there is not");
    }
}

template <class T>
using BitsOf = std::conditional_t<
    std::is_same_v<T, Vec4> || sizeof(T) == 4, uint32_t,
    std::conditional_t<sizeof(T) == 8, uint64_t, std::conditional_t<sizeof(T) == 2, uint16_t, uint8_t>>>;

// f(first byte of a part, distance of rows)
template <class T, class F> void forParts(T* data, F&& f) {
    using Field = std::remove_const_t<T>;
    static_assert(sizeof(Field) % sizeof(BitsOf<Field>) == 0);
    using Byte = std::conditional_t<std::is_const_v<T>, const unsigned char, unsigned char>;
    for (size_t part = 0; part < sizeof(Field) / sizeof(BitsOf<Field>); ++part)
        f(reinterpret_cast<Byte*>(data) + part * sizeof(BitsOf<Field>), sizeof(Field));
}

} // namespace

void columns(StateIo& io, Particles& p, bool features) {
    const size_t n = static_cast<size_t>(p.count);
    if (io.hashes()) {
#define X(type, name)                                                                                                  \
    if (features || !std::is_same_v<type, Feature>) io.bytes(p.name.data(), n * sizeof(type));
        THAW_PARTICLE_FIELDS(X)
#undef X
        return;
    }
    if (n == 0) return;
#define X(type, name)                                                                                                  \
    forParts<const type>(p.name.data(),                                                                                \
                         [&](const unsigned char* from, size_t stride) { write<BitsOf<type>>(io, from, stride, n); });
    THAW_PARTICLE_FIELDS(X)
#undef X
}

void readColumns(StateIo& io, Particles& p, size_t rows, float spacing) {
    if (rows == 0) return;
#define X(type, name)                                                                                                  \
    forParts<type>(p.name##Back.data(),                                                                                \
                   [&](unsigned char* to, size_t stride) { read<BitsOf<type>>(io, to, stride, rows); });
    THAW_PARTICLE_FIELDS(X)
#undef X
    if (!io.good()) return;
    const StateIo::Limits& l = io.limits;
    constexpr float kFarthest = 1e7f; // m, s: no host can put anything there, and nothing gets there
    const auto near = [](float v, float most) { return v >= -most && v <= most; };
    bool sound = true;
    for (size_t k = 0; k < rows; ++k) {
        const Vec4 &x = p.positionBack[k], &v = p.velocityBack[k];
        sound &= near(x.x, kFarthest) && near(x.y, kFarthest) && near(x.z, kFarthest);
        sound &= near(v.x, kFarthest) && near(v.y, kFarthest) && near(v.z, kFarthest) && v.w >= 0;
        sound &= std::isfinite(p.enthalpyBack[k]);
        const uint8_t level = p.levelBack[k];
        sound &= level <= kHighestLevel && x.w == supportOf(spacing, level & 3);
        sound &= p.materialBack[k] < l.materials && p.bodyBack[k] < l.bodies && p.anchorBack[k] <= l.colliders;
        const uint16_t follows = p.followsBack[k];
        sound &= follows & kShapeBit ? shapeOf(follows) <= l.shapes : follows <= l.paths;
        sound &= p.bondSlotBack[k] <= l.slots && p.pieceBack[k] <= l.pieces;
        const uint64_t fine = p.fineBack[k];
        sound &= fine == 0 || fine - 1 + (uint64_t{1} << (level & 3)) <= l.points;
    }
    if (!sound) io.fail("a particle that cannot be");
}

void sparse(StateIo& io, float* values, size_t n) {
    if (n == 0) return;
    unsigned char* data = reinterpret_cast<unsigned char*>(values);
    if (io.saves()) return write<uint32_t>(io, data, sizeof(float), n);
    if (io.restores()) return read<uint32_t>(io, data, sizeof(float), n);
    read<uint32_t>(io, nullptr, 0, n);
}

void takeColumns(Particles& p, int count, int movers) {
    p.count = count, p.moverCount = movers;
#define X(type, name) p.name.swap(p.name##Back);
    THAW_PARTICLE_FIELDS(X)
#undef X
    p.pad();
}

} // namespace thaw
