// SPDX-FileCopyrightText: 2026 the thaw authors
// SPDX-License-Identifier: MIT

void main() {}
