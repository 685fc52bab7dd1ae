#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The command line: what it prints, its exit statuses, and bad input. command_line.sh GEOMINT
set -u
geomint=$1
folder=$(mktemp -d) || exit 1
trap 'chmod -R u+w "$folder"; rm -rf "$folder"' EXIT
cd "$folder" || exit 1
unset DISPLAY
failures=0

fail() {
    printf 'FAILED: %s\n' "$1"
    failures=$((failures + 1))
}

# status STATUS WORDS...: the exit status, and that whatever is said is one sentence without a sign of a crash
status() {
    wanted=$1
    shift
    timeout 60 "$geomint" "$@" >out 2>err </dev/null
    got=$?
    [ "$got" = "$wanted" ] || fail "geomint $*: exit $got, not $wanted: $(head -c 200 err)"
    grep -qiE 'sanitizer|assert|segmentation' err && fail "geomint $*: $(head -n 3 err)"
    return 0
}

# refused STATUS PATTERN WORDS...: one sentence on standard error that holds the pattern
refused() {
    wanted=$1
    pattern=$2
    shift 2
    status "$wanted" "$@"
    [ "$(wc -l <err)" = 1 ] || fail "geomint $*: not one sentence: $(cat err)"
    grep -q -- "$pattern" err || fail "geomint $*: says \"$(cat err)\", not \"$pattern\""
}

# what is refused, and the nearest valid thing it names
refused 1 'did you mean disc' run dics
refused 1 'did you mean radius' run disc raduis=1
refused 1 'did you mean rk4' run disc scheme=rk44
refused 1 'did you mean render' rendr disc
refused 1 'did you mean --frames' render disc --frame 3
refused 1 'no option --state' render disc --state
refused 1 'which scene' run
refused 1 'not of the form key=value' run disc verlet
refused 1 'twice' run disc dt=1 dt=2
refused 1 'empty value' run disc dt=
refused 1 'empty value' run disc scheme=,rk4
refused 1 'is not a number' run disc dt=nan
refused 1 'is not a number' run disc dt=abc
refused 1 'the nearest is 1e-6' run disc dt=0
refused 1 'the nearest is 1e-6' run disc dt=-1
refused 1 'the nearest is 100' run disc dt=1e308
refused 1 'out of range' run disc dt=1e308*1e308
refused 1 'the nearest is 3' run disc points=0
refused 1 'the nearest is 1e6' run disc points=1e12
refused 1 'whole number' run disc points=3.5
refused 1 'none of: oscillator, pendulum' run disc system=spring
refused 1 'one of them follows' run disc steps=3 until=4
refused 1 'whole number' run disc steps=-1
refused 1 'equal length' run disc scheme=rk2,rk4 dt=1,2,3 zip=yes
refused 1 'one of: no, yes' run disc zip=maybe
refused 1 'one of: no, yes' run disc zip=yes,no
refused 1 'empty value' run disc zip=
refused 1 'none of: no, yes' run disc compensated=maybe
refused 1 'more than' run disc dt=1,2,3,4,5,6,7,8,9 radius=1,2,3,4,5,6,7,8,9
refused 1 'needs a value' render disc --size
refused 1 'WIDTHxHEIGHT' render disc --size 10x10
refused 1 'light, dark' render disc --theme blue
refused 1 'after the end' render disc --from 100 --frames 3
refused 1 'no scheme' certify nothing
refused 1 'no figure' figures razafindralandy-99
refused 1 'needs --json' run disc --state
refused 3 'not tell how it was made\|could not be read\|No such file' again nothing.png

# output that cannot be written: one sentence, no half file
mkdir closed && chmod a-w closed
if [ "$(id -u)" != 0 ]; then
    refused 3 'closed' render disc --out closed
    refused 3 'closed' run disc --csv closed/a.csv
fi
refused 3 'could not be made\|not a directory\|Not a directory' render disc --out out/there
refused 3 'could not be written' run disc --csv nowhere/a.csv
refused 3 'No space left' run disc --csv /dev/full steps=100000
timeout 60 "$geomint" run disc >/dev/full 2>err
[ $? = 3 ] || fail 'run to a full disk is not exit 3'
grep -q 'No space left' err || fail "a full disk is not told: $(cat err)"
(
    ulimit -f 8
    timeout 60 "$geomint" render disc --out limited 2>err
    [ $? = 3 ] || exit 1
) || fail 'a file-size limit is not exit 3'
[ "$(ls -A limited | wc -l)" = 0 ] || fail "a file-size limit left $(ls -A limited)"

# a broken pipe ends silently with 141
{
    timeout 60 "$geomint" run disc --csv - steps=100000 2>err
    echo $? >code
} | head -n 1 >/dev/null
[ "$(cat code)" = 141 ] || fail "a broken pipe is exit $(cat code), not 141"
[ -s err ] && fail "a broken pipe is not silent: $(cat err)"

# SIGINT in the middle of frames: what is finished stays whole, exit 130
"$geomint" render disc --frames 100000 --size 320x200 --out frames 2>err &
pid=$!
tries=0
while [ "$(ls frames 2>/dev/null | wc -l)" -lt 5 ] && [ $tries -lt 200 ]; do
    sleep 0.05
    tries=$((tries + 1))
done
# a background job of a shell without job control ignores SIGINT; SIGTERM takes the same path
kill -TERM $pid
wait $pid
[ $? = 130 ] || fail 'an interrupted render is not exit 130'
[ "$(ls frames | wc -l)" -ge 5 ] || fail 'an interrupted render kept no frames'
ls -A frames | grep -vE '^disc-render(-[0-9]*\.png|\.checkpoint)$' && fail 'an interrupted render left a temporary file'
for file in $(ls frames/*.png | tail -n 3); do
    [ "$(tail -c 8 "$file" | od -An -tx1 | tr -d ' \n')" = 49454e44ae426082 ] || fail "$file is cut off"
done

# equal=cost: as many evaluations for every scheme, each row of dt by itself; the first scheme keeps its step
status 0 run kepler scheme=verlet,rk4,kahan-li6 dt=0.05,0.1 equal=cost until=100 --json
python3 - out <<'END' || fail "equal=cost: $(cat out)"
import json, sys
lanes = [json.loads(line) for line in open(sys.argv[1])]
by_step = [[lane for lane in lanes[k::2]] for k in (0, 1)]
assert [group[0]["parameters"]["dt"] for group in by_step] == [0.05, 0.1]
for group in by_step:
    assert len(group) == 3
    for lane in group:
        assert abs(lane["evaluations"] / group[0]["evaluations"] - 1) < 0.02, lane
        assert abs(lane["t"] - 100) <= lane["parameters"]["dt"], lane
END
refused 1 'steps= cannot be given with it' run kepler equal=cost steps=3
refused 1 'one of: no, cost' run kepler equal=yes

# numbers
status 0 run disc scheme=explicit-euler dt=0.02 until=5 --json
grep -q '"scene":"disc","scheme":"explicit-euler"' out || fail 'JSON names scene and scheme'
grep -q '"status":"ok","message":"","t":5,"steps":250,"evaluations":250,"solves":0' out || fail "JSON counts: $(cat out)"
grep -q '"energy_error":0.10514882077' out || fail "energy error: $(cat out)"
status 0 run disc steps=3 points=3 --json --state --max
grep -q '"area_max":' out || fail '--max gives NAME_max'
grep -q '"layout":' out && grep -q '"state":\[' out || fail '--state gives state and layout'
status 0 run disc scheme=rk2,rk4 dt=0.1,0.2 --json
[ "$(wc -l <out)" = 4 ] || fail 'lanes are the product of the lists'
status 0 run disc scheme=rk2,rk4 dt=0.1,0.2 zip=yes --json
[ "$(wc -l <out)" = 2 ] || fail 'zip=yes pairs lists'
status 2 run disc scheme=explicit-euler dt=2 until=1000 --json
grep -q '"status":"blow-up"' out || fail "a blow-up is a status: $(cat out)"
status 2 run disc scheme=explicit-euler dt=2 until=1000
grep -q '^  message  *the step after t = ' out || fail "a blow-up tells its reason: $(cat out)"
status 0 run disc --csv history.csv steps=10 --every 5
[ "$(wc -l <history.csv)" = 4 ] || fail "--every 5 of 10 steps is a head and three rows: $(wc -l <history.csv)"
head -n 1 history.csv | grep -q '^scene,lane,scheme,t,area,' || fail 'the head of a CSV'
cp out first
status 0 certify all
tail -n 1 out | grep -q ', 0 broken$' || fail "certify all: $(tail -n 1 out)"
status 0 certify rk4 --json
for what in '' scenes schemes figures disc 'schemes --long' 'disc --json'; do
    # shellcheck disable=SC2086
    status 0 list $what
    [ -s out ] || fail "list $what prints nothing"
done
status 0 --help
status 0 --version
for word in '^geomint [0-9]' 'OSMesa, OpenGL [0-9]\|EGL, OpenGL [0-9]' 'libpng [0-9]' 'GSL [0-9]'; do
    grep -q "$word" out || fail "--version does not say $word"
done

# the same input gives the same output, bit for bit, but for the seconds
"$geomint" run disc scheme=gauss4 system=pendulum --json --state | sed 's/"seconds":[^,]*//' >one
"$geomint" run disc scheme=gauss4 system=pendulum --json --state | sed 's/"seconds":[^,]*//' >two
cmp -s one two || fail 'two runs differ'

# pictures tell how they were made, and can be made again
status 0 render disc scheme=verlet,rk4 dt=0.1,0.2 --size 320x200 --at 3 --out pictures
status 0 again pictures/disc-render.png --out pictures
cmp -s pictures/disc-render.png pictures/disc-render-again.png || fail 'again is another picture'
status 0 render disc --frames 3 --size 320x200 --out sequence
[ "$(ls sequence | wc -l)" = 3 ] || fail '--frames 3 makes three files'
status 0 render disc --every 6 --size 320x200 --out every
[ "$(ls every | wc -l)" = 4 ] || fail "--every 6 of 18 steps makes four files, not $(ls every | wc -l)"
status 2 render disc scheme=explicit-euler dt=2 until=1000 --strict --size 320x200
status 0 render disc scheme=explicit-euler dt=2 until=1000 --size 320x200

[ $failures = 0 ] && echo 'all as it should be'
exit $failures
