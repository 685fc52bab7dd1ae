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

# a field: an explicit scheme beyond its limit says so; another V stands behind the name; a ring that is open is refused
# before it blows up, too
"$geomint" run phi4 scheme=leapfrog dt=0.11 steps=1 half_length=40 points=800 --json | grep -q '"longest_step":0.0997' ||
    fail 'phi4: the longest step is not told'
"$geomint" run phi4 scheme=leapfrog dt=0.11 until=1000 half_length=40 points=800 --json >out 2>err
[ $? = 2 ] && grep -q 'beyond 0.0997.*, the limit of linear theory' out || fail "phi4 beyond the limit: $(cat out err)"
"$geomint" run klein-gordon V=0 steps=1 --json >out 2>err || fail "klein-gordon V=0: $(cat err)"
"$geomint" run double-sine-gordon half_length=1 2>err
[ $? = 1 ] && grep -q 'ring' err || fail "double-sine-gordon on a short ring: $(cat err)"

# a step that is tied to a parameter follows it, or sets it; the laws of a variable mesh belong to waves without a potential
for words in dt=0.05 courant=0.572957795130823; do
    "$geomint" run wave $words steps=1 --json >out 2>err || fail "wave $words: $(cat err)"
    python3 -c 'import json, math
given = json.loads(open("out").readline())["parameters"]
assert abs(given["dt"] - 0.05) < 1e-15 and abs(given["courant"] - 0.05 * 72 / (2 * math.pi)) < 1e-14, given' ||
        fail "wave $words: $(cat out)"
done
refused 1 'dt= and courant= are both given; one of them follows from the other' run wave dt=0.1 courant=0.5
printf 'field: u\nV: u^2/2\nparameter: c = 0.5\nstart: u = 0, u_t = 0\ntie: dt = 2*c\n' >tied.system
refused 1 'tie: is the step as a multiple of a parameter, as in dt = courant\*dx' run ./tied.system
printf 'field: u\nV: u^2/2\nstart: u = 0, u_t = 0\nhook: mesh-laws\n' >hooked.system
refused 1 'the hook "mesh-laws" is for waves without a potential, V: 0' run ./hooked.system

# on a moving mesh: the scheme says so, and a picture of it is made again
"$geomint" run phi4 scheme=multiplier-lobatto4 points=31 until=2 --measure energy_error,smallest_cell --json >out 2>err ||
    fail "phi4 on a moving mesh: $(cat err)"
python3 -c 'import json, sys
seen = json.loads(open("out").readline())["observables"]
assert seen["energy_error"] < 1e-5 and 0 < seen["smallest_cell"] < 60 / 32, seen' || fail 'phi4 on a moving mesh'
"$geomint" render phi4 scheme=multiplier-lobatto4 points=31 until=1 --size 200x120 -o first.svg 2>err &&
    "$geomint" again first.svg -o second.svg 2>err && cmp -s first.svg second.svg || fail "phi4, again: $(cat err)"
"$geomint" run phi4 scheme=multiplier-lobatto4 points=31 until=2 --checkpoint half 2>err >out &&
    "$geomint" run phi4 scheme=multiplier-lobatto4 points=31 until=4 --continue half --json --state >out 2>err &&
    "$geomint" run phi4 scheme=multiplier-lobatto4 points=31 until=4 --json --state >whole 2>err || fail "phi4, continued: $(cat err)"
sed 's/"seconds":[^,]*,//' out >continued
sed 's/"seconds":[^,]*,//' whole | cmp -s continued - || fail 'phi4 on a moving mesh goes on otherwise'
refused 1 'some of these schemes move their mesh' run phi4 scheme=box,multiplier-lobatto4
refused 1 'between 1 and 100000' run phi4 scheme=multiplier-lobatto4 points=0
printf 'field: u\nV: u^2/2\nstart: u = exp(-x^2), u_t = 1\n' >restless.system
refused 1 'held at both ends' run ./restless.system scheme=uniform-gauss2
printf 'field: u\nV: u^2/2\nboundary: walls\nstart: u = exp(-x^2), u_t = 0\n' >walled.system
refused 1 'the ends of a moving mesh hold u' run ./walled.system scheme=uniform-gauss2
printf 'field: u\nV: u^2/2\nstart: u = 1/(x - 20), u_t = 0\n' >restless.system
refused 1 'not finite where x = 20' run ./restless.system scheme=control-gauss4
printf 'components: u v\nK-matrix: 0, 1/0 | -1/0, 0\nL-matrix: 0, 1 | -1, 0\nS: u^2 + v^2\nstart: u = 0, v = 0\n' >restless.system
refused 1 'an entry of K is not a finite number' run ./restless.system
rm restless.system walled.system half whole continued

# certified on what somebody typed, on three nodes where nothing is said
status 0 certify multiplier-trapezoidal --on phi4
grep -q 'order 2, measured [12]\..* (phi4)' out && grep -q 'M multisymplectic *holds' out || fail "phi4, certified: $(cat out)"
status 0 certify multiplier-trapezoidal --on phi4 points=7
grep -q 'the law is measured on 3 nodes' out || fail "phi4 on 7 nodes, certified: $(cat out)"
refused 1 'on takes systems of at most 28 components' certify multiplier-lobatto4 --on phi4 points=8
# and on rings, between walls, by matrices and by rates, on grids of their own
status 0 certify leapfrog --on phi4
grep -q 'order 2, measured [12]\..* (phi4)' out && grep -q 'M multisymplectic *holds' out &&
    grep -q 'H conserves energy *not claimed *defect' out || fail "phi4 on a ring, certified: $(cat out)"
status 0 certify energy-conserving --on phi4 boundary=walls
grep -q 'H conserves energy *holds' out && grep -q 'no quadratic invariant' out || fail "phi4, walls, certified: $(cat out)"
# round-off of many cells is not the scheme's; sanitizers see no more in as many
many=$(grep -qa __asan_init "$geomint" && echo 800 || echo 4000)
status 0 certify gauss-box3 --on phi4 points=$many
grep -q 'M multisymplectic *holds' out && grep -q '= symmetric *holds' out ||
    fail "phi4 on many points, certified: $(cat out)"
status 0 certify box --on phi4 points=$many
grep -q 'M multisymplectic *holds' out || fail "phi4 on many points, box: $(cat out)"
status 0 certify leapfrog --on phi4 dt=0.16
grep -q 'measured nowhere: dt is beyond' out || fail "phi4, long steps, certified: $(cat out)"
status 0 certify box --on nonlinear-dirac points=201
grep -q 'Q conserves quadratic invariants *not claimed *defect .*e-1[4-6] (charge_error)' out ||
    fail "nonlinear-dirac, certified: $(cat out)"
# of more stages the charge is that of the stages: of means in cells its error would be the grid's, 1e-6
status 0 run nonlinear-dirac scheme=gauss-box3 dt=0.05,0.0125 until=0.5 --max --measure charge_error --json
python3 -c '
import json, sys
errors = [json.loads(line)["observables"]["charge_error_max"] for line in open("out")]
assert len(errors) == 2 and max(errors) < 1e-12, errors
' || fail "nonlinear-dirac by gauss-box3: $(cat out)"
# central differences do not keep what midpoint would: it is not blamed for that
status 0 certify midpoint --on bbm
grep -q 'L conserves linear invariants *holds *defect .* (mass_error)' out &&
    grep -q 'Q conserves quadratic invariants *not measured *no quadratic' out || fail "bbm, certified: $(cat out)"
printf 'field: u v\nrate: u = v\nrate: v = u_xx - sin(u) - v/10\nstart: u = exp(-x^2), v = 0\ninvariant: mass = u\npoints: 101\ndt: 0.05\n' >own.system
status 0 certify rk4 --on own.system
grep -q 'L conserves linear invariants *not measured' out || fail "a mass that nothing keeps, certified: $(cat out)"
printf 'field: u\nrate: u = u_xx\nstart: u = 1 + cos(pi*x/20)\nboundary: walls\ninvariant: mass = u\npoints: 101\ndt: 0.05\n' >own.system
status 0 certify midpoint --on own.system
grep -q 'L conserves linear invariants *holds' out || fail "heat between walls, certified: $(cat out)"
printf 'geomint: 1\nkind: runge-kutta\norder: 1\nclaims: symmetric\na: 0\nb: 1\n' >false.scheme
status 4 certify false.scheme --on own.system
grep -q '= symmetric *BROKEN' out || fail "Euler's method as a symmetric one, on a field: $(cat out)"
# numbers that are large beside others stop no reference, and refute nothing
printf 'field: u\nrate: u = -u_x - u_xxx\nspace: fourier\nstart: u = 1e6*exp(-x^2)\nhalf_length: 10\npoints: 64\n' >large.system
printf 'dt: 0.01\nuntil: 1\n' >>large.system
status 0 certify midpoint --on large.system
printf 'coordinates: q\nH: p_q^2/2 + (q - 1e6)^2/2\nstart: q = 1000001, p_q = 0\ndt: 0.1\nuntil: 1\n' >shifted.system
status 0 certify midpoint --on shifted.system
grep -q 'conserves quadratic invariants  *not measured round-off' out || fail "an energy small beside q: $(cat out)"
rm own.system false.scheme large.system shifted.system
status 0 certify box --on kdv
grep -q 'without --on it is measured' out || fail "kdv, certified: $(cat out)"
refused 1 'waves on a line or on moving meshes; cavity is none' certify steady --on cavity

# where a scheme has no local law the empty surface says so, however small it is
status 0 render phi4 scheme=box,leapfrog,gauss-box3,energy-conserving,lobatto-box4,euler-box show=momentum-law until=1 \
    --size 640x360 -o laws.svg
[ "$(grep -c 'such law' laws.svg)" = 2 ] || fail "two surfaces without a law say it $(grep -c 'such law' laws.svg) times"
rm laws.svg

# what schemes of moving meshes cost is measured against more nodes: each strategy has a motion of its own on given ones
status 0 work-precision phi4 scheme=multiplier-lobatto4,control-gauss4,uniform-gauss4 until=2
[ "$(awk '/^(multiplier|control|uniform)/ && $NF < 0.01' out | wc -l)" = 3 ] || fail "phi4, work-precision: $(cat out)"
rm -f phi4-work-precision.*

# an exact solution that begins elsewhere, or a step that leads nowhere, is no run: it was one of nonsense
bump='start: u = exp(-x^2), u_t = 0\nhalf_length: 10\npoints: 100\ndt: 0.05\nuntil: 1\n'
# a_field LINES: with that start
a_field() { printf "field: u\n$1\n$bump" >own.system; }
for scheme in box uniform-gauss4; do
    a_field 'V: u^2\nexact: u = exp(-x^2) + 1'
    refused 1 'own.system:3:8: exact: u would begin at 1 where x = -10, and it starts at 3.7' run own.system scheme=$scheme
done
a_field 'V: u^2\nexact: u = exp(-x^2)/(1 - 20*t)'
refused 1 'u is not finite where x = -10 one step after the start' run own.system
printf 'field: u\nV: u^2\nhalf_length: 10\nstart: u = exp(-x^2), u_t = sqrt(x + 9)\n' >own.system
refused 1 '^geomint: u_t at the start is not finite where x = -10$' run own.system
for potential in 'log(u)' 'sqrt(u)'; do
    a_field "V: $potential"
    refused 1 'one step after the start: V. is too large there, or dt = 0.05 too long' run own.system
done
a_field 'parameter: alpha = 3\nV: alpha*u^2'
refused 1 'alpha is a key of moving meshes' run own.system scheme=uniform-gauss4
status 0 run own.system
# keys of the ring are names of formulas, and the words of a choice are fields of one kind
a_field 'V: u^2\nrequire: 11 - half_length; the ring is too long: {half_length}'
status 0 run own.system
refused 1 'the ring is too long: 12' run own.system half_length=12
a_field 'V: u^2\nstability: until=1; half_length 5, 10; lost energy_error'
refused 1 'stability: a field needs a unit and steps' run own.system
printf 'choice: kind = a of a, b; two\nfield: u\nwhen: kind = a\nV: u^2\nstart: u = 0, u_t = 0\nwhen: kind = b\nrate: u = -u_x\nstart: u = 0\n' >own.system
refused 1 'choice: kind=b is another equation, and other words are of one kind' run own.system
# an equation that is recognised by its rates has the state of the schemes for it alone, where they are asked for
printf 'field: u\nrate: u = -2*u_xxx - 6*u_x*u\nstart: u = 2/cosh(x/sqrt(2))^2\nhalf_length: 15; left 0\npoints: 64\ndt: 0.001\ninvariant: mass = u\n' |
    sed 's|x/sqrt|(x - 15)/sqrt|' >own.system
status 0 list own.system --long
grep -q 'Korteweg-de Vries, eta = 6, mu = 2' out || fail "the equation is not recognised: $(cat out)"
for scheme in box zabusky-kruskal rk4 etdrk4; do
    status 0 run own.system scheme=$scheme until=0.1 --json --state
    python3 -c '
import json
run = json.load(open("out"))
highest = max(range(64), key=lambda i: run["state"]["u"][i] if isinstance(run["state"], dict) else run["state"][i])
assert abs(run["observables"]["mass_error"]) < 1e-12 and 32 <= highest <= 34, highest
' || fail "own.system by $scheme: $(cat out)"
done
refused 1 'some of these schemes are for this equation alone' run own.system scheme=box,rk4
refused 1 'split-step2' run own.system scheme=split-step2
printf 'rate: u = -u_x\nfield: u\nstart: u = cos(pi*x/20)\ninvariant: mass = u; on edges\n' >own.system
refused 1 'mass: an integral is on nodes or on cells, not on edges' run own.system
# what has corners in parameters alone is smooth
a_field 'parameter: k = 1\nV: abs(k)*u^2'
status 0 run own.system k=-3
bump='start: u = exp(-x^2)\nhalf_length: 10\npoints: 40\ndt: 0.01\nuntil: 0.1\n'
a_field 'rate: u = u_xx\nexact: u = exp(-x^2)*t + 5'
refused 1 'own.system:3:8: exact: u would begin at 5' run own.system
a_field 'rate: u = log(u_x)'
refused 1 'the rate of u at the start is not finite where x = -10' run own.system
a_field 'rate: u = abs(u_x)\nobserve: r = log(u - 5)'
status 0 run own.system
grep -q 'r  *none: its density is not finite everywhere' out || fail "a density: $(cat out)"
status 0 list own.system --long
grep -q 'linear part *no *nothing is linear' out && grep -q 'smooth *no *abs(u_x) (line 2, column 11)' out ||
    fail "abs(u_x): $(cat out)"
status 0 certify rk4 --on own.system
grep -q 'the system is not smooth' out || fail "abs(u_x), certified: $(cat out)"
rm own.system

# value FILE KEY: of the first lane
value() {
    python3 -c 'import json, sys; run = json.loads(open(sys.argv[1]).readline())
for key in sys.argv[2].split("."): run = run[int(key) if key.isdigit() else key]
print(run)' "$1" "$2"
}

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

# a run that is stopped is well; one that leads to no number says where
printf 'rate: x = -1\nstart: x = 1\nstop: x\ndt: 0.125\nuntil: 3\n' >stop.system
"$geomint" run stop.system --json >out || fail 'a stopped run is not well'
python3 -c 'import json, sys
end = json.load(open("out"))
sys.exit(not (end["stopped"] and 0 <= end["t"] - 1 < 1e-14 and end["steps"] == 9))' || fail "stopped: $(cat out)"
printf 'coordinates: x\nH: (p_x^2 + x^2)/2\nstart: x = 1, p_x = 0\nstop: x\nuntil: 100\n' >quarter.system
"$geomint" run quarter.system scheme=gauss8 dt=0.1 --json --state >out || fail quarter
python3 -c 'import json, math; end = json.load(open("out")); assert abs(end["t"] - math.pi/2) < 1e-12 and abs(end["state"][0]) < 1e-15' ||
    fail "a quarter of a turn: $(cat out)"
"$geomint" work-precision quarter.system scheme=gauss8,verlet --json >out || fail 'work-precision of what is stopped'
python3 -c '
import json
points = [point for line in open("out") for point in json.loads(line)["points"]]
assert points and all(1.5 < point["t"] < 1.6 and point["status"] == "ok" for point in points), points
' || fail "work-precision does not stop: $(cat out)"
# what begins where it would stop, or on its section, has not passed it, whichever way it goes
for way in -1 1; do
    printf 'coordinates: x y\nH: (p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)\nstart: x = 1, y = 0, p_x = 0, p_y = %s\nstop: y\n' $way >half.system
    "$geomint" run half.system scheme=gauss8 dt=0.01 until=20 --json >out || fail half
    python3 -c 'import json, math; end = json.load(open("out")); assert end["stopped"] and abs(end["t"] - math.pi) < 1e-12' ||
        fail "half a turn: $(cat out)"
    sed 's/stop: y/section: y = 0; x, p_x/' half.system >turns.system
    "$geomint" run turns.system scheme=gauss8 dt=0.01 until=10 --json --save-tracks turns.npz >out || fail turns
    python3 - turns.npz <<'END' || fail "sections from the start on, p_y = $way"
import array, math, sys, zipfile
with zipfile.ZipFile(sys.argv[1]) as tracks:
    name = next(name for name in tracks.namelist() if "section" in name and name.endswith("t.npy"))
    times = array.array("d", tracks.read(name)[128:])
assert [round(t / math.pi, 9) for t in times] in ([1, 2, 3], [2], [1, 3]), times
END
done
# gone on with from a checkpoint, a run stops where the undisturbed one does
for start in 'q = 0, p = 1' 'q = 1e-17, p = -1'; do
    printf 'coordinates: q\nmomenta: p\nH: (p^2 + q^2)/2\nstart: %s\nstop: q\ndt: 0.01\n' "$start" >on.system
    "$geomint" run on.system until=20 >whole || fail 'on the surface'
    "$geomint" run on.system steps=50 --checkpoint on.check >/dev/null || fail 'a checkpoint'
    "$geomint" run on.system until=20 --continue on.check >parts || fail 'gone on with'
    [ "$(grep -v seconds whole)" = "$(grep -v seconds parts)" ] || fail "gone on with, it stops elsewhere: $(cat parts)"
done
# an event changes the state, all at once, and the energy is measured against what it leaves; closed forms are parabolas
printf 'parameter: r = 0.8\ncoordinates: y\nmomenta: v\nH: v^2/2 + 9.8*y\nevent: y = 0, v < 0; v = -r*v\nstart: y = 50, v = 0\ndt: 0.1\n' >ball.system
"$geomint" run ball.system scheme=gauss4 until=10 --json --state >out || fail 'a ball'
python3 -c '
import json, math
end, r, g, t, v = json.load(open("out")), 0.8, 9.8, math.sqrt(100/9.8), math.sqrt(2*9.8*50)
n = 0
while t + 2*r*v/g < 10:
    v, n, t = r*v, n + 1, t + 2*r*v/g
v, n = r*v, n + 1
height = v*(10 - t) - g*(10 - t)**2/2
kept = end["observables"]
assert abs(end["state"][0] - height) < 1e-9 and abs(end["state"][1] - (v - g*(10 - t))) < 1e-9, (end, height)
assert kept["events"] == n == 2 and kept["energy_error"] < 1e-12, kept
assert abs(kept["event_work"] - 490*(r**4 - 1)) < 1e-9, kept
' || fail "a ball: $(cat out)"
# the velocity over time is three pieces of a line: no stroke joins what a bounce has left to what it makes
"$geomint" render ball.system scheme=gauss4 until=10 show=t:v -o ball.svg >out || fail 'a picture of a ball'
python3 -c '
import xml.etree.ElementTree as tree
lines = [path.get("d") for path in tree.parse("ball.svg").iter() if path.get("stroke") and path.get("d")]
assert any(line.count("M") == 3 and line.count("l") == 3 for line in lines), lines
' || fail 'a line joins the velocities before and after a bounce'
"$geomint" run ball.system scheme=explicit-euler until=10 --json >out || fail 'a ball of Euler'
python3 -c 'import json; assert json.load(open("out"))["observables"]["energy_error"] > 1e-2' || fail "a ball of Euler: $(cat out)"
printf 'rate: x = v, v = 0, w = 0\ninvariant: V = v\ninvariant: W = w\nstart: x = 0, v = 1, w = 3\nevent: x = 1; v = 2*v\nevent: x = 2; w = w + 1/4\n' >gate.system
"$geomint" run gate.system scheme=rk4 until=3 --json >out || fail 'invariants that events change'
python3 -c 'import json; kept = json.load(open("out"))["observables"]; assert kept["events"] == 2 and kept["V_error"] == kept["W_error"] == 0, kept' || fail "invariants that events change: $(cat out)"
"$geomint" run kepler --measure projection,relaxation steps=4 --json >out || fail 'no corrections'
python3 -c 'import json; why = json.load(open("out"))["reasons"]; assert "not projected" in why["projection"] and "not relaxed" in why["relaxation"], why' || fail "no corrections: $(cat out)"
printf 'choice: kind = one of one, two; which\nrate: x = v, v = 0, w = 0\nstart: x = 0, v = 1, w = 3\nevent: x = 1; v = 2*v\nevent: x = 2; w = w + 1/4\ninvariant: W = w\nwhen: kind = two\nobserve: a = x\nobserve: b = v\ninvariant: V = v\nwhen: always\nuntil: 3\n' >gates.system
"$geomint" run gates.system kind=two scheme=rk4 --json >out || fail 'events of another word of a choice'
python3 -c 'import json; kept = json.load(open("out"))["observables"]; assert kept["b"] == 2 and kept["V_error"] == kept["W_error"] == 0, kept' || fail "events of another word of a choice: $(cat out)"
printf 'choice: kind = one of one, two; which\nmesh: strip 1 n\nparameter: n = 2; 1 .. 60; triangles in a row\nunknown: u = 0-form\nequation: u; u = 2 + 3*x^2\nwhen: kind = two\nobserve: least = min(u)\nwhen: always\nobserve: largest = max(u)\n' >strip.system
"$geomint" run strip.system kind=two --json >out || fail 'forms of another word of a choice'
python3 -c 'import json; found = json.load(open("out"))["observables"]; assert abs(found["least"] - 2) < 1e-9 and found["largest"] > 4, found' || fail "forms of another word of a choice: $(cat out)"
"$geomint" run ball.system scheme=gauss4 until=40 --json >out
[ $? = 2 ] && value out status | grep -q events-accumulate || fail "bounces accumulate: $(cat out)"
python3 -c 'import json, math; t = json.load(open("out"))["t"]; assert abs(t - math.sqrt(100/9.8)*(1 + 2*.8/.2)) < 1e-9, t' || fail "bounces accumulate at $(value out t)"
# adaptive schemes, schemes with a memory and a library's end their steps at events, too
python3 - "$geomint" <<'END' || fail 'events of adaptive schemes'
import json, math, subprocess, sys
def run(*words, code=0):
    done = subprocess.run([sys.argv[1], "run", *words, "--json", "--state"], capture_output=True, text=True)
    assert done.returncode == code, (words, done)
    return json.loads(done.stdout)
for scheme, near in ("dopri5", 1e-11), ("tao2", 0.05), ("projected(rk4; invariants: H)", 1e-11), \
        ("relaxed(rk4; invariants: H)", 1e-9), ("gsl-rk8pd", 1e-5), ("gsl-msadams", 1e-5):
    end = run("ball.system", "scheme=" + scheme, "until=10")
    assert abs(end["t"] - 10) < 1e-10 and end["observables"]["events"] == 2, end
    assert abs(end["state"][0] - 19.88043459390461) < near and abs(end["state"][1] - 3.428043459390466) < near, end
accumulate = run("ball.system", "scheme=dopri5", "until=40", code=2)
assert accumulate["status"] == "events-accumulate" and abs(accumulate["t"] - 28.749445424997305) < 1e-9, accumulate
# events at the ends of steps, up to round-off, do not accumulate: a point between two walls
with open("box.system", "w") as file:
    file.write("rate: x = v, v = 0\nevent: x = 0; v = -v\nevent: x = 1; v = -v\nstart: x = 0.5, v = 1\nuntil: 1000\n")
for words in [["scheme=rk4", dt] for dt in ("dt=0.1", "dt=0.03", "dt=0.5", "dt=2.5")] + [["scheme=dopri5", "dt=0.1"]]:
    end = run("box.system", *words)
    assert end["observables"]["events"] == 1000 and abs(end["state"][0] - 0.5) < 1e-9 and end["state"][1] == 1, (words, end)
# a comet between walls: schemes in times of their own meet dopri5's numbers, and the end
with open("comet.system", "w") as file:
    file.write("coordinates: x y\nH: (p_x^2 + p_y^2)/2 - 1/sqrt(x^2 + y^2)\nmonitor: 1/sqrt(x^2 + y^2)\n"
               "event: wall; x = -0.8; p_x = -p_x\nstart: x = 0.5, y = 0, p_x = 0, p_y = sqrt(3)\nuntil: 20\n")
exact = run("comet.system", "scheme=dopri5", "dt=0.02", "tolerance=1e-13")["state"]
for scheme, near in ("logh-kahan-li8", 1e-8), ("controlled-kahan-li8", 1e-6), ("poincare-gauss8", 1e-6), ("levi-civita", 1e-4):
    end = run("comet.system", "scheme=" + scheme, "dt=0.005")
    assert end["observables"]["events"] == 12 and abs(end["t"] - 20) < 1e-10, (scheme, end)
    assert max(abs(a - b) for a, b in zip(end["state"], exact)) < near, (scheme, end, exact)
END
# no order is measured where every step is exact
"$geomint" certify dopri5 --on ball.system >out && grep -q 'order 5, measured nowhere' out || fail "dopri5 on parabolas: $(cat out)"
# without a rebound it comes to rest, and does not fall through the ground; nor upwards, nor where a later force lifts it
"$geomint" run ball.system r=0 scheme=gauss4 until=40 --json >out
[ $? = 2 ] && value out status | grep -q events-accumulate || fail "a ball without a rebound: $(cat out)"
python3 -c 'import json, math; end = json.load(open("out")); assert abs(end["t"] - math.sqrt(100/9.8)) < 1e-9 and end["observables"]["events"] == 1, end' || fail "a ball without a rebound: $(cat out)"
for rests in 'p = 1:-1:-1:2' 'p = -1:1:1:2' 'p = 1:1:-3:0'; do
    IFS=: read -r rate start speed wanted <<END
$rests
END
    printf 'rate: q = p, %s\nevent: q = 0; q = 0, p = 0\nstart: q = %s, p = %s\nuntil: 10\ndt: 0.1\n' "$rate" "$start" "$speed" >rest.system
    "$geomint" run rest.system scheme=rk4 --json >out
    [ $? = "$wanted" ] && [ "$(grep -o '"events":1\b' out)" ] || fail "at rest on its surface, $rests: $(cat out)"
done
# a g that is flat, steep or without a value at 0, or that leaves it in another piece, passes 0 as y does
while read -r g; do
    sed "s/event: y/event: $g/" ball.system >flat.system
    "$geomint" run flat.system scheme=gauss4 until=10 --json --state >out || fail "a ball, $g: $(cat out)"
    python3 -c '
import json, math
end, r, g, t, v, n = json.load(open("out")), 0.8, 9.8, math.sqrt(100/9.8), math.sqrt(980), 0
while t + 2*r*v/g < 10:
    n, t, v = n + 1, t + 2*r*v/g, r*v
s = 10 - t
y = r*v*s - g*s*s/2
assert end["observables"]["events"] == n + 1 == 2 and abs(end["state"][0] - y) < 1e-8, (end, y)
' || fail "a ball, $g: $(cat out)"
done <<'END'
y^3
y*abs(y)
if(y > 0, y^2, -y^2)
sign(y)*sqrt(abs(y))
sqrt(y)
END
# a motion that passes where g is flat does not rest there
printf 'rate: x = 1, y = 0\nevent: (x - 1)^3 = 0; y = y + 1\nstart: x = -2, y = 0\nuntil: 6\n' >flat.system
for dt in 0.1 0.037 1; do
    "$geomint" run flat.system dt=$dt until=5.92 scheme=rk4 --json --state >out || fail "a flat surface, dt=$dt: $(cat out)"
    grep -q '"events":1\b' out || fail "a flat surface, dt=$dt: $(cat out)"
done
# a start on the surface returns to it, soon or not: flights of 2 v
for v in 1e-7 1.1e-3; do
    printf 'rate: x = v, v = -1, n = 0\nevent: x = 0, v < 0; v = -v, n = t\nstart: x = 0, v = %s, n = 0\ndt: 0.1\n' $v >soon.system
    "$geomint" run soon.system until=0.1 dt=0.1 scheme=rk4 --json --state >out
    python3 -c '
import json, sys
end, v = json.load(open("out")), float(sys.argv[1])
happened = end["observables"]["events"]
assert happened == min(1001, int(0.1/(2*v))) and abs(end["t"] - min(0.1, 1001*2*v)) < 1e-9, end' $v || fail "returns, v=$v: $(cat out)"
done
# on the surface of a break an event turns the motion back: a parabola between two bounces, no sliding
printf 'rate: x = v, v = if(x > 0, -1, 1)\nevent: x = 0; v = -v\nstart: x = 1, v = 0\nuntil: 12\ndt: 0.1\nobserve: a = x\n' >both.system
"$geomint" run both.system scheme=rk4 --json >out || fail "an event on a break: $(cat out)"
python3 -c 'import json, math; a = json.load(open("out"))["observables"]["a"]; s = math.fmod(12 - math.sqrt(2), 2*math.sqrt(2)); assert abs(a - math.sqrt(2)*s + s*s/2) < 1e-9, a' || fail "an event on a break: $(cat out)"
# a tank runs dry: beyond the switch the root has no value, so this step is made across it
for scheme in rk4 gauss4; do
    "$geomint" run system 'rate=x = -if(x > 0, sqrt(x), 0)' x=1 until=5 dt=.1 scheme=$scheme --json --state >out || fail "a tank with $scheme: $(cat out)"
    python3 -c 'import json; end = json.load(open("out")); assert end["t"] == 5 and abs(end["state"][0]) < 1e-2, end' || fail "a tank with $scheme: $(cat out)"
done
# where the motion only touches the surface there is no tangent, and the run says so
printf 'coordinates: x\nmomenta: y\nH: y\nevent: (x - 1)^3 = 0; y = 2*y\nstart: x = 0, y = 1\nuntil: 3\ndt: 0.1\ntangents: 2\n' >graze.system
"$geomint" run graze.system scheme=rk4 >out
[ $? = 2 ] && grep -q 'status  *no-tangent' out && grep -q 'message  *the tangents end at the event at t = 1:' out ||
    fail "tangents at a grazing event: $(cat out)"
# a function in an index is a number
printf 'components: v[1 .. 3]\nlet: m(x) = 4 - x\nrate: i = 1 .. 3; v[i] = -i*v[m(i)]\nobserve: a = v[m(1)]\nstart: v[i] = i\nuntil: 1\n' >index.system
sed 's/m(i)\]/4 - i]/; s/m(1)\]/3]/; /let/d' index.system >written.system
for file in index written; do
    "$geomint" run $file.system --json --state | sed 's/.*"observables"/"observables"/' >$file || fail "an index, $file"
done
cmp -s index written || fail "a function in an index: $(cat index written)"
"$geomint" run ball.system scheme=gauss4 until=9 --checkpoint ball.check >/dev/null || fail 'a checkpoint of a ball'
"$geomint" run ball.system scheme=gauss4 until=10 >whole && "$geomint" run ball.system scheme=gauss4 until=10 --continue ball.check >parts || fail 'a ball goes on'
[ "$(grep -v seconds whole)" = "$(grep -v seconds parts)" ] || fail "a ball that goes on: $(cat parts)"
# tangents go through events: det S = r^2 whatever the potential; pieces of sines for the whole map
printf 'coordinates: q\nmomenta: p\nH: p^2/2 + q^2/2 + 2*q\nevent: q = 0, p < 0; p = -0.9*p\nstart: q = 1, p = 0.3\ntangents: 2\ndt: 0.02\nuntil: 5\n' >impact.system
"$geomint" run impact.system scheme=gauss8 --json --state >out || fail 'an impact'
python3 -c '
import json
end = json.load(open("out"))
wanted = [0.47375955955696814, 1.9082277, 0.4458932, -0.7652112985970044, 4.0853731, 1.2331238]
assert all(abs(a - b) < 1e-7 for a, b in zip(end["state"], wanted)), end
assert abs(end["observables"]["area_tangent"] - 0.9**6) < 1e-10 and end["observables"]["events"] == 3, end
' || fail "an impact: $(cat out)"
sed '/^tangents/d' impact.system >plain.system
"$geomint" run plain.system scheme=gauss8 --measure log_volume,lyapunov --json >out || fail 'the volume of an impact'
python3 -c 'import json, math; assert abs(json.load(open("out"))["observables"]["log_volume"] - 6*math.log(.9)) < 1e-9' || fail "the volume of an impact: $(cat out)"
printf 'rate: s = 1, y = 0\nevent: wrap; s = 1; s = 0, y = mod(3*y, 1)\nsection: at wrap; t, y\nstart: s = 0, y = 0.3141592\ndt: 0.1\nuntil: 99.95\n' >map.system
"$geomint" run map.system scheme=rk4 --measure events_wrap,log_volume,lyapunov --json --save-tracks map.npz >out || fail 'a map as events'
python3 - <<'END' || fail "a map as events: $(cat out)"
import array, json, math, zipfile
end = json.load(open("out"))["observables"]
assert end["events_wrap"] == 99 and abs(end["log_volume"] - 99*math.log(3)) < 1e-9, end
assert abs(end["lyapunov"] - 0.99*math.log(3)) < 2e-3, end # but for the part of the first vector that does not grow
with zipfile.ZipFile("map.npz") as tracks:
    times = array.array("d", tracks.read("section_t.npy")[128:])
assert len(times) == 99 and all(abs(t - k - 1) < 1e-12 for k, t in enumerate(times)), times
END
"$geomint" certify rk4 --on plain.system >out || fail "certify across events: $(cat out)"
grep -q 'order 4, measured [34]\.[09]' out || fail "order across events: $(cat out)"
# without conditions a wall is reversible, and symplectic
sed '/^tangents/d; s/, p < 0; p = -0.9\*p/; p = -p/' impact.system >wall.system
"$geomint" certify gauss4 --on wall.system >out || fail 'certify at a wall'
for claim in symplectic symmetric reversible; do
    grep -q "$claim  *holds" out || fail "a wall is not $claim: $(cat out)"
done
# one that never happens changes no bit, nor does one whose conditions never hold
sed '/^event/d' plain.system >calm.system
for line in 'q = 1e9; p = 0' 'q = 0.5, p > 1e9; q = 0' 'q = 1e9; stop'; do
    { cat calm.system; echo "event: $line"; } >never.system
    for scheme in verlet gauss4 rk4; do
        for file in calm never; do
            "$geomint" run $file.system scheme=$scheme --json --state | grep -o '"state".*' >$file.state
        done
        cmp -s calm.state never.state || fail "$line changes what never comes to it by $scheme"
    done
done
# what a quantity is measured against goes through events, too: a ball that falls on and on would only measure round-off
for scheme in avf2 'projected(rk4; invariants: H)'; do
    "$geomint" certify "$scheme" --on ball.system >out || fail "certify $scheme at bounces: $(cat out)"
    grep -q 'in 4000 steps H .*e-1[5-9] in [0-9]* steps, then events-accumulate' out || fail "$scheme at bounces: $(cat out)"
done
# a jump past a value does not reach it, unless the formula only jumps; mod reaches each of its values once a period
printf '%s\n' 4,4,4,4:'mod(t, 1) = 0' 4,4,4,4:'mod(t, 1) - 1/2 = 0' 5,5,5,5:'mod(x, 1) = h' 1,1,1,1:'floor(t) = 3' \
    1,1,1,1:'3 = floor(x)' 1,1,1,1:'floor(t) = 5/2' 1,1,1,1:'ceil(t) = 3' 1,1,1,1:'sign(x - 2) = 0' \
    1,1,1,1:'if(t > 2, 1, -1) = 0' 1,1,1,1:'if(t > 2, x - 2, -1) = 0' 1,1,1,1:'if(x > 1.95, x - 4, 3 - x) = 0' \
    4,4,4,4:'mod(x, 1)*2 = 1' 4,4,4,4:'x - floor(x) = 0.3' 4,4,4,4:'mod(x, 1)^2 = 1/4' 9,9,9,9:'abs(mod(x, 1) - 1/2) = 0.3' \
    1,1,1,1:'tan(t) = 0' 0,0,0,0:'1/(t - 2) = 0' 0,0,0,0:'abs(x) = 0' 0,0,0,0:'if(x > 1, -x, x) = 0' >jumps
while IFS=: read -r counts event; do
    found=
    printf 'parameter: h = 1/8\nrate: x = 1, n = 0\nevent: %s; n = n + 1\nstart: x = 0, n = 0\n' "$event" >jump.system
    for dt in 0.1 0.25 1 2.125; do
        "$geomint" run jump.system dt=$dt until=4.25 scheme=rk4 >out || fail "$event ends the run: $(cat out)"
        found=$found,$(sed -n 's/^ *events  *//p' out)
    done
    [ "$found" = ",$counts" ] || fail "$event happens $found times"
done <jumps
# two events at one place are two, wherever the ends of steps are, in both directions
printf '%s\n' 0:1:'x = 4':'ceil(x) = 5':1:1 0:1:'mod(x, 2) = 0':'floor(x) = 4':2:1 0:1:'mod(x, 0.1) = 0.05':'floor(x/2) = 1':55:1 \
    5.5:-1:'x = 4':'floor(x) = 3':1:1 5.5:-1:'mod(x, 2) = 0':'floor(x) = 3':2:1 5.5:-1:'mod(x, 0.1) = 0.05':'ceil(x) = 3':55:1 >pairs
while IFS=: read -r start rate one other ones others; do
    printf 'rate: x = %s, n = 0, m = 0\nstart: x = %s, n = 0, m = 0\nevent: a; %s; n = n + 1\nevent: b; %s; m = m + 1\n' \
        "$rate" "$start" "$one" "$other" >pair.system
    for dt in 0.03 0.1 0.25 0.7 1 2.75; do
        "$geomint" run pair.system dt=$dt until=5.49 scheme=rk4 --json >out || fail "$one and $other, dt=$dt: $(cat out)"
        grep -q "\"events_a\":$ones,\"events_b\":$others[,}]" out || fail "$one and $other, dt=$dt: $(cat out)"
    done
done <pairs
# the tangents of an event whose g only jumps are those of the jump's surface, x = 3
printf 'rate: x = 1 + y/10, y = -y/5\nstart: x = 0.2, y = 1\nevent: floor(x) = 3; y = y + x^2\nuntil: 4\ndt: 0.1\n' >surface.system
"$geomint" run surface.system scheme=gauss8 --measure log_volume --json >out || fail 'tangents at a jump'
python3 -c '
import json, math
low, high = 0, 4
while high - low > 1e-15:
    t = (low + high)/2
    low, high = (t, high) if 0.2 + t + (1 - math.exp(-t/5))/2 < 3 else (low, t)
y = math.exp(-low/5)
first, second = (1 + y/10, -y/5), (1 + (y + 9)/10, -(y + 9)/5)
late = [second[0] - first[0], second[1] - (6*first[0] + first[1])]
S = [[1 + late[0]/first[0], 0], [6 + late[1]/first[0], 1]]
found = json.load(open("out"))["observables"]["log_volume"]
assert abs(found - (-4/5 + math.log(S[0][0]*S[1][1]))) < 1e-11, (found, S)
' || fail "tangents at a jump: $(cat out)"
printf 'rate: x = -1, n = 0\nstart: x = 4.25, n = 0\nevent: floor(x) = 3; n = t\ndt: 0.1\nuntil: 4\n' >downwards.system
"$geomint" run downwards.system scheme=rk4 --json --state >out || fail 'floor, downwards'
python3 -c 'import json; end = json.load(open("out")); assert abs(end["state"][1] - 0.25) < 1e-14 and end["observables"]["events"] == 1, end' ||
    fail "floor, downwards: $(cat out)"
# a memory reaches an event, or a stop, at the event that changes it, wherever that is in the file
printf 'rate: y = v, v = -2, n = 0, m = 0\nevent: late; n = 3; m = t\nevent: y = 0, v < 0; v = -v, n = n + 1\nstart: y = 1, v = 0, n = 0, m = 0\ndt: 0.1\nuntil: 20\n' >memory.system
{ cat memory.system; echo 'stop: n - 4.5'; } >full.system
"$geomint" run memory.system scheme=rk4 --json --state >out && "$geomint" run full.system scheme=rk4 --json --state >full || fail 'a memory'
python3 -c '
import json
end, full = json.load(open("out")), json.load(open("full"))
assert abs(end["state"][3] - 5) < 1e-13 and end["observables"]["events_late"] == 1 and end["observables"]["events"] == 11, end
assert abs(full["t"] - 9) < 1e-13 and full["state"][2] == 5, full
' || fail "a memory: $(cat out full)"
# mod of a memory jumps as the memory does
printf 'rate: n = 0, m = 0, x = 1\nevent: a; x = 1; x = 0, n = n + 1\nevent: even; mod(n, 2) = 0; m = m + 1\nstart: n = 0, m = 0, x = 0\ndt: 0.1\nuntil: 10.05\n' >even.system
"$geomint" run even.system scheme=rk4 --json >out || fail 'mod of a memory'
grep -q '"events_a":10,"events_even":5[,}]' out || fail "mod of a memory: $(cat out)"
# an event at each end of a step, by round-off before or after it
printf 'rate: x = 1, n = 0\nevent: mod(t, 0.1) = 0; n = n + 1\nstart: x = 0, n = 0\ndt: 0.1\nuntil: 100.01\n' >ends.system
for scheme in rk4 dopri5 gsl-rk4; do
    "$geomint" run ends.system scheme=$scheme --json >out || fail "an event at each end: $scheme"
    grep -q '"events":1000[,}]' out || fail "an event at each end: $scheme: $(cat out)"
done
# a step with the determinant 0 ends no exponent but those of the directions that it ends
"$geomint" run system rate='x = 3.7*x*(1-x) - x, y = -y' x=.3 y=.4 dt=1 until=1000 scheme=explicit-euler \
    --measure lyapunov_spectrum,lyapunov --json >out || fail 'a spectrum with a lost direction'
python3 -c '
import json
seen = json.load(open("out"))["observables"]
assert abs(seen["lyapunov1"] - seen["lyapunov"]) < 5e-3 and seen["lyapunov"] > 0.3 and seen["lyapunov2"] is None, seen
' || fail "a spectrum with a lost direction: $(cat out)"
# a new value that is not finite
printf 'rate: x = -1, n = 0\nstart: x = 1, n = 0\nevent: hit; x = 0.55; n = log(x - 1)\ndt: 0.1\nuntil: 4\n' >log.system
status 2 run log.system scheme=rk4
grep -q 'the step after t = 0.4 failed: the event hit at t = 0.45 has no value (line 3, column 8)' out ||
    fail "an event without a value: $(cat out)"
# several at one time, in the order of the file, each once; a reset that does not leave the surface is no endless loop
printf 'rate: x = 1, y = 0\nstart: x = 0, y = 0\nevent: x = 1; y = y + 1\nevent: x = 1; y = 2*y\nevent: x = 1, y > 1.5; y = y + 10\n' >three.system
"$geomint" run three.system scheme=rk4 dt=0.3 until=2 --json --state >out || fail 'three at once'
grep -q '"state":\[2,12\]' out || fail "three at once: $(cat out)"
printf 'coordinates: q\nmomenta: p\nH: p^2/2 + q^2/2\nstart: q = 1, p = 0\nevent: q = 0; q = q^2\n' >same.system
"$geomint" run same.system scheme=rk4 until=20 --json >out && grep -q '"events":6,' out || fail "nothing changes: $(cat out)"
wrong() {
    { sed '/^event/d' ball.system; printf '%s\n' "$1"; } >wrong.system
    refused 1 "$2" run ./wrong.system ${3:-}
}
wrong 'event: y = 0; r = 1' 'r is a parameter.*rate: r = 0'
wrong 'event: y; v = -v' 'an event needs an =.*with a name event: hit'
wrong 'event: y = 0' 'what happens'
wrong 'event: 3 = r; v = 1' 'never changes'
wrong 'event: y = 0, v; v = -v' 'a condition compares'
wrong 'section: at bounce; y, v' 'there is no event bounce'
wrong 'event: y = 0; v = 1, v = 2' 'v is changed twice by this event'
wrong 'event: y = 0; y = 0' 'this event changes nothing'
wrong 'event: y - r = 0; y = r, v = v' 'this event changes nothing'
wrong 'event: y = 0; v = -v' 'its steps have their own length; rk4, gauss4 and dopri5 end' scheme=error-controlled-verlet
wrong 'event: y = 0; v = -v' 'members=1' members=5
printf 'coordinates: x y\nH: (p_x^2 + p_y^2)/2 + y\nconstraint: x^2 + y^2 - 1\nstart: x = 1, y = 0, p_x = 0, p_y = 0\nevent: x = 0; p_x = 0\n' >held.system
refused 1 'constraint' run ./held.system
printf 'field: u\nrate: u = -u_x\nstart: u = sin(x)\nevent: u = 0; u = 1\n' >sea.system
refused 1 'a field' run ./sea.system
# breaks of piecewise rates are located: closed forms of pieces of parabolas, sines and exponentials
printf 'coordinates: q\nmomenta: p\nH: p^2/2 + 9.8*abs(q)\nstart: q = 5, p = 0\ndt: 0.1\nuntil: 20\n' >corner.system
printf 'coordinates: q\nmomenta: p\nH: p^2/2 + if(q > 0, 4, 1)*q^2/2\nstart: q = 0, p = 1\ndt: 0.1\nuntil: 20\n' >springs.system
printf 'rate: x = -x + sign(sin(t))\nstart: x = 0\ndt: 0.1\nuntil: 10\n' >relay.system
printf 'rate: x = 1, y = floor(x) + mod(2*x, 1) + ceil(x) + max(x, 2*x - 1.3) + heaviside(x - 1.7)\nstart: x = 0.2, y = 0\ndt: 0.1\nuntil: 3.05\n' >steps.system
printf 'rate: z = if(mod(t, 1) < 1/2, 1, -1)\nstart: z = 0\ndt: 0.1\nuntil: 3.25\n' >wave.system
printf 'rate: z = -z + mod(t, 1)\nstart: z = 0\ndt: 0.1\nuntil: 2\n' >saw.system
printf 'rate: x = 2.2 - floor(x)\nstart: x = 0.2\ndt: 0.1\nuntil: 5\n' >stairs.system
printf 'rate: x = 1.4, y = -min(x, floor(3*x) - 1)\nstart: x = 0.2, y = 0\ndt: 0.2\nuntil: 1.8\n' >both.system
printf 'parameter: z = 0.05\nrate: x = v, v = -x - 2*z*v + 0.2*sign(v)\nstart: x = 0, v = 2.5\ndt: 0.1\nuntil: 60\n' >motor.system
printf 'parameter: F = 0\nrate: x = v, v = F - x - 0.3*sign(v)\nstart: x = 1, v = 0\ndt: 0.1\nuntil: 20\n' >friction.system
python3 - "$geomint" <<'END' || fail 'located breaks'
import json, math, subprocess, sys
def run(*words, code=0):
    done = subprocess.run([sys.argv[1], "run", *words, "--json", "--state"], capture_output=True, text=True)
    assert done.returncode == code, (words, done)
    return json.loads(done.stdout)
def error(file, exact, *words):
    return max(abs(a - b) for a, b in zip(run(file, *words)["state"], exact))
corner, springs = (4.7979746446661355, 1.9898987322333186), (0.3725565802396739, -0.666938061652263)
for scheme in "rk4", "gauss4", "verlet", "avf2", "radau5", "yoshida4", "aba104": # each piece is a parabola
    assert error("corner.system", corner, "scheme=" + scheme) < 1e-12, scheme
assert run("corner.system", "scheme=avf2")["observables"]["energy_error"] < 1e-13
assert run("corner.system", "scheme=avf2", "breaks=ignored")["observables"]["energy_error"] > 1e-3
for scheme, order in ("rk4", 4), ("gauss4", 4), ("verlet", 2):
    coarse, fine = (error("springs.system", springs, "scheme=" + scheme, dt) for dt in ("dt=0.05", "dt=0.025"))
    assert abs(math.log2(coarse / fine) - order) < 0.2, (scheme, coarse, fine)
assert error("relay.system", (0.07859308485389671, 10), "scheme=gauss8") < 1e-13
# rates that are linear between breaks: the midpoint rule for each piece
places, sum = (0.2, 0.5, 1, 1.3, 1.5, 1.7, 2, 2.5, 3, 3.25), 0
for a, b in zip(places, places[1:]):
    x = (a + b) / 2
    sum += (b - a) * (math.floor(x) + 2*x % 1 + math.ceil(x) + max(x, 2*x - 1.3) + (x > 1.7))
for dt in "dt=0.1", "dt=0.61", "dt=3.05": # one jump in a step, or all
    assert error("steps.system", (3.25, sum), "scheme=rk4", dt) < 1e-13, dt
    assert error("wave.system", (0.25, 3.25), "scheme=rk4", dt.replace("3.05", "3.25").replace("0.61", "0.65")) < 1e-14, dt
# a tooth takes z to (z + 1)/e; every second step ends at a jump of the rate, up to round-off
tooth = lambda z: (z + 1) / math.e
errors = [error("saw.system", (tooth(tooth(0)), 2), "scheme=rk4", "compensated=yes", "dt=%r" % (0.05 / 2**k)) for k in range(9)]
# the seventh error is a sixteenth of the sixth up to four units in the last place of z
assert all(abs(math.log2(a / b) - 4) < 0.1 for a, b in zip(errors[:5], errors[1:])), errors
assert abs(errors[6] - errors[5] / 16) < 4.5e-16, errors
assert errors[-1] < 1e-15, errors
# at x = 1 the terms of the minimum meet where one of them jumps
for dt in "dt=0.2", "dt=0.05", "dt=1.8":
    assert error("both.system", (2.72, (2/15 - (2.72**2 - 4/9)/2)/1.4), "scheme=rk4", dt) < 1e-13, dt
# the last of three stairs ends where floor turns the rate back
assert error("stairs.system", (2 + 0.2*(5 - 0.8/2.2 - 1/1.2), ), "scheme=rk4", "dt=2.5") < 1e-13
slides = run("stairs.system", "scheme=rk4", "until=10", code=2)
assert "slides along x = 3 from t = 6.19696969" in slides["message"], slides
many = run("wave.system", "scheme=rk4", "dt=600", "until=600", code=2)
assert many["status"] == "events-accumulate" and "more than 1000 breaks" in many["message"], many
assert run("corner.system", "scheme=rk4")["breaks"] == "located" and run("corner.system", "scheme=gsl-msadams")["breaks"] == "ignored"
# half a turn takes x to c + (x - c) exp(-pi z / w) of the other sign; without the jump of the rates in the tangent map
# both multipliers are this
slow = math.exp(-2 * math.pi * 0.05 / math.sqrt(1 - 0.05**2))
orbit = subprocess.run([sys.argv[1], "orbit", "motor.system", "--json"], capture_output=True, text=True)
found = json.loads(orbit.stdout)
assert abs(found["period"] - 6.291054045776003) < 1e-12, found
assert max(abs(re - x) for (re, im), x in zip(sorted(found["multipliers"]), (slow, 1))) < 1e-8, (found, slow)
# at rest by friction from the turn on at which it is stronger than the spring: x = 1, -0.4, -0.2
stuck = run("friction.system", "scheme=gauss8", code=2)
assert stuck["status"] == "sliding" and abs(stuck["t"] - 2 * math.pi) < 1e-11, stuck
assert "slides along v = 0 from t = 6.283185307: both rates point at it" in stuck["message"], stuck
assert abs(stuck["state"][0] + 0.2) < 1e-12, stuck
held = run("friction.system", "scheme=rk4", "F=1.1", code=2)
assert held["status"] == "sliding" and held["t"] == 0, held
# a start on the switch, and one that leaves it with a rate of 0
assert error("corner.system", (0, 0), "q=0", "scheme=rk4") == 0
END
"$geomint" certify avf2 --on corner.system >out || fail "certify through breaks: $(cat out)"
grep -q 'H conserves energy  *holds' out || fail "avf2 through breaks: $(cat out)"
"$geomint" certify avf2 --on corner.system breaks=ignored >out || fail "certify across corners: $(cat out)"
grep -q 'H conserves energy  *not decided' out || fail "avf2 across corners: $(cat out)"
"$geomint" certify rk4 --on springs.system >out && grep -q 'order 4, measured \(3.9\|4.0\)' out ||
    fail "order through breaks: $(cat out)"
"$geomint" certify rk4 --on springs.system breaks=ignored >out && grep -q 'no order can be measured' out ||
    fail "order across jumps: $(cat out)"
# where H jumps its flow does not conserve it: no scheme is praised or blamed for that
for H in 'p^2/2 + if(q > 0.2, 2*q^2 + 1, q^2/2)' 'p^2/2 + q^2/2 + floor(2*q)'; do
    printf 'coordinates: q\nmomenta: p\nH: %s\nstart: q = 1, p = 0\ndt: 0.1\n' "$H" >wall.system
    "$geomint" certify avf2 --on wall.system >out || fail "a jump of H: $(cat out)"
    grep -q 'H conserves energy  *not measured H jumps' out || fail "a jump of H: $(cat out)"
done
# maps, as steps of explicit Euler, have no parts: Lozi's, in steps of its formula
"$geomint" run system rate='x = 1-1.7*abs(x)+y-x, y = 0.5*x-y' x=.1 y=.1 until=20 dt=1 scheme=explicit-euler --json --state >out || fail "a map of pieces: $(cat out)"
python3 -c '
import json
x, y = .1, .1
for _ in range(20):
    x, y = 1 - 1.7*abs(x) + y, .5*x
state = json.load(open("out"))["state"]
assert abs(state[0] - x) + abs(state[1] - y) < 1e-10, (state, x, y)' || fail "a map of pieces: $(cat out)"
# the step that is chosen for a start on a switch is that of the motion beside it
for words in 'q=0 p=1' 'q=1 p=0'; do
    "$geomint" run system H='p^2/2+abs(q)' $words scheme=rk4 | grep -q '^  t  *100$' || fail "the usual step, $words"
done
"$geomint" run system rate='x = y, y = -x - 0.2*y + 0.5*sign(y)' x=3.1 y=0 scheme=rk4 | grep -q '^  t  *100$' || fail "the usual step on a switch"
# each lane that steps across breaks is named, once
"$geomint" run springs.system scheme=gsl-msadams,dopri5,dopri5,rk4 dt=.1,.1,.2,.1 zip=yes >out 2>notes || fail "lanes across breaks: $(cat notes)"
[ "$(grep -c 'steps across breaks; rk4 and gauss4 locate them' notes)" = 2 ] && grep -q 'dopri5 steps' notes &&
    grep -q 'gsl-msadams steps' notes || fail "lanes across breaks: $(cat notes)"
"$geomint" list springs.system --long | grep -q 'smooth .*breaks are located' || fail 'breaks in the list'
# a switch that is never met changes no bit
printf 'coordinates: q\nmomenta: p\nH: p^2/2 + q^4/4 + 3*abs(q - 9) + max(q, -7) + min(p, 8) + mod(q + 2, 100)/3\nstart: q = 1, p = 0.3\ndt: 0.1\nuntil: 20\n' >far.system
for scheme in verlet-position rk4 gauss4 midpoint avf2 radau5 tao2; do
    for breaks in located ignored; do
        "$geomint" run far.system scheme=$scheme breaks=$breaks --json --state | grep -o '"state".*' >$breaks.state
    done
    [ -s located.state ] && cmp -s located.state ignored.state || fail "switches that are far away change bits by $scheme"
done
# steps before a break or an event are made together, unless each is looked at for a section: the same bits
printf 'rate: x = v, v = -x + abs(x - 0.3) - if(v > 0, 1, 2)*x/7, n = 0\nevent: x = 0.55, v > 0; n = n + 1\nevent: mod(t, 1.7) = 0; v = v + 0.1\n' >many.system
printf 'start: x = 1, v = 0.3, n = 0\ndt: 0.013\nuntil: 60\n' >>many.system
{ cat many.system; echo 'section: x + 99 = 0; x, v'; } >single.system
for scheme in rk4 gauss4 midpoint radau5 rk4sym dopri5; do
    for group in many single; do
        "$geomint" run $group.system scheme=$scheme --json --state 2>notes | sed 's/.*"steps"/"steps"/; s/"seconds":[^,]*,//' >$group.state
    done
    grep -q '"events":43}' many.state && cmp -s many.state single.state || fail "steps together, $scheme: $(cat many.state single.state)"
done
# the rates of Robertson's reactions: that of the slowest component, and of the fastest decay (Gear, 1971)
printf 'rate: a = -0.04*a + 1e4*b*c, b = 0.04*a - 3e7*b^2 - 1e4*b*c, c = 3e7*b^2\nstart: a = 1, b = 0, c = 0\nuntil: 40\n' >robertson.system
"$geomint" list robertson.system --long | grep -q 'stiff *yes rates 0.038 to 2.2e+03' || fail 'the rates of a stiff system'
# a symplectic scheme of order 1 steps across: parts would take its energy, h^2 g^2/2 a step
"$geomint" run corner.system scheme=symplectic-euler --json >out || fail "symplectic steps across breaks: $(cat out)"
python3 -c 'import json; assert json.load(open("out"))["observables"]["energy_error"] < 0.1' || fail "symplectic steps across breaks: $(cat out)"
"$geomint" run springs.system scheme=symplectic-euler --json >out || fail "symplectic steps across breaks: $(cat out)"
grep -q '"breaks":"ignored"' out || fail "symplectic steps across breaks: $(cat out)"
for scheme in symplectic-euler dopri5; do
    "$geomint" certify $scheme --on springs.system >out
    grep -q 'measured nowhere: the system is not smooth, so that' out || fail "$scheme across breaks: $(cat out)"
done
# one of order 3 locates them, which keeps its order
"$geomint" certify ruth3 --on springs.system >out
grep -q 'order 3, measured \(2.9\|3.0\)' out || fail "ruth3 through breaks: $(cat out)"
refused 1 'event: is a line of a system' run ./corner.system 'event=q = 1; p = 0'
refused 1 'breaks=foo is none of: located, ignored' run ./springs.system breaks=foo
status 0 run system 'rate=x = 1, z = if(x > 0 and not x > 1 or x > 5, 2, 0)' x=-1 z=0 dt=0.1 until=3 scheme=rk4
"$geomint" list system 'rate=z = floor(t)' z=0 --long | grep -q 'breaks are located' || fail 'breaks of floor'
"$geomint" certify rk4 --on saw.system >out && grep -q 'order 4, measured \(3.99\|4.00\)' out || fail "order through jumps: $(cat out)"
# a run that slides, or ends at an event, is resumed: it has ended
printf 'rate: x = 1\nstart: x = 0\nevent: x = 0.55; stop\ndt: 0.1\nuntil: 3\n' >ends.system
for words in 'friction.system until=20' 'ends.system until=3'; do
    "$geomint" run $words scheme=rk4 --checkpoint ended.check | grep -v seconds >whole
    "$geomint" run $words scheme=rk4 --continue ended.check | grep -v seconds >out || [ $? = 2 ] || fail "$words is not resumed"
    cmp -s whole out || fail "$words goes on after its end: $(cat out)"
done
# a relay at rest has no end to its steps
status 2 run system 'rate=x = -sign(x)' x=0.35 dt=0.1 until=1 scheme=rk4
grep -q 'slides along x = 0 from t = 0.35' out || fail "a relay: $(cat out)"
refused 1 'no parameter "breaks"' run ./wall.system breaks=located
status 0 run friction.system scheme=rk4 steps=3 --measure I1_error
grep -q "invariants are not searched: the system is not smooth" out || fail "why no invariant: $(cat out)"
! "$geomint" run lorenz steps=0 until=0 2>&1 | grep -q nan || fail "a step of nan"

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
