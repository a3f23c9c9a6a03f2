// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/state_io.h"

namespace thaw {

void StateIo::bytes(void* data, size_t size) {
    switch (mode_) {
    case Mode::hash: {
        const unsigned char* p = static_cast<const unsigned char*>(data);
        uint64_t w;
        for (; size >= 8; size -= 8, p += 8) std::memcpy(&w, p, 8), mix(w);
        w = 0;
        if (size > 0) std::memcpy(&w, p, size), mix(w ^ size << 56);
        return;
    }
    case Mode::save:
        if (take(size) && to_) std::memcpy(to_ + at_ - size, data, size);
        return;
    case Mode::check:
        take(size);
        return;
    case Mode::restore:
        if (take(size)) std::memcpy(data, from_ + at_ - size, size);
        return;
    }
}

void StateIo::truth(bool& v) {
    uint8_t byte = v;
    if (!reads()) return bytes(&byte, 1);
    if (const unsigned char* from = look(1)) byte = *from;
    if (byte > 1) return fail("neither yes nor no");
    if (restores()) v = byte != 0;
}

size_t StateIo::count(size_t now, size_t most) {
    uint32_t n = static_cast<uint32_t>(now);
    if (!reads()) {
        bytes(&n, sizeof n);
        return now;
    }
    n = 0;
    if (const unsigned char* from = look(sizeof n)) std::memcpy(&n, from, sizeof n);
    lastCount_ = n;
    if (n <= most) return n;
    fail("more of something than there can be");
    return 0;
}

bool StateIo::flag(bool now) { return count(now, 1) != 0; }

uint64_t checksum(const void* data, size_t size) {
    constexpr int kLanes = 8;
    constexpr uint64_t kOdd = 0x9e3779b97f4a7c15ULL;
    uint64_t lane[kLanes];
    for (int k = 0; k < kLanes; ++k) lane[k] = kOdd * static_cast<uint64_t>(k + 1);
    const unsigned char* p = static_cast<const unsigned char*>(data);
    size_t left = size;
    uint64_t w[kLanes];
    const auto round = [&] {
        for (int k = 0; k < kLanes; ++k) lane[k] = (lane[k] ^ w[k]) * kOdd, lane[k] ^= lane[k] >> 29;
    };
    for (; left >= sizeof w; left -= sizeof w, p += sizeof w) std::memcpy(w, p, sizeof w), round();
    if (left > 0) {
        std::memset(w, 0, sizeof w);
        std::memcpy(w, p, left);
        round();
    }
    uint64_t sum = size;
    for (const uint64_t l : lane) sum = hashCombine(sum, l);
    return sum;
}

} // namespace thaw
