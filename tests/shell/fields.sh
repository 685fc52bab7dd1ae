#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Fields on the command line: potentials, rates and matrices, on rings, between walls and on moving meshes.
# fields.sh GEOMINT
set -u
. "$(dirname "$0")/answers.sh"

# a field: an explicit scheme beyond its limit says so; another V stands behind the name; a ring that is open is refused
# before it blows up, too
"$geomint" run phi4 scheme=leapfrog dt=0.11 steps=1 half_length=40 points=800 --json | grep -q '"longest_step":0.0997' ||
    fail 'phi4: the longest step is not told'
"$geomint" run phi4 scheme=leapfrog dt=0.11 until=1000 half_length=40 points=800 --json >out 2>err
[ $? = 2 ] && grep -q 'beyond 0.0997.*, the limit of linear theory' out || fail "phi4 beyond the limit: $(cat out err)"
"$geomint" run sine-gordon scheme=energy-conserving dt=0.06 until=6 >out 2>err
grep -q "beyond 0.05002, the limit of linear theory 4/dt^2 + V'' >= 4/dx^2" out || fail "energy-conserving beyond the limit: $(cat out err)"
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
# stages of equal times in any order: midpoint steps of 1/4, 1/2, -5/4, 2, -5/4, 1/2, 1/4, the first three listed last first
status 0 certify 'runge-kutta(-5/8,1/4,1/2,0,0,0,0|0,1/8,0,0,0,0,0|0,1/4,1/4,0,0,0,0|-5/4,1/4,1/2,1,0,0,0|-5/4,1/4,1/2,2,-5/8,0,0|-5/4,1/4,1/2,2,-5/4,1/4,0|-5/4,1/4,1/2,2,-5/4,1/2,1/8; -5/4,1/4,1/2,2,-5/4,1/2,1/4; order: 2; claims: symplectic symmetric reversible)'
grep -q '= symmetric  *holds' out || fail "a symmetric composition in another order: $(cat out)"
# numbers that are large beside others stop no reference, and refute nothing
printf 'field: u\nrate: u = -u_x - u_xxx\nspace: fourier\nstart: u = 1e6*exp(-x^2)\nhalf_length: 10\npoints: 64\n' >large.system
printf 'dt: 0.01\nuntil: 1\n' >>large.system
status 0 certify midpoint --on large.system
printf 'coordinates: q\nH: p_q^2/2 + (q - 1e6)^2/2\nstart: q = 1000001, p_q = 0\ndt: 0.1\nuntil: 1\n' >shifted.system
status 0 certify midpoint --on shifted.system
grep -q 'conserves quadratic invariants  *not measured round-off' out || fail "an energy small beside q: $(cat out)"
# metres and kilograms: the momenta are 10^18 times as large as the places, and the area of a step has one unit
printf 'coordinates: q\nH: p_q^2/2/6e24 + 6e24*(2e-7*q)^2/2\nstart: q = 1.5e11, p_q = 0\ndt: 5e5\n' >metres.system
status 0 certify verlet --on metres.system
grep -q 'S symplectic  *holds' out || fail "Verlet in metres: $(cat out)"
status 0 certify explicit-euler --on metres.system
grep -q 'S symplectic  *not claimed  *defect 1.0e-02' out || fail "Euler's areas in metres: $(cat out)"
grep -q 'steps H  *drifts' out || fail "Euler's energy in metres: $(cat out)"
# an energy that is 0 but for rounding, and one of small numbers: the changes are those of its terms
status 0 certify explicit-euler --on system 'H=(p1^2+p2^2)/2-1/sqrt(q1^2+q2^2)' q1=1 q2=0 p1=0 'p2=sqrt(2)' dt=0.1
grep -q 'steps H  *drifts  *change 8.4e-02' out || fail "an energy of 0: $(cat out)"
status 4 certify 'strang(A by rk4, B by rk4; order: 2; claims: keeps energy)' --on system 'H=p^2/2+q^2/2' \
    'part=A = p^2/2+q^2/4 , B = q^2/4' q=1e-7 p=0 dt=0.5
grep -q 'H conserves energy  *BROKEN  *defect 2.7e-02' out || fail "an energy of small numbers: $(cat out)"
# a beat grows in 4000 steps, and a drift grows in more
status 0 certify verlet --on system 'H=p1^2/2 + q1^2/2 + p2^2/2 + w^2*q2^2/2' w=1.004 q1=1 q2=0 p1=0 p2=1 dt=0.1
grep -q 'steps H  *oscillates' out || fail "a beat: $(cat out)"
status 0 certify rk4 --on system 'H=p^2/2-cos(q)' q=2 p=0 dt=0.02
grep -q 'steps H  *drifts' out || fail "a slow drift: $(cat out)"
# steps that any scheme would make show nothing
status 0 certify 'projected(rk4; H; order: 4; claims: symplectic symmetric)' --on kepler eccentricity=0.3 dt=0.002
grep -q 'S symplectic  *not decided .*take a longer dt' out || fail "short steps: $(cat out)"
status 0 certify 'relaxed(rk4; H; claims: keeps energy)' --on kepler
! grep -q 'given up.*linear' out || fail "linear invariants of a relaxed step, which it keeps: $(cat out)"
status 4 certify 'projected(rk4; H; order: 4; claims: symplectic symmetric)' --on kepler eccentricity=0.3 dt=0.05
grep -q '= symmetric  *BROKEN' out || fail "longer steps: $(cat out)"
status 0 certify 'relaxed(rk4; H; order: 4; claims: symmetric)' --on system 'H=p^2/2 - cos(q)' q=0 p=0 dt=0.1
grep -q '= symmetric  *not decided .*equilibrium' out || fail "an equilibrium: $(cat out)"
# an order that theory proves is not refuted by a system that is stiff for the steps
status 0 certify radau5 --on system 'rate=x = -1e4*(x^3 - cos(t)^3) - sin(t)' x=1 dt=0.05
grep -q 'measured 2.9.*not reached on this system' out || fail "an order on a stiff system: $(cat out)"
status 4 certify 'runge-kutta(0,0|1,0; 1/2,1/2; order: 3)' --on system 'rate=x = -x' x=1 dt=0.05
grep -q 'BROKEN' out || fail "a false order"
rm own.system false.scheme large.system shifted.system metres.system
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

[ $failures = 0 ] && echo 'all as it should be'
exit $failures
