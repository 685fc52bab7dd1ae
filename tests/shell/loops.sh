#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The action of a ring of members, against sums over the states that the program prints: loops.sh PROGRAM
set -u
. "$(dirname "$0")/answers.sh"

keys=loop_action,loop_action_error,loop_resolution

# The same integral without a Fourier transform: the derivative of the trigonometric polynomial of N points, N odd, at
# one of them is sum_m (-1)^m / (2 sin(m pi / N)) times the point m before less the one m after. The shares of waves are
# plain sums.
cat >reference.py <<'END'
import cmath, json, math, re, sys
first, last = (json.load(open(name)) for name in ("start", "out"))
def ring(row):
    n, m = (int(word) for word in re.findall(r"= (\d+)", row["layout"]))
    return [row["state"][c * m:c * m + m - 1] for c in range(n)]
def action(rows):
    half, points = len(rows) // 2, len(rows[0])
    weights = [(-1) ** m / (2 * math.sin(m * math.pi / points)) for m in range(1, points // 2 + 1)]
    slope = lambda x, j: sum(weight * (x[j - m] - x[(j + m) % points]) for m, weight in enumerate(weights, 1))
    whole = [sum((p[j] - p[0]) * slope(q, j) for j in range(points)) for q, p in zip(rows, rows[half:])]
    return sum(whole) * 2 * math.pi / points
def share(rows):
    half, points = len(rows) // 2, len(rows[0])
    wave = lambda x, w: sum(value * cmath.exp(-2j * math.pi * w * j / points) for j, value in enumerate(x))
    size = [sum(w * abs(wave(q, w)) * abs(wave(p, w)) for q, p in zip(rows, rows[half:])) for w in range((points + 1) // 2)]
    return sum(size[-(-points // 4):]) / sum(size)
error, most = float(sys.argv[1]), float(sys.argv[2])
numbers, before, now = last["observables"], action(ring(first)), action(ring(last))
if math.isnan(error):
    assert share(ring(last)) > 1e-3 and numbers["loop_action"] is numbers["loop_action_error"] is None, numbers
    assert last["reasons"]["loop_action_error"] == "the loop is not resolved with %d points" % len(ring(last)[0]), last["reasons"]
    assert abs(numbers["loop_resolution"] / share(ring(last)) - 1) < 1e-9, (numbers, share(ring(last)))
else:
    assert abs(numbers["loop_action"] / now - 1) < 1e-12, (numbers, now)
    assert abs(numbers["loop_action_error"] - (now / before - 1)) < 1e-13 + 1e-9 * abs(error), (numbers, now / before - 1)
    assert abs(numbers["loop_action_error"] - error) <= most and numbers["loop_resolution"] < 1e-15, numbers
assert not last["warning"], last["warning"]
END

# looped ERROR TOLERANCE STEPS WORDS...
looped() {
    error=$1
    most=$2
    steps=$3
    shift 3
    status 0 run "$@" steps=0 --state --json
    cp out start
    status 0 run "$@" steps="$steps" --state --json --strict --measure "$keys"
    python3 reference.py "$error" "$most" || fail "$*: $(head -c 600 out)"
}

printf 'coordinates: a b\nH: (p_a^2 + p_b^2)/2 + b^2 + 0.15*(a - b)^2 - cos(a)\n' >two.system
printf 'start: a = 1.1, b = -0.4, p_a = 0.2, p_b = 0.5\ndt: 0.1\n' >>two.system
for row in verlet:0:2e-15 midpoint:0:2e-15 rk4:-1.104107e-6:1e-12 explicit-euler:0.683487:1e-6; do
    rest=${row#*:}
    looped "${rest%:*}" "${rest#*:}" 50 ./two.system members=64 spread=.3 scheme="${row%%:*}"
done
status 0 run ./two.system members=64 spread=.3 scheme=verlet steps=0 --measure loop_action --json
python3 -c 'import json, math; print(json.load(open("out"))["observables"]["loop_action"] / (-.09 * math.pi) - 1)' >off
python3 -c 'assert abs(float(open("off").read())) < 1e-14' || fail "a ring of radius .3 at the start: $(cat off)"

# both angles, also torn by chaos: then there is no number, and nothing is lost
looped 0 2e-13 200 double-pendulum members=64 spread=.05 scheme=gauss4
looped -5.8714e-6 1e-9 200 double-pendulum members=64 spread=.05 scheme=rk4
looped nan 0 500 double-pendulum members=64 spread=.05 scheme=gauss4

# a ring of places alone has the action 0, and the error is then a share of both loops
printf 'view: a, b\n' >>two.system
for row in verlet:5e-14 rk4:5e-5 explicit-euler:1; do
    status 0 run ./two.system members=64 spread=.3 scheme="${row%:*}" steps=50 --measure "$keys" --json
    python3 - "${row#*:}" <<'END' || fail "a ring of places: $(cat out)"
import json, sys
seen, most = json.load(open("out"))["observables"], float(sys.argv[1])
assert (most > 1e-9) * most / 10 <= abs(seen["loop_action_error"]) <= most, seen
END
done

# one friction of both momenta shrinks it by exp(-c t), by another force it changes; a Lagrangian; constraints
printf 'coordinates: q r\nL: (v_q^2 + v_r^2)/2 + cos(q) - 0.2*q*r - r^2\nstart: q = 1, v_q = 0, r = 0.3, v_r = 0.2\n' >slow.system
printf 'force: q = -0.1*v_q, r = -c*v_r\nparameter: c = 0.1; 0 .. 1\nview: q, v_q\ndt: 0.1\n' >>slow.system
for row in '.1:2e-15:slow.system scheme=conformal-midpoint2' '.1:1e-6:slow.system scheme=rk4' '.2:none:slow.system c=.2'; do
    rest=${row#*:}
    status 0 run ./${rest#*:} members=64 spread=.3 steps=30 --measure "$keys" --json
    python3 - "${rest%%:*}" <<'END' || fail "$row: $(cat out)"
import json, sys
row = json.load(open("out"))
seen = row["observables"]["loop_action_error"]
assert row["reasons"]["loop_action_error"].startswith("forces change") if sys.argv[1] == "none" else abs(seen) < float(sys.argv[1]), row
END
done
status 0 run spherical-pendulum members=20 spread=.1 steps=10 --measure "$keys" --json
python3 -c 'import json; assert abs(json.load(open("out"))["observables"]["loop_action_error"]) < 1e-13' || fail "constraints: $(cat out)"

# what has no ring has a reason, what has no momenta no such observable
status 0 run kepler until=1 --measure loop_action
grep -q 'loop_action *none: it needs a disc of at least 5 members' out || fail "one member: $(cat out)"
status 0 run ./two.system members=9 shape=line steps=1 --measure loop_action
grep -q 'needs a disc' out || fail "a line: $(cat out)"
refused 1 'no observable loop_action' run lorenz steps=1 --measure loop_action
[ "$failures" = 0 ]
