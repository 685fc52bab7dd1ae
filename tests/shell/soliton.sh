#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The soliton scene from the command line: soliton.sh PROGRAM all|third
set -u
which=$2
. "$(dirname "$0")/answers.sh"

# ends STATUS-WORD EXIT WORDS...: how a run ends; its numbers are printed all the same
ends()
{
    word=$1
    exit=$2
    shift 2
    "$geomint" run soliton "$@" --json >"$folder/out" 2>"$folder/err"
    [ $? -eq "$exit" ] || fail "$* does not exit with $exit"
    grep -q "\"status\":\"$word\"" "$folder/out" || fail "$*: $(cat "$folder/out")"
    grep -q '"energy":[0-9]' "$folder/out" || fail "$* prints no numbers"
}

refused 1 "0.01 and 0.999999" run soliton velocity=1
refused 1 "between 1 and 100000" run soliton points=0
refused 1 "for the density exp(3.u_x^2) with alpha = 2.5, where the slope of u is up to 4.588" run soliton "density=exp(3*u_x^2)" points=7
refused 1 "length 1 cuts the start off, where u is 1.23 at x = 0 and the end holds 0" run soliton length=1
refused 1 "only scheme, points and dt" work-precision soliton velocity=.5,.6
refused 1 "stability varies dt and velocity" stability soliton velocity=.5,.6

ends ok 0 scheme=multiplier-lobatto4 alpha=100 until=1
ends ok 0 scheme=control-gauss4 alpha=0 until=1
ends ok 0 scheme=multiplier-lobatto4 points=1 until=1
ends ok 0 scheme=multiplier-trapezoidal points=100000 dt=1e-5 steps=1
ends ok 0 scheme=multiplier-lobatto4 velocity=.999999 alpha=100 dt=1e-3 steps=20
ends mesh-crossing 2 scheme=multiplier-lobatto4 dt=1
ends mesh-crossing 2 scheme=control-gauss4 points=15 dt=.05 until=40

# without a density every strategy is the uniform mesh, to round-off
for pair in control-gauss4,uniform-gauss4 multiplier-lobatto4,uniform-lobatto4; do
    "$geomint" run soliton scheme=$pair alpha=0 until=2 | awk '
        /solution_error/ { error[++count] = $2 }
        END { difference = error[1] - error[2]; exit !(count == 2 && difference < 1e-9 && difference > -1e-9) }' ||
        fail "$pair differ with alpha = 0"
done

# the best pairs of points and step: files, columns, both sentences
"$geomint" work-precision soliton scheme=multiplier-trapezoidal,uniform-gauss4 points=15,31 dt=.2,.1,.05 until=2 \
    --size 320x180 --out "$folder" >"$folder/out" 2>"$folder/err" || fail "work-precision: $(cat "$folder/err")"
[ -s "$folder/soliton-work-precision.png" ] || fail "no PNG of work-precision"
head -1 "$folder/soliton-work-precision.csv" | grep -q '^scene,scheme,order,points,dt,' || fail "no column of points"
grep -q 'points for an error of' "$folder/out" || fail "points are not priced"
grep -q 'Cheapest by run time:.* Fewest points: multiplier' "$folder/out" || fail "no sentence: $(cat "$folder/out")"
# one number of points is no ladder
"$geomint" work-precision soliton scheme=uniform-gauss4 points=31 dt=.2,.1 until=2 --size 320x180 --out "$folder" \
    >"$folder/out" 2>&1 || fail "work-precision with one number of points"
head -1 "$folder/soliton-work-precision.csv" | grep -q '^scene,scheme,order,dt,' || fail "a column of one resolution"

"$geomint" stability soliton scheme=multiplier-lobatto4,uniform-gauss4 until=2 --size 320x180 --out "$folder" \
    >"$folder/out" 2>"$folder/err" || fail "stability: $(cat "$folder/err")"
[ -s "$folder/soliton-stability.png" ] || fail "no PNG of the map"
grep -q '^soliton,multiplier-lobatto4,0.9.*,1,1,mesh-crossing,' "$folder/soliton-stability.csv" ||
    fail "a step of 1 does not cross the mesh"
grep -q '^soliton,multiplier-lobatto4,0.2.*,bounded,ok,' "$folder/soliton-stability.csv" ||
    fail "a short step is not bounded"
grep -q 'M mesh-crossing' "$folder/out" || fail "the letters are not told"

# the figures of the document
for number in 2 3 4 5 6 7 8 9 10 11 12 13 14; do
    turn $number "$which" || continue
    "$geomint" figures tyranowski-$number --quick --out "$folder" >/dev/null 2>"$folder/err" ||
        fail "figure $number: $(cat "$folder/err")"
    [ -s "$folder/tyranowski-$number.png" ] || fail "no picture of figure $number"
done

[ $failures -eq 0 ] && echo "all well"
exit $((failures > 0))
