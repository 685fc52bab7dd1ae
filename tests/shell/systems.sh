#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Systems on the command line: those that the program brings are listed; what is wrong is said with its place.
# systems.sh GEOMINT SYSTEMS
set -u
systems=$2
. "$(dirname "$0")/answers.sh"

for file in "$systems"/*.system; do
    name=$(basename "$file" .system)
    forms=$(grep -c '^mesh: ' "$file") # systems of forms are listed by their types
    for form in --long --latex; do
        [ "$forms" -gt 0 ] && [ $form = --latex ] && continue
        "$geomint" list "$name" $form >out 2>err || fail "list $name $form: $(cat err)"
        [ -s out ] && [ ! -s err ] || fail "list $name $form: $(cat err)"
    done
    [ "$forms" -gt 0 ] || "$geomint" list "$file" --json | python3 -c '
import json, sys
about = json.load(sys.stdin)
assert about["title"] and about["equations"] and about["structure"]
fits = {"field": "leapfrog", "nodes": "free-gauss4", "multisymplectic": "gauss-box4"}
assert fits.get(about["kind"], "rk4") in about["schemes"]
# fifteen square roots exist together in one of 2^15 points: what holds them is tested, not proved; so is what
# the parameters of the file alone have, as the symmetry of a bowl without a dent
known = {"tested at random points"} if sys.argv[1] in ("outer-planets", "bowl") else {"proved"}
# densities of fields are integrated, not proved
known |= {"not checked"} if sys.argv[1] in ("bbm", "boussinesq", "camassa-holm", "kdv", "nls", "nonlinear-dirac") else set()
assert set(about["invariants"].values()) <= known, about["invariants"]
' "$name" || fail "list $name --json"
    for word in title reference watch; do
        grep -q "^$word: " "$file" || fail "$name has no $word"
    done
done
for n in 3 4 6 11 100; do
    "$geomint" list toda N=$n --json | python3 -c '
import json, sys
about = json.load(sys.stdin)
assert len(about["equations"]) == 2 * int(sys.argv[1]) and set(about["invariants"].values()) == {"proved"}
' $n || fail "list toda N=$n"
done

# constraints are equations too, and act by multipliers
"$geomint" list chain --latex | grep -qF '0 &= \frac{\left(x_{2} - x_{1}\right)^{2} + \left(y_{2} - y_{1}\right)^{2} - 1}{2}' || fail "list chain --latex: no constraint"
"$geomint" list chain --latex | grep -qF '&= -g - \lambda_{5}\left(y_{5} - y_{4}\right)' || fail "list chain --latex: no multiplier"
"$geomint" list cartesian-pendulum --json | grep -qF '"constraints":["(x^2 + y^2 - 1)/2"]' || fail "list --json: no constraint"

# what a force does to the law of a symmetry is no scheme's fault
forced() {
    printf 'geomint: 1\ntitle: forced\ncoordinates: x y\nL: (v_x^2 + v_y^2)/2 - (x^2 + y^2)/2\nforce: x = -%s, y = -%s\n' "$1" "$2"
    printf 'symmetry: x = -y, y = x\nstart: x = 1, y = 0, v_x = 0, v_y = 1\n'
}
forced 0.1*v_x 0.1*v_y >drag.system
forced 0.1*x 0.1*y >radial.system
"$geomint" list ./drag.system --long | grep -q 'momentum1 = .* (by symmetry, not kept)' || fail "a force along a symmetry"
"$geomint" list ./radial.system --long | grep -q 'momentum1 = .* (by symmetry, proved)' || fail "a force across a symmetry"
"$geomint" certify variational-midpoint2 --on ./drag.system >out 2>err || fail "certify on a force along a symmetry: $(cat out err)"
grep -q 'conserves momentum maps  *not measured' out || fail "a force is blamed on a scheme"
"$geomint" certify variational-midpoint2 --on ./radial.system | grep -q 'conserves momentum maps  *holds' || fail "a force across a symmetry, certified"

# a no has the place of its term, of a derived one that of where it came from
holds() {
    "$geomint" list "$1" --long | grep -q -- "^  $2  *$3" || fail "list $1 --long: not \"$2 $3\""
}
holds driven-pendulum quadratic 'no  sin(q) (from line 11, column 31) is not of degree 2, in the rate of p'
holds lotka-volterra volume 'no  .* (from line 13, column 16) contains'
holds restricted-three-body separable 'no  y\*p_x (line 12, column 24) holds'
cat >stiff.system <<'END'
coordinates: a b
H: (p_a^2 + p_b^2)/2 + 2500*b^2/2 - 1/sqrt(a^2 + b^2)
start: a = 1, b = 0, p_a = 0, p_b = 1
END
holds ./stiff.system fast-linear 'yes'
# both sides of a kink have derivatives that vanish
for energy in 'abs(p + q)' 'max(p, q)' 'mod(p + q, 1)' 'sqrt((p + q)^2)'; do
    printf 'coordinates: q\nmomenta: p\nH: %s\nstart: q = 1, p = 2\n' "$energy" >kink.system
    holds ./kink.system separable 'no'
done
printf 'coordinates: q\nmomenta: p\nH: p^2/2 + abs(q) + sqrt(1 + q^2)\nstart: q = 1, p = 2\n' >kink.system
holds ./kink.system nystrom 'yes'
# a perturbation that rounding hides, too, and another one near it
for rate in 'x = y, y = -x + 1e-12*y' 'x = y, y = -x + 1e-17*y' 'x = 1e8*y, y = -1e8*x + 1e-9*y' 'x = 2^30*y*2^31, y = -x'; do
    printf 'components: x y\nrate: %s\ninvariant: C = x^2 + y^2\nstart: x = 1, y = 0\n' "$rate" >kink.system
    "$geomint" run ./kink.system steps=1 >out 2>&1 && fail "an invariant of $rate: $(cat out)"
done
# decimals are fractions, also where constants are multiplied: 6*0.1 = 2*0.3
printf 'components: x y\nrate: x = 0.1*y, y = -0.3*x\ninvariant: C = 3*x^2 + y^2\nstart: x = 1, y = 0\n' >kink.system
"$geomint" run ./kink.system steps=1 >out 2>&1 || fail "decimals: $(cat out)"
printf 'rate: x = 0.1*x + 0.2*x, y = -0.3*y\nstart: x = 1, y = 1\n' >kink.system
holds ./kink.system divergence-free 'yes'
magnetic() { # RATES ANSWER
    printf 'rate: x = u, y = v, %s\nstart: x = 1, y = 0, u = 0, v = 1\n' "$1" >kink.system
    holds ./kink.system magnetic "$2"
}
magnetic 'u = -x + 0.1*3*v, v = -y - 0.3*u' 'yes'
magnetic 'u = -x + 0.3*v, v = -y - 0.3000000000001*u' 'no'
for law in 'abs(x) - x' 'min(x, 3) - x' 'sqrt(x^2) - x'; do
    printf 'components: x\nrate: x = 1\ninvariant: s = %s\nstart: x = 1\n' "$law" >kink.system
    "$geomint" run ./kink.system steps=1 >out 2>&1 && fail "the invariant $law: $(cat out)"
done
# functions of functions that would be too many operands are refused before they are written out; x(0.0) is x(0)
{
    printf 'let: f0(v) = v*v\n'
    for i in $(seq 40); do printf 'let: f%d(v) = f%d(v + %d) + f%d(v)\n' "$i" $((i - 1)) "$i" $((i - 1)); done
    printf 'rate: x = f40(x)\nstart: x = 1\n'
} >deep.system
refused 1 'deep.system:42:11: the formula, with its loops and functions written out, has more than' run ./deep.system
(ulimit -t 3 && "$geomint" run ./deep.system >out 2>&1)
[ $? = 1 ] || fail "a deep function is not refused within three seconds"
"$geomint" run system rate='x = x(0) - x' x=1 until=1 --state --json | sed 's/.*"state"//' >state.txt
"$geomint" run system rate='x = x(0.0) - x' x=1 until=1 --state --json | sed 's/.*"state"//' | cmp -s - state.txt || fail 'x(0.0)'
refused 1 "let= replaces a line of a system's file" run system rate='x = m(x)' let='m(v) = v^2' x=1
# derivatives prove nothing across a jump that the motion passes; they do where it does not pass, or nothing jumps
claim() { # LINES PATTERN
    printf "$1" >jump.system
    "$geomint" list ./jump.system --long >out 2>&1
    grep -q -- "$2" out || fail "a claim across a jump: $1: $(cat out)"
}
claim 'rate: x = 2 - sign(x)\nstart: x = -1\ninvariant: S = sign(x)\n' 'S is not an invariant'
claim 'coordinates: q\nmomenta: p\nH: (p^2 + q^2)/2\nstart: q = 0, p = 1\ninvariant: S = atan2(q, p) - t\n' 'S is not an invariant: it jumps in the motion; observe: takes'
claim 'coordinates: q\nmomenta: p\nH: (p^2 + q^2)/2\nstart: q = 0, p = 1\ninvariant: S = cos(atan2(q, p)/2 - t/2)\n' 'S is not an invariant: it jumps'
claim 'coordinates: q\nmomenta: p\nH: (p^2 + q^2)/2\nstart: q = 0, p = 1\ninvariant: S = cos(atan2(q, p) - t)\n' 'S = cos(atan2(q, p) - t) (tested at random points)'
claim 'rate: x = y, y = -x\nstart: x = 1, y = 0\ninvariant: S = atan(y/x) + t\n' 'S is not an invariant: it jumps'
claim 'rate: x = y, y = -x\nstart: x = 1, y = 0\ninvariant: S = tan(atan(y/x) + t)\n' 'S = .* (proved)'
claim 'rate: x = 1, y = 0\nstart: x = 0, y = 0\ninvariant: S = atan(1/(x - 5.005)) + atan(x - 5.005)\n' 'S is not an invariant: it jumps'
claim 'rate: x = 2 + abs(x)/x, y = 0\nstart: x = -1.3, y = 0\n' 'divergence-free  no'
claim 'coordinates: q\nH: p_q^2/2 + max(q, 2*q)\nstart: q = 1, p_q = 0\ninvariant: S = p_q^2/2 + max(q, 2*q)\n' 'S = .* (proved)'
# a region that random points do not meet is not called tested
claim 'rate: x = y, y = -x - max(1 - x^2 - y^2, 0)*y\nstart: x = 0.3, y = 0.4\n' 'divergence-free  no'
claim 'rate: x = y, y = -x\nstart: x = 0.003, y = 0.004\ninvariant: S = if(x^2 + y^2 > 1e-3, x^2 + y^2, x)\n' 'S = .* (not checked)'
claim 'rate: x = 1, y = 2\nstart: x = 0, y = 0\ninvariant: S = 2*floor(x) - y + mod(y, 1)\n' 'S is not an invariant'
claim 'rate: x = 1, y = 2\nstart: x = 0, y = 0\ninvariant: S = 2*floor(x) + 2*mod(x, 1) - y\n' 'mod(x, 1) - y (tested'
claim 'rate: x = y, y = -x\nstart: x = 1, y = 0\ninvariant: S = if(x^2 + y^2 < 1, 2, 1)\n' 'S = .* (proved)'
claim 'rate: x = y, y = -1.01*x\nstart: x = 1, y = 0\ninvariant: S = if(x^2 + y^2 < 1, 2, 1)\n' 'S is not an invariant'
claim 'rate: x = 2 - sign(x)\nstart: x = -1\n' 'divergence-free  no  sign(x) .* jumps'
claim 'rate: x = sign(x + y), y = -sign(x + y)\nstart: x = -1, y = 0\n' 'divergence-free  yes'
claim 'rate: x = y, y = -x + sign(sin(t))\nstart: x = -1, y = 0\n' 'divergence-free  yes the divergence is 0$'
claim 'coordinates: q\nH: p_q^2/2 + floor(q)\nstart: q = 0.5, p_q = 1\n' 'divergence-free  no  floor(q) .* jumps in H'
claim 'coordinates: q\nH: p_q^2/2 + if(q > 0, 4, 1)*q^2\nstart: q = 1, p_q = 0\n' 'divergence-free  yes'
claim 'coordinates: q\nH: p_q^2/2 + abs(q)\nstart: q = 1, p_q = 0\ninvariant: E = p_q^2/2 + abs(q)\n' 'E = .* (proved)'
claim 'coordinates: q\nH: p_q^2/2\nstart: q = 1, p_q = 0\nsymmetry: q = sign(q)\n' 'the momentum map of this symmetry jumps'
so3='components: x y z\nbracket: x y = z, y z = x, z x = y\nH: x^2/2 + y^2\nstart: x = 1, y = 0, z = 1\n'
claim "${so3}casimir: C = sign(x)\\n" 'C is not a Casimir'
claim "${so3}casimir: C = sign(x^2 + y^2 + z^2 - 2)\\n" 'C = .* (a Casimir, proved)'
holds ./stiff.system kepler-split 'yes'
# x' = v, v' = g(x, t) in any order takes the schemes of T(p) + V(q), also without a potential and with the time
second() { # RATES ANSWER
    printf 'rate: %s\nstart: x = 1, v = 0, y = 0.2, w = 0.1\n' "$1" >second.system
    holds ./second.system second-order "$2"
}
second 'x = v, y = w, v = -x, w = -y - 0.1*w' 'no  w .* holds a velocity, in the rate of w'
second 'x = 2*v, v = -x, y = w, w = -y' 'no  2\*v .* is not a velocity, in the rate of x'
second 'x = v, y = v, v = -x, w = -y' 'no  v .* is not a velocity, in the rate of y'
second 'x = v, y = w, v = -x - t*v, w = -y' 'no  v .* holds a velocity, in the rate of v' # which vanishes at t = 0
second 'x = v, y = w, v = w - w - x, w = -y' 'yes'
printf 'rate: v = -sin(x), x = v\nstart: x = 1, v = 0\n' >second.system
holds ./second.system second-order 'yes'
second 'x = v, v = -x + y/2, y = w, w = -2*y - x/2 + cos(t)/2' 'yes'
for scheme in 'verlet 2' 'yoshida4 4' 'blanes-moan-nystrom6 6'; do
    set -- $scheme
    "$geomint" certify "$1" --on ./second.system >out 2>&1
    grep -Eq "order $2, measured ($2[.]0|$(($2 - 1))[.]9)" out || fail "$1 of second order: $(cat out)"
done
"$geomint" certify variational-midpoint2 --on ./second.system >out 2>&1 && fail 'an action without a potential'
state() { # WORDS: the state of a run, a line for each scheme
    "$geomint" run "$@" scheme=verlet,yoshida4 dt=0.1 until=10 --json --state | sed 's/.*"state"://'
}
state system rate='x = v' rate='v = -sin(x)' x=1 v=0 >second.txt
state system H='v^2/2 - cos(x)' coordinates=x momenta=v x=1 v=0 | cmp -s - second.txt || fail 'second order differs from H'
state ./second.system >second.txt
printf 'rate: x = v, y = w, v = -x + y/2, w = -2*y - x/2 + cos(t)/2\nstart: x = 1, v = 0, y = 0.2, w = 0.1\n' >order.system
printf 'rate: x = y, y = -x\nstart: x = 1, y = 1\ninvariant: I = x^2 + y^2 + t^2\n' >wrong.system # its rate is 0 at t = 0
refused 1 'wrong.system:3:12: I is not an invariant' run ./wrong.system
"$geomint" list soliton --source | sed "s/^points: 31/points: 100001/" >soliton.system
refused 1 'soliton.system:16:9: points: 100001 are more than the 100000 nodes' run ./soliton.system until=0
# a magnetic field rotates velocities: in rates, also interleaved and with the time, and in H with p = v/c + A(x, t)
magnetic() { # RATES ANSWER
    printf 'rate: %s\nstart: x = 1, u = 0, y = 0.2, v = 1\n' "$1" >magnetic.system
    holds ./magnetic.system magnetic "$2"
}
magnetic 'x = u, y = v, u = -x + v, v = -y + u' 'no  -y + u .* does not rotate the velocity, in the rate of v'
magnetic 'x = u, y = v, u = -x + v*u, v = -y - u*u' 'no  -x + v\*u .* does not rotate the velocity, in the rate of u'
magnetic 'x = u, u = -x + v*x + cos(t), y = v, v = -y - u*x' 'yes'
"$geomint" run ./magnetic.system scheme=boris2,magnetic-splitting2 dt=0.1 steps=40 --json --state >out
python3 - out <<'END' || fail "steps in a magnetic field: $(cat out)"
import json, math, sys
for line, exact in zip(open(sys.argv[1]), (False, True)):
    x, y, u, v, t, h = 1, 0.2, 0, 1, 0, 0.1
    for _ in range(40):
        x, y, t = x + h / 2 * u, y + h / 2 * v, t + h / 2
        u, v = u + h / 2 * (math.cos(t) - x), v - h / 2 * y
        angle = h * x if exact else 2 * math.atan(h * x / 2)  # the tangent of Boris' half angle is exact
        u, v = math.cos(angle) * u + math.sin(angle) * v, math.cos(angle) * v - math.sin(angle) * u
        u, v = u + h / 2 * (math.cos(t) - x), v - h / 2 * y
        x, y, t = x + h / 2 * u, y + h / 2 * v, t + h / 2
    state = json.loads(line)["state"]
    assert all(abs(a - b) < 1e-12 for a, b in zip(state, (x, y, u, v, t))), (state, x, y, u, v, t)
END
{
    printf 'coordinates: x y\nmomenta: p r\nlet: A = (1 + sin(t)/3)*y + x^2/5\nlet: B = x*cos(t)/4\n'
    printf 'H: 0.7*((p - A)^2 + (r - B)^2)/2 + x^4/4 + y^2*cos(t)/2\nstart: x = 1, y = 0.2, p = 0.3, r = 0.5\n'
} >canonical.system
for c in 0 1; do # without momenta squared no velocity gives them
    "$geomint" list system H='c*((p1 - q2)^2 + p2^2)/2 + 3*p1*q2 + q1^2' c=$c q1=1 q2=0.5 p1=0.2 p2=0.1 --long >out
    grep -Eq "magnetic  *$([ $c = 1 ] && echo yes || echo 'no  H is not quadratic')" out || fail "c = $c: $(cat out)"
done
for system in ./magnetic.system ./canonical.system charged-particle; do
    for scheme in boris2 magnetic-splitting2; do
        "$geomint" certify $scheme --on $system >out 2>&1
        grep -Eq 'order 2, measured (2[.]0|1[.]9)' out && grep -q 'symmetric  *holds' out ||
            fail "$scheme of $system: $(cat out)"
        "$geomint" certify "composition($scheme; g, 1 - 2*g, g; let: g = 1/(2 - 2^(1/3)))" --on $system >out 2>&1
        grep -Eq 'measured (4[.]0|3[.]9)' out || fail "$scheme of order 4 of $system: $(cat out)"
    done
done
"$geomint" run charged-particle scheme=boris2,magnetic-splitting2 steps=200000 --max --json >out
[ "$(grep -Eo '"energy_error_max":[0-9.e-]*' out | awk -F: '$2 < 3e-4' | wc -l)" = 2 ] || fail "the energy: $(cat out)"
state ./order.system | cmp -s - second.txt || fail 'the order of rates matters'
"$geomint" list stiff.system --json | grep -q gautschi2 || fail 'a stiff linear part has no scheme of its own'

printf 'coordinates: q\nH: p_q^2/2 + 2q\nstart: q = 1, p_q = 0\n' >wrong.system
refused 1 'wrong.system:2:15: there is no operator' list wrong.system
[ "$(sed -n 2p err)" = '    H: p_q^2/2 + 2q' ] && [ "$(sed -n 3p err)" = '                  ^' ] || fail "no caret: $(cat err)"

# what is wrong with a line that a scene is made of has its place, too
misplaced() { # PLACE LINE [START]
    printf 'coordinates: x\nH: p_x^2/2 + x^2/2\nstart: %s\n%s\n' "${3:-x = 1, p_x = 0}" "$2" >wrong.system
    refused 1 "wrong.system:$1" run ./wrong.system
}
# a file names the lanes of its picture; what is wrong with them is said to be the file's
printf 'coordinates: q\nmomenta: p\nH: p^2/2 - cos(q)\nstart: q = 1, p = 0\nlanes: scheme=verlet,rk4\n  dt=.1,.2 zip=yes\n' >lanes.system
status 0 render lanes.system -o lanes.svg
grep -q 'Verlet, .*[.]1<' lanes.svg && grep -q 'RK4, .*[.]2<' lanes.svg || fail 'a picture of other lanes than those of the file'
status 0 run lanes.system steps=1
[ "$(grep -c 'lanes  ' out)" = 1 ] || fail 'a run is of one lane'
printf 'coordinates: q\nmomenta: p\nH: p^2/2 - cos(q)\nstart: q = 1, p = 0\nlanes: scheme=verlt\n' >lanes.system
refused 1 'in the line "lanes:" of lanes: there is no scheme "verlt"' render lanes.system -o lanes.svg
misplaced '4:14: schemes: verlt is not a scheme' 'schemes: rk4 verlt'
misplaced '4:10: there is no name disk' 'members: disk 3'
misplaced '4:10: members is 1.5, and has to be a whole number from 1 to 1e6' 'members: 1.5'
misplaced '4:14: members is 2, and its range is from 3 to 9' 'members: n = 2; 3 .. 9'
misplaced '4:9: spread is 2e+06, and has to be a number from 0 to 1e6' 'spread: 2e6'
misplaced '4:10: the name dt is taken' 'members: dt = 5'
misplaced '4:9: the name x is taken' 'spread: x = 5'
misplaced '4:20: all is not a new word for show=' 'view: x, p_x; show all'
misplaced '4:11: tangents is 3: there are 1 to 2 tangents of 2 components' 'tangents: 3'
misplaced '4:8: xi1_x is of a tangent, whose start and rate follow from the system' 'force: xi1_x = 1
tangents: 1'
misplaced '5:1: a system with constraints has no tangents' 'constraint: x - 1
tangents: 1'
printf 'coordinates: x\nH: p_x^2/2 + x*xi1_x\nstart: x = 1, p_x = 0\ntangents: 1\n' >wrong.system
refused 1 'wrong.system:2:16: the motion does not depend on its tangents' run ./wrong.system
printf 'coordinates: x\nL: v_x^2/2\nstart: x = 1, v_x = 0\ntangents: 1\n' >wrong.system
refused 1 'wrong.system:4:1: a system with L has no line "tangents"' run ./wrong.system
misplaced '4:8: steps: 10.5 is not a whole number' 'steps: 10.5'
misplaced '4:8: exact: x would begin at 2, and it starts at 1' 'exact: x = 2*x(0)*cos(t)'
misplaced '4:17: observe: has no option "titel"; did you mean title' 'observe: r = x; titel y'
misplaced '4:8: graph: far is not an observable' 'graph: far; log'
misplaced '4:24: work: far is not an observable' 'work: until=1; measure far'
misplaced '4:21: stability: k is not a parameter' 'stability: until=1; k 1, 2'
misplaced '4:8: level: t is not shown' 'level: t; grey'
misplaced '3:8: p_x has no value at the start' '' 'x = 1'
misplaced '4:14: there is no function arctan; did you mean atan' 'observe: r = arctan(x)'
misplaced '4:14: there is no function log2; did you mean log(x)/log(2)' 'observe: r = log2(x)'
misplaced '4:18: a condition compares two values' 'observe: r = if(x, 1, 2)'
misplaced '4:15: x(t - 17) is a delay; delay equations are not solved' 'observe: r = x(t - 17)/2'
# a start that is not admitted is refused with the file's own sentence, and one that is admitted runs
printf 'name: A pit\ntitle: A pit of {k}\ncoordinates: x\nparameter: k = 2\nH: p_x^2/2 + k*x^2/2\nstart: x = 1, p_x = 0\n' >pit.system
printf 'require: k - x^2; x=%s is outside of a pit of {k:/}\nobserve: r = x; while x; missing x is below 0\n' '{x}' >>pit.system
refused 1 'x=-1.5 is outside of a pit of 2' run ./pit.system x=-1.5
status 0 run ./pit.system x=-1.25 steps=0 --json
grep -qF '"r":null' out && grep -qF '"r":"x is below 0"' out || fail "a condition that does not hold: $(cat out)"
status 0 list ./pit.system --json
grep -qF '"title":"A pit"' out || fail "the name of a list: $(cat out)"
# the derivative's own notation, and a force where a scheme needs an energy alone
printf "x' = -x\nstart: x = 1\n" >prime.system
refused 1 "prime.system:1:1: x' = -x is written rate: x = -x" run ./prime.system
for left in "x'" dx/dt; do
    printf "rate: %s = -x\nstart: x = 1\n" "$left" >prime.system
    refused 1 "prime.system:1:.*a name alone: rate: x = -x gives x' = -x" run ./prime.system
done
printf 'coordinates: q\nH: p_q^2/2 + q^2/2\nforce: q = -0.1*p_q\nstart: q = 1, p_q = 0\n' >forced.system
refused 1 'does not fit scene forced: it needs a Hamiltonian on which no force acts; here the line force: adds one' run ./forced.system scheme=verlet
# what is derived is printed in lowest terms, and what is typed as it was typed
printf 'parameter: m = 2\ncoordinates: a r\nH: p_r^2/(2*m) + p_a^2/(2*m*r^2) + 2*r^2/4\nstart: a = 0, r = 1, p_a = 1, p_r = 0\n' >polar.system
"$geomint" list ./polar.system >out || fail 'a system in polar coordinates'
for line in "a' = p_a/(m\*r^2)" "p_r' = p_a^2/(m\*r^3) - r" 'H = p_r^2/(2\*m) + p_a^2/(2\*m\*r^2) + 2\*r^2/4'; do
    grep -q "^  $line\$" out || fail "no line $line: $(cat out)"
done
"$geomint" list ./polar.system --latex >out || fail 'the same for a paper'
grep -qF '\dot{a} &= \frac{p_{a}}{m\,r^{2}} \\' out || fail "the same for a paper: $(cat out)"
"$geomint" list kepler-space >out || fail 'a system of three dimensions'
grep -q "^  p_x' = -x/r^3\$" out || fail "a root with a name: $(cat out)"
# how dense steps are: above 0, of the state alone; where it falls too fast the run says so
misplaced '4:10: the monitor is -1 at the start: how dense steps are is a number above 0' 'monitor: x - 2'
misplaced '4:10: a monitor holds coordinates, momenta and parameters alone' 'monitor: 1 + t'
refused 1 'does not fit scene system: it needs a monitor, the density of steps; geomint list' run system H='p^2/2 + q^2/2' q=1 p=0 scheme=controlled-verlet2
refused 1 'it needs a potential V(q) < 0 of a Hamiltonian T(p) + V(q)' run system H='p^2/2 + q^2' q=1 p=0 scheme=logh2
# where this run starts counts, not where the file does
printf 'coordinates: q\nmomenta: p\nH: p^2/2 - cos(q)\nstart: q = 3, p = 0\n' >top.system
refused 1 'it needs a potential V(q) < 0 of a Hamiltonian T(p) + V(q), T(0) = 0' run ./top.system scheme=logh2
"$geomint" run ./top.system q=0 p=1 scheme=logh2 until=1 >out || fail 'what attracts at the start of the run alone'
printf 'coordinates: q\nmomenta: p\nH: p^2/2 - cos(q)\nstart: q = 0, p = 1\n' >bottom.system
refused 1 'it needs a potential V(q) < 0' run ./bottom.system q=3 p=0 scheme=logh2
refused 1 'it needs a potential V(q) < 0 .*, T(0) = 0' run system H='cosh(p1)+cosh(p2)-1/sqrt(q1^2+q2^2)' q1=1 q2=0 p1=0 p2=1 scheme=logh2
refused 1 'scheme logh2 .*it needs a single member, for its time is its own' run ./bottom.system members=10 scheme=logh2
"$geomint" run outer-planets scheme=logh2 --json >out || fail "the outer planets in another time"
grep -q '"warning":"[^"]*the last step leads far beyond until = ' out || fail "a step far beyond the end: $(cat out)"
"$geomint" run kepler scheme=logh2 --json >out || fail "Kepler in another time"
grep -q '"warning":""' out || fail "a step a little beyond the end: $(cat out)"
"$geomint" run system H='p^2/2 - cos(q)' q=0 p=1.9 scheme=logh2 dt=.01 until=10 >out
[ $? = 2 ] || fail "a potential that is not negative is no failure"
grep -q 'the energy at rest, which has to be negative, is -0.119, and 0.0' out || fail "no word of the potential: $(cat out)"

# momenta by the names of a file are told to be others here
refused 1 'not given: q= p=; for other names type coordinates=x,y$' run system L='v_x^2/2 + v_y^2/2 - x*y' x=1 y=0 v_x=0 v_y=0
refused 1 'not given: p=; without coordinates= a momentum is p, not p_q' run system 'H=p_q^2/2 + q^2' q=1 p_q=0
refused 1 'not given: p=$' run system 'H=q^2' q=1

# a coordinate that H does not hold has a momentum at rest, and not one of -0
printf 'coordinates: x y\nH: (p_x^2 + p_y^2)/2 + y\nstart: x = 0, y = 0, p_x = 1, p_y = 0\n' >falling.system
"$geomint" list ./falling.system --long | grep -q "^  p_x' = 0\$" || fail "a momentum at rest"
"$geomint" list ./falling.system --latex | grep -q 'dot{p_{x}} &= 0 ' || fail "a momentum at rest, in LaTeX"

# of a name that is defined twice a file tells the line of the first; a command line has none
printf 'coordinates: q\nH: q\nlet: a = 1\nlet: a = 2\n' >twice.system
"$geomint" run ./twice.system 2>out
grep -q 'twice.system:4:6: a is defined twice, first in line 3$' out || fail "twice in a file: $(cat out)"
"$geomint" run system 'H=p^2/2+a*q' a=1 a=2 q=1 p=0 2>out
grep -q 'in a=, column 1: a is defined twice$' out || fail "twice on the command line: $(cat out)"

printf 'coordinates: x\nH: p_x^2/2 + x^2/2\nstart: x = 1, p_x = 0\nmonitor: x - 0.5\ndt: 0.001\nuntil: 9\n' >falls.system
"$geomint" run ./falls.system scheme=controlled-verlet2 >out 2>err
[ $? = 2 ] || fail "a monitor that falls to 0 is no failure"
grep -q 'the step after t = 1.0[0-9]* was not found: the monitor, the density of steps, is 0.0' out ||
    fail "no word of the monitor: $(cat out)"

refused 1 'there is no scheme "verlett"; did you mean verlet$' run kepler scheme=verlett
refused 1 'there is no scheme "z*"; see geomint list' run kepler "scheme=$(printf 'z%.0s' $(seq 200))"
# a lane freezes with what was not finite, also where a step bends there and the slope does not lead, of any member
bends() { # SCHEME MEMBERS
    printf 'coordinates: q\nH: p_q^2/2 + sqrt(1 - q)\nstart: q = 0, p_q = 1\n' >bends.system
    "$geomint" run ./bends.system scheme="$1" members="$2" dt=0.2 >out 2>err
    [ $? = 2 ] || fail "$1: a root of what is negative is no failure"
    grep -q 'failed: sqrt(1 - q) is not finite where 1 - q = -0\.' out || fail "$1 of $2: $(cat out)"
}
bends verlet 1
bends verlet 5
bends rk4 1
bends gauss4 1
printf 'rate: x = 1/sqrt(2 - t)\nstart: x = 2\n' >late.system
"$geomint" run ./late.system scheme=rk4 dt=0.15 >out 2>err
grep -q 'sqrt(2 - t) is not finite where 2 - t = -0.00625' out || fail "the time of a stage: $(cat out)"
misplaced '3:21: p_x is not finite at the start' '' 'x = 1, p_x = 0/0'
misplaced '4:10: observe: energy_error makes two observables energy_error' 'observe: energy_error = x'
misplaced '4:10: observe: energy_error_max makes two observables energy_error_max' 'observe: energy_error_max = x'
misplaced '5:12: invariant: L makes two observables L_error' "$(printf 'observe: L_error = x\ninvariant: L = p_x^2 + x^2')"
printf 'hamiltonian: q\ncoordinates: q\nH: p_q^2/2\nstart: q = 0, p_q = 0\n' >wrong.system
refused 1 'wrong.system:1:1: a system has no line "hamiltonian"' run ./wrong.system
[ "$(sed -n 3p err)" = '    ^' ] || fail "no caret below the first line: $(cat err)"
# where memory is short one sentence says for what
(
    ulimit -v 200000
    "$geomint" --help >/dev/null 2>&1 || exit 0 # a sanitizer wants more
    failures=0
    refused 5 'lennard-jones.system:[0-9]*:12: not enough memory for N = 300' run lennard-jones N=300
    exit "$failures"
) || failures=$((failures + 1))

printf 'coordinates: x\nH: p_x^2/2 + abs(x)\nstart: x = 1, p_x = 0\n' >kink.system
"$geomint" list bbm --latex | grep -qF '\partial_t\left(u - u_{xx}\right) &= -u_{x} - u\,u_{x}' || fail "list bbm --latex: no mass"
"$geomint" list peakons --latex | grep -qF 'L_{\mathrm{cell}} &= m_{t}^{2}\,\tanh\left(\frac{d}{2}\right) + ' || fail "list peakons --latex: no cell"
"$geomint" list kink.system --latex | grep -qF -- '-\operatorname{sign}\left(x\right)' || fail "the derivative of |x| in LaTeX"

# a swing of the error counts, wherever the run ends: no verdict but that of steps that are too long
"$geomint" stability toda scheme=verlet --judge accurate --json --out . | grep -q '"step":0\.1[^}]*"verdict":"wrong"' &&
    fail "a short step is wrong"

printf 'coordinates: q\nH: p_q^2 + \033[31mq\n' >wild.system
refused 1 '0x1b' list wild.system
refused 1 "^geomint: bracket= replaces a line of a system's file" run system H='x^2 + y^2' bracket='[x, y] = 1' x=1 y=0
# a formula that is none is told before values are asked for, and one without its scene finds it
refused 1 'in H=, column 1: H: has no value' run system H=
refused 1 'in H=, column 8: the formula ends where a number' run system H='p^2/2 +'
refused 1 'in x=, column 1: a formula was expected' run system rate='x = y' x= y=2
# what is missing is told after a fault of a formula; lines below a typed one keep their numbers
refused 1 'in k=, column 3: the formula ends' run system H='p^2/2 + k*q + m' k=3+
printf 'coordinates: q\nmomenta: p\nH: p^2/2\n  + q^2\nparameter: k = 1 +\nstart: q = 1, p = 0\n' >below.system
refused 1 'below.system:5:19: the formula ends' run ./below.system H='p^2/2'
refused 1 'in H=, column 1: H: has no value' run ./below.system H=
# a line goes on behind empty lines and comments; a reserved name says why
printf 'coordinates: q\nmomenta: p\nH: p^2/2\n\n# half\n  + q^2/2\nstart: q = 1, p = 0\n' >apart.system
status 0 run ./apart.system steps=1
printf 'coordinates: q\nmomenta: p\nparameter: trails = 1\nH: p^2/2 + trails*q^2\nstart: q = 1, p = 0\n' >trails.system
refused 1 'trails.system:3:12: the name trails is reserved: it is a key' run ./trails.system
refused 1 'in H=, column 9: there is no function foo' run system H='p^2/2 + foo(q)'
refused 1 'a product is written with \*: q\*(' run system H='p^2/2 + q(1 + q)'
refused 1 'in rate=, column 15: the formula ends' run system rate='x = y, y = -x*'
refused 1 'values that are not given: q= p= N=' run system H='p^2/2 + sum(i = 1 .. N, q^i)'
refused 1 'a formula is for the scene system: system H=p^2/2' run H='p^2/2' q=1 p=0
refused 3 'File name too long' run "./$(head -c 5000 /dev/zero | tr '\0' a).system"
grep -q "$(printf '\033')" err && fail 'an escape reached the terminal'
printf 'H: ' >zero.system
head -c 3 /dev/zero >>zero.system
refused 1 'zero.system:1:4: a byte is 0' list zero.system
awk 'BEGIN { printf "coordinates: q\nH: "; for (i = 0; i < 1000000; i++) printf "(" }' >deep.system
refused 1 'nested more than' list deep.system
truncate -s 104857601 large.system
refused 3 'it has 100 MB, more than 100' list large.system
refused 3 'No such file' list none.system
mkdir folder.system
refused 3 'Is a directory' list folder.system
mkfifo pipe.system
refused 3 'it is a pipe' list pipe.system # which nobody waits for
refused 1 'no parameter "M"' list toda M=3
refused 1 'takes parameters with numbers' list toda N
refused 1 'outside of its range' list toda N=2
refused 1 'of a system' list vortices --latex
refused 1 'names of scenes' list nothing

# every one of them runs, is drawn, and is made again without its file
for file in "$systems"/*.system; do
    name=$(basename "$file" .system)
    step= # at the usual one Verlet loses a part of the energy of stiff springs
    [ "$name" = stiff ] && step=dt=0.005
    [ "$name" = disc ] && step=scheme=verlet # its first one is no symplectic scheme
    "$geomint" run "$name" ${step:+"$step"} steps=20 --json >out 2>err || fail "run $name: $(cat err)"
    python3 -c '
import json
run = json.load(open("out"))
assert run["status"] == "ok" and run["steps"] == 20, run
for key, value in run["observables"].items():
    # the rotor conserves an energy between its kicks alone
    limit = 1 if run["scene"] == "kicked-rotor" else 0.05
    assert value is None or not key.endswith("_error") or value < limit, (key, value)
' || fail "run $name"
done
cp "$systems/lotka-volterra.system" mine.system
"$geomint" render ./mine.system a=1,2 until=3 --size 200x120 -o first.svg 2>err || fail "render: $(cat err)"
rm mine.system
"$geomint" again first.svg -o second.svg 2>err || fail "again: $(cat err)"
cmp -s first.svg second.svg || fail 'again makes another picture'

# what is typed is listed like a file; a file may begin with the mark of UTF-8; parameters hold elements of lists
"$geomint" list system H='p^2/2 + k*q^4' k=2 q='sum(i = 1 .. 3, i)' p=0 --json | python3 -c '
import json, sys
about = json.load(sys.stdin)
assert about["kind"] == "canonical" and about["structure"]["separable"]["holds"], about
' || fail 'list system H='
"$geomint" list system H='p^2/2 + k*q^4' q=1 p=0 >out 2>err
[ $? = 1 ] && grep -q 'not given: k=' err || fail "list system without k: $(cat err)"
printf '\357\273\277parameter: c = m[1]*2 + d\nparameter: d = m[2]\nparameter: m[1..N] = 1, 2\nparameter: N = 2\n' >marked.system
printf 'rate: x = c*x\nstart: x = 1\ndt: 0.1\nuntil: 1\n' >>marked.system
"$geomint" run marked.system 'm[1]=3' --json >out && [ "$(value out parameters.c)" = 8 ] || fail "marked: $(cat out)"
"$geomint" run system H='p^2/2 + q^2/2' q='sum(i = 1 .. 3, i)' p=0 until=1 dt=0.1 --json >out
[ "$(value out parameters.q)" = 6 ] || fail "a start that is a sum: $(cat out)"
printf 'coordinates: q\nH: p_q^2/2 + q^2/2\nobserve: area = q\nstart: q = 1, p_q = 0\n' >area.system
"$geomint" run area.system >out 2>err
[ $? = 1 ] && grep -q 'two observables area' err || fail "two areas: $(cat err)"

# scenes that the program brings, typed as formulas: the same numbers
"$geomint" run henon-heiles scheme=rk4 dt=0.01 steps=1000 --json --state >built 2>err || fail "henon-heiles: $(cat err)"
p1=$(python3 -c 'print(repr((2 * (1/12 - (0.01/2 - 0.001/3)) - 0.01) ** 0.5))')
"$geomint" run system H='(p1^2 + p2^2 + q1^2 + q2^2)/2 + q1^2*q2 - q2^3/3' q1=0 q2=0.1 p1=$p1 p2=0.1 scheme=rk4 \
    dt=0.01 steps=1000 --json --state >typed 2>err || fail "system: $(cat err)"
python3 -c '
import json
built, typed = (json.load(open(name))["state"] for name in ("built", "typed"))
assert max(abs(a - b) for a, b in zip(built, typed)) < 1e-13, (built, typed)
' || fail 'a scene and its formula differ'

# the eight closes after its period; what follows from a parameter follows
"$geomint" run figure-eight scheme=gauss8 dt=6.325913983/1000 steps=1000 --json --state >eight || fail figure-eight
python3 -c '
import json
seen = json.load(open("eight"))
start = [seen["parameters"]["%s[%d]" % (c, i)] for c in "xyuv" for i in (1, 2, 3)]
assert max(abs(a - b) for a, b in zip(seen["state"], start, strict=True)) < 1e-9, seen["state"]
' || fail 'the eight is open'
# the rigid body turns as Jacobi's elliptic functions say, which the arithmetic-geometric mean makes
"$geomint" run rigid-body scheme=gauss8 dt=0.01 until=10 --json --state >body 2>err || fail "rigid-body: $(cat err)"
python3 -c '
import json, math
def elliptic(u, m): # sn, cn, dn; Abramowitz and Stegun, 16.4
    a, b, c = [1], math.sqrt(1 - m), [math.sqrt(m)]
    while abs(c[-1]) > 1e-16:
        a.append((a[-1] + b) / 2)
        c.append((a[-2] - b) / 2)
        b = math.sqrt(a[-2] * b)
    angle = 2 ** (len(a) - 1) * a[-1] * u
    for k in range(len(a) - 1, 0, -1):
        angle = (angle + math.asin(c[k] / a[k] * math.sin(angle))) / 2
    return math.sin(angle), math.cos(angle), math.sqrt(1 - m * math.sin(angle) ** 2)
r1, r2, r3 = 1 / 2, 1, 3 / 2 # of the moments; from y2 = 0 on
y1, y3 = math.cos(1.1), math.sin(1.1)
k1, k3 = (r3 - r2) / (r3 - r1), (r2 - r1) / (r3 - r1)
small, large = y1 / math.sqrt(k1), y3 / math.sqrt(k3)
assert small < large
sn, cn, dn = elliptic(10 * math.sqrt(k1 * k3) * (r3 - r1) * large, (small / large) ** 2)
seen = json.load(open("body"))["state"]
wanted = y1 * cn, -small * sn, y3 * dn
assert max(abs(abs(a) - abs(b)) for a, b in zip(seen, wanted, strict=True)) < 1e-13, (seen, wanted)
' || fail 'the rigid body and elliptic functions'
# the double pendulum in momenta against Lagrange's equations in velocities, by extrapolated midpoint steps
"$geomint" run double-pendulum scheme=gauss8 dt=0.0005 until=2 compensated=yes --json --state >pendulum 2>err ||
    fail "double-pendulum: $(cat err)"
python3 -c '
import json, math
def field(y):
    a, b, v, w = y
    s, c = math.sin(a - b), math.cos(a - b)
    p, q = -w * w * s - 2 * 9.81 * math.sin(a), v * v * s - 9.81 * math.sin(b)
    return v, w, (p - c * q) / (2 - c * c), (2 * q - c * p) / (2 - c * c)
def step(y, h): # Gragg, Bulirsch and Stoer, of order 12
    rows = []
    for k, n in enumerate((2, 4, 6, 8, 10, 12)):
        before, now = y, [u + h / n * f for u, f in zip(y, field(y))]
        for _ in range(n - 1):
            before, now = now, [u + 2 * h / n * f for u, f in zip(before, field(now))]
        rows.append([[(u + v + h / n * f) / 2 for u, v, f in zip(before, now, field(now))]])
        for j in range(k):
            ratio = (n / (2 * (k - j))) ** 2 - 1
            rows[k].append([u + (u - v) / ratio for u, v in zip(rows[k][j], rows[k - 1][j])])
    return rows[-1][-1]
y = [2, 2.5, 0, 0]
for _ in range(200):
    y = step(y, 0.01)
a, b, v, w = y
c = math.cos(a - b)
wanted = a, b, 2 * v + c * w, c * v + w
seen = json.load(open("pendulum"))["state"]
assert max(abs(p - q) for p, q in zip(seen, wanted, strict=True)) < 1e-12, (seen, wanted)
' || fail 'the double pendulum by two ways'
# to t = 5 the motion magnifies what is off at the start 4000 times, and solvers in double precision part by 10^-12 to 10^-9:
# held against the same extrapolation in 40 digits, whose digits 150 and 200 steps share
"$geomint" run double-pendulum scheme=gauss8 dt=0.0025 until=5 compensated=yes --json --state >pendulum 2>err ||
    fail "double-pendulum to 5: $(cat err)"
python3 -c '
import json
wanted = 8.1910784594145030, 0.015016920586249930, 3.2449248433303540, 5.1209663727083043
seen = json.load(open("pendulum"))["state"]
assert max(abs(p - q) for p, q in zip(seen, wanted, strict=True)) < 1e-12, (seen, wanted)
' || fail 'the double pendulum in 40 digits'
printf 'parameter: a = 1\nparameter: b = 2*a\nrate: x = b*x\nstart: x = a\ndt: a/10\nuntil: 1\n' >follow.system
"$geomint" run follow.system a=3,1 --json >out || fail follow
[ "$(value out parameters.b)" = 6.0 ] || [ "$(value out parameters.b)" = 6 ] || fail "b does not follow: $(cat out)"
[ "$(value out parameters.x)" = 3 ] || fail "x does not follow: $(cat out)"

# an observable of the file may leave the numbers: it has no value, with a reason, and the run is as good as before
printf 'coordinates: q\nmomenta: p\nH: (p^2+q^2)/2\nobserve: root = sqrt(q)\nobserve: pole = 1/(q - q)\n' >root.system
printf 'start: q = 1, p = 0\ndt: 0.1\nuntil: 2.5\n' >>root.system
status 0 run ./root.system --csv rows.csv
[ "$(grep -c 'none: it has no finite value in this state' out)" = 2 ] || fail "observables without a value: $(cat out)"
! grep -q -e '-nan' rows.csv || fail "a sign without a number: $(cat rows.csv)"
status 0 run ./root.system --json
grep -q '"reasons":{"root":"it has no finite value in this state","pole":"it has' out || fail "reasons: $(cat out)"
status 0 run ./root.system until=1
grep -q '^  root  *0.73' out || fail "a root: $(cat out)"
# a quotient that is infinite on the way to a finite rate
# rates and brackets stand in one line or in several
printf 'rate: x = y, y = -mu*max(x, 0)\nparameter: mu = 2\nstart: x = 1, y = 0\n' >one.system
printf 'rate: x = y\nrate: y = -mu*max(x, 0)\nparameter: mu = 2\nstart: x = 1, y = 0\n' >several.system
for words in ./one.system ./several.system "system 'rate=x = y, y = -mu*max(x, 0)' mu=2 x=1 y=0" \
    "system 'rate=x = y' 'rate=y = -mu*max(x, 0)' mu=2 x=1 y=0"; do
    eval "\"$geomint\" run $words scheme=rk4 dt=0.1 until=3 --json --state" | grep -o '"state".*' >>states || fail "$words"
done
[ "$(sort -u states | wc -l)" = 1 ] && [ "$(wc -l <states)" = 4 ] || fail "rates in one line: $(cat states)"
printf 'bracket: x y = z, y z = x, z x = y\nH: (x^2 + 2*y^2)/2\nstart: x = 1, y = 1, z = 0\n' >spin.system
"$geomint" list ./spin.system --json | grep -q '"casimirs"\|"invariants"' || fail "brackets in one line"

"$geomint" run system 'rate=y=1/(1+1/(abs(y)*sqrt(abs(y))))' y=0 dt=0.1 until=1 scheme=rk4 >out || fail 'an infinite quotient'
printf 'coordinates: q\nmomenta: p\nH: (p^2 + q^2)/2\nstart: q = pi/2, p = 1\nstop: cos(q)\n' >edge.system
"$geomint" run edge.system scheme=gauss8 dt=0.01 until=20 --json >out || fail edge
value out t | grep -q '^1.133' || fail "cos(pi/2) is 0 but for round-off: $(cat out)"
# momenta determine velocities at the start of this run too, whatever the file says of its own
printf 'coordinates: x y\nL: (x*v_x^2 + v_y^2)/2 - x^2\nstart: x = 1, y = 0, v_x = 0, v_y = 1\n' >mass.system
for scheme in variational-midpoint2 rk4; do
    refused 1 'L is singular at the start, x = 0, y = 0: momenta do not determine velocities' run ./mass.system x=0 scheme=$scheme
done
printf 'coordinates: x\nparameter: m = 1\nL: m*v_x^2/2 - x^2\nstart: x = 1, v_x = 0\n' >weight.system
refused 1 'L is singular at the start, x = 1: momenta do not determine velocities' run ./weight.system m=0 scheme=variational-midpoint2
"$geomint" run ./weight.system m=0.5 scheme=variational-midpoint2 >out || fail 'a mass of a half'
printf 'coordinates: a b\nL: (v_a^2 + sin(a)^2*v_b^2)/2\nstart: a = 1, b = 0, v_a = -1, v_b = 0\n' >pole.system
"$geomint" run pole.system dt=0.5 until=5 scheme=rk4 --json >out
[ $? = 2 ] || fail 'a singular transform, and no failure'
value out message | grep -q 'momenta do not determine velocities.* where a = 0, b = 0' || fail "singular: $(value out message)"
"$geomint" run system H='p^2/2 - sqrt(q)' q=0.1 p=-1 dt=0.1 until=3 scheme=verlet --json >out
[ $? = 2 ] || fail 'no number, and no failure'
value out message | grep -q 'sqrt(q) is not finite where q = -' || fail "a failure says: $(value out message)"

# what has an exact solution is measured by it; members are a disc, and its area is kept
printf 'rate: x = -x\nstart: x = 2\nexact: x = x(0)*exp(-t)\ndt: 0.01\nuntil: 1\n' >decay.system
"$geomint" run decay.system scheme=rk4 --json >out || fail decay
python3 -c 'import json; assert 0 < json.load(open("out"))["observables"]["solution_error"] < 1e-10' || fail exact
# a grid and a line, whose last one is in the middle; sections are those of every member
"$geomint" run system H='p^2/2 + q^2/2' q=1 p=2 members=5 spread=0.5 shape=grid steps=0 scheme=verlet --json --state >out || fail grid
grep -q '"state":\[0.5,1.5,0.5,1.5,1,1.5,1.5,2.5,2.5,2\]' out || fail "grid: $(grep -o '"state":[^]]*' out)"
"$geomint" run system H='p^2/2 + q^2/2' q=1 p=2 members=4 spread=0.5 shape=line steps=0 scheme=verlet --json --state >out || fail line
grep -q '"state":\[0.5,1,1.5,1,2,2,2,2\]' out || fail "line: $(grep -o '"state":[^]]*' out)"
"$geomint" run system H='p^2/2 + q^2/2' q=1 p=0 members=33 spread=0.1 dt=0.1 until=20 scheme=verlet --json >out || fail disc
python3 -c '
import json, math
seen = json.load(open("out"))["observables"]
assert abs(seen["area"] - math.pi * 0.01) < 1e-12 and seen["area_error"] < 1e-12, seen
' || fail 'the disc'

# an ensemble whose keys have the file's names, with tangents, and a picture of one graph; a certificate is of the motion
cat >plane.system <<'END'
coordinates: q
momenta: p
H: p^2/2 - cos(q)
start: q = 0, p = 1
tangents: 2
members: edge = 12; 3 .. 1e5; on the edge
spread: size = 0.2; 0.01 .. 1
graph: energy_error; log; show law
dt: 0.1
until: 5
END
status 0 run plane.system edge=3 size=.1 scheme=midpoint --json --strict
python3 -c '
import json
seen = json.load(open("out"))
assert seen["parameters"]["edge"] == 3 and abs(seen["observables"]["area_tangent"] - 1) < 1e-12, seen
' || fail "an ensemble of a file: $(cat out)"
status 0 render plane.system show=law scheme=midpoint -o law.svg
grep -q 'midpoint: energy error' law.svg || fail 'show= draws a graph alone'
refused 1 'the nearest is 3' run plane.system edge=2
refused 1 'did you mean edge' run plane.system edgs=5
refused 1 'has no parameter "members"' run plane.system members=5
status 0 certify verlet --on plane.system
grep -q 'symplectic  *holds' out || fail "a certificate with tangents: $(cat out)"

# momenta, a wave and an energy whose sums are 0 but for round-off: their errors are told in units of what cancels there
cat >zero.system <<'END'
coordinates: q[1..3]
momenta: p[1..3]
H: sum(i = 1 .. 3, p[i]^2/2) + sum(i = 1 .. 2, cosh(q[i+1] - q[i]))
start: q[i] = sin(3*i), p[1] = 0.1, p[2] = 0.2, p[3] = -0.3
invariant: P = sum(i = 1 .. 3, p[i])
dt: 0.1
until: 1000
END
printf 'field: u\nrate: u = -u_x - u*u_x + 0.01*u_xx\nstart: u = sin(pi*x)\nhalf_length: 1\npoints: 64\n' >wave.system
printf 'invariant: M = u\ndt: 0.01\nuntil: 2\n' >>wave.system
printf 'coordinates: x y\nL: (v_x^2 + v_y^2)/2 + 0.1*x + 0.2*y + 0.3*x*y - 0.59\nschemes: midpoint\n' >fall.system
printf 'start: x = 1, y = 1, v_x = 0.1, v_y = 0.1\ndt: 0.01\nuntil: 1\n' >>fall.system
for system in zero:P wave:M fall:energy; do
    status 0 run ./"${system%:*}".system --json --strict
    python3 -c '
import json, sys
seen = json.load(open("out"))
assert seen["observables"][sys.argv[1] + "_error"] < 1e-13 and not seen["warning"], seen
' "${system#*:}" || fail "$system: what cancels at the start"
done

status 0 run duffing members=64 --json --strict # a polygon of the members is off by 42 %
grep -q '"reasons":{"area":"the loop is not resolved with 63 points' out || fail "an edge that is not resolved: $(cat out)"

refused 1 'in H=, column 10: there is no operator' run system H='p^2/2 + 2q' q=1 p=0
grep -q '^ *^$' err || fail 'no caret below a typed formula'
refused 1 'not given: p= k=' run system H='p^2/2 + k*q^2' q=1
refused 1 'needs a formula' run system q=1
refused 1 'did you mean cos' run system H='p^2/2 + cso(q)' q=1 p=0
status 0 run system L='v_q^2/2 + cos(q)' q=1 v_q=0 dt=0.1 until=1 scheme=midpoint
cp out written
status 0 run system L='v^2/2 + cos(q)' q=1 v=0 dt=0.1 until=1 scheme=midpoint
sed 's/seconds.*//' written >one
sed 's/seconds.*//' out >two
cmp -s one two || fail 'a velocity called v is another one than v_q'
status 0 run system L='(v1^2 + v2^2)/2 - q1^2*q2^2' q1=1 q2=0.5 v1=0 v2=0.1 dt=0.1 until=1 scheme=midpoint
status 0 run system H='p^2/2 + k_q*q^2/2' q=1.5e11 p=0 k_q=1 dt=0.1 until=1 scheme=verlet
refused 1 'takes one value' run toda N=3,4
refused 1 'did you mean members' run lorenz membrs=3
refused 3 'No such file' run none.system
refused 3 'No such file' sweep none.system x=1,2
refused 3 'No such file' work-precision none.system
refused 3 'No such file' stability none.system
printf 'coordinates: q\nH: p_q^2/2\nstart: q = 1, p_q = 0\nschemes: vrlet\n' >scheme.system
refused 1 'vrlet is not a scheme' run scheme.system
refused 1 'vrlet is not a scheme' list scheme.system
sed 's/^schemes: .*/members: few/' scheme.system >members.system
refused 1 'there is no name few' run members.system
# what two systems of one name must not share
"$geomint" run system H='p^2/2 - cos(q)' q=1 p=0 dt=0.1 until=1 --checkpoint one.ck >/dev/null 2>&1 || fail checkpoint
refused 3 'checkpoint of something else' run system H='p^2/2 - 2*cos(q)' q=1 p=0 dt=0.1 until=2 --continue one.ck
"$geomint" sweep system H='p^2/2 - cos(q)' q=0.5..1:2 p=0 dt=0.1 until=1 --table one.csv >/dev/null 2>&1 || fail sweep
refused 3 'not a table of this sweep' sweep system H='p^2/2 - 9*cos(q)' q=0.5..1:2 p=0 dt=0.1 until=1 --table one.csv
"$geomint" run toda N=3 until=0.1 --save toda.csv >/dev/null 2>&1 || fail save
head -n 1 toda.csv | grep -q '^t,q\[0\],q\[1\],q\[2\],p\[0\],p\[1\],p\[2\]$' || fail "columns: $(head -n 1 toda.csv)"
printf 'coordinates: x y\nH: (p_x^2 + p_y^2)/2\nconstraint: x^2 + y^2 - 1\nstart: x = 1, y = 0, p_x = 0, p_y = 1\n' >bead.system
"$geomint" run bead.system until=10 dt=0.1 scheme=rattle2 --json | grep -q '"constraint_defect":[0-9.]*e-1[4-9]' ||
    "$geomint" run bead.system until=10 dt=0.1 scheme=rattle2 --json | grep -q '"constraint_defect":0' || fail 'a bead on its ring'
refused 1 'the start violates the constraints: their residual is 3' run bead.system x=2 until=1
refused 1 'needs\|lacks\|fit' run bead.system scheme=verlet until=1
sed 's/(p_x^2 + p_y^2)/(1 + x^2)*(p_x^2 + p_y^2)/' bead.system >heavy.system
refused 1 'constraints take L, or H = T(p) + V(q) with a quadratic T' run heavy.system until=1
refused 1 'in H=, column 7: H is not finite at the start' run system H='p^2/2+log(q)' q=-1 p=0
printf 'components: x\nparameter: a = 1\nparameter: k = 2*a; 0 .. 3\nrate: x = -k*x\nstart: x = 1\nuntil: 1\n' >range.system
refused 1 'k is 18 with these values' run range.system a=9
sed 's/^until: .*/dt: -0.1/' range.system >dt.system
refused 1 'dt.system:6:5: dt is -0.1' run dt.system
printf 'coordinates: q\nH: p_q^2/2 + q\nobserve: energy_error = q\nstart: q = 1, p_q = 0\n' >twice.system
refused 1 'two observables energy_error' run twice.system
printf 'title: evil \033[31m\nrate: x = -x\nstart: x = 1\n' >wild.system
status 0 list wild.system
grep -q "$(printf '\033')" out && fail 'an escape of a file reached the terminal'
"$geomint" stability driven-pendulum scheme=rk4 eps=0 q=0 until=2 --out maps 2>err | grep -q '^ω is .*: 1 here$' ||
    fail 'stability does not tell its unit'
"$geomint" complete run doub | grep -q '^double-pendulum' || fail 'systems are not completed'
"$geomint" complete run lorenz rh | grep -q '^rho=' || fail 'keys of systems are not completed'

# a solitary wave of Serre's equations comes around the ring in its exact shape, to order 2; by midpoint the momentum is
# kept, by averages along the step the energy too; two that meet stand higher than both together
length='30/sqrt(1.3)'
for steps in 66 132; do
    "$geomint" run serre scheme=midpoint N=$((30 * steps / 66)) "dt=$length/$steps" "until=$length" --json >wave$steps.json
done
"$geomint" run serre scheme=avf2 N=20 until=10 --json >wave.json
"$geomint" run serre scheme=midpoint B=0.3 s=7 dt=0.1 until=6.3 --json --state >meeting.json
python3 -c '
import json, math
def observed(name):
    return json.load(open(name))["observables"]
coarse, fine, kept = observed("wave66.json"), observed("wave132.json"), observed("wave.json")
assert 0.011 < fine["shape_error"] < 0.012 and 1.85 < math.log2(coarse["shape_error"] / fine["shape_error"]) < 2.1
assert fine["momentum_error"] < 1e-14 and 1e-9 < fine["energy_error"] < 1e-6
assert kept["momentum_error"] < 1e-14 and kept["energy_error"] < 1e-14
x = json.load(open("meeting.json"))["state"][:60]
# the water above the depth of two waves A/cosh(kx)^2, A/k tanh(kx) of it from the crest on
k, D = math.sqrt(0.9 / 1.3) / 2, 0.5
def above(i):
    place = -15 + i * D
    return 0.3 / k * (math.tanh(k * (place + 7)) + math.tanh(k * (place - 7)))
heights = [(D + above(i + 1) - above(i)) / (x[i + 1] - x[i]) - 1 for i in range(59)]
assert 0.6 < max(heights) < 0.68, max(heights)
print(coarse, fine, kept, max(heights))
' >out 2>&1 || fail "waves of Serre: $(cat out)"

# the camera
cat >space.system <<'END'
components: x y z
parameter: a = 1
rate: x = y
rate: y = -x
rate: z = 0
start: x = 1, y = 0, z = 0
view: x, y, z
surface: sphere; a
until: 1
END
refused 1 'zoom' render space.system zoom=0 -o space.png
refused 1 'elevation' render space.system elevation=200 -o space.png
refused 1 'azimuth' render space.system azimuth=x -o space.png
refused 1 'the size of a surface is -1' render space.system a=-1 -o space.png
refused 1 'a plane is shown' render space.system show=x:y azimuth=3 -o space.png
refused 1 'azimuth' render duffing azimuth=3 -o space.png
# names over time, trails, the phase portrait
refused 1 'show=t: needs a name; the names are x, y' run lotka-volterra show=t:
refused 1 'show=t:x+ needs a name before and after each +; the names are x, y' run lotka-volterra show=t:x+
refused 1 'show=t:+x needs a name before and after each +' run lotka-volterra show=t:+x
refused 1 'show=t:y+x+y has y twice' run lotka-volterra show=t:y+x+y
refused 1 'show=x:nope is none of: all, t:all, x:y, t:NAME; did you mean x:y' run lotka-volterra show=x:nope
refused 1 'show=q1:p3 is none of: .*; did you mean q1:p1' run kepler show=q1:p3
refused 1 'there is no "angular_momentu"; did you mean angular_momentum; the names are q1, q2, p1, p2, energy' \
    run kepler show=t:angular_momentu
refused 1 'has 9 names; a graph has at most 8' run lorenz show=t:x+y+z+x+y+z+x+y+z
refused 1 'a graph has at most 8 names, and this system has 36 components' run outer-planets show=t:all
refused 1 'show=sideways is none of: all, t:all, x:y, t:NAME' run lotka-volterra show=sideways
refused 1 'trails=-1 is not yes, no or a time above 0' run vortices trails=-1
refused 1 'portrait needs a plane: this system has 4 components' run kepler portrait=yes
refused 1 'portrait needs a field that does not depend on t' run duffing portrait=yes
refused 1 'portrait needs a plane: this system has constraints' run cartesian-pendulum portrait=yes
{
    printf 'geomint: 1\nchoice: state = plane of plane, space; which\nwhen: state = plane\ncomponents: x y\n'
    printf 'rate: x = y\nrate: y = -x\nstart: x = 1, y = 0\nwhen: state = space\ncomponents: x y z\n'
    printf 'rate: x = y\nrate: y = -x\nrate: z = -z\nstart: x = 1, y = 0, z = 1\n'
} >states.system
refused 1 'portrait needs a plane: this system has 3 components' run ./states.system state=space portrait=yes
refused 1 'show=t:z: there is no "z"' run ./states.system show=t:z
status 0 run ./states.system state=space show=t:z until=1
sed -i 's/plane of plane/space of plane/' states.system
refused 1 'portrait needs a plane: this system has 3 components' run ./states.system portrait=yes
status 0 run ./states.system state=plane portrait=yes until=1
refused 1 'window=1,0,0,1 is empty' run lotka-volterra portrait=yes --window 1,0,0,1
refused 1 'window=nan is not four finite numbers' run lotka-volterra portrait=yes --window nan
refused 1 'the rate of x is not finite at the start' run system rate='x = sqrt(-1 - x^2)' rate='y = x' x=1 y=0 portrait=yes
damped() {
    status 0 run system rate='x = y' rate='y = -sin(x) - 0.3*y' x=1 y=0 steps=5 portrait=yes "$@"
}
damped --window -4,4,-3,3 --json
python3 - <<'END' || fail "equilibria: $(cat out)"
import json
saddle, focus, other = json.load(open('out'))['equilibria']
assert saddle['kind'] == other['kind'] == 'saddle' and focus['kind'] == 'stable focus'
assert abs(saddle['at'][0] + 3.141592653589793) < 1e-12 and abs(other['at'][0] - 3.141592653589793) < 1e-12
assert abs(saddle['eigenvalues'][0][0] - 0.8611874) < 1e-7 and abs(saddle['eigenvalues'][1][0] + 1.161187) < 1e-6
assert abs(focus['eigenvalues'][0][0] + 0.15) < 1e-12 and abs(focus['eigenvalues'][0][1] - 0.9886859) < 1e-6
END
damped --window 4,5,1,2 --json
grep -qF '"equilibria":[]' out || fail "a window without equilibria: $(cat out)"
damped --window 4,5,1,2
grep -q 'equilibrium  *none in the window' out || fail "a window without equilibria: $(cat out)"
status 0 run system rate='x = sqrt(1.5 - x)' rate='y = x' x=1 y=0 dt=0.01 steps=1 portrait=yes --window 2,3,0,1 --json
grep -qF '"equilibria":"the field is nowhere finite in the window"' out || fail "a field without values: $(cat out)"
status 0 run system rate='x = y' rate='y = x*y' x=1 y=1 dt=0.01 steps=1 portrait=yes --window -1,2,-1,2 --json
grep -qF '"equilibria":"equilibria fill a curve, which is not listed"' out || fail "a line of equilibria: $(cat out)"
"$geomint" render lotka-volterra show=t:x+y portrait=no trails=1 until=1 -o time.png 2>/dev/null &&
    "$geomint" again time.png -o again.png 2>/dev/null && cmp -s time.png again.png || fail 'again, over time'
sed 's/; a$/; x/' space.system >moves.system
refused 1 'moves.system:8:10: a surface does not move' run moves.system
"$geomint" render space.system scheme=rk4 azimuth=20 elevation=-5 zoom=2 turn=3 -o space.png 2>/dev/null &&
    "$geomint" again space.png -o again.png 2>/dev/null || fail 'again, in space'
cmp -s space.png again.png || fail 'a picture in space is another one again'
"$geomint" render space.system scheme=rk4 azimuth=21 elevation=-5 zoom=2 turn=3 -o other.png 2>/dev/null
cmp -s space.png other.png && fail 'the azimuth changes nothing'

# their names
refused 1 'did you mean lorenz' run lorentz
status 0 list systems
grep -q '^lorenz  *The butterfly' out || fail "list systems: $(head -n 3 out)"

[ $failures = 0 ] && echo 'all as it should be'
exit $failures
