#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the thaw authors
# SPDX-License-Identifier: MIT
#
# shader_test.sh GLSLANG SOURCE WORK: compiles and links every program that the renderer builds, put together as the renderer does
# it (#version, the pass, common.glsl, the files), and finds shaders that no program uses. Drivers accept more than the language
# allows; glslang does not.
set -euo pipefail
glslang=$1 source=$2 work=$3
folder=$source/shaders
mkdir -p "$work"

# Calls of GlProgram::build(vertex, fragments, pass, ...): "a.vert", "b.glsl+c.frag", "SOME_PASS" or nullptr.
programs=$(cat "$source"/editor/view/*.cpp | tr -s '\n ' ' ' |
    grep -oE '"[a-z_]+\.vert", *"([a-z_]+\.(glsl|frag)\+?)+", *("[A-Z_]*"|nullptr)' | tr -d '"' | tr -s ', ' ' ' | sort -u)
[[ -n $programs ]] || { echo "shaders: found no program in editor/view"; exit 1; }

# compose OUTPUT PASS FILES: FILES is a list with + between
compose() {
    local files
    [[ $2 == nullptr || -z $2 ]] && set -- "$1" NO_PASS "$3"
    IFS=+ read -ra files <<<"$3"
    {
        printf '#version 330 core\n#define %s\n' "$2"
        cat "$folder/common.glsl"
        for file in "${files[@]}"; do
            printf '\n#line 1\n'
            cat "$folder/$file"
        done
    } >"$1"
}

failed=0
while read -r vertex fragments pass; do
    compose "$work/program.vert" "$pass" "$vertex"
    compose "$work/program.frag" "$pass" "$fragments"
    if ! output=$("$glslang" -l "$work/program.vert" "$work/program.frag" 2>&1); then
        printf 'shaders: %s, %s, %s:\n%s\n' "$vertex" "$fragments" "$pass" "$output"
        failed=1
    fi
done <<<"$programs"

for path in "$folder"/*.vert "$folder"/*.frag "$folder"/*.glsl; do
    name=$(basename "$path")
    if [[ $name != common.glsl ]] && ! grep -qE "(^|[ +])${name/./\\.}([ +]|\$)" <<<"$programs"; then
        printf 'shaders: no program uses %s\n' "$name"
        failed=1
    fi
done
exit $failed
