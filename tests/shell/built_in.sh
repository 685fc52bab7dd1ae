#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Files that are part of the program: lists and runs without a folder of data, the text of each, copies of them, names in
# folders of one's own, and loops that belong to formulas. built_in.sh GEOMINT SHARE
set -u
share=$2
. "$(dirname "$0")/answers.sh"

# numbers FILE: what a run printed, but for the engine, the time, the names of scene and scheme, and a file's text
numbers() { sed -E 's/"(engine|scene|scheme)":"[^"]*",//g; s/"(system|room)":"(#|geomint)([^"\\]|\\.)*",//; s/"seconds":[^,]*,//' "$1"; }

# same NAME COPY WORDS...: both words lead to the same line
same() {
    first=$(printf '%s' "$1" | sed 's/.*=//')
    status 0 list "$first" --source
    cp out "$2"
    cmp -s "$2" "$share"/*/"$2" || fail "list $first --source is not the file"
    original=$1
    copy=$3
    shift 3
    # shellcheck disable=SC2086 # lists of words
    status 0 run $original "$@" --json --state
    cp out original
    # shellcheck disable=SC2086
    status 0 run $copy "$@" --json --state
    numbers original >wanted
    [ -s wanted ] && numbers out | cmp -s wanted - || fail "a copy of $first has other numbers"
}

# every file is listed, by a program that is not installed, from any folder, with an empty environment
for kind in systems rooms tours; do
    (cd / && env -i "$geomint" list "$kind" --json) >listed 2>err || fail "list $kind: $(cat err)"
    ls "$share/$kind" | sed -n 's/\.\(system\|room\|tour\)$//p' | sort >wanted
    sed -E 's/^\{"[a-z]*":"([^"]*)".*/\1/' listed | sort | cmp -s - wanted || fail "list $kind is not what share/$kind has"
    "$geomint" list "$kind" --json | cmp -s listed - || fail "list $kind depends on the environment"
done
(cd / && env -i "$geomint" run figure-eight until=1) >out 2>err || fail "figure-eight from /: $(cat err)"
grep -q 'energy_error' out || fail "figure-eight from /: $(cat out)"

# copies, those of rooms without their meshes
for file in "$share"/systems/*.system; do
    name=$(basename "$file" .system)
    same "$name" "$name.system" "./$name.system" steps=10
done
for file in "$share"/rooms/*.room; do
    name=$(basename "$file" .room)
    same "$name" "$name.room" "./$name.room" steps=1
done
for file in "$share"/schemes/*.scheme; do
    name=$(basename "$file" .scheme)
    same "kepler scheme=$name" "$name.scheme" "kepler scheme=./$name.scheme" steps=10
done
status 0 list area --source
cmp -s out "$share/tours/area.tour" || fail 'the text of a tour'
# a mesh beside the file counts first, and a path is a path
echo nothing >office.msh
refused 3 'office.msh' list ./office.room
status 0 list office
rm office.msh
refused 3 'could not be read' run cavity mesh=office.msh steps=1

# JSON has the file and its text
for word in toda ./toda.system office kepler disc vortices; do
    status 0 list "$word" --json
    python3 -c '
import json, sys
about, word, share = json.load(open("out")), sys.argv[1], sys.argv[2]
path = {"toda": "systems/toda.system", "office": "rooms/office.room", "kepler": "systems/kepler.system", "disc": "systems/disc.system", "vortices": None}.get(word, word)
assert about["file"] == path, about["file"]
text = open(word if path == word else share + "/" + path).read() if path else None
assert about["source"] == text' "$word" "$share" || fail "list $word --json"
done

# what has no file, and what there is not
refused 1 '^geomint: vortices has no file, .*geomint list vortices describes it$' list vortices --source
refused 1 '^geomint: rk4 has no file, ' list rk4 --source
refused 1 '^geomint: systems has no file, ' list systems --source

# a word is its own source, and an alias has the file of what it means
status 0 list 'composition( verlet;1/2,  1/2)' --source
grep -qx 'composition(verlet; 1/2, 1/2)' out || fail "the source of a word: $(cat out)"
status 0 list kick-drift-kick --source
grep -q '^kicks: 1/2, 1/2' out || fail "the source of an alias: $(cat out)"
refused 1 'did you mean toda' list tota --source
refused 3 'could not be read' list ./none.system --source
refused 1 'takes one name' list toda office --source
# the equations of a system of the program with other values
status 0 list oscillator system=pendulum
grep -q 'H = p^2/2 - cos(q)' out || fail 'list oscillator system=pendulum'
status 0 list kepler eccentricity=.3
grep -q 'q1  *0.7' out || fail 'list kepler eccentricity=.3'
refused 1 'values only after the name of a system' list vortices count=3

# names of folders: the program's come first, then those of the variable, then the user's own, each once
mkdir -p mine config/geomint
sed 's/^title:.*/title: Mine/' toda.system | tee mine/toda.system >mine/ring.system
sed 's/^title:.*/title: Another/' toda.system | tee config/geomint/ring.system >config/geomint/last.system
cp kutta38.scheme mine/third.scheme
list_mine() { env XDG_CONFIG_HOME="$folder/config" GEOMINT_SYSTEMS=mine "$geomint" list systems; }
list_mine >out || fail 'list systems with folders'
[ "$(grep -cE '^(toda +A ring of Toda|ring +Mine|last +Another)$' out)" = 3 ] || fail "names of folders: $(grep -E '^(toda|ring|last) ' out)"
[ "$(grep -cE '^(toda|ring|last) ' out)" = 3 ] || fail 'a name is listed twice'
GEOMINT_SCHEMES=mine status 0 run kepler scheme=third steps=1
refused 1 'there is no scheme "third"' run kepler scheme=third steps=1

# a folder that cannot be opened is reported once, where it is looked into
GEOMINT_SYSTEMS=none refused 3 'the folder none of GEOMINT_SYSTEMS could not be opened' list systems
[ "$(grep -c 'could not be opened' err)" = 1 ] || fail "said more than once: $(cat err)"
grep -q '^toda ' out || fail 'the names of the program are missing beside a folder that is'
GEOMINT_ROOMS=none refused 3 'of GEOMINT_ROOMS could not be opened' list rooms
GEOMINT_ROOMS=none refused 3 'of GEOMINT_ROOMS could not be opened' run nothing
GEOMINT_SCHEMES=none refused 3 'of GEOMINT_SCHEMES could not be opened' run kepler scheme=nothing
GEOMINT_SYSTEMS=none status 0 run toda steps=1

# loops of the program: of its formulas, whatever the file is called; the interpreter makes the same numbers
engine() { # WANTED WORDS...
    wanted_engine=$1
    shift
    status 0 run "$@" steps=50 --json --state
    grep -q "\"engine\":\"$wanted_engine\"" out || fail "run $*: not $wanted_engine"
    numbers out >taken
    status 0 run "$@" steps=50 --json --state --engine interpreted
    grep -q '"engine":"interpreted"' out || fail "run $*: --engine interpreted is not"
    numbers out | cmp -s taken - || fail "run $*: the engines differ"
}
sed '/^title\|^symmetry\|^compile/d; s/0.97000435669734/0.97/' figure-eight.system >three.system
sed 's/- sum(i/- 0.9*sum(i/' figure-eight.system >lighter.system
for scheme in verlet rk4 gauss4 midpoint; do
    engine native figure-eight "scheme=$scheme"
    engine native ./three.system "scheme=$scheme"
    engine interpreted ./lighter.system "scheme=$scheme"
done
for scheme in rk4 gauss4; do
    engine native toda N=4 "scheme=$scheme"
    engine interpreted toda N=6 "scheme=$scheme"
    engine native duffing "scheme=$scheme"
    engine native duffing delta=0 "scheme=$scheme"
done
engine interpreted lorenz
engine native figure-eight members=2
engine interpreted figure-eight members=17
# without the friction a file that never had one has the same numbers
sed '/^parameter: delta/d; /^force/d; /^compile/d' duffing.system >free.system
status 0 run duffing delta=0 scheme=rk4 steps=50 --json --state --engine interpreted
sed 's/.*"state"://' out >wanted
status 0 run ./free.system scheme=rk4 steps=50 --json --state
sed 's/.*"state"://' out | cmp -s wanted - || fail 'delta = 0 is not in the place of the parameter'

# wrong lines
for line in no 'M = 3' 'N = q' 'N = 5 .. 4.5'; do
    sed "s/^compile:.*/compile: $line/" toda.system >wrong.system
    refused 1 'wrong.system:30:' list ./wrong.system
done

[ $failures = 0 ] && echo "all as it should be"
exit $failures
