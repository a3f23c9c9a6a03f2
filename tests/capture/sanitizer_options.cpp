// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

// Read by AddressSanitizer at start, of no effect without it. Mesa 22.3.6 leaves 240 bytes of its own when its driver
// is unloaded, from addresses that no suppression can name, and the leak checker's tracer crashes on its threads.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "detect_leaks=0"; }
