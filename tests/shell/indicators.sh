#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Indicators of chaos from the command line, and what the systems of share/systems are known for: indicators.sh PROGRAM
set -u
. "$(dirname "$0")/answers.sh"

refused 1 "did you mean lyapunov" run kepler until=1 --measure lyapunow
refused 1 "no observable lyapunov" run burgers until=0.01 --measure lyapunov

# told when asked for alone, and then in nothing else than themselves
all=lyapunov,lyapunov_change,megno,megno_change,return_time,escape_time
status 0 run henon-heiles energy=1/8 q2=-.25 p2=0 until=200 --json --state
cp out plain
grep -q lyapunov out && fail "indicators are told unasked"
status 0 run henon-heiles energy=1/8 q2=-.25 p2=0 until=200 --json --state --measure "$all" --csv rows.csv --every 7
python3 - plain out rows.csv <<'END' || fail "the orbit is not the same, or its numbers: $(head -c 600 out)"
import csv, json, sys
plain, asked = json.loads(open(sys.argv[1]).readline()), json.loads(open(sys.argv[2]).readline())
assert plain["state"] == asked["state"] and plain["evaluations"] == asked["evaluations"]
numbers = asked["observables"]
assert numbers["lyapunov"] > 0.02 and numbers["megno"] > 3 and 5 < numbers["return_time"] < 9, numbers
assert numbers["escape_time"] is None and "not left" in asked["reasons"]["escape_time"]
rows = list(csv.DictReader(open(sys.argv[3])))
assert float(rows[-1]["megno"]) == numbers["megno"]
half = min(rows, key=lambda row: abs(float(row["t"]) - 100))
assert abs(numbers["megno"] - float(half["megno"]) - numbers["megno_change"]) < 0.1
END

# every kind of system: a formula, components alone, a time; of a disc the last member; twice the same
for words in "system H=p^2/2-cos(q) q=1 p=0 dt=.1" "lorenz" "duffing until=100" "double-pendulum until=2" \
    "disc system=pendulum until=10" "abc until=10" "vortices until=1" "stiff until=.1" "oscillator until=1" "kepler until=10" \
    "lennard-jones N=20 until=.2"; do
    status 0 run $words --measure lyapunov,megno --json
    cp out once
    status 0 run $words --measure megno,lyapunov --json
    python3 - once out "$words" <<'END' || fail "$words: $(head -c 400 out)"
import json, sys
one, other = [json.loads(open(name).readline())["observables"] for name in sys.argv[1:3]]
assert one["lyapunov"] is not None and one["megno"] is not None and one == other, (one, other)
END
done

# the exponents that are known: of Lorenz' equations .906 (J. C. Sprott, Chaos and Time-Series Analysis, 2003), of the standard
# map ln(K/2) for large K (B. V. Chirikov, 1979); a planet comes back after 2 pi, and never parts but along its orbit
observed() {
    python3 -c 'import json, sys; print(json.loads(open("out").readline())["observables"][sys.argv[1]])' "$1"
}
between() {
    python3 -c 'import sys; value, low, high = map(float, sys.argv[1:]); sys.exit(not low < value < high)' "$(observed "$1")" "$2" "$3" ||
        fail "$1 = $(observed "$1") is not between $2 and $3"
}
status 0 run lorenz until=1000 --measure lyapunov --json
between lyapunov .88 .93
status 0 run kicked-rotor K=10 until=20000 --measure lyapunov --json
between lyapunov 1.58 1.64
# an order is of short steps, and a map's dt of 1 is none
for words in symplectic-euler:1 verlet:2; do
    status 0 certify "${words%:*}" --on kicked-rotor --json
    python3 - out "${words#*:}" <<'END' || fail "the order of ${words%:*} on a map"
import json, sys
order = json.loads(open(sys.argv[1]).readline())["measured_order"]
assert abs(order - int(sys.argv[2])) < 0.1, order
END
done
# x'' + .3 x' + 2 x = 0 in the well, whatever the time that it carries does
status 0 run duffing a=0 until=500 --measure lyapunov --json
between lyapunov -.16 -.14
status 0 run kepler-space scheme=gauss8 until=2000 --measure lyapunov,return_time --json
between lyapunov 0 .01
between return_time 6.28318530 6.28318532

# what left or failed has no exponent, and says so; the time until then is that of the stop
status 0 run system "H=p^2/2 - q^2/2" q=1 p=0 dt=.01 until=20 scheme=verlet --measure lyapunov --json
between lyapunov .9 1.1
printf 'coordinates: q\nmomenta: p\nH: p^2/2 - q^2/2\nstart: q = 1, p = 0\nstop: q - 10\ndt: 0.01\nuntil: 9\n' >leaves.system
status 0 run ./leaves.system scheme=gauss8 --measure lyapunov,escape_time --json
between escape_time 2.99322 2.99323 # arcosh 10
grep -q '"lyapunov":null' out && grep -q '"lyapunov":"the run was stopped' out || fail "an orbit that left has an exponent"
status 2 run henon-heiles scheme=explicit-euler until=1000 --measure megno,escape_time --json
grep -q '"megno":"blow-up"' out || fail "an orbit that blew up has a MEGNO"
status 2 run outer-planets scheme=implicit-euler dt=100 --measure escape_time --json
grep -q '"escape_time":"no-convergence"' out || fail "a run that failed is said to have stayed"
status 0 run kepler scheme=gsl-rk4 until=1 --measure lyapunov --json
grep -q '"lyapunov":"the state of the scheme' out || fail "GSL's steppers have no derivative"
"$geomint" list schemes --json | python3 -c '
import json, sys
words = {row["scheme"]: row.get("tangent") for row in map(json.loads, sys.stdin)}
assert [words[name] for name in ("verlet", "gauss4", "avf2", "gsl-rk4")] == ["exact", "exact", "differences", "none"], words
' || fail "list does not say how derivatives are found"

# a map: what lies outside of the energy is left out, chaos and order lie where they are known to lie
status 0 sweep henon-heiles energy=1/8 q2=-.4..0.6:11 p2=-.4..0.4:9 until=300 scheme=verlet --measure megno --size 480x320 -o map.png
[ -s map.png ] || fail "no map"
python3 - map.csv <<'END' || fail "the map is wrong"
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1])))
at = {(round(float(row["q2"]), 3), round(float(row["p2"]), 3)): row for row in rows}
assert len(rows) == 99 and at[-.4, -.4]["status"] == "refused" and at[-.4, -.4]["megno"] == ""
assert float(at[.3, 0]["megno"]) < 2.5 and float(at[-.2, 0]["megno"]) > 3, (at[.3, 0], at[-.2, 0])
assert float(at[.2, .2]["megno"]) == float(at[.2, .2]["megno"]) > 3
END
# of several observables each map says what it shows, and one that shows nothing has no colours to read
status 0 sweep henon-heiles q2=-.1,.1 p2=-.1,.1 until=20 scheme=verlet --measure escape_time,lyapunov -o maps.svg
grep -q 'time until the orbit has left, Verlet<' maps.svg && grep -q 'no run has a number<' maps.svg &&
    grep -q 'largest Lyapunov exponent, Verlet<' maps.svg || fail "two maps do not say what they show"
status 0 work-precision henon-heiles scheme=verlet dt=.1,.05 until=20 --measure lyapunov --size 320x180

# argon as in Hairer, Lubich & Wanner, I.4: H = -1260.2 and 22.72 K at the start, in kB K; explicit Euler gains hundreds with
# steps of half a fs, Verlet swings by 2 with 40 fs and four times that with 80
status 0 run argon steps=0 --json --state
python3 - out <<'END' || fail "the start of argon"
import json, sys
run = json.loads(open(sys.argv[1]).readline())
x, y, u, v = [run["state"][7 * k:7 * k + 7] for k in range(4)]
kinetic = sum(a * a + b * b for a, b in zip(u, v)) / (2 * 66.34e-27 / 1.380658e-23)
ratios = [.341 ** 2 / ((x[i] - x[j]) ** 2 + (y[i] - y[j]) ** 2) for i in range(7) for j in range(i)]
energy = kinetic + sum(4 * 119.8 * (r ** 6 - r ** 3) for r in ratios)
assert abs(energy + 1260.2) < 0.05 and abs(kinetic / 7 - 22.72) < 0.005, (energy, kinetic / 7)
assert abs(run["observables"]["temperature"] - kinetic / 7) < 1e-9
END
# step by step as by the loop below; of the temperature no more can be asked: it swings between 1 and 31 K about 15.5 K, and
# where it is after 200 ps the last digits of a step decide
for words in verlet:4e-5:200 verlet:8e-5:100 symplectic-euler:1e-5:800; do
    scheme=${words%%:*} steps=${words##*:} dt=${words#*:}
    status 0 run argon "scheme=$scheme" "dt=${dt%:*}" "steps=$steps" --measure energy_error,temperature --json
    python3 - out "$scheme" "${dt%:*}" "$steps" <<'END' || fail "argon by $words"
import json, sys
observables, scheme = json.loads(open(sys.argv[1]).readline())["observables"], sys.argv[2]
h, steps, k, mass = float(sys.argv[3]) * 1e-9, int(sys.argv[4]), 1.380658e-23, 66.34e-27
x = [complex(a, b) * 1e-9 for a, b in
     [(0, 0), (.02, .39), (.34, .17), (.36, -.21), (-.02, -.4), (-.35, -.16), (-.31, .21)]]
v = [complex(a, b) for a, b in [(-30, -20), (50, -90), (-70, -60), (90, 40), (80, 90), (-40, 100), (-80, -60)]]
pairs = [(i, j) for i in range(7) for j in range(i)]
def power(i, j):
    return (.341e-9 / abs(x[i] - x[j])) ** 6
def kick(h):
    for i, j in pairs:
        s, d = power(i, j), x[i] - x[j]
        a = h / mass * 24 * 119.8 * k * (2 * s * s - s) / abs(d) ** 2 * d
        v[i], v[j] = v[i] + a, v[j] - a
def kinetic():
    return sum(abs(a) ** 2 for a in v) * mass / 2 / k
def energy():
    return kinetic() + sum(4 * 119.8 * (power(i, j) ** 2 - power(i, j)) for i, j in pairs)
start = energy()
for _ in range(steps):
    kick(h / 2 if scheme == "verlet" else h)
    x = [a + h * b for a, b in zip(x, v)]
    kick(h / 2 if scheme == "verlet" else 0)
error = abs(energy() / start - 1)
assert abs(observables["energy_error"] - error) < 1e-11, (observables, error)
assert abs(observables["temperature"] - kinetic() / 7) < 1e-6, (observables, kinetic() / 7)
END
done
# gains NAME DT LOW HIGH: the largest error of the energy
gains() {
    status 0 run argon scheme=$1 dt=$2 --measure energy_error,temperature --csv argon.csv --every 10
    python3 - argon.csv "$3" "$4" <<'END' || fail "argon by $1, $2"
import csv, sys
rows, low, high = list(csv.DictReader(open(sys.argv[1]))), float(sys.argv[2]), float(sys.argv[3])
energy = 1260.2 * max(float(row["energy_error"]) for row in rows)
mean = sum(float(row["temperature"]) for row in rows) / len(rows)
assert low < energy < high and (high > 100 or 14 < mean < 17), (energy, mean)
END
}
gains explicit-euler 5e-7 100 1e4
gains symplectic-euler 1e-5 3 15
gains verlet 4e-5 1 4
gains verlet 8e-5 5 15

# the planets as they are, half axes in au; and as schemes leave them after 200 000 days (I.2.4): thrown outwards by the one
# Euler, into the sun by the other, where they are by the symplectic ones
status 0 run outer-planets steps=0 --json --state
python3 - out <<'END' || fail "the start of the planets"
import json, math, sys
state = json.loads(open(sys.argv[1]).readline())["state"]
masses = [1.00000597682, 0.000954786104043, 0.000285583733151, 0.0000437273164546, 0.0000517759138449, 1 / 1.3e8]
for i, known in enumerate([5.203, 9.54, 19.2, 30.1, 39.5], 1):
    r = math.dist(state[i:18:6], state[0:18:6])
    v = [p / masses[i] for p in state[18 + i::6]]
    axis = 1 / (2 / r - sum(x * x for x in v) / (2.95912208286e-4 * (masses[0] + masses[i])))
    assert abs(axis / known - 1) < 0.015, (i, axis)
END
status 0 render outer-planets -o planets.svg
for words in 'explicit Euler, Δt = 10<' 'implicit Euler, Δt = 10<' 'symplectic Euler, Δt = 100<' 'Verlet, Δt = 200<'; do
    grep -q "$words" planets.svg || fail "the picture of the planets lacks $words"
done
status 0 run outer-planets scheme=explicit-euler dt=10 --measure jupiter,energy_error --json
between jupiter 10 20
status 2 run outer-planets scheme=implicit-euler dt=10 --measure jupiter,energy_error --json
between jupiter 0 1
status 0 run outer-planets scheme=symplectic-euler dt=100 --measure jupiter,energy_error --json --max
between jupiter 4.7 5.7
between energy_error_max 0 .03
status 0 run outer-planets scheme=verlet dt=200 --measure jupiter,energy_error --json --max
between jupiter 4.9 5.5
between energy_error_max 0 .003

[ "$failures" = 0 ] && echo "indicators: all passed"
exit "$failures"
