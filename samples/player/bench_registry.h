// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
//
// A source file that is linked into the player adds `thaw bench NAME` by defining one BenchRegistration at file scope.
#pragma once

#include <vector>

namespace thaw::player {

struct BenchEntry {
    const char* name;
    const char* help;
    int (*run)(int argc, char** argv); // argv[0] is the name; gets what follows it on the command line; exit code
};

inline std::vector<BenchEntry>& benchEntries() {
    static std::vector<BenchEntry> entries;
    return entries;
}

struct BenchRegistration {
    BenchRegistration(const char* name, const char* help, int (*run)(int, char**)) {
        benchEntries().push_back({name, help, run});
    }
};

} // namespace thaw::player
