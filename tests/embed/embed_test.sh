#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the thaw authors
# SPDX-License-Identifier: MIT
#
# embed_test.sh static SOURCE BUILD WORK   installs the library that was built in BUILD and uses it from outside
# embed_test.sh shared SOURCE BUILD WORK   builds a shared one inside a parent project, checks its symbols, uses it
set -euo pipefail
kind=$1 source=$2 build=$3 work=$4
here=$source/tests/embed
die() { printf 'embed: %s\n' "$*" >&2; exit 1; }

rm -rf "$work"
mkdir -p "$work"
launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi

if [[ $kind == static ]]; then
    cmake --install "$build" --prefix "$work/first" >"$work/install.log"
else
    # -O1: what is tested here is the package, not the speed.
    cmake -S "$here/subdirectory" -B "$work/build" -G Ninja -DTHAW_SOURCE_DIR="$source" -DBUILD_SHARED_LIBS=ON \
        -DTHAW_INSTALL=ON -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" "${launcher[@]}" >"$work/configure.log"
    cmake --build "$work/build" -j 2 >"$work/build.log" 2>&1 || { tail -n 40 "$work/build.log" >&2; die "the shared build failed"; }
    "$work/build/hello"
    cmake --install "$work/build" --prefix "$work/first" >"$work/install.log"
fi

# Nothing that is installed may remember where it was built or installed.
prefix=$work/moved
mv "$work/first" "$prefix"
if grep -rlF -e "$work/first" -e "$source" "$prefix" --include='*.cmake' --include='*.pc' --include='*.h'; then
    die "these files name a path of the build machine"
fi
library=$(find "$prefix" -name 'libthaw.*' | sort | head -n 1)
[[ -n $library ]] || die "no library was installed"
libdir=$(dirname "$library")

if [[ $kind == shared ]]; then
    [[ -e $libdir/libthaw.so.0 ]] || die "no libthaw.so.0 in $libdir"
    symbols=$(nm -D --defined-only "$libdir/libthaw.so" | awk '{ print $3 }')
    foreign=$(grep -v '^thaw[A-Z]' <<<"$symbols" || true)
    [[ -z $foreign ]] || die "exported, but not ours: $foreign"
    declared=$(tr '\n' ' ' <"$source/runtime/include/thaw/thaw.h" | grep -oE 'THAW_API [^(;]*\(' | sed -nE 's/.*[ *](thaw[A-Z][A-Za-z0-9_]*)\($/\1/p' | sort -u)
    (($(wc -l <<<"$declared") > 20)) || die "found only these declarations in thaw.h: $declared"
    missing=$(comm -23 <(printf '%s\n' "$declared") <(sort -u <<<"$symbols"))
    [[ -z $missing ]] || die "declared, but not exported: $missing"
fi

cmake -S "$here/consumer" -B "$work/find_package" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" >"$work/consumer.log"
cmake --build "$work/find_package" >>"$work/consumer.log" || { cat "$work/consumer.log" >&2; die "the find_package consumer failed"; }
"$work/find_package/hello"

export PKG_CONFIG_PATH=$libdir/pkgconfig
# shellcheck disable=SC2046 # words are meant to split
cc -std=c99 -Wall -Wextra -Wpedantic -Werror $(pkg-config --cflags thaw) "$here/consumer/hello.c" -o "$work/hello" $(pkg-config --libs thaw)
LD_LIBRARY_PATH=$libdir "$work/hello"
[[ $(pkg-config --modversion thaw) == "$(sed -nE 's/^project\(thaw VERSION ([0-9.]+).*/\1/p' "$source/CMakeLists.txt")" ]] ||
    die "pkg-config and CMakeLists.txt disagree about the version"
