#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Engines on the command line: the same numbers, told which; a second start needs no compiler; the cache listed and
# emptied; what is refused. engines.sh GEOMINT SOURCE
set -u
GEOMINT_KERNEL=$2
GEOMINT_COMPILER_SECONDS=200 # the machine may have much else to do
export GEOMINT_KERNEL GEOMINT_COMPILER_SECONDS
. "$(dirname "$0")/answers.sh"
XDG_CACHE_HOME=$folder/caches
export XDG_CACHE_HOME

# numbers ENGINE WORDS...: what the program tells, but for the engine and the seconds
numbers() {
    engine=$1
    shift
    status 0 run "$@" --json --state --engine "$engine"
    sed -E 's/"engine":"[a-z]*",//; s/"seconds":[^,]*,//' out
}

numbers interpreted kepler-space until=20 scheme=verlet >interpreted
grep -q '"engine":"interpreted"' out || fail "an interpreted run tells no engine"
numbers native kepler-space until=20 scheme=verlet >native
grep -q '"engine":"native"' out || fail "a native run tells no engine: $(cat err)"
cmp -s interpreted native || fail "the engines' numbers differ"
entries=$(ls "$XDG_CACHE_HOME/geomint" | wc -l)
[ "$entries" = 1 ] || fail "$entries files in the cache, not 1"

# bases in turns: the loops of one family, or of several
for bases in 'rk4, rk2' 'avf2, rk4, verlet, midpoint'; do
    turns="scheme=composition($bases; 0.3, 0.5, 0.2, 0)"
    numbers interpreted kepler-space until=5 "$turns" >interpreted_turns
    numbers native kepler-space until=5 "$turns" >native_turns
    grep -q '"engine":"native"' out || fail "$bases in turns: not native: $(cat err)"
    cmp -s interpreted_turns native_turns || fail "$bases in turns: the engines' numbers differ"
done
# located breaks: one kernel for all sides, in loops that end there, and in a scheme that has none
for scheme in verlet gauss4 avf2; do
    numbers interpreted system 'H=p^2/2 + if(q > 0, 4, 1)*q^2/2 + floor(3*q)' q=0 p=1 until=20 "scheme=$scheme" >interpreted_breaks
    numbers native system 'H=p^2/2 + if(q > 0, 4, 1)*q^2/2 + floor(3*q)' q=0 p=1 until=20 "scheme=$scheme" >native_breaks
    grep -q '"engine":"native"' out || fail "breaks with $scheme: not native: $(cat err)"
    cmp -s interpreted_breaks native_breaks || fail "breaks with $scheme: the engines' numbers differ"
done
rm -r "$XDG_CACHE_HOME/geomint"
numbers native kepler-space until=20 scheme=verlet >native

# no compiler is needed twice
real=$PATH
mkdir bin
printf '#!/bin/sh\necho called >>"%s/calls"\nexec "%s" "$@"\n' "$folder" "$(command -v cc)" >bin/cc
chmod +x bin/cc
PATH=$folder/bin:$PATH
for until in 20 21; do
    status 0 run kepler-space until=$until scheme=verlet --engine native --json
    grep -q '"engine":"native"' out || fail "with a compiler of its own: $(cat err)"
done
[ "$(wc -l <calls)" = 1 ] || fail "the compiler was called $(wc -l <calls) times, not once"
# one that spoils the cache, or is sent away while it works, leaves the interpreter
printf '#!/bin/sh\nchmod 755 "$TMPDIR"\n' >bin/cc
status 0 run lorenz until=1 --engine native
grep -q 'only you may open' err || fail "a cache that is spoilt meanwhile: $(cat err)"
chmod 700 "$XDG_CACHE_HOME/geomint"
printf '#!/bin/sh\ntouch "%s/compiling"\nexec sleep 1000\n' "$folder" >bin/cc
"$geomint" run lorenz until=1 --engine native >out 2>err &
pid=$!
while [ ! -e compiling ] && kill -0 $pid; do
    sleep 0.02
done
kill -INT $pid
wait $pid
code=$?
[ "$code" = 130 ] || fail "interrupted while it compiles: $code"
printf '#!/bin/sh\nexit 1\n' >bin/cc
PATH=$real

# of several processes at once one entry stays
status 0 cache --clear
for i in 1 2 3; do
    "$geomint" run kepler-space until=21 scheme=yoshida4 --engine native --json >out$i 2>err$i &
done
wait
for i in 1 2 3; do
    grep -q '"engine":"native"' out$i || fail "beside others: $(cat err$i)"
done
entries=$(ls "$XDG_CACHE_HOME/geomint" | wc -l)
[ "$entries" = 1 ] || fail "$entries files in the cache, not 1, after others"

# nor does it matter that somebody empties the cache all the while: who loses its entry is interpreted, and told
numbers interpreted kepler-space until=21 scheme=yoshida4 >interpreted21
{ while [ ! -e done ]; do "$geomint" cache --clear >/dev/null; done; } &
clearing=$!
for i in 1 2 3 4; do
    numbers native kepler-space until=21 scheme=yoshida4 >native21
    cmp -s interpreted21 native21 || fail "while the cache is emptied the numbers differ"
    [ ! -s err ] || grep -q interpreted: err || fail "while the cache is emptied: $(cat err)"
done
touch done
wait "$clearing"
status 0 cache --clear
status 0 run kepler-space until=21 scheme=yoshida4 --engine native --json

# another build has entries of its own in the same cache
cp "$geomint" other_build
here=$geomint
geomint=$folder/other_build
numbers native kepler-space until=21 scheme=yoshida4 >native21
geomint=$here
grep -q '"engine":"native"' out || fail "another build is not native: $(cat err)"
cmp -s interpreted21 native21 || fail "another build's numbers differ"
entries=$(ls "$XDG_CACHE_HOME/geomint" | wc -l)
[ "$entries" = 2 ] || fail "$entries files in the cache of two builds, not 2"
status 0 cache --clear
status 0 run kepler-space until=21 scheme=yoshida4 --engine native --json

status 0 cache
grep -q '^1 kernel of [0-9]* bytes in ' out || fail "cache tells $(cat out)"
status 0 cache --clear
grep -q '^1 removed from ' out || fail "cache --clear tells $(cat out)"
[ -z "$(ls "$XDG_CACHE_HOME/geomint")" ] || fail "cache --clear leaves $(ls "$XDG_CACHE_HOME/geomint")"

# where it cannot be had a sentence says why, and the numbers are there
PATH=$folder/bin:/usr/bin:/bin
numbers native kepler-space until=20 scheme=verlet,ruth3 >other
[ "$(grep -c interpreted: err)" = 1 ] || fail "with a compiler that fails: $(cat err)"
head -n 1 other | sed 's/"message":"[^"]*",//' >one
sed 's/"message":"[^"]*",//' interpreted | cmp -s - one || fail "with a compiler that fails the numbers differ"
PATH=$real
status 0 run system L='v_q^2/2 - q^2/2' q=1 p=0 until=1 --engine native
grep -q 'Lagrangian' err || fail "a Lagrangian is native: $(cat err)"
GEOMINT_KERNEL=$folder status 0 run lorenz until=1 --engine native
grep -q 'interpreted: the compiler failed' err || fail "without sources: $(cat err)"
status 0 run driven-pendulum scheme=verlet until=1 --engine native
grep -q 'interpreted: splittings have native loops where' err || fail "a splitting with the time: $(cat err)"
status 0 cache --clear
[ -z "$(ls "$XDG_CACHE_HOME/geomint")" ] || fail "what failed leaves $(ls "$XDG_CACHE_HOME/geomint")"
# an entry that is a folder with something in it is named, each time
status 0 run lorenz until=1 --engine native
entry=$(ls -d "$XDG_CACHE_HOME"/geomint/*.so)
rm "$entry"
mkdir "$entry"
touch "$entry/something"
for i in 1 2; do
    status 0 run lorenz until=1 --engine native
    grep -q "interpreted: $entry could not be written: Is a directory" err || fail "an entry that is a folder: $(cat err)"
done
rm -r "$entry"
# a disk that becomes full while the compiler works: what it complains of is told, and nothing stays
mkdir disk
cat >full.sh <<'END'
mount -t tmpfs -o size=20k none disk || exit 77
XDG_CACHE_HOME=$PWD/disk "$1" run lorenz until=1 --engine native --json >out 2>err || exit
ls disk/geomint >left
END
unshare -rm sh full.sh "$geomint" 2>refusal
code=$?
if [ "$code" = 77 ] || [ -s refusal ]; then
    echo "no disk of its own: $(cat refusal)"
else
    [ "$code" = 0 ] && grep -q '"engine":"interpreted"' out || fail "on a full disk: $(cat out err)"
    grep -q 'the compiler failed: .*No space left on device' err || fail "of a full disk: $(cat err)"
    [ ! -s left ] || fail "a full disk keeps $(cat left)"
fi
# a built-in problem in C has no engine
status 0 run vortices until=1 --json --engine native
grep -q '"engine"' out && fail "a built-in problem tells an engine"

refused 1 'none of: auto, interpreted, native' run lorenz --engine fast
refused 1 'takes no word' cache everything
refused 1 'no option --engine' certify rk4 --engine native
chmod 755 "$XDG_CACHE_HOME/geomint"
refused 3 'only you may open' cache
exit "$((failures > 0))"
