#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Modified Hamiltonians from the command line: backward.sh PROGRAM
set -u
. "$(dirname "$0")/answers.sh"

refused 1 "which scene" backward
refused 1 "no scene" backward keplar
refused 1 "no modified energy" backward room
refused 1 "steps= ends the runs at t = 1 and t = 0.5; until= ends them together" backward kepler steps=10 dt=.1,.05
refused 1 "RK4 is not symplectic" backward kepler scheme=rk4
refused 1 "only scheme and dt" backward kepler eccentricity=.1,.2 dt=.1 scheme=verlet
refused 1 "not smooth" backward system "H=p^2/2 + abs(q)" q=1 p=0 dt=.1 until=1 scheme=midpoint
refused 1 "did you mean modified_energy4_error" run kepler until=1 --measure modified_energy_4_error

status 0 backward kepler steps=10 dt=.1 --size 160x90 -o steps.png
grep -q '^kepler, up to t = 1:' out || fail "backward with steps=: $(cat out)"

# null with the reason, and in the order that was asked for; what is not asked for is not told
modified=modified_energy2_error,modified_energy4_error,modified_energy6_error
status 0 run disc scheme=verlet,rk4 until=1 --json
grep -q modified out && fail "modified energies are told unasked"
status 0 run disc scheme=verlet,rk4 until=1 --measure "$modified,energy_error" --json --max --csv history.csv
python3 - out history.csv <<'END' || fail "run --measure: $(head -c 500 out)"
import csv, json, sys
verlet, rk4 = [json.loads(line) for line in open(sys.argv[1])]
keys = [f"modified_energy{k}_error" for k in (2, 4, 6)]
assert list(verlet["observables"])[:4] == keys + ["energy_error"], verlet
falling = [verlet["observables"][key + "_max"] for key in ["energy_error"] + keys]
assert all(b < a / 10 for a, b in zip(falling, falling[1:])), falling
assert all(rk4["observables"][key] is None for key in keys) and rk4["observables"]["energy_error"] > 0
assert all("not symplectic" in rk4["reasons"][key] for key in keys)
rows = list(csv.DictReader(open(sys.argv[2])))
assert float(rows[-1]["energy_error"]) > 0 and rows[0].keys() >= set(keys)
END

# a scheme of one's own, on a system of one's own: slopes 4, 6, 8 of H and what is cut off after dt^4, dt^6
step='composition(verlet; 1.35120719195966, -1.70241438391932, 1.35120719195966)'
status 0 backward system "H=p^2/2 - cos(q)" q=0 p=1.5 dt=.1,.05,.025 "scheme=$step,rk4" until=20 --size 320x180 \
    -o own.png --json
python3 - out own.csv <<'END' || fail "backward --json: $(head -c 500 out)"
import csv, json, sys
own, rk4 = [json.loads(line) for line in open(sys.argv[1])]
for power, slope in (0, 4), (4, 6), (6, 8):
    assert abs(own["slopes"][power] - slope) < 0.2, own["slopes"]
assert own["reason"] == "" and "not symplectic" in rk4["reason"] and rk4["points"] == []
assert [point["dt"] for point in own["points"]] == [.1, .05, .025]
assert all(point["best"] == 6 and 1 < point["gamma"] < 100 for point in own["points"])
rows = list(csv.DictReader(open(sys.argv[2])))
assert len(rows) == 21 and float(rows[6]["error"]) == float("%.9g" % own["points"][0]["errors"][6])
END
# stopped on the way, too: the shorter step that ends there, at q = 1, has another modified Hamiltonian
printf 'coordinates: q\nH: p_q^2/2 - cos(q)\nstart: q = -1, p_q = 2\nstop: q - 1\nobserve: place = q\n' >stops.system
status 0 backward ./stops.system dt=.1,.05,.025 scheme=verlet until=20 --size 320x180 -o stops.png --json
python3 - out <<'END' || fail "backward of what stops: $(head -c 500 out)"
import json, sys
slopes = json.loads(open(sys.argv[1]).readline())["slopes"]
assert all(abs(slopes[power] - power - 2) < 0.3 for power in (0, 2, 4)), slopes
END
status 0 run ./stops.system scheme=verlet dt=.1 until=20 --measure modified_energy4_error,place --json --max
python3 - out <<'END' || fail "a modified energy where a run stops: $(head -c 500 out)"
import json, sys
run = json.loads(open(sys.argv[1]).readline())
assert run["stopped"] and abs(run["observables"]["place"] - 1) < 1e-12, run
assert run["observables"]["modified_energy4_error"] is None and "stopped within a step" in run["reasons"]["modified_energy4_error"]
assert 0 < run["observables"]["modified_energy4_error_max"] < 1e-4, run
END
status 0 again own.png
[ -s own-again.png ] || fail "the diagram is not made again"

# the linear case: kept to round-off after the first term
status 0 backward disc scheme=symplectic-euler dt=.1,.2 until=10 --size 320x180 -o linear.svg --json
python3 -c 'import json; p = json.load(open("out"))["points"]; assert all(x["errors"][1] < 1e-14 < x["errors"][2] for x in p)' ||
    fail "symplectic Euler does not keep H - dt p q / 2"
status 0 backward disc dt=.1,.2 until=10 -o linear.pdf
grep -q '^ *slope .*1\.0.*3\.0.*5\.0' out || fail "no slopes: $(cat out)"

# as a measure, and drawn
status 0 work-precision kepler scheme=verlet dt=.02,.01 until=3 --measure modified_energy2_error --size 320x180
awk -F, 'NR > 1 { if (last && (last / $8 < 12 || last / $8 > 20)) exit 1; last = $8 }' kepler-work-precision.csv ||
    fail "the modified energy is not of order 4 in work-precision"
for words in disc kepler 'henon-heiles q2=.1 overlay=no' stiff vortices oscillator; do
    scene=${words%% *}
    # shellcheck disable=SC2086
    status 0 render $words scheme=midpoint,rk4 until=.5 show=modified --size 320x180 -o $scene.svg
    grep -q 'not symplectic' $scene.svg || fail "$scene: no reason in the picture"
done
[ "$failures" = 0 ] && echo "backward: all passed"
exit "$failures"
