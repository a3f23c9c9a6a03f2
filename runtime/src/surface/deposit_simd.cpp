// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/deposit_simd.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "surface/deposit_simd.cpp"
#include "hwy/foreach_target.h"

#include "base/simd.h"

HWY_BEFORE_NAMESPACE();
namespace thaw {
namespace HWY_NAMESPACE {

constexpr int kSide = 8;
constexpr int kMostNodes = 24; // that a particle reaches along an axis: 17 at most, in whole vectors
using I32 = hn::Vec<TagI32>;

HWY_INLINE float localOf(float p, double perCell, double first) {
    return static_cast<float>(static_cast<double>(p) * perCell - first);
}

// Of what is in the block and may round to its end.
HWY_INLINE float homeOf(float p, double perCell, double first) {
    const float local = localOf(p, perCell, first);
    return local < 7.9999995f ? local : 7.9999995f;
}

// The first whole number after v, which is above -16. That it may be one more for rounding brings nothing: the kernel
// ends there.
HWY_INLINE int firstAfter(float v) { return static_cast<int>(v + 17) - 16; }

// 1 - (first + l - at)^2 inverse for l = 0..8 parts - 1.
HWY_INLINE void along(float offset, float inverse, int parts, float* out) {
    alignas(32) static constexpr float kPlaces[kSide] = {0, 1, 2, 3, 4, 5, 6, 7};
    for (int part = 0; part < kSide * parts; part += kLanes) {
        const F32 place = hn::Add(hn::Load(kF32, kPlaces + part % kSide), all(static_cast<float>(part - part % kSide)));
        const F32 d = hn::Add(place, all(offset));
        hn::Store(hn::NegMulAdd(hn::Mul(d, d), all(inverse), all(1)), kF32, out + part);
    }
}

// a b rounded to a whole number below 2^22: that of the sum's last digits. NearestInt also sees to numbers that do not
// fit, with three instructions more.
HWY_INLINE I32 wholeProduct(F32 a, F32 b) {
    const F32 magic = all(12582912.0f);
    return hn::Sub(hn::BitCast(kI32, hn::MulAdd(a, b, magic)), hn::BitCast(kI32, magic));
}

HWY_INLINE void bring(F32 t, F32 amplitude, int32_t* to) {
    t = hn::Max(t, zero());
    const I32 w = wholeProduct(hn::Mul(amplitude, t), hn::Mul(t, t));
    hn::StoreU(hn::Add(hn::LoadU(kI32, to), w), kI32, to);
}

// Windows of the same size for all particles of a radius, wherever in their cell they are: loops of different lengths
// cost more, a branch each that is not foreseen. kNodes: along an axis; 0: `nodes`, any number.
template <int kNodes>
HWY_INLINE void depositOne(float x, float y, float z, float radius, float inverse, F32 amplitude, int nodes,
                           DepositTile& tile) {
    if (kNodes > 0) nodes = kNodes;
    const int parts = (nodes + kSide - 1) / kSide;
    const int fx = firstAfter(x - radius), fy = firstAfter(y - radius), fz = firstAfter(z - radius);
    alignas(32) float alongX[kMostNodes], alongY[kMostNodes], alongZ[kMostNodes];
    along(static_cast<float>(fx) - x, inverse, parts, alongX);
    along(static_cast<float>(fy) - y, inverse, parts, alongY);
    along(static_cast<float>(fz) - z, inverse, parts, alongZ);
    tile.lower[0] = fy < tile.lower[0] ? fy : tile.lower[0], tile.lower[1] = fz < tile.lower[1] ? fz : tile.lower[1];
    tile.upper[0] = fy + nodes > tile.upper[0] ? fy + nodes : tile.upper[0];
    tile.upper[1] = fz + nodes > tile.upper[1] ? fz + nodes : tile.upper[1];
    const int side = kSide + 2 * tile.pad;
    int32_t* first =
        tile.nodes + ((fz + tile.pad) * side + fy + tile.pad) * DepositTile::kRow + fx + DepositTile::kBeyond;
    for (int part = 0; part < nodes; part += kLanes) {
        const F32 xs = hn::Sub(hn::Load(kF32, alongX + part), all(2)); // each of the three is 1 - something
        for (int nz = 0; nz < nodes; ++nz) {
            const F32 xz = hn::Add(xs, all(alongZ[nz]));
            int32_t* row = first + nz * side * DepositTile::kRow + part;
            for (int ny = 0; ny < nodes; ++ny, row += DepositTile::kRow)
                bring(hn::Add(xz, all(alongY[ny])), amplitude, row);
        }
    }
}

void depositLanes(const FillArrays& from, const int* which, const float* amplitudes, int count, const FillBlock& block,
                  DepositTile& tile) {
    const float cellSquared = static_cast<float>(1 / (block.perCell * block.perCell));
    float last = -1, inverse = 0, radius = 0;
    int nodes = 0;
    for (int n = 0; n < count; ++n) {
        const int k = which[n];
        if (from.inverse[k] != last) {
            last = from.inverse[k];
            inverse = last * cellSquared, radius = std::sqrt(1 / inverse);
            nodes = static_cast<int>(2 * radius) + 1;
        }
        const float x = homeOf(from.x[k], block.perCell, block.first[0]),
                    y = homeOf(from.y[k], block.perCell, block.first[1]),
                    z = homeOf(from.z[k], block.perCell, block.first[2]);
        const F32 amplitude = all(amplitudes[n] * block.perUnit);
        if (nodes == 5)
            depositOne<5>(x, y, z, radius, inverse, amplitude, nodes, tile);
        else
            depositOne<0>(x, y, z, radius, inverse, amplitude, nodes, tile);
    }
}

// In kFillUnit, which is in the amplitude.
HWY_INLINE I32 share(F32 dx, F32 dy, F32 dz, F32 inverse, F32 amplitude) {
    const F32 t = hn::Max(hn::NegMulAdd(dot3(dx, dy, dz, dx, dy, dz), inverse, all(1)), zero());
    return wholeProduct(hn::Mul(amplitude, t), hn::Mul(t, t));
}

void sumAroundLanes(const FillArrays& from, const int* begins, const int* ends, int runs, const int* which, int rows,
                    int* sums) {
    // Four at a time share what is loaded. All of the runs: to pick first what is near costs more than it saves.
    for (int i = 0; i < rows; i += 4) {
        const int left = rows - i, a = which[i], b = which[left > 1 ? i + 1 : i], c = which[left > 2 ? i + 2 : i],
                  d = which[left > 3 ? i + 3 : i];
        const F32 x0 = all(from.x[a]), x1 = all(from.x[b]), x2 = all(from.x[c]), x3 = all(from.x[d]);
        const F32 y0 = all(from.y[a]), y1 = all(from.y[b]), y2 = all(from.y[c]), y3 = all(from.y[d]);
        const F32 z0 = all(from.z[a]), z1 = all(from.z[b]), z2 = all(from.z[c]), z3 = all(from.z[d]);
        auto s0 = hn::Zero(kI32), s1 = s0, s2 = s0, s3 = s0;
        for (int run = 0; run < runs; ++run)
            for (int k = begins[run]; k < ends[run]; k += kLanes) {
                const F32 x = load(from.x + k), y = load(from.y + k), z = load(from.z + k);
                const F32 inverse = load(from.inverse + k);
                const F32 amplitude = hn::IfThenElseZero(hn::FirstN(kF32, static_cast<size_t>(ends[run] - k)),
                                                         hn::Mul(load(from.amplitude + k), all(1 / kFillUnit)));
                s0 = hn::Add(s0, share(hn::Sub(x, x0), hn::Sub(y, y0), hn::Sub(z, z0), inverse, amplitude));
                s1 = hn::Add(s1, share(hn::Sub(x, x1), hn::Sub(y, y1), hn::Sub(z, z1), inverse, amplitude));
                s2 = hn::Add(s2, share(hn::Sub(x, x2), hn::Sub(y, y2), hn::Sub(z, z2), inverse, amplitude));
                s3 = hn::Add(s3, share(hn::Sub(x, x3), hn::Sub(y, y3), hn::Sub(z, z3), inverse, amplitude));
            }
        sums[i] = hn::GetLane(hn::SumOfLanes(kI32, s0));
        if (left > 1) sums[i + 1] = hn::GetLane(hn::SumOfLanes(kI32, s1));
        if (left > 2) sums[i + 2] = hn::GetLane(hn::SumOfLanes(kI32, s2));
        if (left > 3) sums[i + 3] = hn::GetLane(hn::SumOfLanes(kI32, s3));
    }
}

void addTileLanes(DepositTile& tile, int32_t* const around[27]) {
    const int side = kSide + 2 * tile.pad;
    const auto within = [](int v) HWY_ATTR { return v < 2 * kSide ? v : 2 * kSide; }; // nothing reaches farther
    for (int z = tile.lower[1]; z < within(tile.upper[1]); ++z)
        for (int y = tile.lower[0]; y < within(tile.upper[0]); ++y) {
            int32_t* row = tile.nodes + ((z + tile.pad) * side + y + tile.pad) * DepositTile::kRow;
            int32_t* const* near = around + ((z + kSide) / kSide * 3 + (y + kSide) / kSide) * 3;
            const int node = ((z & (kSide - 1)) * kSide + (y & (kSide - 1))) * kSide;
            for (int dx = 0; dx < 3; ++dx)
                for (int part = 0; part < kSide; part += kLanes) {
                    int32_t* from = row + dx * kSide + part;
                    if (near[dx] != nullptr) {
                        int32_t* to = near[dx] + node + part;
                        hn::StoreU(hn::Add(hn::LoadU(kI32, to), hn::LoadU(kI32, from)), kI32, to);
                    }
                    hn::StoreU(hn::Zero(kI32), kI32, from);
                }
        }
    for (int a = 0; a < 2; ++a) tile.lower[a] = kSide, tile.upper[a] = -kSide;
}

void depositAcrossLanes(const FillArrays& from, int first, const float* amplitudes, int count, const FillBlock& block,
                        int32_t* nodes) {
    const float cellSquared = static_cast<float>(1 / (block.perCell * block.perCell));
    for (int n = 0; n < count; ++n) {
        const int k = first + n;
        const float x = localOf(from.x[k], block.perCell, block.first[0]),
                    y = localOf(from.y[k], block.perCell, block.first[1]),
                    z = localOf(from.z[k], block.perCell, block.first[2]);
        const float inverse = from.inverse[k] * cellSquared;
        alignas(32) float alongX[kSide], alongY[kSide], alongZ[kSide];
        along(-x, inverse, 1, alongX), along(-y, inverse, 1, alongY), along(-z, inverse, 1, alongZ);
        const F32 amplitude = all(amplitudes[n] * block.perUnit);
        for (int nz = 0; nz < kSide; ++nz)
            for (int ny = 0; ny < kSide; ++ny)
                for (int part = 0; part < kSide; part += kLanes)
                    bring(hn::Add(hn::Load(kF32, alongX + part), all(alongY[ny] + alongZ[nz] - 2)), amplitude,
                          nodes + (nz * kSide + ny) * kSide + part);
    }
}

void markInsideLanes(const int32_t* base, const int32_t* lift, int32_t iso, uint8_t* bits) {
    const I32 least = hn::Set(kI32, iso - 1);
    for (int row = 0; row < kSide * kSide; ++row) {
        unsigned b = 0;
        for (int part = 0; part < kSide; part += kLanes) {
            I32 sum = hn::LoadU(kI32, base + row * kSide + part);
            if (lift != nullptr) sum = hn::Add(sum, hn::LoadU(kI32, lift + row * kSide + part));
            b |= bitsOf(hn::RebindMask(kF32, hn::Gt(sum, least))) << part;
        }
        bits[row] = static_cast<uint8_t>(b);
    }
}

} // namespace HWY_NAMESPACE
} // namespace thaw
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace thaw {

HWY_EXPORT(depositLanes);
HWY_EXPORT(sumAroundLanes);
HWY_EXPORT(addTileLanes);
HWY_EXPORT(depositAcrossLanes);
HWY_EXPORT(markInsideLanes);

void deposit(const FillArrays& from, const int* which, const float* amplitudes, int count, const FillBlock& block,
             DepositTile& tile) {
    HWY_DYNAMIC_DISPATCH(depositLanes)(from, which, amplitudes, count, block, tile);
}

void sumAround(const FillArrays& from, const int* begins, const int* ends, int runs, const int* which, int count,
               int* sums) {
    HWY_DYNAMIC_DISPATCH(sumAroundLanes)(from, begins, ends, runs, which, count, sums);
}

void addTile(DepositTile& tile, int32_t* const around[27]) { HWY_DYNAMIC_DISPATCH(addTileLanes)(tile, around); }

void depositAcross(const FillArrays& from, int first, const float* amplitudes, int count, const FillBlock& block,
                   int32_t* nodes) {
    HWY_DYNAMIC_DISPATCH(depositAcrossLanes)(from, first, amplitudes, count, block, nodes);
}

void markInside(const int32_t* base, const int32_t* lift, int32_t iso, uint8_t* bits) {
    HWY_DYNAMIC_DISPATCH(markInsideLanes)(base, lift, iso, bits);
}

} // namespace thaw
#endif
