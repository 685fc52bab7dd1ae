#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Exercises of tours: each passes with a right answer and not with a near miss, in the explorer and when the saved answer is
# graded; forged answers and wrong conditions are refused. exercises.sh GEOMINT TOURS
set -u
tours=$(realpath "$2")
. "$(dirname "$0")/answers.sh"
GEOMINT_TOURS=$tours
export GEOMINT_TOURS

# answer STEP STEPS RUN [CHANGE]: writes x.answer
answer() {
    printf 'tour: exercises\nstep: %s\nsteps: %s\nrun: %s\n' "$1" "$2" "$3" >x.answer
    [ $# -lt 4 ] || printf 'change: %s\n' "$4" >>x.answer
}

# graded STATUS PATTERN: x.answer has that verdict, in one line behind the name of the exercise
graded() {
    "$geomint" grade x.answer >out 2>err
    status=$?
    [ $status = "$1" ] || fail "grade ends with $status instead of $1: $(cat x.answer out err)"
    [ -s err ] && fail "grade complains: $(cat err)"
    [ "$(wc -l <out)" = 2 ] && sed -n 1p out | grep -q '^exercises, step [1-4]: ' && sed -n 2p out | grep -q "$2" || fail "grade does not say $2: $(cat out)"
}
passes() {
    answer "$@"
    graded 0 '^Passed with '
}
misses() {
    pattern=$1
    shift
    answer "$@"
    graded 4 "^Not passed: .*$pattern"
}

# ---- the four exercises ----

passes 1 62 'disc scheme=verlet dt=1'
passes 1 60 'disc scheme=symplectic-euler dt=pi/3'
misses 'evaluations < 65' 1 69 'disc scheme=verlet dt=0.9'
misses 'area_error < 1e-10' 1 62 'disc scheme=rk4 dt=1'
misses 'energy_error < 1' 1 33 'disc scheme=verlet dt=1.9'
misses 'is at t = 61,' 1 61 'disc scheme=verlet dt=1'
misses 'is at t = 68.25,' 1 35 'disc scheme=verlet dt=1.95' # further steps do not choose the time of judgement
misses 'is at t = 63,' 1 63 'disc scheme=verlet dt=1'
misses 'is at t = 0,' 1 0 'disc scheme=verlet dt=100'
misses 'another radius' 1 62 'disc scheme=verlet dt=1 radius=0.1'
misses 'area_error < 1e-10' 1 62 'disc scheme=rk4 dt=1' '0 1 scheme=verlet'

passes 2 5316 'stiff scheme=verlet dt=0.0395'
misses 't/steps > 0.0392' 2 5384 'stiff scheme=verlet dt=0.039'
misses 'is at t = 62.8761,' 3 632 'kepler eccentricity=0.9 scheme=logh-suzuki4 dt=0.1'
misses 'led beyond' 2 5270 'stiff scheme=verlet dt=0.0399'
misses 'evaluations < steps + 2' 2 5316 'stiff scheme=midpoint dt=0.0395'
# what is changed at the end has made no step: neither a long dt nor another scheme reaches it
misses 'no step since' 1 62 'disc scheme=verlet dt=0.52' '0 62 dt=31'
misses 'no step since' 2 20999 'stiff scheme=verlet dt=0.01' '0 20999 dt=0.0395'
misses 't/steps > 0.0392' 2 20997 'stiff scheme=verlet dt=0.01' '0 20996 dt=0.0395'
misses 'no step since' 2 5317 'stiff scheme=symplectic-euler dt=0.0395' '0 5317 scheme=verlet'
misses 'order > 1.5' 2 5316 'stiff scheme=symplectic-euler dt=0.0395' '0 5315 scheme=verlet'

passes 3 623 'kepler eccentricity=0.9 scheme=logh-kahan-li8 dt=0.1'
# steps of several lengths have one end too
misses 'is at t = 62.7767,' 3 624 'kepler eccentricity=0.9 scheme=logh-kahan-li8 dt=0.1'
misses 'is at t = 62.7316,' 3 622 'kepler eccentricity=0.9 scheme=logh-kahan-li8 dt=0.1'
misses 'runs backwards in time' 1 64 'disc scheme=verlet dt=1' '0 63 dt=-1'
misses 'position_error < 1e-8' 3 623 'kepler eccentricity=0.9 scheme=logh-suzuki4 dt=0.1'
misses 'evaluations < 20000' 3 1249 'kepler eccentricity=0.9 scheme=logh-kahan-li8 dt=0.05'
for show in q1:p1 t:all; do
    passes 3 623 "kepler eccentricity=0.9 scheme=logh-kahan-li8 dt=0.1 show=$show" # the view is free
    passes 3 623 'kepler eccentricity=0.9 scheme=logh-kahan-li8 dt=0.1' "0 100 show=$show"
done
misses 'another eccentricity' 3 628 'kepler eccentricity=0.1 scheme=logh-kahan-li8 dt=0.1'

kutta='explicit(0,\ 0,\ 0\ |\ 1/2,\ 0,\ 0\ |\ -1,\ 2,\ 0;\ 1/6,\ 2/3,\ 1/6'
passes 4 125 "kepler eccentricity=0.3 scheme=$kutta) dt=0.05"
misses 'order > 2.5' 4 125 "kepler eccentricity=0.3 scheme=explicit(0,\\ 0,\\ 0\\ |\\ 1/2,\\ 0,\\ 0\\ |\\ -1,\\ 2,\\ 0;\\ 1/4,\\ 1/2,\\ 1/4) dt=0.05"
misses 'certified > 0' 4 125 "kepler eccentricity=0.3 scheme=$kutta;\\ order:\\ 4) dt=0.05"
misses 'typed > 0' 4 125 'kepler eccentricity=0.3 scheme=ruth3 dt=0.05'

# of several lanes one suffices, and the nearest miss is reported
passes 1 '62 62' 'disc scheme=rk4,verlet dt=1'
misses 'evaluations < 65' 1 '62 69' 'disc scheme=rk4,verlet dt=1,0.9 zip=yes'

# ---- the same verdict in the explorer, whose saved answer is graded alike ----

"$geomint" tour exercises --keys '6s' --screen 80x24 --shot screen.txt || fail 'the explorer'
grep -q 'Task: Preserve the area' screen.txt || fail "the task is not seen: $(cat screen.txt)"
grep -q 'Not passed: RK4 misses area_error < 1e-10' screen.txt || fail "no verdict: $(cat screen.txt)"
grep -q 'Hint:' screen.txt && fail 'the hint is shown before it is asked for'
"$geomint" tour exercises --keys '6s H' --screen 80x24 --shot screen.txt || fail 'H'
grep -q 'Hint: A symplectic scheme' screen.txt || fail "the hint is not seen: $(cat screen.txt)"
grep -q 'Not passed: RK4' screen.txt || fail "the hint hides the verdict: $(cat screen.txt)"
for dt in 1 0.9; do
    rm -f ./*.answer
    "$geomint" tour exercises --keys "s verlet ENTER ENTER $dt ENTER r 7s S" --screen 80x24 --shot screen.txt || fail 'S'
    grep -q 'Saved exercises-0001.answer: geomint grade' screen.txt || fail "S saves nothing: $(cat screen.txt)"
    [ "$(wc -c <exercises-0001.answer)" -lt 200 ] || fail 'the answer is long'
    mv exercises-0001.answer x.answer
    if [ $dt = 1 ]; then
        graded 0 '^Passed with Verlet: '
        grep -q 'Passed with Verlet: ' screen.txt || fail "not passed: $(cat screen.txt)"
    else
        graded 4 '^Not passed: Verlet misses evaluations < 65: evaluations = 70'
        grep -q 'Not passed: Verlet misses evaluations < 65' screen.txt || fail "passed: $(cat screen.txt)"
    fi
done
# a change during the run is repeated
"$geomint" tour exercises --keys '1s s verlet ENTER 6s S' --screen 80x24 --shot screen.txt || fail 'a switch'
mv exercises-0001.answer x.answer
grep -q '^change: 0 [1-9][0-9]* scheme=verlet$' x.answer || fail "no change in $(cat x.answer)"
graded 4 'Verlet, after RK4 misses area_error'

# a copy of a lane goes along, though all that the answer could tell of the two is equal
"$geomint" tour exercises --keys 's verlet ENTER ENTER 1 ENTER r 3s f rk4 ENTER 6s S' --screen 80x24 --shot screen.txt || fail 'a fork'
mv exercises-0001.answer x.answer
grep -q '^run: disc scheme=verlet,verlet dt=1 ' x.answer && grep -q '^change: 1 [1-9][0-9]* scheme=rk4$' x.answer ||
    fail "no fork in $(cat x.answer)"
graded 0 '^Passed with Verlet: '

# ---- what is refused ----

refused 1 'grade takes a file' grade
refused 3 'could not be read' grade nowhere.answer
bad() {
    printf "$2" >bad.answer
    refused 1 "$1" grade bad.answer
}
bad 'a line tour:' ''
bad 'a line run:' 'tour: exercises\nstep: 1\n'
bad 'given twice' 'tour: exercises\ntour: exercises\n'
bad 'no line "passed"' 'tour: exercises\nstep: 1\nrun: disc\nsteps: 1\npassed: yes\n'
bad 'there is no tour' 'tour: exercize5\nstep: 1\nrun: disc\nsteps: 1\n'
bad 'a number from 1 to 4' 'tour: exercises\nstep: 5\nrun: disc\nsteps: 1\n'
bad 'is not an exercise' 'tour: area\nstep: 1\nrun: disc\nsteps: 1\n'
bad 'is about disc' 'tour: exercises\nstep: 1\nrun: kepler\nsteps: 1\n'
bad 'for each lane' 'tour: exercises\nstep: 1\nrun: disc scheme=rk4\nsteps: 1e99\n'
bad 'for each lane' 'tour: exercises\nstep: 1\nrun: disc scheme=rk4,verlet\nsteps: 5\n'
bad 'did you mean verlet' 'tour: exercises\nstep: 1\nrun: disc scheme=verlett\nsteps: 1\n'
bad 'LANE STEP key=value' 'tour: exercises\nstep: 1\nrun: disc scheme=rk4\nsteps: 1\nchange: x\n'
bad 'cannot be changed' 'tour: exercises\nstep: 1\nrun: disc scheme=rk4\nsteps: 2\nchange: 0 1 radius=1\n'
bad 'at most 2048 bytes' "tour: $(head -c 2050 /dev/zero | tr '\0' x)\n"

# an answer that takes too long has no verdict; a lower limit of the process counts
limited() {
    (ulimit -S -t 1 && exec "$geomint" grade x.answer) >out 2>err
    status=$?
    [ $status = 1 ] && [ ! -s out ] && grep -q 'more than a minute of CPU time' err ||
        fail "$1 ends with $status: $(cat out err)"
}
answer 1 100000000 'disc scheme=gauss4 dt=1'
limited 'an answer of many steps'

# one step half way, whose evaluations are few
printf 'tour: exercises\nstep: 1\nsteps: 1\nrun: disc scheme=midpoint dt=32\n' >x.answer
graded 4 'is at t = 32, and the exercise ends at t = 62'

# a condition is read with the tour: a mistake in it has its line and a caret
head='title: x\nstep: a\nsay: b\nask: c\nanswer: d\nshow: kepler scheme=rk4\nuntil: 1\n'
wrong() {
    printf "$head$2\n" >wrong.tour
    "$geomint" tour ./wrong.tour --list >out 2>err
    [ $? = 3 ] && grep -qF "$1" err || fail "$2: $(cat err)"
}
wrong 'line 8' 'expect: energy_eror < 1e-6'
grep -qF 'did you mean energy_error' err || fail "no proposal: $(cat err)"
[ "$(grep -n '\^' err | cut -d: -f1)" = 3 ] && sed -n 2p err | grep -q 'energy_eror < 1e-6' || fail "no caret: $(cat err)"
wrong 'a condition compares two values' 'expect: energy_error'
wrong 'equality of computed numbers is not a condition; compare by < or >' 'expect: steps = 5'
wrong 'there is no value energy_error[1]' 'expect: energy_error[1] < 1'
wrong 'hint: is for an exercise' 'hint: none'
wrong 'show is a word, not a number' 'expect: show > 1'
wrong 'names at least one value' 'expect: 0/0 < 1'
printf 'title: x\nstep: a\nsay: b\nshow: kepler\nexpect: t > 0\n' >wrong.tour
refused 3 'needs show: and ask:' tour ./wrong.tour --list
printf "$head"'expect: q2 < 0.5\n' | sed 's/kepler scheme=rk4/henon-heiles/' >wrong.tour
refused 3 'q2 is where a lane starts' tour ./wrong.tour --list
mkdir folder
printf 'coordinates: q\nparameter: order = 2\nH: p_q^2/2 + order*q^2/2\nstart: q = 1, p_q = 0\n' >folder/own.system
printf "$head"'expect: order > 1\n' | sed 's/kepler/.\/folder\/own.system/' >wrong.tour
refused 3 'order is a name of all exercises and of this scene' tour ./wrong.tour --list

# an answer is graded with the tour that is named, so a teacher's own text decides
sed 's/evaluations < 65/evaluations < 60/' "$tours/exercises.tour" >stricter.tour
answer 1 62 'disc scheme=verlet dt=1'
"$geomint" grade x.answer ./stricter.tour >out
[ $? = 4 ] && grep -q 'evaluations < 60' out || fail "another tour: $(cat out)"

# what was not measured, and what is not a number, meets no condition, nor does its opposite
printf 'coordinates: q\nH: p_q^2/2 + q^2/2 - q^4/9\npart: A = p_q^2/2 + q^2/2\npart: B = -q^4/9\nstart: q = 1, p_q = 0\n' >parts.system
for condition in 'certified > 0' 'order > 1' 'symplectic < 1' 'not 0/(t - t) < 1' 'not sqrt(-1 - t) > 0'; do
    printf "$head"'expect: %s\n' "$condition" | sed 's/kepler/.\/parts.system/' >own.tour
    printf 'tour: own\nstep: 1\nsteps: 10\nrun: ./parts.system scheme=strang(A,B) dt=0.1\n' >x.answer
    "$geomint" grade x.answer ./own.tour >out 2>err
    [ $? = 4 ] || fail "$condition: $(cat out err)"
done

# a lane is one of those that are shown, whichever
printf "$head"'expect: steps > 3\n' | sed 's/rk4/rk4 eccentricity=0.2,0.6 dt=0.1/' >lists.tour
for eccentricity in 0.2 0.6 0.4; do
    printf 'tour: lists\nstep: 1\nsteps: 10\nrun: kepler scheme=rk4 dt=0.1 eccentricity=%s\n' $eccentricity >x.answer
    "$geomint" grade x.answer ./lists.tour >out
    [ $? = "$([ $eccentricity = 0.4 ] && echo 4 || echo 0)" ] || fail "eccentricity $eccentricity of a list: $(cat out)"
done
printf 'tour: lists\nstep: 1\nsteps: 10\nrun: kepler scheme=rk4 dt=0.1 eccentricity=0.6 perturbation=0.01\n' >x.answer
"$geomint" grade x.answer ./lists.tour >out
[ $? = 4 ] && grep -q 'another perturbation' out || fail "a lane like the second one: $(cat out)"

# a parameter that sets the step is free, unless the equations have it too
for rate in '-x' '-k*x' 'k'; do
    printf 'subtitle: k is {k}\nparameter: k = 1; 1e-6 .. 100; the step\nparameter: h = 0.1\nrate: x = y, y = %s\nstart: x = 1, y = 0\ntie: dt = k*h\n' \
        "$rate" >tie.system
    printf "$head"'expect: steps > 3\n' | sed 's/kepler/.\/tie.system/' >tie.tour
    printf 'tour: tie\nstep: 1\nsteps: 20\nrun: ./tie.system scheme=rk4 k=0.5\n' >x.answer
    "$geomint" grade x.answer ./tie.tour >out
    [ $? = "$([ "$rate" = -x ] && echo 0 || echo 4)" ] || fail "a step that follows from k, with the rate $rate: $(cat out)"
done

# a setting without use meets no condition
printf "$head"'expect: tolerance < 1 and steps > 3\n' | sed 's/rk4/dopri5 tolerance=1e-3 dt=0.1/' >setting.tour
printf 'tour: setting\nstep: 1\nsteps: 10\nrun: kepler scheme=verlet dt=0.1\n' >x.answer
"$geomint" grade x.answer ./setting.tour >out
[ $? = 4 ] && grep -q 'tolerance = nan' out || fail "a setting of another scheme: $(cat out)"

# an answer about a system of the tour is graded in any folder, with the tour's own file
printf "$head"'expect: steps > 3\n' | sed 's/kepler scheme=rk4/own.system scheme=rk4 dt=0.1/' >folder/own.tour
"$geomint" tour ./folder/own.tour --keys '3s S' --screen 80x24 --shot screen.txt || fail 'a system of a folder'
grep -q 'Saved own-0001.answer: geomint grade own-0001.answer ./folder/own.tour ' screen.txt || fail "S: $(cat screen.txt)"
mkdir apart
sed 's/^steps: .*/steps: 10/' own-0001.answer >x.answer
cd apart
refused 3 'own.tour could not be read: No such file or directory; the tour may be named' grade ../x.answer
cd ..
"$geomint" grade x.answer ./folder/own.tour >out 2>err || fail "a system of a folder: $(cat out err)"
sed 's/run: [^ ]*/run: own.system/' x.answer >folder/x.answer
"$geomint" grade folder/x.answer ./folder/own.tour >out 2>err || fail "in another folder: $(cat out err)"

# a tour with the name of one of the program's is not taken for it
for name in exercises Exercises; do
    cp folder/own.tour folder/$name.tour
    (cd folder && "$geomint" tour ./$name.tour --keys '3s S' --screen 80x24 --shot screen.txt) || fail 'a namesake'
    grep -qx "tour: $name.tour" folder/$name-0001.answer || fail "a namesake: $(cat folder/*.answer)"
    refused 3 "$name.tour could not be read" grade folder/$name-0001.answer
done
# a tour of the user's folder is found from everywhere, for its answers too
GEOMINT_TOURS=$PWD/folder "$geomint" tour Exercises --keys '3s S' --screen 80x24 --shot screen.txt || fail 'a tour of a folder'
GEOMINT_TOURS=$PWD/folder "$geomint" grade Exercises-0001.answer >out 2>err
[ $? = 4 ] && grep -q '^Exercises, step 1: a$' out || fail "a tour of a folder: $(cat out err)"

# of a long condition the values remain
long=$(for k in 0 1 2 3 4 5 6 7 8 9; do printf 'energy_error < 1e%s + angular_momentum_error and ' $k; done)
printf "$head"'expect: %s t > 9\n' "$long" | sed 's/rk4/rk4 dt=0.1/' >long.tour
printf 'tour: long\nstep: 1\nsteps: 10\nrun: kepler scheme=rk4 dt=0.1\n' >x.answer
"$geomint" grade x.answer ./long.tour >out
[ $? = 4 ] && grep -q '…: energy_error = .*, t = 1\.$' out || fail "a long verdict: $(cat out)"
printf "$head"'expect: t > 0\nat: 0.5 tolerance=1e-3\n' >wrong.tour
refused 3 'line 9: tolerance=1e-3 cannot be changed during the run' tour ./wrong.tour --list
[ "$failures" = 0 ] && echo "exercises: all passed"
exit $((failures > 0))
