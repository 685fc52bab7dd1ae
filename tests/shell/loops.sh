#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The action of a ring of members, against sums over the states that the program prints; the volume of a scheme's map,
# against its derivative by complex steps: loops.sh PROGRAM
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

# a loop may be large beside its action, so that its points make an error that a symplectic scheme has not: no number
status 0 run outer-planets shape=disc members=64 steps=0 --state --json
cp out start
status 0 run outer-planets shape=disc members=64 scheme=wisdom-holman2 dt=200 steps=100 --state --json --measure "$keys"
sed '/^error, most/q' reference.py >sums.py
cat >>sums.py <<'END'
numbers, before, now = last["observables"], action(ring(first)), action(ring(last))
assert abs(now / before - 1) > 0.01 and share(ring(last)) < 1e-4, (now, before)
assert numbers["loop_action_error"] is None and abs(numbers["loop_action"] / now - 1) < 1e-9, numbers
assert last["reasons"]["loop_action_error"] == "the loop is not resolved with 63 points", last["reasons"]
END
python3 sums.py 0 0 || fail "the error of a loop's points: $(head -c 600 out)"

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
assert row["reasons"]["loop_action_error"].startswith("forces other than a friction") if sys.argv[1] == "none" else abs(seen) < float(sys.argv[1]), row
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

# x' = y z, y' = -x z + .1 sin y, z' = -.2 z + .3 x y: the map's determinants without the program, and its errors
printf 'components: x y z\nrate: x = y*z, y = -x*z + 0.1*sin(y), z = -0.2*z + 0.3*x*y\n' >spin.system
printf 'start: x = 0.7, y = 0.5, z = 0.6\ndt: 0.1\nuntil: 4\n' >>spin.system
cat >volume.py <<'END'
import cmath, json, math, sys
h, scheme, row = 0.1, sys.argv[1], json.load(open("out"))
def f(u):
    x, y, z = u
    return [y * z, -x * z + 0.1 * cmath.sin(y), -0.2 * z + 0.3 * x * y]
def plus(u, factor, k):
    return [a + factor * b for a, b in zip(u, k)]
def step(u, h):
    if scheme == "explicit-euler":
        return plus(u, h, f(u))
    if scheme == "midpoint":
        k = f(u)
        for _ in range(80):
            k = f(plus(u, h / 2, k))
        return plus(u, h, k)
    a = f(u); b = f(plus(u, h / 2, a)); c = f(plus(u, h / 2, b)); d = f(plus(u, h, c))
    return plus(u, h / 6, [p + 2 * q + 2 * r + s for p, q, r, s in zip(a, b, c, d)])
def determinant(u):
    a, b, c = ([g.imag / 1e-30 for g in step([u[k] + (1e-30j if k == i else 0) for k in range(3)], h)] for i in range(3))
    return (a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]))
u, logarithm, divergence = [0.7, 0.5, 0.6], 0, 0
for _ in range(40):
    middle, end = [v.real for v in step(u, h / 2)], [v.real for v in step(u, h)]
    logarithm += math.log(determinant(u))
    divergence += h * (-0.2 + 0.1 * (math.cos(u[1]) + 4 * math.cos(middle[1]) + math.cos(end[1])) / 6)
    u = end
seen = row["observables"]
assert abs(seen["log_volume"] - float(sys.argv[2])) < 5.1e-8, (seen, sys.argv)
assert abs(seen["log_volume"] - logarithm) < 1e-12, (seen, logarithm)
assert abs(seen["volume_error"] - math.expm1(logarithm - divergence)) < 1e-12, (seen, logarithm - divergence)
END
for row in rk4:-.4472275 midpoint:-.4471490 explicit-euler:-.3498378; do
    status 0 run ./spin.system scheme="${row%:*}" --measure log_volume,volume_error --json --strict
    python3 volume.py "${row%:*}" "${row#*:}" || fail "the volume by ${row%:*}: $(tail -c 300 out)"
done
status 0 run ./spin.system scheme=gauss6 --measure log_volume,volume_error --json
python3 -c '
import json
seen = json.load(open("out"))["observables"]
assert abs(seen["log_volume"] + .4472273) < 5.1e-8 and abs(seen["volume_error"]) < 2e-9, seen
' || fail "the volume of the motion: $(tail -c 300 out)"

# a linear flow by its trace, schemes by differences also far from the origin, tracers, a time, memory
kept() {
    most=$1
    shift
    status 0 run "$@" --measure log_volume,volume_error --json
    python3 - "$most" <<'END' || fail "$*: $(tail -c 300 out)"
import json, sys
assert abs(json.load(open("out"))["observables"]["volume_error"]) < float(sys.argv[1])
END
}
kept 1e-6 abc scheme=volume-splitting2 until=2000
kept 1e-10 vortices scheme=midpoint until=2
kept 1e-3 duffing scheme=gauss4 until=20
kept 1e-10 henon-heiles scheme=variational-galerkin4 until=20
kept 1e-9 outer-planets scheme=wisdom-holman2 steps=100
kept 1e-9 figure-eight 'scheme=saba2(kepler, interaction)' steps=100
status 0 run system 'rate=x = -x - y' 'rate=y = x - 2*y' x=1 y=0 dt=.1 until=3 scheme=explicit-euler --measure log_volume --json
python3 -c '
import json, math
assert abs(json.load(open("out"))["observables"]["log_volume"] - 30 * math.log(.9 * .8 + .01)) < 1e-12
' || fail "30 determinants of 1 + h A: $(tail -c 200 out)"

# lyapunov of a scheme by differences is that of the others, however far the orbit has gone
status 0 run abc scheme=volume-splitting2 dt=.02 until=5000 --measure lyapunov --json
python3 -c 'import json; assert abs(json.load(open("out"))["observables"]["lyapunov"] - .001569) < 2e-6' || fail "$(tail -c 200 out)"

# no volume: too many components, constraints, a library's scheme, steps that depend on the state
for row in '64 components:lennard-jones N=20 until=.1' 'constraints:cartesian-pendulum until=.1' 'no derivative:lorenz scheme=gsl-rk4 until=1' \
    'other lengths:kepler scheme=logh2 until=1'; do
    status 0 run ${row#*:} --measure volume_error
    grep -q "volume_error *none: .*${row%%:*}" out || fail "$row: $(cat out)"
done
[ "$failures" = 0 ]
