#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Systems on the command line: those that the program brings are listed; what is wrong is said with its place.
# systems.sh GEOMINT SYSTEMS
set -u
geomint=$1
GEOMINT_SYSTEMS=$2
export GEOMINT_SYSTEMS
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

fail() {
    printf 'FAILED: %s\n' "$1"
    failures=$((failures + 1))
}

# refused STATUS PATTERN WORDS...: the first line on standard error holds the pattern
refused() {
    wanted=$1
    pattern=$2
    shift 2
    timeout 60 "$geomint" "$@" >out 2>err </dev/null
    got=$?
    [ "$got" = "$wanted" ] || fail "geomint $*: exit $got, not $wanted: $(head -c 200 err)"
    head -n 1 err | grep -q -- "$pattern" || fail "geomint $*: says \"$(cat err)\", not \"$pattern\""
    [ -s out ] && fail "geomint $*: printed something"
}

for file in "$GEOMINT_SYSTEMS"/*.system; do
    name=$(basename "$file" .system)
    for form in --long --latex; do
        "$geomint" list "$name" $form >out 2>err || fail "list $name $form: $(cat err)"
        [ -s out ] && [ ! -s err ] || fail "list $name $form: $(cat err)"
    done
    "$geomint" list "$file" --json | python3 -c '
import json, sys
about = json.load(sys.stdin)
assert about["title"] and about["equations"] and about["structure"] and "rk4" in about["schemes"]
assert set(about["invariants"].values()) <= {"proved"}, about["invariants"]
' || fail "list $name --json"
    for word in title reference watch; do
        grep -q "^$word: " "$file" || fail "$name has no $word"
    done
done
for n in 3 4 6 11; do
    "$geomint" list toda N=$n --json | python3 -c '
import json, sys
about = json.load(sys.stdin)
assert len(about["equations"]) == 2 * int(sys.argv[1]) and set(about["invariants"].values()) == {"proved"}
' $n || fail "list toda N=$n"
done

printf 'coordinates: q\nH: p_q^2/2 + 2q\nstart: q = 1, p_q = 0\n' >wrong.system
refused 1 'wrong.system:2:15: there is no operator' list wrong.system
[ "$(sed -n 2p err)" = '    H: p_q^2/2 + 2q' ] && [ "$(sed -n 3p err)" = '                  ^' ] || fail "no caret: $(cat err)"
printf 'coordinates: q\nH: p_q^2 + \033[31mq\n' >wild.system
refused 1 '0x1b' list wild.system
grep -q "$(printf '\033')" err && fail 'an escape reached the terminal'
printf 'H: ' >zero.system
head -c 3 /dev/zero >>zero.system
refused 1 'zero.system:1:4: a byte is 0' list zero.system
awk 'BEGIN { printf "coordinates: q\nH: "; for (i = 0; i < 1000000; i++) printf "(" }' >deep.system
refused 1 'nested more than' list deep.system
truncate -s 100000001 large.system
refused 1 'at most 100 MB' list large.system
refused 3 'No such file' list none.system
mkdir folder.system
refused 3 'Is a directory' list folder.system
mkfifo pipe.system
refused 3 'it is a pipe' list pipe.system # which nobody waits for
refused 1 'no parameter "M"' list toda M=3
refused 1 'takes parameters with numbers' list toda N
refused 1 'outside of its range' list toda N=2
refused 1 'of a system' list kepler --latex
refused 1 'names of scenes' list nothing
[ $failures = 0 ] && echo 'all as it should be'
exit $failures
