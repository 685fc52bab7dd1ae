#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Milliseconds of whole processes, medians of rounds in which all take turns: nothing (`true`), --version, a step of a
# run, and one still picture and sixty frames by each painter, whose ratios are told; beside another build of geomint if there is one to compare with:
# start.sh GEOMINT [OTHER [ROUNDS]]
set -u
geomint=$1
other=${2:-$1}
rounds=${3:-25}
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT

# take LABEL WORDS: appends their microseconds to a file
take() {
    label=$1
    shift
    begun=$(date +%s%N)
    "$@" >"$folder/out" 2>&1
    echo $((($(date +%s%N) - begun) / 1000)) >>"$folder/$label"
}

tell() {
    sort -n "$folder/$1" | awk -v what="$2" '
        { times[NR] = $1 }
        END { printf "%-28s %8.2f ms, at least %.2f\n", what, times[int((NR + 1) / 2)] / 1000, times[1] / 1000 }'
}

# ratio LABEL WORDS: of the medians of both painters
ratio() {
    for painter in own osmesa; do
        sort -n "$folder/$1-$painter" | awk '{ times[NR] = $1 } END { print times[int((NR + 1) / 2)] }'
    done | awk -v what="$2" 'NR == 1 { own = $1 } END { printf "%s %.2f times as long as by own\n", what, $1 / own }'
}

round=0
while [ "$round" -lt "$rounds" ]; do
    take nothing true
    for build in this other; do
        program=$geomint
        [ "$build" = other ] && program=$other
        take "$build-version" "$program" --version
        take "$build-run" "$program" run disc steps=3
        for painter in own osmesa; do
            take "$build-still-$painter" "$program" render disc --painter "$painter" -o "$folder/a.png"
            rm -rf "$folder/frames"
            take "$build-frames-$painter" "$program" render disc --painter "$painter" --frames 60 --out "$folder/frames"
        done
    done
    round=$((round + 1))
done
tell nothing true
for build in this other; do
    [ "$build" = other ] && [ "$other" = "$geomint" ] && continue
    tell "$build-version" "$build: --version"
    tell "$build-run" "$build: run disc steps=3"
    for painter in own osmesa; do
        tell "$build-still-$painter" "$build: still by $painter"
        tell "$build-frames-$painter" "$build: 60 frames by $painter"
    done
    ratio "$build-still" "$build: a still by osmesa takes"
    ratio "$build-frames" "$build: 60 frames by osmesa take"
done
