#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the thaw authors
# SPDX-License-Identifier: MIT
#
# header_test.sh COMPILER LANGUAGE STANDARD INCLUDE_DIR: every public header compiles alone, twice over, without a warning.
set -euo pipefail
compiler=$1 language=$2 standard=$3 include=$4
cd "$include"
for header in thaw/*.h; do
    printf '#include "%s"\n#include "%s"\nint main(void) { return 0; }\n' "$header" "$header" |
        "$compiler" -x "$language" -std="$standard" -Wall -Wextra -Wpedantic -Wshadow -Werror -I. -fsyntax-only -
done
if [[ $language == c++ ]]; then
    for header in thaw/*.hpp; do
        [[ -e $header ]] || continue
        printf '#include "%s"\n#include "%s"\nint main() { return 0; }\n' "$header" "$header" |
            "$compiler" -x c++ -std="$standard" -Wall -Wextra -Wpedantic -Wshadow -Werror -I. -fsyntax-only -
    done
fi
