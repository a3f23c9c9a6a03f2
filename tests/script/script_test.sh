#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the thaw authors
# SPDX-License-Identifier: MIT
#
# script_test.sh SOURCE: the parts of ./thaw that neither install nor build.
set -uo pipefail
source=$1
thaw=$source/thaw
failed=0
elsewhere=$(mktemp -d)
trap 'rm -rf "$elsewhere"' EXIT
cd "$elsewhere" || exit 1

# expect STATUS TEXT ARGUMENTS...: the exit status, and a text in what it prints
expect() {
    local status=$1 text=$2 output actual
    shift 2
    output=$("$thaw" "$@" 2>&1 </dev/null)
    actual=$?
    if ((actual != status)) || [[ $output != *"$text"* ]]; then
        printf 'script: ./thaw %s: expected %s and "%s", got %s and:\n%s\n' "$*" "$status" "$text" "$actual" "$output"
        failed=1
    fi
}

expect 0 'usage: ./thaw COMMAND'
expect 0 'usage: ./thaw COMMAND' help
expect 0 'usage: ./thaw COMMAND' --help
expect 2 "unknown command 'meld'" meld
expect 0 'usage: ./thaw demo' demo --help
expect 2 'demo takes no arguments' demo --fast
expect 0 'usage: ./thaw test' test --help
expect 2 'needs a value' test --label
expect 2 "unknown argument '--bogus'" test --bogus
expect 2 "unknown preset 'fast'" test --preset fast
expect 0 'usage: ./thaw build' build -h
expect 2 "unknown preset 'fast'" build fast
expect 2 'one preset at most' build release debug
expect 0 'usage: ./thaw editor' editor --help
expect 0 'usage: ./thaw gallery' gallery --help
expect 2 "unknown argument '--fast'" gallery --fast
expect 2 "no picture 'mona_lisa'" gallery mona_lisa
expect 2 "no picture 'mona_lisa'" gallery candle mona_lisa
expect 2 '--check takes no names' gallery --check candle
expect 0 'capture samples/scenes/candle.json' gallery --list
expect 0 'tour path samples/scenes/candle.json' gallery --list
expect 0 'usage: ./thaw clean' clean --help
expect 2 'clean takes no arguments' clean all

# A link to the script finds its home all the same.
ln -s "$thaw" link
"$elsewhere/link" help >/dev/null || { echo 'script: a link to ./thaw does not work'; failed=1; }

# What is left behind in the caller's directory: nothing but that link.
[[ $(ls -A) == link ]] || { echo "script: left in the caller's directory: $(ls -A)"; failed=1; }

# The pictures in the repository are those of its scenes, and what has become stale is noticed.
expect 0 '' gallery --check
mkdir -p stale/samples
cp "$thaw" stale/thaw
cp -r "$source/samples/gallery" "$source/samples/scenes" stale/samples/
# staleSays TEXT: what the copy's check complains of, once
staleSays() {
    local output status
    output=$(./stale/thaw gallery --check 2>&1)
    status=$?
    if ((status != 1)) || [[ $output != *"$1"* ]]; then
        printf 'script: a stale gallery: expected "%s", got %s and:\n%s\n' "$1" "$status" "$output"
        failed=1
    fi
    cp -r "$source/samples/gallery" "$source/samples/scenes" stale/samples/
}
sed -i 's/"seconds": /"seconds": 1/' stale/samples/scenes/bar.json
staleSays 'bar.png: its command, scene or mesh is not what it was made from'
echo '# another' >>stale/samples/scenes/meshes/star.obj
staleSays 'star.png: its command, scene or mesh'
sed -i 's/--size 480x270 --sheet/--size 480x271 --sheet/' stale/samples/gallery/gallery.txt
staleSays 'burn.png: its command'
rm stale/samples/gallery/candle.gif
staleSays 'candle.gif: is missing'
touch stale/samples/gallery/spoon.png
staleSays 'spoon.png: is not in gallery.txt'
rm stale/samples/gallery/spoon.png
sed -i '/^| !\[burn\]/d' stale/samples/gallery/README.md
staleSays 'README.md: its table is not that of gallery.txt'

# A picture that could not be put in its place does not count as made.
mkdir -p stale/build/release/bin stale/tools
touch stale/build/release/build.ninja
printf '#!/bin/sh\nmkdir -p out/gallery/bar\nfor f in sheet capture_000; do echo new >out/gallery/bar/$f.png; done\n' >stale/build/release/bin/thaw
printf '#!/bin/sh\nexit 0\n' >stale/tools/cmake
printf '#!/bin/sh\nexit 1\n' >stale/tools/cp
chmod +x stale/build/release/bin/thaw stale/tools/*
echo '# another' >>stale/samples/scenes/bar.json
if PATH=$PWD/stale/tools:$PATH ./stale/thaw gallery bar.png >/dev/null 2>&1; then
    echo 'script: gallery said nothing of a picture that it could not copy'
    failed=1
fi
staleSays 'bar.png: its command, scene or mesh'
rm stale/tools/cp
PATH=$PWD/stale/tools:$PATH ./stale/thaw gallery bar.png >/dev/null || { echo 'script: gallery does not make a picture'; failed=1; }
[[ $(<stale/samples/gallery/bar.png) == new ]] || { echo 'script: the new picture is not in its place'; failed=1; }
rm -r stale

# Without root, without sudo and with a package missing it must say what to install, not fail in the middle.
if command -v setpriv >/dev/null && ((EUID == 0)); then
    mkdir -p copy/third_party_notes
    cp "$thaw" copy/thaw
    echo 'build no-such-package-as-this' >copy/third_party_notes/packages.txt
    chmod -R a+rX "$elsewhere"
    output=$(PATH=$elsewhere/bin:/usr/bin:/bin setpriv --reuid=65534 --regid=65534 --clear-groups ./copy/thaw build 2>&1 </dev/null)
    status=$?
    if ((status != 1)) || [[ $output != *'apt-get install --no-install-recommends no-such-package-as-this'* ]]; then
        printf 'script: without root it said (status %s): %s\n' "$status" "$output"
        failed=1
    fi
fi

# Every package is named once, in a set that exists.
if ! awk '/^#/ || NF == 0 { next } NF != 2 || ($1 != "build" && $1 != "test") || seen[$2]++ { print "script: bad line: " $0; bad = 1 } END { exit bad }' \
    "$source/third_party_notes/packages.txt"; then failed=1; fi

exit $failed
