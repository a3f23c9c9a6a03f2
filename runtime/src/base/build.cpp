// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#include "base/build.h"

#include "thaw/thaw.h"

#include <hwy/highway.h>
#include <hwy/targets.h>

#include <string>

namespace thaw {

const char* buildString() {
    static const std::string text = [] {
        const int64_t targets = hwy::SupportedTargets();
        std::string s = "thaw " + std::to_string(THAW_VERSION / 10000) + "." +
                        std::to_string(THAW_VERSION / 100 % 100) + "." + std::to_string(THAW_VERSION % 100);
#if defined(__clang__)
        s += ", clang " __clang_version__;
#elif defined(__GNUC__)
        s += ", gcc " __VERSION__;
#endif
        // Better targets have lower bits.
        s += std::string(", ") + hwy::TargetName(targets & -targets);
#if !defined(NDEBUG)
        s += ", asserts";
#endif
        return s;
    }();
    return text.c_str();
}

} // namespace thaw
