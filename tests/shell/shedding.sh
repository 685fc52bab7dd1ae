#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Vortices behind a cylinder against the benchmark of M. Schaefer & S. Turek (1996), 2D-2: the largest drag 3.22 to 3.24,
# the largest lift .99 to 1.01, Strouhal's number .295 to .305. shedding.sh GEOMINT ROOMS [KEY=VALUE ...]
set -u
room=$2/shedding.room
. "$(dirname "$0")/answers.sh"
shift 2

status 0 run "$room" scheme=crank-nicolson tracers=0 "$@" --measure cylinder_drag,cylinder_lift --csv history.csv
# parabolas through the highest three of each peak of the last second; drag and lift times 2 / (U^2 D)
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    { t[++n] = $at["t"]; drag[n] = 20 * $at["cylinder_drag"]; lift[n] = 20 * $at["cylinder_lift"] }
    function top(x, i, where,    slope, bend) {
        slope = (x[i + 1] - x[i - 1]) / 2; bend = x[i - 1] - 2 * x[i] + x[i + 1]
        return where ? t[i] - slope / bend * (t[i + 1] - t[i]) : x[i] - slope * slope / (2 * bend)
    }
    function peak(x, i) { return x[i] > x[i - 1] && x[i] >= x[i + 1] && t[i] > t[n] - 1 }
    END {
        for (i = 2; i < n; i++) {
            if (peak(drag, i) && top(drag, i) > most_drag) most_drag = top(drag, i)
            if (peak(lift, i)) { if (top(lift, i) > most_lift) most_lift = top(lift, i)
                                 if (!peaks++) first = top(lift, i, 1); last = top(lift, i, 1) }
        }
        strouhal = 0.1 * (peaks - 1) / (last - first)
        printf "drag %.4f lift %.4f Strouhal %.5f of %d peaks\n", most_drag, most_lift, strouhal, peaks
        exit !(peaks >= 3 && most_drag > 3.23 * 0.98 && most_drag < 3.23 * 1.02 && most_lift > 0.97 &&
               most_lift < 1.03 && strouhal > 0.295 && strouhal < 0.305)
    }' history.csv || fail "not the benchmark's vortices"

[ "$failures" = 0 ]
