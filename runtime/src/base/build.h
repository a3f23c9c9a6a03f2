// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT
#pragma once

namespace thaw {

// Version, compiler and the instruction set that the kernels run with on this machine. Static storage.
const char* buildString();

} // namespace thaw
