#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the thaw authors
# SPDX-License-Identifier: MIT
#
# window_test.sh EDITOR SOURCE OUT: the editor in a real window of its own X server, used with real mouse and key
# events, and judged by its picture, by what it says of itself (--controls) and by the files that it saves. What is
# waited for is always a state, never a time. OUT: where the last picture and report go when something is wrong.
set -uo pipefail
editor=$1 source=$2 out=$3
root=$(mktemp -d)
report=$root/report
log=$root/log
limit=120 # s for one state; a machine under load draws a picture a second
server='' program=''

cleanUp() {
    [[ -z $program ]] || kill "$program" 2>/dev/null
    [[ -z $server ]] || { kill "$server" && wait "$server"; } 2>/dev/null
    chmod -R u+w "$root"
    rm -rf "$root"
}
trap cleanUp EXIT

fail() {
    printf 'window: %s\n' "$*"
    mkdir -p "$out"
    cp "$report" "$log" "$out/" 2>/dev/null
    [[ -z $server ]] || import -window root "$out/failed.png" 2>/dev/null
    grep ' state ' "$report" 2>/dev/null | cut -d ' ' -f 6-
    tail -n 5 "$log" 2>/dev/null
    printf 'window: picture and report are in %s\n' "$out"
    exit 1
}

begun=$(date +%s%N)
step() { printf '%6.1f s  %s\n' "$((($(date +%s%N) - begun) / 1000000))e-3" "$*"; }

# state NAME: its value
state() { sed -n "s/^0 0 0 0 state $1 \?//p" "$report" 2>/dev/null; }
# isTrue EXPRESSION: of numbers
isTrue() { [[ $(awk "BEGIN { print ($1) ? 1 : 0 }") == 1 ]]; }
alive() { kill -0 "$program" 2>/dev/null; }
# waitFor WHAT COMMAND...: until the command succeeds
waitFor() {
    local what=$1 until=$((SECONDS + limit))
    shift
    until "$@"; do
        alive || fail "$what: the editor has ended"
        ((SECONDS < until)) || fail "$what: not within $limit s"
        sleep 0.05
    done
}
is() { [[ $(state "$1") == "$2" ]]; }
reached() { isTrue "$(state "$1") + 0 $2 $3"; }
contains() { [[ $(state "$1") == *"$2"* ]]; }
sees() { grep -q "^[0-9-]* [0-9-]* [0-9-]* [0-9-]* $1\$" "$report" 2>/dev/null; }
waitState() { waitFor "state $1 = $2" is "$1" "$2"; }

# middle NAME: of a control, as "x y"
middle() {
    waitFor "control $1" sees "$1"
    awk -v n="$1" '{ x = $1; y = $2; w = $3; h = $4; $1 = $2 = $3 = $4 = ""; sub(/^ */, "") }
        $0 == n { printf "%d %d\n", x + w / 2, y + h / 2; exit }' "$report"
}
# click NAME
click() {
    local at
    at=$(middle "$1") || exit 1
    # shellcheck disable=SC2086
    xdotool mousemove $at click 1
}
# park: the pointer where it changes nothing
park() { xdotool mousemove 640 797; }
key() { xdotool key "$1"; }

# project X Y Z: of a point of the world the pixel, as the candle's camera sees it
project() {
    awk -v px="$1" -v py="$2" -v pz="$3" '
        $5 == "viewport" { x0 = $1; y0 = $2; w = $3; h = $4 }
        END {
            ex = 0.14; ey = 0.165; ez = 0.4; tx = 0; ty = 0.07; tz = 0; fov = 24 * 3.14159265 / 180
            fx = tx - ex; fy = ty - ey; fz = tz - ez; l = sqrt(fx * fx + fy * fy + fz * fz); fx /= l; fy /= l; fz /= l
            rx = -fz; rz = fx; l = sqrt(rx * rx + rz * rz); rx /= l; rz /= l
            ux = -rz * fy; uy = rz * fx - rx * fz; uz = rx * fy
            dx = px - ex; dy = py - ey; dz = pz - ez
            depth = dx * fx + dy * fy + dz * fz; s = h / 2 / (sin(fov / 2) / cos(fov / 2)) / depth
            printf "%d %d\n", x0 + w / 2 + s * (dx * rx + dz * rz), y0 + h / 2 - s * (dx * ux + dy * uy + dz * uz)
        }' "$report"
}

# shoot NAME: a picture of the part of the window that shows the candle, when it is as fine as it gets
shoot() {
    park
    waitState up-to-date yes
    waitFor 'a picture as fine as it gets' isSharp
    local low high
    low=$(project -0.03 0.125 0.017) high=$(project 0.03 0.01 0.017)
    # The report is written when the picture is on the screen.
    import -window root -crop "$((${high% *} - ${low% *}))x$((${high#* } - ${low#* }))+${low% *}+${low#* }" +repage "$root/$1.png"
}
isSharp() { is sharp yes && { sleep 0.3; is sharp yes; }; }
# different A B: share of pixels that differ by more than noise
different() { compare -metric AE -fuzz 6% "$root/$1.png" "$root/$2.png" null: 2>&1 | awk -v n="$(identify -format '%[fx:w*h]' "$root/$1.png")" '{ print $1 / n }'; }

brightness() { import -window root -format '%[fx:mean]' info:; }

# start ARGUMENTS...: the editor, until it shows its scene
start() {
    rm -f "$report"
    # A write beyond the limit of a file's size is an error, not the end.
    (trap '' XFSZ; exec "${as[@]}" "$editor" --size 1280x800 --controls "$report" "$@" >"$log" 2>&1) &
    program=$!
    waitState up-to-date yes
    local window
    window=$(xdotool search --name 'thaw$' | tail -n 1)
    [[ -n $window ]] || fail 'there is no window'
    xdotool windowfocus "$window"
    wid=$window
}
# ended STATUS: waits for the editor to end
ended() {
    local until=$((SECONDS + limit)) status
    while alive; do
        ((SECONDS < until)) || fail 'the editor does not end'
        sleep 0.05
    done
    wait "$program"
    status=$?
    program=''
    ((status == $1)) || fail "the editor ended with $status"
}
# chooseFile PATH: in the file browser
chooseFile() {
    waitFor 'the file browser' sees 'file name'
    waitState typing yes
    key ctrl+a
    xdotool type --delay 1 "$1"
    key Return
}

for tool in Xvfb xdotool import compare; do
    command -v "$tool" >/dev/null || { printf 'window: %s is missing: ./thaw test installs it\n' "$tool"; exit 1; }
done
export XDG_CONFIG_HOME=$root/config XDG_STATE_HOME=$root/state MESA_SHADER_CACHE_DISABLE=true
# Root writes into folders that are read-only unless it gives that up.
as=()
if ((EUID == 0)); then
    as=(setpriv --bounding-set -dac_override)
    "${as[@]}" true 2>/dev/null || as=()
fi
mkdir "$root/scenes" "$root/locked"
cp -r "$source/samples/scenes/meshes" "$root/scenes/"
cp "$source/samples/scenes/candle.json" "$root/scenes/candle.json"

exec {ready}> >(cat >"$root/display")
Xvfb -displayfd "$ready" -screen 0 1280x800x24 -nolisten tcp >/dev/null 2>&1 &
server=$!
exec {ready}>&-
until=$((SECONDS + limit))
until [[ -s $root/display ]]; do
    kill -0 "$server" 2>/dev/null || fail 'the X server does not start'
    ((SECONDS < until)) || fail 'the X server does not answer'
    sleep 0.05
done
export DISPLAY=:$(<"$root/display")
unset WAYLAND_DISPLAY

step 'open the candle'
start "$root/scenes/candle.json"
is sources 1 || fail 'the candle has one flame'

step 'draw an S on its side'
click 'tool Path'
waitState tool Path
line=()
for i in {0..24}; do
    # shellcheck disable=SC2046
    line+=(mousemove $(project "$(awk "BEGIN { print 0.009 * sin(6.283 * $i / 24) }")" "$(awk "BEGIN { print 0.105 - 0.08 * $i / 24 }")" 0.017) sleep 0.01)
    ((i)) || line+=(mousedown 1)
done
xdotool "${line[@]}" mouseup 1
waitState paths 1
is chosen path || fail 'the new path is not chosen'

step 'place heat before its upper end'
click 'tool Heat'
waitState tool Heat
# shellcheck disable=SC2046
xdotool mousemove $(project 0 0.108 0.018) click 1
waitState sources 2
shoot before

step 'play to frame 300'
key space
waitState playing yes
waitFor 'frame 300' reached frame '>=' 300
key space
waitState playing no
reached melted '>' 0.005 || fail "after 5 s only $(state melted) has melted"
reached captured '>' 1e-4 || fail "the path holds $(state captured) kg"
shoot after
isTrue "$(different before after) > 0.05" || fail "the picture has changed in $(different before after) of its pixels only"

step 'back to the start'
key Home
waitState frame 0
waitState melted 0
shoot again
isTrue "$(different before again) < 0.01" || fail "at the start it looks different in $(different before again)"

step 'undo twice, redo twice'
key ctrl+z
waitState sources 1
key ctrl+z
waitState paths 0
key ctrl+y
waitState paths 1
key ctrl+y
waitState sources 2

step 'save, close, open again, save under another name'
is saved no || fail 'it says that it is saved'
key ctrl+s
waitState saved yes
cmp -s "$root/scenes/candle.json" "$source/samples/scenes/candle.json" && fail 'the file is what it was'
key ctrl+q
ended 0
start "$root/scenes/candle.json"
is paths 1 && is sources 2 || fail 'what was drawn is not in the file'
key ctrl+shift+s
chooseFile again.json
waitState file "$root/scenes/again.json"
waitState saved yes
cmp "$root/scenes/candle.json" "$root/scenes/again.json" || fail 'the file is not the same when it is saved again'

step 'add the bunny'
key ctrl+i
chooseFile meshes/bunny.obj
click 'accept import'
waitState bodies 2
waitState up-to-date yes
is error '' || fail "the bunny: $(state error)"

step 'another size while it plays'
key space
waitFor 'a frame' reached frame '>' 2
xdotool windowsize "$wid" 900 620
waitState size 900x620
at=$(state frame)
waitFor 'frames at the new size' reached frame '>' "$at + 5"
read -r x y w h _ < <(grep ' viewport$' "$report")
((x >= 0 && y >= 0 && w > 200 && h > 150 && x + w <= 900 && y + h <= 620)) || fail "the picture is at $x,$y, $w x $h"
import -window root "$root/window.png"
# The picture of the scene is in it: not one colour.
isTrue "$(convert "$root/window.png" -crop "${w}x$h+$x+$y" -format '%[fx:standard_deviation]' info:) > 0.02" || fail 'the picture is empty'
xdotool windowsize "$wid" 1280 800
waitState size 1280x800
key space
waitState playing no

step 'close with unsaved changes'
key ctrl+q
click 'keep editing'
waitFor 'the question is gone' eval '! sees "keep editing"'
is saved no && alive || fail 'it does not go on'

step 'a folder that is read-only'
cp "$root/scenes/again.json" "$root/locked/old.json"
cp "$root/locked/old.json" "$root/old"
chmod a-w "$root/locked"
if "${as[@]}" test -w "$root/locked"; then
    step '  left out: this user writes everywhere'
else
    key ctrl+shift+s
    chooseFile "$root/locked/old.json"
    waitFor 'asked whether to replace it' sees replace
    click replace
    waitFor 'the reason' contains complaint 'old.json: cannot be written: Permission denied'
    click 'close message'
    waitState complaint ''
    cmp "$root/old" "$root/locked/old.json" || fail 'the old file is not what it was'
    [[ $(ls -A "$root/locked") == old.json ]] || fail "left beside it: $(ls -A "$root/locked")"
    is saved no && is file "$root/scenes/again.json" || fail 'it says that it is saved'
fi

step 'a disk that is full'
cp "$root/scenes/again.json" "$root/old"
prlimit --pid "$program" --fsize=100: || fail 'no limit for the size of files'
# The report cannot be written either now: a window that says why dims what is behind it.
bright=$(brightness)
key ctrl+s
waitFor 'a window with the reason' eval 'isTrue "$(brightness) < 0.8 * $bright"'
prlimit --pid "$program" --fsize=unlimited: || fail 'no end of the limit'
waitFor 'the reason' contains complaint 'again.json'
contains complaint 'File too large' || fail "the reason is: $(state complaint)"
cmp "$root/old" "$root/scenes/again.json" || fail 'the old file is not what it was'
click 'close message'
waitState complaint ''
is saved no || fail 'it says that it is saved'
key ctrl+s
waitState saved yes
cmp -s "$root/old" "$root/scenes/again.json" && fail 'with room again it is still not saved'

step 'close without saving'
key ctrl+z
waitState saved no
cp "$root/scenes/again.json" "$root/old"
key ctrl+q
click discard
ended 0
cmp "$root/old" "$root/scenes/again.json" || fail 'it was saved all the same'
[[ -z $(find "$root/state" -type f) ]] || fail "left behind: $(find "$root/state" -type f)"
step 'done'
