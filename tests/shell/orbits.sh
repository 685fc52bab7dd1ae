#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Lyapunov spectra, periodic orbits and orbit diagrams against numbers that are known: orbits.sh PROGRAM
set -u
. "$(dirname "$0")/answers.sh"

# holds CONDITION: of the answer's only object, as d; near(a, b, e) if a and b differ by at most e
holds() {
    python3 - out "$1" <<'END' || fail "$1: $(head -c 900 out)"
import cmath, json, math, sys
d = json.loads(open(sys.argv[1]).readline())
o = d.get("observables", {})
near = lambda a, b, e: abs(a - b) <= e
sys.exit(not eval(sys.argv[2]))
END
}

# ---- spectra ----

# Henon's map has the determinant -0.3 everywhere; his exponents, J. C. Sprott, Chaos and Time-Series Analysis (2003)
henon='rate=x = 1 - 1.4*x^2 + y - x, y = 0.3*x - y'
status 0 run system "$henon" x=0 y=0 scheme=explicit-euler dt=1 until=300000 --measure lyapunov_spectrum --json
holds 'near(o["lyapunov_sum"], math.log(.3), 1e-12) and near(o["lyapunov1"], .4192, 2e-3) and near(o["lyapunov2"], -1.6232, 2e-3)'
holds 'near(o["lyapunov_dimension"], 1 + o["lyapunov1"] / -o["lyapunov2"], 1e-12)'
# Lorenz: the divergence is -41/3, and rk4 with dt = .005 has 6e-6 less
status 0 run lorenz scheme=rk4 dt=.005 until=1000 --measure lyapunov_spectrum,lyapunov --json
holds 'near(o["lyapunov1"], .906, .02) and near(o["lyapunov2"], 0, .005) and near(o["lyapunov3"], -14.572, .03)'
holds 'near(o["lyapunov_sum"], -13.66666, 2e-6) and near(o["divergence_mean"], -41/3, 1e-9)'
holds 'near(o["lyapunov_dimension"], 2.062, .003) and near(o["lyapunov"], o["lyapunov1"], .01)'
holds 'near(o["lyapunov1"] + o["lyapunov2"] + o["lyapunov3"], o["lyapunov_sum"], 1e-10)'
# of x' = A x: the eigenvalues; a driven system has the 0 of its time
status 0 run system 'rate=x = -x + y, y = -2*y + z, z = -3*z' x=1 y=1 z=1 scheme=rk4 dt=.01 until=100 --measure lyapunov_spectrum --json
holds 'all(near(o["lyapunov%d" % k], -k, 1e-3) for k in (1, 2, 3))'
status 0 run duffing a=0 until=200 --measure lyapunov_spectrum --json
holds 'near(o["lyapunov1"], 0, 1e-9) and near(o["lyapunov_sum"], -.3, 1e-5)'
# the mean divergence has ln |det S| of events and breaks: a wall takes 0.9^2 of the area at each of three bounces; across
# x = 0 the rate falls from 3 to 1
printf 'coordinates: q\nH: p_q^2/2 + q^2/2 + 2*q\nevent: q = 0; p_q = -0.9*p_q\nstart: q = 1, p_q = 0.3\n' >wall.system
status 0 run ./wall.system scheme=gauss8 dt=.05 until=5 --measure lyapunov_spectrum --json
holds 'near(o["divergence_mean"], 6*math.log(.9)/5, 1e-10) and near(o["lyapunov_sum"], 6*math.log(.9)/5, 1e-10)'
status 0 run system 'rate=x = 2 - sign(x)' x=-1 scheme=rk4 dt=.1 until=10 --measure lyapunov_spectrum --json
holds 'near(o["divergence_mean"], -math.log(3)/10, 1e-12) and near(o["lyapunov_sum"], -math.log(3)/10, 1e-12)'
# the error of a scheme shows also where an event that adds to a speed, or a break, interrupts its steps: the divergence is
# -0.3, and the determinant of a step of explicit Euler with dt = 1 is 1.7
printf 'rate: x = v, v = -x - 0.3*v\nevent: mod(t, 1) = 0.5; v = v + 1\nstart: x = 1, v = 0\n' >kick.system
status 0 run ./kick.system scheme=explicit-euler dt=1 until=10 --measure lyapunov_spectrum,log_volume,volume_error --json
holds 'near(o["divergence_mean"], -.3, 1e-12) and near(o["volume_error"], math.exp(o["log_volume"] + 3) - 1, 1e-9)'
holds 'near(o["log_volume"], 10*math.log(1.21), 1e-9)'
status 0 run system 'rate=x = v, v = -x - 0.3*v + 0.2*sign(x)' x=1 v=0 scheme=rk2 dt=1 until=12 --measure lyapunov_spectrum,log_volume,volume_error --json
holds 'near(o["divergence_mean"], -.3, 1e-12) and near(o["volume_error"], math.exp(o["log_volume"] + 3.6) - 1, 1e-9)'
# a collision after which one speed gives the other: the determinant is 0, not its rounding
printf 'parameter: m = 1\nrate: x = u, y = v, u = -0.1*u, v = -0.1*v\nstart: x = 0, y = 1, u = 2, v = 0.3\n' >together.system
printf 'event: x - y = 0, u > v; u = (m*u + 1.3*v)/(m + 1.3), v = (m*u + 1.3*v)/(m + 1.3) - 0.5\n' >>together.system
for mass in 1 .7 .3; do
    status 0 run ./together.system m=$mass scheme=gauss8 dt=.05 until=2 --measure log_volume,volume_error --json
    holds 'o["volume_error"] is None and "determinant 0" in d["reasons"]["volume_error"]'
done
# tangents of a file are no components of the motion, also through events; twice as many would grow twice as fast
sed 's/^start/tangents: 2\nstart/' wall.system >carried.system
status 0 run ./carried.system scheme=gauss8 dt=.05 until=5 --measure lyapunov_spectrum,lyapunov --json
holds 'near(o["lyapunov_sum"], 6*math.log(.9)/5, 1e-10) and near(o["lyapunov1"] + o["lyapunov2"], o["lyapunov_sum"], 1e-10)'
holds '"lyapunov3" not in o'
saddle='coordinates: q\nH: p_q^2/2 - q^2/2 - q^4/4\nstart: q = 1e-3, p_q = 1e-3\n'
printf "$saddle" >saddle.system
printf "${saddle}tangents: 2\n" >tangents.system
status 0 run ./saddle.system scheme=rk4 dt=.01 until=6 --measure lyapunov --json
cp out alone
status 0 run ./tangents.system scheme=rk4 dt=.01 until=6 --measure lyapunov --json
python3 -c '
import json
alone, carried = (json.load(open(name))["observables"]["lyapunov"] for name in ("alone", "out"))
assert alone == carried and abs(alone - 1) < .2, (alone, carried)
' || fail "an exponent beside tangents: $(cat out)"
# a symplectic map: the sum is 0, and exponents come in pairs
status 0 run henon-heiles energy=1/8 q2=-.25 p2=0 scheme=verlet until=5000 --measure lyapunov_spectrum --json
holds 'near(o["lyapunov_sum"], 0, 1e-9) and near(o["lyapunov1"] + o["lyapunov4"], 0, .004) and o["lyapunov1"] > .02'
# a scheme whose derivative comes from differences; one without any
status 0 run disc system=pendulum scheme=avf2 until=20 --measure lyapunov_spectrum --json
holds 'o["lyapunov1"] is not None'
status 0 run kepler scheme=gsl-rk4 until=1 --measure lyapunov_spectrum --json
holds '"no derivative" in d["reasons"]["lyapunov1"]'
refused 1 "named twice" run lorenz --measure lyapunov_spectrum,lyapunov1
refused 1 "no observable lyapunov_spectrum" run burgers --measure lyapunov_spectrum

# values at a section that is at an event: the speed after each push tends to sqrt(c/(1 - rho^2))
status 0 sweep clock c=.1,.2 scheme=gauss8 until=600 --values v:1 --at section --table ticks.csv
python3 -c '
import csv, math
rho = math.exp(-2 * math.pi * .05 / math.sqrt(1 - .05**2))
rows = list(csv.DictReader(open("ticks.csv")))
assert len(rows) == 2 and all(abs(float(r["v"]) - math.sqrt(float(r["c"]) / (1 - rho**2))) < 1e-9 for r in rows), rows
' || fail "values at an event: $(cat ticks.csv)"

# ---- periodic orbits of a flow ----

# a start that does not return leads to a cycle that attracts
# a ball that conserves its energy returns after a bounce, however long a step is beside it: 2 sqrt(2 y0/g)
printf 'parameter: y0 = 1\nrate: y = v, v = -9.8\nevent: y = 0, v < 0; v = -v\nstart: y = y0, v = 0\n' >bounces.system
for height in 1 .01 1e-4 1e-6 1e-9; do
    status 0 orbit ./bounces.system y0=$height --json
    holds "near(d['period'] / (2*math.sqrt(2*$height/9.8)), 1, 1e-9)"
done
# an orbit that is smaller than what closes beside a large number is not shortened without an end
printf 'rate: x = v, v = -x, z = 0\nstart: x = 5e-9, v = 0, z = 1e6\n' >small.system
status 0 orbit ./small.system scheme=rk4 dt=.01 period=2*pi --json
holds 'near(d["period"], 2*math.pi, 1e-6)'
status 0 orbit clock --json
holds 'near(d["period"], 6.291054045776003, 1e-11) and near(d["multipliers"][1][0], 0.5330684683745183, 1e-9)'
# a motion that only decays is no orbit; an event that changes the energy leaves one multiplier of 1: a ball whose speed p
# becomes 0.8 p and then sqrt(p^2 + 0.2) has the other one 0.64
printf 'rate: x = v, v = -x - 0.1*v\nevent: x = 0, v > 0; v = sqrt(v^2 + 0.2)\nstart: x = 0, v = 0.6\n' >still.system
status 2 orbit ./still.system fix=x --json
holds 'd["status"] == "an equilibrium"'
grep -q 'an orbit moves' err || fail "the sentence of a motion that decays: $(cat err)"
printf 'coordinates: q\nmomenta: p\nH: p^2/2 + q^2/2\nevent: q = 0, p > 0; p = sqrt(p^2 + 0.2)\nevent: q = 0, p < 0; p = 0.8*p\nstart: q = 1, p = 0\n' >pushed.system
status 0 orbit ./pushed.system --json
holds 'd["by_structure"] == 1 and d["stability"] == "stable" and near(d["period"], 2*math.pi, 1e-12) and near(d["multipliers"][1][0], 0.64, 1e-9)'
# the numbers are of an integrator of order 8 with the tolerance 1e-13, and Newton's method
printf 'rate: x = y, y = (1 - x^2)*y - x\nstart: x = 2, y = 0\n' >vdp.system
status 0 orbit ./vdp.system --json
holds 'd["status"] == "ok" and d["stability"] == "stable" and near(d["period"], 6.663286859323133, 1e-9)'
holds 'near(d["start"][0], 2.0086198609, 1e-9) and near(d["multipliers"][0][0], 1, 1e-9) and near(d["multipliers"][1][0], 8.5969506360e-4, 1e-12)'
# a start inside of the cycle comes back after two turns, which are not its period
status 0 orbit van-der-pol --json
holds 'near(d["period"], 6.663286859323133, 1e-9) and near(d["multipliers"][1][0], 8.5969506360e-4, 1e-12)'
# its steps are halved from 64 in a period, whatever dt is
holds 'd["steps"] in [64 << k for k in range(13)]'
printf 'rate: x = 1 + x^2*y - 4*x, y = 3*x - x^2*y\nstart: x = 2, y = 1\n' >brusselator.system
status 0 orbit ./brusselator.system --json
holds 'near(d["period"], 7.15691992118, 1e-9) and near(d["multipliers"][1][0], 2.516375799e-4, 1e-12)'
status 0 orbit lorenz x=-13.7636 y=-19.5788 z=27 fix=z --json
holds 'near(d["period"], 1.5586522107162, 1e-9) and d["start"][2] == 27 and d["stability"] == "unstable"'
holds 'near(d["multipliers"][0][0], 4.712947273, 1e-8) and near(d["multipliers"][2][0], 1.19e-10, 1e-12)'
# Arenstorf's, with steps that suffice for nine digits
cat >arenstorf.system <<'END'
parameter: mu = 0.012277471
let: a = ((x + mu)^2 + y^2)^1.5
let: b = ((x - 1 + mu)^2 + y^2)^1.5
rate: x = u, y = v
rate: u = x + 2*v - (1 - mu)*(x + mu)/a - mu*(x - 1 + mu)/b, v = y - 2*u - (1 - mu)*y/a - mu*y/b
start: x = 0.994, y = 0, u = 0, v = -2.0015851063790825
END
status 0 orbit ./arenstorf.system period=17.0652165601580 scheme=gauss8 dt=17.0652165601580/24576 fix=x --json
holds 'near(d["period"], 17.0652165601580, 1e-9) and d["stability"] == "hyperbolic" and near(d["multipliers"][0][0], 285.4037, 285e-4)'
holds 'near(d["multipliers"][3][0], .00350381, 3e-7) and all(near(complex(*m), 1, 1.5e-3) for m in d["multipliers"][1:3])'
# a circle in a field of force has the period 2 pi; its multipliers are 1, three of them by the two invariants
status 0 orbit kepler --json
holds 'near(d["period"], 2 * math.pi, 1e-9) and d["by_structure"] >= 2 and all(near(complex(*m), 1, 1e-4) for m in d["multipliers"])'
# an invariant whose gradient vanishes on the orbit, or depends on that of the energy, gives no multiplier 1: the second
# degree of freedom is unstable
printf 'coordinates: a b\nH: p_a^2/2 + a^2/2 + a^4/4 + p_b^2/2 - 0.01*b^2\ninvariant: Ea = p_a^2/2 + a^2/2 + a^4/4\ninvariant: Eb = p_b^2/2 - 0.01*b^2; scale 1\nstart: a = 1, b = 0, p_a = 0, p_b = 0\ndt: 0.05\n' >apart.system
status 0 orbit ./apart.system --json
holds 'd["by_structure"] == 2 and d["stability"] == "hyperbolic" and near(d["multipliers"][0][0], math.exp(math.sqrt(.02)*d["period"]), 1e-8)'
# four invariants in involution of a figure eight leave two elliptic pairs, of the rotation numbers that Simo gives
status 0 orbit figure-eight --json
holds 'd["by_structure"] == 8 and d["stability"] == "elliptic"'
holds 'any(near(complex(*m), complex(math.cos(2*math.pi*.00842272), math.sin(2*math.pi*.00842272)), 1e-6) for m in d["multipliers"])'
status 0 orbit figure-eight
grep -q '0\.9985999[0-9]* ± 0\.052896' out || fail "the pair beside the ones: $(cat out)"
status 0 orbit kepler --json
# a root of order four, which rounding splits: digits below its error are not printed
holds 'd["stability"] == "parabolic"'
status 0 orbit kepler
grep -q '^  multipliers  *1, 1, 1, 1$' out || fail "a multiple root: $(cat out)"
# of every size: a circle of radius s, and van der Pol's cycle
for s in 3e-10 1 1e8; do
    status 0 orbit system 'rate=x = y, y = -x' x=$s y=0 --json
    holds "near(d['period'], 2 * math.pi, 1e-12) and d['start'] == [$s, 0]"
    status 0 orbit system "rate=x = y, y = (1 - (x/$s)^2)*y - x" x=2*$s y=0 --json
    holds "near(d['period'], 6.663286859323133, 1e-11) and near(d['start'][0] / $s, 2.0086198609, 1e-9) and near(d['multipliers'][1][0], 8.5969506360e-4, 1e-12)"
done
# far from the origin: its radius is 1e-6, its place 5
status 0 orbit system 'rate=x = 1e6*y, y = -1e6*(x - 5)' x=5.000001 y=0 --json
holds 'near(d["period"], 2e-6 * math.pi, 1e-15)'
# an angle that turns: the period of x' = 1 - sin(x)/2 is 2 pi/sqrt(3/4), of the pendulum an elliptic integral
printf 'rate: x = 1 - sin(x)/2\nangle: x\nstart: x = 0\n' >angle.system
status 0 orbit ./angle.system --json
holds 'near(d["period"], 2 * math.pi / math.sqrt(.75), 1e-11)'
printf 'coordinates: q\nH: p_q^2/2 - cos(q)\nangle: q\nstart: q = 0, p_q = 2.5\n' >angle.system
status 0 orbit ./angle.system --json
holds 'near(d["period"], 3.19248444426357, 1e-11) and d["stability"] == "parabolic"'
# digits that are noise are not printed
status 0 orbit lorenz x=-13.7636 y=-19.5788 z=27 fix=z
grep -q '^  multipliers  *4.712947273, 1, 1.19e-10$' out || fail "digits of a small multiplier: $(cat out)"
# shaken: the period is that of the force, and det M = exp(-.3 T)
status 0 orbit duffing a=.3 period=2*pi/1.2 --json
holds 'near(abs(complex(*d["multipliers"][0]) * complex(*d["multipliers"][1])), math.exp(-.3 * 2 * math.pi / 1.2), 1e-10) and d["residual"] < 1e-10'

# a start on a switch: the motion through it has the multiplier 1, as from anywhere else on the orbit
for start in 'x=3.1 y=0 dt=0.1 fix=y' 'x=3.1 y=0' 'x=3.1 y=0.1'; do
    status 0 orbit system rate='x = y, y = -x - 0.2*y + 0.5*sign(y)' $start --json
    holds 'near(d["multipliers"][0][0], 1, 1e-9) and near(d["multipliers"][1][0], .5318020829, 1e-9) and d["by_structure"] == 1'
done
# the kind of a fixed point whose multipliers are near the unit circle, by R(z) of the scheme
status 0 orbit system H='p^2/2 + q^2/2' q=0 p=0 scheme=rk4 dt=0.2 steps=1 --json
holds 'd["stability"] == "stable" and near(abs(complex(*d["multipliers"][0])), abs(sum((.2j)**k / math.factorial(k) for k in range(5))), 1e-14)'
status 0 orbit system H='p^2/2 - cos(q)' q=0 p=0 scheme=explicit-euler dt=0.001 steps=1 --json
holds 'd["stability"] == "unstable" and near(abs(complex(*d["multipliers"][0])), abs(1 + .001j), 1e-14)'
# a swing that loses, or gains, little: det M = exp(+-1e-6 pi)
for sign in - +; do
    status 0 orbit system rate="x = y, y = -(0.6+0.3*cos(2*t))*x $sign 1e-6*y" x=0 y=0 period=pi --json
    holds "d['stability'] == ('stable' if '$sign' == '-' else 'unstable') and near(abs(complex(*d['multipliers'][0]))**2, math.exp(${sign}1e-6 * math.pi), 1e-10)"
done

# ---- of a map ----

# the orbit of Verlet on the pendulum that closes after 16 steps, and its trace by the map written out
pendulum="system H=p^2/2-cos(q) q=2.1 p=0 scheme=verlet dt=0.5190055055451657"
# shellcheck disable=SC2086 # words
status 0 orbit $pendulum steps=16 --json
holds 'near(d["start"][0], 2, 1e-9) and near(d["start"][1], 0, 1e-9) and near(d["period"], 8.30408808872265, 1e-12) and d["by_structure"] == 0'
python3 - out <<'END' || fail "the multipliers of Verlet's map: $(cat out)"
import json, math, sys
d = json.loads(open(sys.argv[1]).readline())
h, q, p, m = 0.5190055055451657, 2., 0., [[1, 0], [0, 1]]
mul = lambda a, b: [[sum(a[i][k] * b[k][j] for k in (0, 1)) for j in (0, 1)] for i in (0, 1)]
for _ in range(16):
    kick = lambda q: [[1, 0], [-h / 2 * math.cos(q), 1]]
    m, p = mul(kick(q), m), p - h / 2 * math.sin(q)
    m, q = mul([[1, h], [0, 1]], m), q + h * p
    m, p = mul(kick(q), m), p - h / 2 * math.sin(q)
trace, first = m[0][0] + m[1][1], d["multipliers"][0][0]
assert abs(first + 1 / first - trace) < 1e-9 and abs(first * d["multipliers"][1][0] - 1) < 1e-9, (trace, d["multipliers"])
END
for K in .5 .97; do
    status 0 orbit kicked-rotor K=$K q=0 p=0 steps=1 --json
    holds "near(d['multipliers'][0][0], (2 + $K + math.sqrt($K**2 + 4 * $K)) / 2, 1e-12) and d['stability'] == 'hyperbolic'"
    status 0 orbit kicked-rotor K=$K q=pi p=0 steps=1 --json
    holds "near(d['multipliers'][0][0], (2 - $K) / 2, 1e-12) and d['stability'] == 'elliptic'"
done
# Henon's: x = (-.7 + sqrt(.49 + 5.6)) / 2.8, and his orbit of two points
status 0 orbit system "$henon" x=.6 y=.2 scheme=explicit-euler dt=1 steps=1 --json
holds 'near(d["start"][0], (-.7 + math.sqrt(6.09)) / 2.8, 1e-12) and d["stability"] == "unstable"'
status 0 orbit system "$henon" x=1 y=-.1 scheme=explicit-euler dt=1 steps=2 --json
holds 'near(d["start"][0]**2 * 1.96 - .98 * d["start"][0] + .49 - 1.4, 0, 1e-9)'

# ---- files, and what cannot be ----

status 0 orbit ./vdp.system --save cycle.system -o cycle.svg
grep -q 'multipliers 1, 0.000859695' cycle.svg || fail "the picture does not name its multipliers"
status 0 run ./cycle.system --state --json
holds 'd["scheme"] == "gauss8"'
holds 'near(d["state"][0], 2.0086198608748, 1e-10) and near(d["state"][1], 0, 1e-10)'
status 0 again cycle.svg
# the scheme of the orbit comes first in the file, before those of the system's own line
status 0 orbit van-der-pol scheme=gauss4 --save driven.system
grep -q '^schemes: gauss4 [a-z]' driven.system || fail "the schemes of a saved orbit: $(grep schemes driven.system)"
status 0 run ./driven.system --json
holds 'd["scheme"] == "gauss4"'
status 2 orbit system 'H=p^2/2 + q^2/2' q=0 p=0 period=1 --json
holds 'd["status"] == "an equilibrium" and d["multipliers"] == [] and d["stability"] == "none" and d["period"] == 1'
status 2 orbit system 'H=p^2/2 + q^2/2' q=0 p=0 period=1
grep -q '^  multipliers  *none$' out && grep -q '^  kind  *none$' out && ! grep -q structure out || fail "what an equilibrium has: $(cat out)"
status 2 orbit lorenz period=.3 --json
holds 'd["status"] == "no-convergence" and d["residual"] > 1e-6 and d["multipliers"] == []'
grep -q 'start closer to one' err || fail "the sentence of an orbit that does not close: $(cat err)"
refused 1 "has more than 1000000000 steps" orbit lorenz period=1e300
refused 1 "fix=zz is not a component; did you mean z" orbit lorenz fix=zz
refused 1 "period=-1 is not a number above 0" orbit lorenz period=-1
refused 1 "period= is a word of the flow" orbit lorenz steps=3 period=1
refused 1 "orbit follows one run" orbit lorenz x=1,2
refused 1 "has no derivative" orbit lorenz scheme=dopri5
refused 1 "it has constraints" orbit cartesian-pendulum
refused 1 "period= gives the period" orbit duffing
refused 1 "1.234 is not a period of the equations: at the same state the rate of p is" orbit duffing period=1.234
refused 1 "5 is not a period of the equations" orbit duffing period=5
refused 1 "is steps times dt, is not a period" orbit duffing scheme=midpoint dt=.05 steps=100
refused 2 "the start is an equilibrium" orbit system 'H=p^2/2 - cos(q)' q=pi p=0
refused 2 "ends before it returns: the implicit step after t = 0.99" orbit system 'rate=x = x^2' x=1
status 2 orbit system 'rate=x = x^2' x=1 period=3
grep -q 'no orbit that closes: the implicit step after t = 0.99' err || fail "the reason of a run that ends: $(cat err)"
refused 1 "not a .system file" orbit ./vdp.system --save cycle.npz
refused 2 "does not return" orbit system 'rate=x=-x' x=1
refused 1 "orbit does not follow burgers" orbit burgers
[ ! -e cycle.npz ] || fail "a refused command wrote a file"

# ---- many values a run ----

# the logistic map: its cycles of 2 and 4, which solve polynomials (R. M. May, Nature 261 (1976) 459), and its window of 3
logistic='rate=x = r*x*(1 - x) - x'
cat >tree.py <<'END'
import csv, sys
rows = list(csv.DictReader(open("tree.csv")))
assert len(rows) == 36 and [int(row["index"]) for row in rows] == 3 * list(range(12))
assert open("tree.csv").readline().endswith(",seconds,index,t,x\n")
assert float(rows[11]["t"]) == 2000
cycles = [[float(row["x"]) for row in rows[12 * k:12 * k + 12]] for k in range(3)]
for cycle, known in zip(cycles, [[.5130445095, .7994554905], [.3828196831, .5008842103, .8269407066, .8749972636]]):
    assert len({round(x, 9) for x in cycle}) == len(known) and all(min(abs(x - y) for y in known) < 1e-9 for x in cycle), cycle
assert len({round(x, 9) for x in cycles[2]}) == 3
END
# tree OPTION...: the table of three runs with twelve values each
tree() {
    status 0 sweep system "$logistic" r=3.2,3.5,3.84 x=0.5 scheme=explicit-euler dt=1 steps=2000 --values x:12 "$@"
}
tree --table tree.csv
python3 tree.py || fail "the cycles of the logistic map: $(head -3 tree.csv)"
# resumed after it was cut within a run or within a row, made of shards, and made again: the same values
cp tree.csv whole.csv
for lines in 1 14 20 25 30; do
    head -n "$lines" whole.csv >tree.csv
    [ "$lines" = 20 ] && printf 'system-' >>tree.csv
    tree --table tree.csv
    [ "$(wc -l <tree.csv)" = 37 ] && python3 tree.py || fail "a table that was cut after line $lines"
done
# a table of other values, or at another place, is left as it is
cp tree.csv kept.csv
refused 3 "not that of run 0 with --values x:5 --at step; it is left as it is" sweep system "$logistic" r=3.2,3.5,3.84 x=0.5 scheme=explicit-euler dt=1 steps=2000 --values x:5 --table tree.csv
refused 3 "not that of run 0 with --values x:12 --at maximum" sweep system "$logistic" r=3.2,3.5,3.84 x=0.5 scheme=explicit-euler dt=1 steps=2000 --values x:12 --at maximum --table tree.csv
cmp -s tree.csv kept.csv || fail "a table of other values was changed"
tree --table shards.csv --shard 1/2
tree --table shards.csv --shard 2/2
status 0 sweep --join shards.csv
mv shards.csv tree.csv
python3 tree.py || fail "the table of two shards"
tree --table tree.csv --retry ok
python3 tree.py || fail "a table whose runs were made again"
# at a section and at maxima: x = cos(w t), v = -sin(w t) passes v = 0 upwards at x = -1; x has its maxima at whole turns
printf 'rate: x = w*v, v = -w*x\nparameter: w = 1\nstart: x = 1, v = 0\nsection: v = 0, x < 0; x, v\ndt: 0.01\nuntil: 40\n' >turn.system
for place in section maximum; do
    status 0 sweep ./turn.system w=1,2 scheme=gauss8 --values x:5 --at $place --measure escape_time
    python3 - out "$place" <<'END' || fail "values at each $place: $(head -3 out)"
import csv, math, sys
rows = list(csv.DictReader(open(sys.argv[1])))
assert len(rows) == 10 and "escape_time" in rows[0]
for row in rows:
    x, turns = float(row["x"]), float(row["t"]) * float(row["w"]) / (2 * math.pi)
    at, most = (.5, 1e-11) if sys.argv[2] == "section" else (0, 2e-8)
    assert abs(x - (-1 if at else 1)) < most and abs(turns - at - round(turns - at)) < 1e-5, row
END
done
# of a map a maximum is one of its values: the larger ones of the cycle of 4
status 0 sweep system "$logistic" r=3.5,3.500001 x=0.5 scheme=explicit-euler dt=1 steps=2001 --values x:2 --at maximum
python3 - out <<'END' || fail "the maxima of a map: $(cat out)"
import csv, sys
rows = list(csv.DictReader(open(sys.argv[1])))[:2]
assert all(float(row["t"]) == int(float(row["t"])) for row in rows), rows
assert all(abs(x - y) < 1e-9 for x, y in zip(sorted(float(row["x"]) for row in rows), [.8269407066, .8749972636])), rows
END
# a run that fails has one row; a second key makes panels
status 0 sweep system "$logistic" r=3.2,5 x=0.5 scheme=explicit-euler dt=1 steps=2000 --values x:3
[ "$(grep -c ',ok,' out)" = 3 ] && grep -q ',blow-up,.*,,,$' out || fail "a run that fails: $(cat out)"
status 0 sweep system "$logistic" r=3..4:30 x=.3,.5 scheme=explicit-euler dt=1 steps=300 --values x:20 -o panels.svg
status 0 again panels.svg
# an error is one, not the quantity itself
status 0 sweep kepler eccentricity=0,0.5 scheme=verlet until=50 --values energy_error:1 --measure energy_error
awk -F, 'NR > 1 && ($13 != $16 || $16 > 0.1) { exit 1 }' out || fail "errors as values: $(cat out)"
# what is printed of a derivative of max can be read
status 0 list system 'H=p^2/2 + max(q, 0)^2' q=1 p=0
grep -qF "p' = -2*max(q, 0)*if(0 < q, 1, 0)" out || fail "the derivative of max: $(cat out)"
refused 1 "give a key a range" sweep lorenz --values x:10
refused 1 "is not NAME:K" sweep lorenz rho=1,2 --values x
refused 1 "did you mean z" sweep lorenz rho=1,2 --values zz:3
refused 1 "has no section" sweep system "$logistic" r=3,4 x=.5 scheme=explicit-euler dt=1 --values x:3 --at section
refused 1 "is none of: step, section, maximum" sweep lorenz rho=1,2 --values x:3 --at nowhere
refused 1 "place of --values" sweep lorenz rho=1,2 --at step

# ---- stiff systems without a step size and schemes ----

# van der Pol and the Oregonator: E. Hairer & G. Wanner, Solving Ordinary Differential Equations II (1996), IV.10
printf 'rate: x = z, z = ((1 - x^2)*z - x)/1e-6\nstart: x = 2, z = 0\nuntil: 2\n' >pol.system
status 0 run ./pol.system --json --state
holds 'd["scheme"] == "gsl-msbdf" and near(d["state"][0], 1.7061677321, 1e-4) and d["steps"] == 200 and d["seconds"] < .5'
cat >oregonator.system <<'END'
rate: y1 = 77.27*(y2 + y1*(1 - 8.375e-6*y1 - y2)), y2 = (y3 - (1 + y1)*y2)/77.27, y3 = 0.161*(y1 - y3)
start: y1 = 1, y2 = 2, y3 = 3
until: 360
END
status 0 run ./oregonator.system --json --state
holds 'd["scheme"] == "gsl-msbdf" and all(near(a / b, 1, 1e-5) for a, b in zip(d["state"], (1.00081487, 1228.17852, 132.055494)))'
printf 'rate: a = -0.04*a + 1e4*b*c, b = 0.04*a - 3e7*b^2 - 1e4*b*c, c = 3e7*b^2\nstart: a = 1, b = 0, c = 0\nuntil: 40\n' >robertson.system
status 0 run ./robertson.system --json --state
holds 'd["scheme"] == "gsl-msbdf" and near(d["state"][0], .7158270688, 1e-5)'
for scheme in implicit-euler sdirk2 trapezoidal midpoint radau3 radau5; do
    status 0 run ./robertson.system scheme=$scheme dt=.2,.1,.04,.01 --json
    [ "$(grep -c '"status":"ok"' out)" = 4 ] || fail "Robertson's reaction with $scheme"
done
status 0 run ./robertson.system scheme=implicit-euler dt=1e8 steps=1 --json --state
holds 'near(d["state"][0], 4.53359916e-3, 1e-10) and near(d["state"][1], 1.82159855e-8, 1e-15)'
# the same with a step size or schemes in the file, and systems that are not stiff, begin as before
(cat robertson.system && echo 'dt: 0.01') >other.system
status 0 run ./other.system --json
holds 'd["scheme"] != "gsl-msbdf"'
status 0 run system 'rate=x = 10*(y - x), y = x*(28 - z) - y, z = x*y - 8/3*z' x=1 y=1 z=1 --json
holds 'd["scheme"] != "gsl-msbdf"'

[ "$failures" = 0 ] && echo "orbits: all passed"
exit "$failures"
