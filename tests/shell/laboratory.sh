#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# work-precision and stability from the command line: laboratory.sh PROGRAM
set -u
. "$(dirname "$0")/answers.sh"

refused 1 "which scene" work-precision
refused 1 "no scene" work-precision keplar
refused 1 "only scheme and dt" work-precision kepler eccentricity=.1,.2
refused 1 "no observable" work-precision kepler --measure energy-error
refused 1 "is undefined" work-precision kepler perturbation=.01 --measure position_error
refused 1 "nothing to measure" work-precision kepler until=0
refused 1 "until= ends them together" work-precision kepler steps=10 dt=.1,.05
refused 1 "which scene" stability
# a scene without a map says why, and what helps
for scene in disc abc; do
    refused 1 "scene $scene has no stability map: .*stability --region SCHEME" stability $scene
done
for scene in channel couette poiseuille taylor-green; do
    refused 1 "scene $scene has no stability map: .*stability cavity" stability $scene
done
refused 1 "none of: bounded, accurate" stability kepler --judge stable
refused 1 "needs an error above 0" stability kepler --judge accurate=0
refused 1 "has no error to be accurate by" stability sine-gordon --judge accurate
refused 1 "contradict each other" stability --region rk4 --judge bounded
refused 1 "did you mean" stability --region rk44
refused 1 "no linear stability region" stability --region logh2
refused 1 "no scene" stability kepler --region rk4

# steps= is another way to say where a run ends
"$geomint" work-precision kepler scheme=rk4 steps=5 --size 160x90 --out "$folder" >"$folder/out" 2>"$folder/err" &&
    grep -q 'at t = 0.314159$' "$folder/out" || fail "work-precision with steps=: $(cat "$folder/out" "$folder/err")"
"$geomint" stability stiff scheme=verlet steps=10 --size 160x90 --out "$folder" >"$folder/out" 2>"$folder/err" &&
    grep -q '^stiff, .*, after t = 0.3:' "$folder/out" || fail "stability with steps=: $(cat "$folder/out" "$folder/err")"

# a small ladder: files, table, sentence
"$geomint" work-precision kepler scheme=rk4,verlet dt=2*pi/50,2*pi/100,2*pi/200 until=2*pi --size 320x180 \
    --out "$folder" >"$folder/out" 2>"$folder/err" || fail "work-precision: $(cat "$folder/err")"
[ -s "$folder/kepler-work-precision.png" ] || fail "no PNG"
[ "$(wc -l <"$folder/kepler-work-precision.csv")" -eq 7 ] || fail "the CSV has other than 6 rows"
grep -q '^Cheapest by run time: ' "$folder/out" || fail "no sentence"
grep -q '^kepler,rk4,4,.*,ok,' "$folder/kepler-work-precision.csv" || fail "no row of rk4"

# a scheme with a tolerance has it as a column, which is empty for the others
"$geomint" work-precision kepler scheme=rk4,dopri5 tolerance=1e-4,1e-6 dt=.1,.05 until=1 --size 320x180 -o "$folder/by.png" \
    >"$folder/out" 2>"$folder/err" || fail "work-precision by tolerance: $(cat "$folder/err")"
[ "$(cut -d, -f2,8 "$folder/by.csv" | tr '\n' ' ')" = \
    'scheme,tolerance rk4, rk4, dopri5,0.0001 dopri5,9.9999999999999995e-07 ' ] ||
    fail "tolerances in the table: $(cat "$folder/by.csv")"

# a scheme that chooses its steps is measured where it ends, against a reference that is taken on to there
"$geomint" work-precision system H='p^2/2 + q^4/4' q=1 p=0.3 scheme=error-controlled-verlet,gauss8 dt=.02,.01,.005,.0025 \
    until=3 --size 320x180 --out "$folder" >"$folder/out" 2>"$folder/err" || fail "steps of its own: $(cat "$folder/err")"
awk -F, '$2 == "error-controlled-verlet" { if (before && (before / $8 < 2.5 || before / $8 > 6)) exit 1; before = $8; n++ }
    END { exit n != 4 }' "$folder/system-work-precision.csv" ||
    fail "error control is not of order 2: $(cat "$folder/system-work-precision.csv")"

# the error falls by 2^4 with half the step
awk -F, '$2 == "rk4" { if (before && (before / $8 < 10 || before / $8 > 40)) exit 1; before = $8 }' \
    "$folder/kepler-work-precision.csv" || fail "rk4 is not of order 4 in the CSV"

# no exact solution: a reference run; any scene has it
"$geomint" work-precision disc scheme=verlet,rk4 dt=.1,.05 until=1 points=8 --size 320x180 --out "$folder" \
    >"$folder/out" 2>&1 || fail "work-precision disc"
grep -q 'against a run of' "$folder/out" || fail "no reference run is named"

# an observable that is the distance from an exact solution serves where the problem brings none
"$geomint" work-precision channel dt=0.02,0.01 until=0.1 --size 320x180 --out "$folder" >"$folder/out" 2>&1 ||
    fail "work-precision channel: $(cat "$folder/out")"
grep -q '^channel, solution_error' "$folder/out" || fail 'a channel is not measured by its solution'

# another measure
"$geomint" work-precision vortices scheme=rk4,gauss4 dt=.1,.05 until=1 strength=1 --measure angular_impulse_error \
    --size 320x180 --out "$folder" >"$folder/out" 2>&1 || fail "work-precision --measure"
grep -q ',angular_impulse_error,' "$folder/vortices-work-precision.csv" || fail "the measure is not named in the CSV"

# interrupted, it keeps what it has, which is something as soon as it was given time enough
for seconds in 1 3 9 27 81; do
    timeout --preserve-status -s INT $seconds "$geomint" work-precision kepler until=4000*pi --size 320x180 \
        --out "$folder/half" >"$folder/out" 2>&1
    [ $? -eq 130 ] || fail "interrupted work-precision does not exit with 130"
    [ -s "$folder/half/kepler-work-precision.csv" ] && break
done
[ -s "$folder/half/kepler-work-precision.csv" ] || fail "interrupted work-precision keeps nothing"

"$geomint" stability stiff scheme=verlet until=10 --size 320x180 --out "$folder" >"$folder/out" 2>"$folder/err" ||
    fail "stability: $(cat "$folder/err")"
[ -s "$folder/stiff-stability.png" ] || fail "no PNG of the map"
grep -q '^stiff,verlet,50,2.0499.*,blow-up,blow-up,' "$folder/stiff-stability.csv" || fail "Verlet is not lost at 2.05"
grep -q '^stiff,verlet,50,1.95.*,bounded,ok,' "$folder/stiff-stability.csv" || fail "Verlet is not bounded at 1.95"
grep -q 'bounded for all values up to 1.95' "$folder/out" || fail "no limit in the table"

# a map does not depend on how many runs are made at once
for jobs in 1 2; do
    "$geomint" stability stiff scheme=verlet,rk4 until=2 --jobs $jobs --size 320x180 --out "$folder/jobs$jobs" \
        >"$folder/out" 2>"$folder/err" || fail "stability --jobs $jobs: $(cat "$folder/err")"
done
cmp -s "$folder/jobs1/stiff-stability.csv" "$folder/jobs2/stiff-stability.csv" || fail 'another number of jobs makes another map'

# where the system allows a low order alone the reference of order 8 is no better: x = 2/3 t^1.5, and its error is told
status 0 work-precision system 'rate=x = sqrt(t)' x=0 scheme=gauss6 until=1 --out "$folder/root"
grep -q 'the reference has an error of about 2.8e-07 itself' out || fail "the error of the reference: $(cat out)"
# bounded and accurate are two questions: RK4 with 40 steps a period and e = 0.5 is the one, not the other
for judge in bounded accurate=1e-2; do
    "$geomint" stability kepler scheme=rk4 until=8*pi --judge $judge --size 320x180 --out "$folder" >"$folder/out" \
        2>"$folder/err" || fail "stability --judge $judge: $(cat "$folder/err")"
    verdict=$(awk -F, '$3 == 0.5 && $4 == 0.025 { print $6 "," $11 }' "$folder/kepler-stability.csv")
    case $judge in
    bounded)
        [ "$verdict" = bounded,bounded ] || fail "bounded is $verdict"
        grep -q '^kepler, which step is bounded, after' "$folder/out" || fail "the question: $(head -n 1 "$folder/out")"
        grep -q 'W' "$folder/out" && fail 'a step that is bounded and wrong is marked though only bounded was asked'
        ;;
    *)
        [ "$verdict" = wrong,accurate=0.01 ] || fail "accurate is $verdict"
        grep -q '^kepler, which step is accurate to 0.01 (position_error), after .*: . accurate, .*W wrong' "$folder/out" ||
            fail "the question: $(head -n 1 "$folder/out")"
        awk -F, 'NR > 1 && $6 == "accurate" && $10 > 1e-2 || $6 == "wrong" && $10 <= 1e-2 { exit 1 }' \
            "$folder/kepler-stability.csv" || fail 'accurate is not the error asked for'
        "$geomint" again "$folder/kepler-stability.png" --out "$folder/judged" >"$folder/out" 2>&1 &&
            cmp -s "$folder/kepler-stability.csv" "$folder/judged/kepler-stability-again.csv" || fail 'again asks something else'
        ;;
    esac
done

# JSON says what the CSV says
for words in 'kepler scheme=rk4,verlet dt=2*pi/50,2*pi/100,2*pi/200 until=2*pi' \
    'kepler scheme=explicit-euler,gauss4 dt=1,4 until=8' 'wave scheme=leapfrog dt=.01,.005 until=1'; do
    # shellcheck disable=SC2086
    "$geomint" work-precision $words --size 320x180 --out "$folder" --json >"$folder/out" 2>"$folder/err" ||
        fail "work-precision $words --json: $(cat "$folder/err")"
    [ "$(cat "$folder/err")" = "geomint: wrote $folder/${words%% *}-work-precision.png and $folder/${words%% *}-work-precision.csv" ] ||
        fail "work-precision does not say what it wrote: $(cat "$folder/err")"
    python3 - "$folder/out" "$folder/${words%% *}-work-precision.csv" <<'END' || fail "work-precision $words --json"
import csv, json, sys

def no_constant(word):
    raise ValueError(word)

lines = [json.loads(line, parse_constant=no_constant) for line in open(sys.argv[1])]
rows = list(csv.DictReader(open(sys.argv[2])))
points = [(line, point) for line in lines for point in line["points"]]
assert len(points) == len(rows) > 0
for (line, point), row in zip(points, rows):
    assert (line["scene"], line["scheme"], str(line["order"])) == (row["scene"], row["scheme"], row["order"])
    assert point["status"] == row["status"] and float(row["dt"]) == point["dt"]
    assert row[line["measure"]] == "" and point["error"] is None or float(row[line["measure"]]) == point["error"]
for line in lines:
    assert len(line["prices"]) == 3
    for price in line["prices"]:
        reached = any(p["error"] is not None and p["error"] <= price["error"] for p in line["points"])
        assert (price["seconds"] is not None) == reached, price
END
done
"$geomint" stability stiff scheme=verlet,midpoint until=10 --size 320x180 --out "$folder" --json >"$folder/out" 2>"$folder/err" ||
    fail "stability --json: $(cat "$folder/err")"
python3 - "$folder/out" "$folder/stiff-stability.csv" <<'END' || fail "stability --json: $(head -c 300 "$folder/out")"
import csv, json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
rows = list(csv.DictReader(open(sys.argv[2])))
assert [line["scheme"] for line in lines] == ["verlet", "midpoint"]
assert lines[0]["limit"] == 1.95
cells = [(line, cell) for line in lines for cell in line["cells"]]
assert len(cells) == len(rows)
for (line, cell), row in zip(cells, rows):
    assert float(row[line["parameter"]]) == cell[line["parameter"]] and float(row["step"]) == cell["step"]
    assert (row["scheme"], row["verdict"], row["status"]) == (line["scheme"], cell["verdict"], cell["status"])
    assert (row["error"] == "") == (cell["error"] is None)
END
"$geomint" stability --region rk4 --size 320x180 --out "$folder" --json 2>"$folder/err" | python3 -c '
import json, sys
told = json.load(sys.stdin)
assert told["scheme"] == "rk4" and abs(told["imaginary_limit"] - 8 ** .5) < .01 and abs(told["real_limit"] - 2.785) < .01
' || fail "stability --region --json"

# steady flows: the stream function's error falls with the square of the edge, whatever the step
"$geomint" work-precision couette scheme=steady rows=12,24,48 dt=.2,.1 --size 320x180 --out "$folder" >"$folder/out" \
    2>"$folder/err" || fail "work-precision couette: $(cat "$folder/err")"
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) { if ($i == "rows") r = i; if ($i == "psi_error") e = i } }
    NR > 1 { error[$r] = $e }
    END { if (!r || !e || NR < 4) exit 1; p = error[12] / error[24]; q = error[24] / error[48]
          exit p < 3.4 || p > 4.6 || q < 3.4 || q > 4.6 }' "$folder/couette-work-precision.csv" ||
    fail "couette is not of order 2 in the edge: $(cat "$folder/couette-work-precision.csv")"
grep -q 'Fewest rows: ' "$folder/out" || fail "couette: the edges are not compared"

# Taylor-Green vortices against their exact solution: orders 1 and 2 in the step
"$geomint" work-precision taylor-green columns=24 viscosity=.2 dt=.25,.125 until=1 --size 320x180 --out "$folder" \
    >"$folder/out" 2>"$folder/err" || fail "work-precision taylor-green: $(cat "$folder/err")"
awk -F, '$2 == "semi-implicit" || $2 == "crank-nicolson" { rows++ } END { exit rows != 4 || NR != 5 }' \
    "$folder/taylor-green-work-precision.csv" || fail "taylor-green: entrants"

# Courant numbers and Reynolds numbers: small steps are bounded, steps a hundred times the edge are not
for scene in cavity room; do
    small='columns=10 rows=0 until=2'
    [ $scene = room ] && small='rows=10 columns=0 until=1'
    # shellcheck disable=SC2086
    "$geomint" stability $scene $small --size 320x180 --out "$folder" >"$folder/out" 2>"$folder/err" ||
        fail "stability $scene: $(cat "$folder/err")"
    [ -s "$folder/$scene-stability.png" ] || fail "no PNG of the map of $scene"
    [ "$(wc -l <"$folder/$scene-stability.csv")" -eq 81 ] || fail "stability $scene: cells are missing"
    awk -F, -v s=$scene '$4 <= 1 && $3 <= 100 && $6 != "bounded" { exit 1 }
        $2 == "crank-nicolson" && $4 == 100 && $3 == 1000 && $6 == "bounded" { exit 1 }' "$folder/$scene-stability.csv" ||
        fail "stability $scene: $(cat "$folder/out")"
done

"$geomint" stability --region rk4 --size 320x180 --out "$folder" >"$folder/out" 2>&1 || fail "stability --region"
grep -q 'imaginary z up to 2.82' "$folder/out" || fail "the region of rk4: $(cat "$folder/out")"
[ -s "$folder/rk4-stability.png" ] || fail "no PNG of the region"
"$geomint" stability --region rk2 --size 320x180 --out "$folder" >"$folder/out" || fail "the region of rk2"
grep -q 'real z from -2, for imaginary z up to 0;' "$folder/out" || fail "the region of rk2: $(cat "$folder/out")"
"$geomint" stability --region verlet --size 320x180 --out "$folder" | grep -q 'up to h ω = 2$' || fail "Verlet's limit"

# fields on a line: every scene has both, and the limits are the known ones
for scene in sine-gordon kdv nls wave burgers; do
    "$geomint" stability $scene --size 320x180 --out "$folder" >"$folder/$scene.txt" 2>"$folder/err" ||
        fail "stability $scene: $(cat "$folder/err")"
    [ -s "$folder/$scene-stability.png" ] || fail "no PNG of the map of $scene"
done
# limit SCENE SCHEME: the largest step that is bounded throughout
limit()
{
    awk -v scheme="$2" '$1 == scheme { found = 1 } found && /bounded for all/ { print $NF; exit }' "$folder/$1.txt"
}
[ "$(limit sine-gordon leapfrog)" = 0.99 ] || fail "leapfrog is not lost at a Courant number of 1"
[ "$(limit sine-gordon energy-conserving)" = 1 ] || fail "energy-conserving is not lost above 1"
[ "$(limit sine-gordon box)" = 8 ] || fail "the box is lost"
[ "$(limit kdv zabusky-kruskal)" = 0.37 ] || fail "Zabusky-Kruskal is not lost above 0.385"
[ "$(limit wave leapfrog)" = 1 ] || fail "leapfrog for the wave equation is not lost above 1"
for words in 'sine-gordon scheme=leapfrog,box dt=.04,.02 until=1' 'kdv scheme=box dt=.1,.05 until=1' \
    'nls scheme=box,split-step2 dt=.04,.02 until=1' 'wave scheme=leapfrog dt=.01,.005 until=1' \
    'burgers scheme=ftcs,crank-nicolson dt=.004,.002 until=.2'; do
    # shellcheck disable=SC2086
    "$geomint" work-precision $words --size 320x180 --out "$folder" >"$folder/out" 2>"$folder/err" ||
        fail "work-precision $words: $(cat "$folder/err")"
    grep -q '^Cheapest by run time: ' "$folder/out" || fail "work-precision $words: no sentence"
done

# Burgers: the Courant numbers typed are those measured at every distance of the nodes; a shock begins at t = 1
"$geomint" work-precision burgers scheme=ftcs,crank-nicolson dx=.04,.02,.01 courant=.5,.25 --size 320x180 \
    --out "$folder" >"$folder/out" 2>"$folder/err" || fail "work-precision burgers courant: $(cat "$folder/err")"
awk -F, 'NR > 1 { ratio = $5 / $4; rows++; if (ratio != .5 && ratio != .25) wrong++
        if ($2 == "crank-nicolson" && ratio == .5) error[$4 + 0] = $9 }
    END { exit !(rows == 12 && !wrong && error[.02] / error[.01] > 3 && error[.02] / error[.01] < 5) }' \
    "$folder/burgers-work-precision.csv" || fail "Courant numbers: $(cat "$folder/burgers-work-precision.csv")"
"$geomint" work-precision burgers test=shock until=2 scheme=ftcs dx=.02 dt=.002 --size 320x180 --out "$folder" \
    >"$folder/out" 2>"$folder/err" || fail "work-precision of the shock: $(cat "$folder/err")"
grep -q ',500,2,ok,' "$folder/burgers-work-precision.csv" || fail "the shock's runs do not end at t = 2"

# charts tell how they were made, and are measured again
for chart in kepler-work-precision vortices-work-precision stiff-stability rk4-stability; do
    "$geomint" again "$folder/$chart.png" --out "$folder/again" >"$folder/out" 2>&1 || fail "again $chart"
    [ -s "$folder/again/$chart-again.png" ] || fail "again makes no PNG of $chart"
    [ "$(wc -l <"$folder/$chart.csv")" -eq "$(wc -l <"$folder/again/$chart-again.csv")" ] ||
        fail "again measures something else than $chart"
done
cmp -s "$folder/stiff-stability.csv" "$folder/again/stiff-stability-again.csv" || fail "again is another map"
cmp -s "$folder/stiff-stability.png" "$folder/again/stiff-stability-again.png" || fail "again paints another map"
head -1 "$folder/again/vortices-work-precision-again.csv" | grep -q angular_impulse_error ||
    fail "again forgets the measure"

# an adaptive scheme ends at until too
"$geomint" run kepler scheme=logh2 dt=2*pi/60 eccentricity=.9 until=10 --json >"$folder/out" || fail "logh2"
grep -q '"message":"","warning":"","t":10,' "$folder/out" || fail "logh2 does not end at until: $(cat "$folder/out")"

[ $failures -eq 0 ] && echo "all well"
exit $((failures > 0))
