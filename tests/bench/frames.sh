#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Frames a second of the disc with four lanes at 1280x720, PNG included, and the peak of memory for few and for many
# frames: frames.sh GEOMINT [RUNS]. matplotlib makes about 8 such frames a second, gnuplot 4.
set -u
geomint=$1
runs=${2:-5}
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
lanes=scheme=explicit-euler,implicit-euler,symplectic-euler,midpoint

# render FRAMES: seconds and kilobytes
render() {
    rm -rf "$folder" # frames that are there would be kept
    /usr/bin/env bash -c '
        start=$(date +%s.%N)
        "$1" render disc "$2" --frames "$3" --out "$4" 2>/dev/null &
        pid=$!
        peak=0
        while now=$(awk "/VmHWM/ { print \$2 }" /proc/$pid/status 2>/dev/null) && [ -n "$now" ]; do
            peak=$now
            sleep 0.05
        done
        wait $pid
        echo "$start $(date +%s.%N) $peak"' - "$geomint" "$lanes" "$1" "$folder" |
        awk -v frames="$1" '{ printf "%d frames: %.1f a second, %d MB\n", frames, frames / ($2 - $1), $3 / 1024 }'
}

run=0
while [ "$run" -lt "$runs" ]; do
    render 300
    run=$((run + 1))
done
render 1500
