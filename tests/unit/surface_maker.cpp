// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "surface/maker.h"
#include "surface_fixture.h"

#include <doctest/doctest.h>

#include <cstdlib>

using namespace thaw;

namespace {

struct Memory {
    int left = -1; // allocations that are granted yet; -1: all

    thawAllocator hook() {
        const auto take = [](size_t size, size_t alignment, void* user) -> void* {
            Memory& m = *static_cast<Memory*>(user);
            if (m.left == 0) return nullptr;
            if (m.left > 0) --m.left;
            return std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
        };
        return {take, [](void* memory, size_t, void*) { std::free(memory); }, this};
    }
};

} // namespace

TEST_CASE("surface: blocks of a mesh that failed count with no other") {
    Wax wax;
    Dice dice;
    wax.scatterBox(9, 9, 9, dice);
    Mesher fresh;
    fresh(wax);
    int failed = 0, late = 0;
    for (int granted = 0; granted < 1000; ++granted) {
        Memory memory;
        Allocator allocator(memory.hook());
        SurfaceMaker maker(allocator, {});
        maker.rows.copy(wax.input());
        memory.left = granted;
        maker.begin({wax.spacing, 0.75f, 1});
        bool done = true;
        try {
            maker.finish();
        } catch (const std::bad_alloc&) {
            done = false;
        }
        memory.left = -1;
        if (done) break;
        ++failed, late += maker.surface().meshedBlocks() > 0;
        const bool whole = maker.surface().positions.empty(); // else only the copy that is shown was not made
        maker.begin({wax.spacing, 0.75f, 1});
        CHECK(maker.finish().positions.size() == fresh.surface.positions.size());
        CHECK(maker.meshedBlocks() == (whole ? fresh.surface.meshedBlocks() : 0));
    }
    CHECK(failed > 30);
    CHECK(late > 3); // some failed when blocks had been counted
}
