#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# All certificates, as text and as JSON. certificates.sh GEOMINT
set -u
. "$(dirname "$0")/answers.sh"

status 0 certify all
tail -n 1 out | grep -q ', 0 broken$' || fail "certify all: $(tail -n 1 out)"
# JSON has no infinity, and a row is known by its name and its family
status 0 certify all --json
python3 - out <<'END' || fail 'certify all --json'
import json, sys
rows = [json.loads(line, parse_constant=lambda word: sys.exit(word + " is no JSON")) for line in open(sys.argv[1])]
names = [(row["scheme"], row["family"]) for row in rows]
if len(rows) < 90 or len(set(names)) != len(names):
    sys.exit("rows that cannot be told apart")
END

# near a mass a step of any length stretches round-off; what the differences make of it is no defect of a scheme
for scheme in midpoint gauss4 gauss6 gauss8 midpoint-suzuki4 midpoint-kahan-li6; do
    status 0 certify $scheme --on restricted-three-body --json
    python3 -c '
import json, sys
verdict = json.load(open("out"))["properties"]["symplectic"]
sys.exit(not verdict["measured"] or verdict["defect"] > verdict["tolerance"] / 5)
' || fail "$scheme: its derivative is measured too coarsely: $(cat out)"
done

# what a gauge cannot see is no defect of a scheme: the time is the same for all states of an area, a reference of a stiff
# system has round-off of its own, and an angle that turns is rounded ever more
status 0 certify conformal-midpoint2 --on duffing
grep -q 'F conformal symplectic  *holds' out || fail "the time in areas: $(cat out)"
status 0 certify gsl-rk8pd --on stiff
grep -q 'order 8, measured 8' out || fail "an order at round-off: $(cat out)"
# its errors fall by powers from 7.3 to 7.7, more and more, down to round-off
status 0 certify gsl-rk8pd --on van-der-pol
! grep -q BROKEN out || fail "an order that is not yet reached: $(cat out)"
status 0 certify discrete-gradient2 --on kicked-rotor
grep -q 'H  *conserved ' out || fail "roundings of an angle: $(cat out)"
# away from its constraint a motion is not Hamiltonian, and the midpoint rule leaves it
status 0 certify midpoint --on cartesian-pendulum
grep -q 'S symplectic  *not claimed' out || fail "a scheme beside the constraint: $(cat out)"
status 0 certify rattle2 --on cartesian-pendulum
grep -q 'S symplectic  *holds' out || fail "a scheme on the constraint: $(cat out)"
# the reference meets the events, at their times
for scheme in dopri5 rk4; do
    printf 'coordinates: q\nmomenta: p\nH: p^2/2 - cos(q)\nevent: mod(t, 0.37) = 0.1; p = p - 0.3*sin(q)\nstart: q = 0.5, p = 0.2\ndt: 0.1\n' >kicks.system
    for system in clock ./kicks.system; do
        status 0 certify $scheme --on $system
        grep -q 'order [45], measured [3-6]' out || fail "$scheme on $system: $(cat out)"
    done
done

# the moments between levels are components, which a quadratic quantity need not hold
status 0 certify leapfrog --on klein-gordon
grep -q 'Q conserves quadratic invariants not claimed  defect' out || fail "a quadratic energy of levels: $(cat out)"
# the bounds of what is computed are narrow enough to tell every condition that fails
status 0 certify gauss8
grep -q 'of order 9, 286 of 286 fail' out || fail "conditions that fail: $(cat out)"
# the same motion in units of a millionth
printf 'coordinates: q\nmomenta: p\nH: p^2/2 - 1e-12*cos(1e6*q)\nstart: q = 1e-6, p = 0\ndt: 0.1\n' >small.system
status 0 certify gauss4 --on ./small.system
grep -q 'order 4, measured 4\.0' out || fail "an order in small units: $(cat out)"
grep -q 'S symplectic  *holds' out || fail "a derivative in small units: $(cat out)"

[ $failures = 0 ] && echo 'all as it should be'
exit $failures
