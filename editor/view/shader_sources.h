// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

#pragma once

namespace thaw::view {

/// GLSL text of a file in shaders/ by its file name ("surface.frag"), or nullptr when there is no such file.
/// The build generates the definition from the folder. Static storage.
const char* shaderSource(const char* name);

} // namespace thaw::view
