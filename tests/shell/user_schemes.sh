#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Schemes of one's own on the command line: those that the program brings hold what they claim, a wrong one does not, a
# picture is made again without the file, and what cannot be read is said with its place. own_schemes.sh GEOMINT SCHEMES
set -u
schemes=$2
. "$(dirname "$0")/answers.sh"

for file in "$schemes"/*.scheme; do
    name=$(basename "$file")
    "$geomint" certify "$file" --json >out 2>err || fail "certify $name: exit $?: $(cat err)"
    python3 -c '
import json, sys
about = json.load(open("out"))
# a corrector is beyond the theory of coefficients
assert about["holds"] and (not about["theory"] or about["theory"]["order"] == about["order"]), about
' || fail "certify $name: what theory says"
    for word in title about reference kind order claims; do
        grep -q "^$word: " "$file" || fail "$name has no $word"
    done
done

# one and the same run, by name, by file and as a word
cat >gauss.scheme <<'END'
geomint: 1
kind: runge-kutta      # the rows of gauss4
let: s = sqrt(3)
a: 1/4, 1/4 - s/6
 | 1/4 + s/6, 1/4
b: 1/2, 1/2
END
word='runge-kutta(1/4, 1/4 - sqrt(3)/6 | 1/4 + sqrt(3)/6, 1/4; 1/2, 1/2)'
"$geomint" run kepler "scheme=gauss4,./gauss.scheme,$word" steps=100 --state --json >out 2>err || fail "run: $(cat err)"
python3 -c '
import json, sys
lanes = [json.loads(line) for line in open("out")]
assert [lane["scheme"] for lane in lanes] == ["gauss4", "./gauss.scheme", sys.argv[1]]
for lane in lanes:
    for key in "scheme", "seconds", "parameters":
        lane.pop(key)
assert lanes[0] == lanes[1] == lanes[2], lanes
' "$word" || fail 'the three ways to say gauss4 differ'
"$geomint" run kepler "scheme=$word,rk4" steps=9 --csv out.csv >/dev/null || fail 'run --csv'
python3 -c '
import csv, sys
rows = list(csv.reader(open("out.csv")))
assert len({len(row) for row in rows}) == 1 and {row[2] for row in rows[1:]} == {sys.argv[1], "rk4"}
' "$word" || fail 'the scheme is no cell of the table'

# a picture knows it without the file, from another folder
mkdir made again
"$geomint" render kepler scheme=./gauss.scheme,rk4 until=3 --size 160x90 -o made/a.png 2>err || fail "render: $(cat err)"
cp made/a.png again/
mv gauss.scheme elsewhere.scheme
(cd again && "$geomint" again a.png --out . 2>../err >../out) || fail "again: $(cat err)"
mv elsewhere.scheme gauss.scheme

# a file that names another one, from its own folder
mkdir -p deep
printf 'kind: composition\nbase: ../gauss.scheme\nsteps: 1/2, 1/2\n' >deep/twice.scheme
"$geomint" certify deep/twice.scheme >out 2>err || fail "certify deep/twice.scheme: $(cat err)"
grep -q 'order 4, measured' out || fail "deep/twice.scheme: $(cat out)"
"$geomint" stability --region deep/twice.scheme --json >out 2>err || fail "stability --region: $(cat err)"
"$geomint" stability henon-heiles scheme=deep/twice.scheme,rk4 >out 2>err || fail "stability: $(cat err)"
"$geomint" work-precision kepler scheme=./gauss.scheme,best until=2 --out . >out 2>err || fail "work-precision: $(cat err)"
[ "$(grep -c '^gauss\|^midpoint\|^rk4sym' out)" -ge 2 ] || fail "best: $(cat out)"
"$geomint" sweep kepler 'scheme=composition(verlet; 1/2, 1/2),verlet' dt=0.05,0.1 until=5 --table table.csv >/dev/null 2>err ||
    fail "sweep: $(cat err)"
python3 -c '
import csv
rows = list(csv.DictReader(open("table.csv")))
assert len(rows) == 4 and {row["status"] for row in rows} == {"ok"}, rows
' || fail "sweep: $(cat table.csv)"

# bases in turns, as a word and as a file with other files; resumed from a checkpoint, and painted again
printf 'kind: composition\nbase: symplectic-euler, adjoint(symplectic-euler)\nsteps: 1/2, 1/2\n' >deep/turns.scheme
printf 'kind: composition\nbase: turns.scheme, ../gauss.scheme\nsteps: 1/2, 1/2\n' >deep/mixed.scheme
word='composition(symplectic-euler, adjoint(symplectic-euler); 1/2, 1/2)'
"$geomint" run kepler "scheme=verlet,deep/turns.scheme,$word,deep/mixed.scheme,composition(verlet, gauss4; 1/2, 1/2)" \
    steps=40 dt=0.05 --state --json >out 2>err || fail "bases in turns: $(cat err)"
python3 -c '
import json
states = [json.loads(line)["state"] for line in open("out")]
for a, b in ((0, 1), (0, 2), (3, 4)):
    assert max(abs(x - y) for x, y in zip(states[a], states[b])) < 1e-13, (a, b, states)
' || fail 'bases in turns'
status 0 certify deep/mixed.scheme
grep -q 'order 2, measured' out && grep -q 'S symplectic *holds' out || fail "deep/mixed.scheme: $(cat out)"
mixed='scheme=composition(rk4, verlet, midpoint; 0.3, 0.5, 0.2)'
status 0 run kepler "$mixed" dt=0.05 until=5 --json --state
grep -o '"state":.*' out >whole
status 0 run kepler "$mixed" dt=0.05 until=2.5 --checkpoint half.checkpoint
status 0 run kepler "$mixed" dt=0.05 until=5 --continue half.checkpoint --json --state
grep -o '"state":.*' out | cmp -s - whole || fail 'bases in turns are not resumed'
mkdir turns
"$geomint" render kepler "$mixed" until=1 --size 160x90 -o turns.png >out 2>err &&
    (cd turns && "$geomint" again ../turns.png --out . && "$geomint" again turns-again.png --out .) >out 2>err ||
    fail "bases in turns again: $(cat err)"
cmp -s turns/turns-again.png turns/turns-again-again.png || fail 'bases in turns: again of again'
refused 1 'scheme, column 23: 7 steps cannot be shared by 2 bases in turns' certify \
    'composition(rk4, rk2; 1, 0, 0, 0, 0, 0, 0)'
sed -i 's/turns.scheme, .*/turns.scheme, rk44/' deep/mixed.scheme
refused 1 'deep/mixed.scheme:2:21: there is no scheme "rk44"; did you mean rk4' certify deep/mixed.scheme

# the steps of a symmetric scheme of order 2 that has no coefficients give the order that they give to any other one
thrice='let: g = 1/(2 - 2^(1/3)); g, 1 - 2*g, g'
while read -r order word; do
    status 0 certify "$word"
    grep -q "^  order $order, measured" out || fail "steps of $word: $(cat out)"
done <<END
4 composition(boris2; $thrice)
4 composition(magnetic-splitting2; let: g = 1/(4 - 4^(1/3)); g, g, 1 - 4*g, g, g)
4 composition(avf2; $thrice)
4 composition(composition(kahan2; 1/2, 1/2); $thrice)
6 composition(boris2; let: a = 0.78451361047755726382; let: b = 0.23557321335935813368; a, b, -1.17767998417887100695, 1.31518632068391121889, -1.17767998417887100695, b, a)
2 composition(boris2; 1.35, -1.7, 1.35)
2 composition(boris2; 1/3, 2/3)
END

# what no problem of the certificates measures is open
status 0 certify 'relaxed(rk4; I1)'
grep -q 'L conserves linear invariants .*name a system, --on SYSTEM' out || fail "relaxed(rk4; I1): $(cat out)"

# a part with coefficients loses energy, though in short steps only round-off shows
status 4 certify 'composition(gauss8, avf4; claims: keeps energy; 1/2, 1/2)'
grep -q 'H conserves energy *BROKEN.*refuted by theory' out || fail "gauss8 and avf4 in turns: $(cat out)"
status 0 certify 'composition(avf2, avf4; claims: keeps energy; 1/2, 1/2)'
grep -q 'H conserves energy *holds' out || fail "avf2 and avf4 in turns: $(cat out)"

# a wrong one
"$geomint" certify 'explicit(order: 4; 0,0,0,0|1/2,0,0,0|0,1/2,0,0|0,0,1,0; 1/3,1/6,1/3,1/6)' >out 2>err
[ $? = 4 ] || fail 'weights exchanged: not refuted'
grep -q 'most that of t\[t\]' out || fail "weights exchanged: $(cat out)"
"$geomint" certify 'runge-kutta(claims: symplectic; 1/2, 0 | 1/2, 1/2; 1/2, 1/2)' >out 2>err
[ $? = 4 ] || fail 'no symplectic tableau: not refuted'

printf 'kind: runge-kutta\na: 1, 2\nb: 1\n' >wrong.scheme
refused 1 'wrong.scheme:2:4: a has 1 rows of 2 entries: it is not square' certify wrong.scheme
[ "$(sed -n 2p err)" = '    a: 1, 2' ] && [ "$(sed -n 3p err)" = '       ^' ] || fail "no caret: $(cat err)"
for order in 0 21 2x x 2.5; do
    printf 'kind: runge-kutta\na: 0\nb: 1\norder: %s\n' "$order" >wrong.scheme
    refused 1 "wrong.scheme:4:8: order: is a whole number from 1 to 20" certify wrong.scheme
done
# a column is one of the words of the command, and not of a file
printf 'kind: projected\nbase: rk4\ninvariants: far\n' >far.scheme
refused 1 'an invariant far (.*, \.\.\.); geomint list kepler' run kepler scheme=./far.scheme steps=1
refused 1 'an invariant far (.*, \.\.\.), in column 28; geomint' run kepler 'scheme=projected(rk4; invariants: far)' steps=1
refused 1 'scheme, column 21: the steps sum to 2, not to 1' run disc 'scheme=composition(verlet; 1, 1)' until=1
[ "$(sed -n 3p err)" = '                        ^' ] || fail "no caret: $(cat err)"
printf 'kind: adjoint\nbase: me.scheme\n' >me.scheme
refused 1 'me.scheme contains itself' certify me.scheme
refused 1 'no kind of scheme "runge-kuta(...)"; did you mean runge-kutta(...)$' run disc 'scheme=runge-kuta(0 0; 1/2 1/2)'
refused 1 'no kind of scheme "xyzzy(...)"; docs/own-schemes.md names them$' certify 'xyzzy(rk4)'
printf 'kind: adjoint\nbase: other.scheme\n' >me.scheme
printf 'kind: composition\nbase: me.scheme\nsteps: 1\n' >other.scheme
refused 1 'me.scheme contains itself' run disc scheme=me.scheme until=1
printf 'kind: adjoint\nbase: ./me.scheme\n' >me.scheme
refused 1 'me.scheme contains itself' run disc scheme=me.scheme until=1
refused 1 'cannot be shown' certify "$(printf 'a\033[31m.scheme')"
for share in 1 2; do
    "$geomint" sweep kepler 'scheme=adjoint(rk4),rk4' dt=0.01..0.03:3 until=1 --table shares.csv --shard $share/2 \
        >/dev/null 2>&1 || fail "share $share of a sweep"
done
status 0 sweep --join shares.csv
[ "$(wc -l <shares.csv)" = 7 ] || fail 'a sweep with a scheme of its own is not joined'
refused 3 'none.scheme could not be read' run disc scheme=none.scheme until=1
refused 3 'none.scheme could not be read' certify none.scheme
refused 3 'none.scheme could not be read' stability --region none.scheme
printf 'kind: explicit\na: 0\nb: 1 \033[31m\n' >wild.scheme
refused 1 'wild.scheme:3:6' certify wild.scheme
grep -q "$(printf '\033')" err && fail 'an escape reached the terminal'

# what stands in the way of a file
printf '\357\273\277kind: explicit\na: 0\nb: 1\n' >marked.scheme
status 0 certify marked.scheme
head -c 1100000 /dev/zero | tr '\0' '#' >large.scheme
refused 3 'large.scheme could not be read: it has 1.04904 MB, more than 1' certify large.scheme
refused 1 'the word says that it is of the kind runge-kutta' certify 'runge-kutta(kind: explicit; 1/2; 1)'
refused 1 'the drifts sum to 0.3, not to 1' run kepler 'scheme=splitting(0.1, 0.2; 1)' until=1
status 0 work-precision kepler scheme=best,rk4 until=2 --out .
status 0 work-precision kepler scheme=rk4,best,rk2 until=2 --out .
status 0 work-precision kepler 'scheme=projected(rk4; H, L),best' until=2 --out . # those of the family of rk4
grep -q '^rk4 ' out || fail "the best of a projected scheme: $(cat out)"

# a switch in flight to a word with commas, and again from the picture alone
switched='0:5:scheme=composition(verlet; 1/2, 1/2),0:8:dt=0.02'
"$geomint" render kepler scheme=rk4 until=1 --changes "$switched" --size 160x90 -o switched.png >out 2>err ||
    fail "render --changes: $(cat err)"
mkdir once
(cd once && "$geomint" again ../switched.png --out . >../out 2>../err) || fail "again of a switch: $(cat err)"
cmp -s switched.png once/*.png || fail 'again of a switch paints another picture'

# a tour finds its schemes from its own folder
mkdir -p class/schemes
cp gauss.scheme class/schemes/
printf 'title: A tour\nstep: One\nsay: Look.\nshow: kepler scheme=./schemes/gauss.scheme,rk4 until=1\n' >class/a.tour
status 0 tour class/a.tour --list

# on a system
status 0 certify verlet --on henon-heiles --json
python3 - out <<'END' || fail 'certify --on --json'
import json, sys
about = json.load(open(sys.argv[1]))
assert about["system"] == "henon-heiles" and about["holds"] and abs(about["measured"]["order"] - 2) < 0.05
assert about["measured"]["symplectic"] < 1e-10 and about["measured"]["keeps linear invariants"] is None
assert about["properties"]["keeps linear invariants"]["reason"], about
END
status 0 certify verlet --on system 'H=p^2/2 + abs(q)' q=1 p=0 dt=0.1 breaks=ignored --json
grep -q '"order":null,"order_reason":"the system is not smooth' out || fail "a rough system: $(cat out)"
# few steps on one side of a corner decide nothing; those across it do, and what is not quadratic is not called so
printf 'coordinates: q\nmomenta: p\nH: p^2/2 + 9.8*abs(q)\nstart: q = 5, p = 0\ndt: 0.1\nuntil: 20\n' >corner.system
status 0 certify kahan2 --on system 'rate=x = -x*y + cos(t), y = x^2 - y' x=1 y=0.5 dt=.05 # its time is that of the middle
status 0 certify avf2 --on ./corner.system breaks=ignored
[ "$(grep -c 'not decided *the system is not smooth' out)" = 3 ] || fail "beside a corner: $(cat out)"
! grep -q holds out || fail "beside a corner: $(cat out)"
status 0 certify avf2 --on ./corner.system breaks=ignored --json
grep -q '"keeps energy":{"claimed":true,"measured":false,"defect":null.*"reason":"the system is not smooth' out ||
    fail "beside a corner: $(cat out)"
status 4 certify avf2 --on ./corner.system breaks=ignored q=0.05 p=-1
grep -q 'conserves energy *BROKEN *defect' out || fail "across a corner: $(cat out)"
status 0 certify gauss4 --on ./corner.system breaks=ignored q=0 p=1
! grep -q 'quadratic invariants *BROKEN' out || fail "across a corner: $(cat out)"
status 4 certify 'explicit(claims: symmetric; order: 1; 0; 1)' --on ./corner.system breaks=ignored
rm corner.system
# the disc carries tangents: what is measured is the motion
for words in 'system=oscillator' 'system=pendulum'; do
    status 0 certify midpoint --on disc "$words"
    grep -q 'S symplectic *holds *defect' out && grep -q 'H conserves energy *not claimed *defect' out ||
        fail "the motion of the disc: $(cat out)"
    status 4 certify 'explicit(claims: symplectic; order: 1; 0; 1)' --on disc "$words"
    grep -q 'S symplectic *BROKEN *defect' out || fail "the motion of the disc: $(cat out)"
done
status 0 certify midpoint --on disc
grep -q 'Q conserves quadratic invariants *holds *defect.*energy_error' out || fail "the oscillator's energy: $(cat out)"
status 0 certify gauss4 --on kepler eccentricity=0.3 dt=0.02
grep -q 'conserves quadratic invariants *holds *defect.*angular_momentum' out || fail "angular momentum: $(cat out)"
printf 'geomint: 1\ncomponents: x y z\nrate: x = 10*(y - x)\nrate: y = 28*x - y - x*z\nrate: z = x*y - 8/3*z\nstart: x = 1, y = 1, z = 1\n' >butterfly.system
printf 'coordinates: q\nmomenta: p\nH: p^2/2 + q^4/4\nstart: q = 1, p = 0\n' >quartic.system
status 0 certify rk4 --on ./butterfly.system dt=0.01
grep -q 'symplectic *not claimed *the system has no Hamiltonian' out || fail "no Hamiltonian: $(cat out)"
"$geomint" certify 'explicit(claims: symplectic; order: 1; 0; 1)' --on henon-heiles >out 2>err
[ $? = 4 ] || fail 'a false claim holds on a system'
refused 1 'verlet does not fit' certify verlet --on ./butterfly.system
refused 1 'no scene "nowhere"' certify rk4 --on nowhere
refused 1 'takes ordinary differential equations' certify steady --on cavity
refused 1 'one scheme and one value' certify rk4 --on kepler dt=0.1,0.2

# conjugate to Verlet, and stable as it is; the coefficients cancel to noise
status 0 certify 'processed(verlet; splitting(1/3; 1/7))'
grep -q 'stable on the oscillator up to . dt = 2$' out || fail "a processed Verlet: $(grep stable out)"

# the diagram of the order, made again without the files
mkdir -p drawn
printf 'kind: composition\nbase: verlet\nsteps: 1/2, 1/2\n' >halves.scheme
status 0 certify halves.scheme --on ./quartic.system dt=0.01 -o drawn/a.png --size 320x200 --title Halves
grep -q 'wrote drawn/a.png and drawn/a.csv' err || fail "certify -o: $(cat err)"
python3 - drawn/a.csv <<'END' || fail 'the table of the order'
import csv, math, sys
rows = list(csv.DictReader(open(sys.argv[1])))
a, b = rows[2], rows[-1]
slope = math.log(float(a["error"]) / float(b["error"])) / math.log(float(a["dt"]) / float(b["dt"]))
assert len(rows) > 10 and abs(slope - 2) < 0.05, slope
END
rm halves.scheme quartic.system
status 0 again drawn/a.png -o drawn/b.png
cmp drawn/a.png drawn/b.png || fail 'a diagram of the order is not made again'
status 0 certify crank-nicolson --out drawn
[ -s drawn/order.png ] || fail 'certify --out draws nothing'
refused 1 'no diagram: the order of leapfrog' certify leapfrog -o drawn/c.png
refused 1 'the diagram of one scheme' certify all -o drawn/c.png
[ ! -e drawn/c.png ] || fail 'a diagram of nothing'

# nothing is broken where nothing was measured; a method for other motions does not keep the form of constrained ones
status 0 certify 'composition(verlet, boris2; 1/2, 1/2)'
grep -q 'measured nowhere: no problem of the certificates fits it: name a system, --on SYSTEM$' out || fail "$(cat out)"
status 0 certify 'composition(verlet, lobatto2; 1/2, 1/2)'
grep -q 'S symplectic  *holds' out || fail "$(cat out)"
status 0 certify 'composition(rattle2, midpoint; 1/2, 1/2)' --on spherical-pendulum
grep -q 'S symplectic  *not claimed' out || fail "$(cat out)"
status 0 certify 'composition(rattle2, rattle2; 1/2, 1/2)' --on spherical-pendulum
grep -q 'S symplectic  *holds' out || fail "$(cat out)"

# with the digits that are missing
status 0 certify 'composition(verlet; order: 4; 1.3512, -1.7024, 1.3512)' --polish new/folder/polished.scheme
grep -q '1.35120719195965763404768780897' new/folder/polished.scheme || fail "polished: $(cat new/folder/*)"
status 0 certify new/folder/polished.scheme
printf '# my own\nkind: composition\nbase: verlet\norder: 4\nsteps: g, 1 - 2*g, g\nlet: g = 1.35120819 # typed\n' >typed.scheme
"$geomint" certify typed.scheme >/dev/null 2>&1
[ $? = 4 ] || fail 'a wrong digit holds'
status 0 certify typed.scheme --polish better.scheme --json
status 0 certify better.scheme
grep -q '^let: g = 1.35120719195965763404768780897 # typed$' better.scheme || fail "polished: $(cat better.scheme)"
printf 'kind: runge-kutta\norder: 4\na: 0.2500, -0.03868 | 0.53868, 0.2500\nc: 0.2113, # the first\n 0.7887 # the second\nb: 0.5, 0.5\n' >times.scheme
status 0 certify times.scheme --polish better-times.scheme
status 0 certify better-times.scheme
grep -q '^c: 0.211324865405187117745425609749, # the first$' better-times.scheme || fail "c: $(cat better-times.scheme)"
grep -q '^ 0.788675134594812882254574390251 # the second$' better-times.scheme || fail "c: $(cat better-times.scheme)"
status 0 certify 'composition(rk4; order: 4; 0.333333333333333333, 0.666666666666666667)'
status 4 certify 'composition(rk4; order: 4; 0.333333333433333333, 0.666666666666666667)'
status 0 certify 'composition(gauss4; order: 6; 1.1747, -1.3493, 1.1747)' --polish over-gauss.scheme
status 0 certify over-gauss.scheme
grep -q '; 1.17467175808936, -1.34934351617873, ' over-gauss.scheme || fail "polished: $(cat over-gauss.scheme)"
refused 1 'would overwrite' certify typed.scheme --polish ./typed.scheme
refused 1 'no coefficients near these' certify 'composition(verlet; order: 4; 0.50001, 0.49999)' --polish x.scheme
refused 1 'not a scheme of the program' certify rk4 --polish x.scheme
[ ! -e x.scheme ] || fail 'a file was written for nothing'
# what is right, however it is written: filled up with zeros, its stages in another order, one of them twice, one
# that nothing is made of
for scheme in 'splitting(0, 1; 1/2, 1/2; claims: symplectic symmetric; order: 2)' \
    'splitting(1/2, 1/2; 1, 0; claims: symplectic symmetric; order: 2)' \
    'runge-kutta(1/3,5/24,-1/24|0,0,0|2/3,1/6,1/6; 2/3,1/6,1/6; claims: symmetric; order: 4)' \
    'runge-kutta(1/2, 0 | 1/2, 0; 1/2, 1/2; claims: symplectic symmetric; order: 2)' \
    'runge-kutta(1/4, 1/4, 0 | 1/4, 1/4, 0 | 3, 1, 0; 1/2, 1/2, 0; claims: symplectic symmetric; order: 2)'; do
    status 0 certify "$scheme"
done
status 4 certify 'splitting(1; 1; claims: keeps quadratic invariants)'
# decimals are known as far as they are written
"$geomint" certify 'composition(verlet; 1.35120719195966, -1.70241438391932, 1.35120719195966)' |
    grep -q 'order 4, to the 15 digits written: 16 conditions' || fail 'the digits of typed decimals'
"$geomint" certify 'composition(verlet; 1.35120719195966, -1.702414384, 1.35120719195966)' --json |
    grep -q '"theory":{"order":4,"digits":\(9\|10\),' || fail 'the fewest digits of typed decimals'
"$geomint" certify explicit-euler --json | grep -q '"theory":{"order":1,"digits":null,' || fail 'exact fractions have no digits'

[ $failures = 0 ] && echo 'all as it should be'
exit $failures
