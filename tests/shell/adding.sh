#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# docs/adding.md, followed literally on a copy of the sources. adding.sh SOURCE
set -eu
source=$1
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT
(cd "$source" && tar cf - README.md LICENSE meson.build meson_options.txt app core docs library loader python render scenes share tests) |
    tar xf - -C "$copy"
cd "$copy"

# what a block's first line says: new=FILE, append=FILE, or in=FILE after=WORD (behind the first line with that)
awk '
/^```/ && open { close_block(); open = 0; next }
/^```/ {
    open = 1; text = ""; file = ""; after = ""; mode = ""
    for (i = 2; i <= NF; i++) {
        key = substr($i, 1, index($i, "=") - 1); value = substr($i, index($i, "=") + 1)
        if (key == "new" || key == "append" || key == "in") { mode = key; file = value }
        if (key == "after") after = value
    }
    if ($1 == "```sh") mode = "sh"
    next
}
open { text = text $0 "\n" }
function close_block(   line, found, all) {
    if (mode == "sh") printf "%s", text > "commands"
    else if (mode == "new") { printf "%s", text > file; close(file) }
    else if (mode == "append") { printf "%s", text >> file; close(file) }
    else if (mode == "in") {
        all = ""; found = 0
        while ((getline line < file) > 0) {
            all = all line "\n"
            if (!found && index(line, after)) { all = all text; found = 1 }
        }
        close(file)
        if (!found) { print "docs/adding.md: " file " has no line with " after; exit 1 }
        printf "%s", all > file; close(file)
    }
}' docs/adding.md

# not optimised: what is built is used for a second
meson setup build -Dloops=baseline -Dbuildtype=plain -Dtests=disabled >log 2>&1 || { cat log; exit 1; }
ninja -C build app/geomint >log 2>&1 || { grep -E 'error|warning' log; exit 1; }
if grep warning log; then
    exit 1
fi
PATH=$copy/build/app:$PATH
export PATH
while read -r command; do
    echo "$command"
    sh -c "$command" >out 2>&1 || { cat out; exit 1; }
done <commands
[ -s pictures/well-render.png ] && [ -s diagrams/well-work-precision.png ]
