#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What it costs to save the states of Kepler's orbit at every step, beside the same run that stops at every step and
# saves nothing (rows of the history go to /dev/null), and beside the plain run. Usage: saving.sh PROGRAM. Wall
# seconds for a million steps, the median of five.
program=${1:?usage: saving.sh PROGRAM}
steps=1000000
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT

seconds() {
    for _ in 1 2 3 4 5; do
        from=$(date +%s%N)
        "$program" run kepler scheme=verlet steps=$steps "$@" >/dev/null 2>&1
        awk "BEGIN { print ($(date +%s%N) - $from) / 1e9 }"
    done | sort -n | sed -n 3p
}

history=$(seconds --csv /dev/null)
printf '%-28s %8s\n' 'nothing, no stop' "$(seconds)"
printf '%-28s %8s\n' 'looked at, at every step' "$(seconds --max)"
printf '%-28s %8s\n' 'history to /dev/null' "$history"
for ending in npz csv; do
    saved=$(seconds --save "$folder/a.$ending")
    printf '%-28s %8s  %s times the history\n' "saved as .$ending" "$saved" \
        "$(awk "BEGIN { printf \"%.2f\", $saved / $history }")"
done
