#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What a step of the room costs against the number of vertices: flow and scalar, Courant number about .8, and the
# memory at most. Usage: flows.sh PROGRAM. Milliseconds are the median of three runs.
program=${1:?usage: flows.sh PROGRAM}

# one ROWS COLUMNS DT STEPS: milliseconds a step
once() {
    "$program" run room rows="$1" columns="$2" dt="$3" steps="$4" tracers=0 --json |
        sed -n 's/.*"steps":\([0-9]*\),.*"seconds":\([0-9.e+-]*\),.*/\1 \2/p' |
        awk '{ printf "%.2f\n", 1000 * $2 / $1 }'
}

memory() {
    if command -v /usr/bin/time >/dev/null 2>&1; then
        /usr/bin/time -f %M "$program" run room rows="$1" columns="$2" dt="$3" steps=1 tracers=0 2>&1 >/dev/null | tail -1
    else
        echo 0
    fi
}

printf '%10s %12s %12s\n' vertices 'ms a step' 'MB'
while read -r rows columns steps; do
    dt=$(awk "BEGIN { print 0.1 / $rows }")
    median=$(for _ in 1 2 3; do once "$rows" "$columns" "$dt" "$steps"; done | sort -n | sed -n 2p)
    vertices=$(awk "BEGIN { print ($columns / 2 + 1) * ($rows + 1) + $columns / 2 * $rows }")
    kilobytes=$(memory "$rows" "$columns" "$dt")
    awk "BEGIN { printf \"%10d %12.2f %12.0f\n\", $vertices, $median, $kilobytes / 1024 }"
done <<END
25 34 400
35 46 200
50 66 200
85 112 60
120 158 30
190 250 10
270 356 5
END
