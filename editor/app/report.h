// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace thaw::editor {

class App;

/// Where every control is, and how things stand, for scripts that drive the window: lines "x y width height name", and
/// "0 0 0 0 state NAME VALUE".
std::string reportOf(const App& app);
/// Into a file, when it differs from what was written last. What cannot be written is tried again at the next call.
void writeReport(const App& app, const std::string& file, std::string& last);

} // namespace thaw::editor
