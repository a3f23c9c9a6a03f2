// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include "base/math.h"
#include "base/memory.h"
#include "base/types.h"
#include "thaw/thaw.h"

#include <string>
#include <type_traits>
#include <vector>

namespace thaw {

// Types whose bytes are all of their value: no gaps, no pointers.
template <class T> inline constexpr bool kGapless = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <> inline constexpr bool kGapless<Vec3> = true;
template <> inline constexpr bool kGapless<Vec4> = true;
template <> inline constexpr bool kGapless<Quat> = true;
template <> inline constexpr bool kGapless<Transform> = true;
template <> inline constexpr bool kGapless<Box> = true;
template <> inline constexpr bool kGapless<thawVec3> = true;
template <> inline constexpr bool kGapless<thawMaterialDef> = true;
template <> inline constexpr bool kGapless<thawWork> = true;
template <> inline constexpr bool kGapless<thawCounters> = true; // filled whole when it is made, gaps included

// One walk over the state of a world, for all that is done with it: hashing it, writing it into an image, looking
// whether an image can be read, and reading it. Every class lists once what of it lives from step to step (its
// function `state`), so what is hashed is what is saved and what comes back. What no step depends on is a report:
// saved, but not hashed.
class StateIo {
public:
    enum class Mode : uint8_t { hash, save, check, restore };
    struct Limits { // of what an image may name
        size_t particles = 0, rows = 0, materials = 0, bodies = 0, colliders = 0, sources = 0, paths = 0, shapes = 0;
        size_t pieces = 0, points = 0, slots = 0; // rigid ones, of the reference, of bonds
    };

    explicit StateIo(uint64_t seed) : mode_(Mode::hash), hash_(seed) {}
    // buffer may be null: then it is only counted.
    StateIo(void* buffer, size_t capacity)
        : mode_(Mode::save), to_(static_cast<unsigned char*>(buffer)), capacity_(capacity) {}
    StateIo(const void* image, size_t size, bool check)
        : mode_(check ? Mode::check : Mode::restore), from_(static_cast<const unsigned char*>(image)), capacity_(size) {
    }

    bool hashes() const { return mode_ == Mode::hash; }
    bool saves() const { return mode_ == Mode::save; }
    bool checks() const { return mode_ == Mode::check; }
    bool restores() const { return mode_ == Mode::restore; }
    bool reads() const { return checks() || restores(); }
    bool good() const { return good_; }
    // Of an image: it is not what it should be. The first reason counts.
    void fail(const char* what) {
        if (good_) why_ = what;
        good_ = false;
    }
    const std::string& why() const { return why_; }
    uint64_t hash() const { return hash_; }
    void mix(uint64_t word) { hash_ = hashCombine(hash_, word); }
    size_t at() const { return at_; } // bytes written or read

    void bytes(void* data, size_t size);
    // Room in the image, to be written or read by hand; null when there is none. Not for hashing.
    unsigned char* room(size_t size) { return take(size) && to_ ? to_ + at_ - size : nullptr; }
    const unsigned char* look(size_t size) { return take(size) ? from_ + at_ - size : nullptr; }

    // Values. When an image is checked they stay what they are.
    template <class... T> void operator()(T&... values) { (value(values), ...); }
    // The same of what no step depends on.
    template <class... T> void report(T&... values) {
        if (!hashes()) (value(values), ...);
    }
    // A number that is below `limit`.
    template <class T> void index(T& v, size_t limit) {
        if (!reads()) return value(v);
        T read{};
        if (const unsigned char* from = look(sizeof read)) std::memcpy(&read, from, sizeof read);
        if (!(static_cast<uint64_t>(read) < limit)) return fail("a number out of range");
        if (restores()) v = read;
    }
    // How many follow: `now`, or as many as the image says.
    size_t count(size_t now, size_t most);
    size_t lastCount() const { return lastCount_; }
    // Whether something is there: `now`, or what the image says.
    bool flag(bool now);
    // Elements of an Array or std::vector, each by f(element). While an image is checked f gets one of its own.
    template <class C, class F> void list(C& c, size_t most, F&& f) {
        const size_t n = count(c.size(), most);
        if (checks()) {
            if (!good()) return;
            reserve(c, n);
            const Mode mode = mode_;
            mode_ = Mode::restore;
            for (size_t k = 0; k < n && good(); ++k) {
                std::remove_cvref_t<decltype(c[0])> own{};
                f(own);
            }
            mode_ = mode;
            return;
        }
        if (restores()) c.resize(good() ? n : 0);
        for (auto& x : c) {
            if (!good()) return;
            f(x);
        }
    }
    // The same for what owns memory: read into `stage` when the image is checked, and then swapped in, so that nothing
    // is left to fail.
    template <class C, class F> void staged(C& live, C& stage, size_t most, F&& f) {
        if (hashes()) return list(live, most, f);
        uint64_t length = 0;
        unsigned char* const head = saves() ? room(sizeof length) : nullptr;
        if (reads())
            if (const unsigned char* from = look(sizeof length)) std::memcpy(&length, from, sizeof length);
        if (!good()) return;
        const size_t begin = at_;
        if (restores()) {
            take(length);
            live.swap(stage);
            return;
        }
        C& c = checks() ? stage : live;
        const size_t n = count(c.size(), most);
        if (checks() && good()) c.resize(n);
        const Mode mode = mode_;
        if (checks()) mode_ = Mode::restore;
        for (auto& x : c) {
            if (!good()) break;
            f(x);
        }
        mode_ = mode;
        if (head) length = at_ - begin, std::memcpy(head, &length, sizeof length);
        if (checks() && at_ - begin != length) fail("a part of another length");
    }
    // All bytes of an Array or std::vector of gapless elements.
    template <class C> void block(C& c, size_t most) {
        using T = std::remove_cvref_t<decltype(c[0])>;
        static_assert(kGapless<T>);
        const size_t n = count(c.size(), most);
        if (!good()) return;
        if (checks()) {
            reserve(c, n);
            take(n * sizeof(T));
            return;
        }
        if (restores()) c.resize(n);
        if (n > 0) bytes(c.data(), n * sizeof(T));
    }

    // For as long as it lives values are read also while an image is checked: into what belongs to nobody.
    class Trial {
    public:
        explicit Trial(StateIo& io) : io_(io), mode_(io.mode_) {
            if (io.checks()) io.mode_ = Mode::restore;
        }
        ~Trial() { end(); }
        void end() { io_.mode_ = mode_; }
        Trial(const Trial&) = delete;
        Trial& operator=(const Trial&) = delete;

    private:
        StateIo& io_;
        Mode mode_;
    };

    Limits limits;

private:
    template <class T> void value(T& v) {
        static_assert(kGapless<std::remove_all_extents_t<T>>);
        if constexpr (std::is_same_v<std::remove_all_extents_t<T>, bool>) {
            for (size_t k = 0; k < sizeof v; ++k) truth(reinterpret_cast<bool*>(&v)[k]);
        } else {
            bytes(&v, sizeof v);
        }
    }
    void truth(bool& v);
    bool take(size_t size) {
        if (!good_ || size > capacity_ - at_) {
            fail(saves() ? "the buffer is too small" : "it ends too early");
            return false;
        }
        at_ += size;
        return true;
    }
    template <class T> static void reserve(Array<T>& c, size_t n) { c.reserve(n); }
    template <class T> static void reserve(std::vector<T>& c, size_t n) { c.reserve(n); }

    Mode mode_;
    bool good_ = true;
    unsigned char* to_ = nullptr;
    const unsigned char* from_ = nullptr;
    size_t capacity_ = 0, at_ = 0, lastCount_ = 0;
    uint64_t hash_ = 0;
    std::string why_;
};

// 64 bits of so many bytes, 8 at a time side by side.
uint64_t checksum(const void* data, size_t size);

} // namespace thaw
