#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The command line: what it prints, its exit statuses, and bad input. command_line.sh GEOMINT
set -u
source=$(cd "$(dirname "$0")/../.." && pwd) || exit 1
meshes=$source/tests/reference/meshes
. "$(dirname "$0")/answers.sh"
longest=60

# the four words of a painter, by the option and by the variable, for whatever paints; for nothing else
painters='--painter and GEOMINT_PAINTER take auto, osmesa, egl or own$'
for command in 'render disc until=1' figures 'work-precision disc' 'stability kepler' 'backward disc' 'sweep disc' \
    'certify rk4' 'again a.png' 'tour' terminal; do
    # shellcheck disable=SC2086 # words
    refused 1 "^geomint: \"vulkan\" is not a painter: $painters" $command --painter vulkan
    # shellcheck disable=SC2086 # words
    GEOMINT_PAINTER=vulkan refused 1 "^geomint: \"vulkan\" is not a painter: $painters" $command
done
refused 1 "^geomint: \"vulkan\" is not a painter: $painters" tui disc --painter vulkan
for painter in own osmesa egl; do
    refused 1 "^geomint: --painter $painter paints PNG files and movies; an SVG or PDF file is lines and letters$" \
        render disc --painter $painter -o lines.svg
    refused 1 'paints PNG files and movies' render disc --painter $painter --format pdf
done
status 0 render disc until=1 --painter auto -o lines.svg
GEOMINT_PAINTER=vulkan status 0 run disc steps=1

# what is refused, and the nearest valid thing it names
refused 1 'did you mean disc' run dics
refused 1 'did you mean radius' run disc raduis=1
refused 1 'did you mean rk4' run disc scheme=rk44
refused 1 'did you mean render' rendr disc
refused 1 'did you mean --frames' render disc --frame 3
refused 1 'no option --state; it has --every, --frames' render disc --state
# beginnings and abbreviations before slips; what is far from everything is not guessed at
refused 1 'did you mean eccentricity$' run kepler ecc=0.5
refused 1 'did you mean eccentricity$' run kepler ecty=0.5
refused 1 'did you mean explicit-euler$' run disc scheme=explicit-eulr
refused 1 'did you mean kepler$' keplar
refused 1 'did you mean --theme$' render disc --thm
refused 1 '"nope"; see geomint --help$' nope
refused 1 'no parameter "title"; did you mean --title$' render disc title=foo
refused 1 'no option --vtk; there are --json, --state, --max, --csv' run disc --vtk a
refused 1 'no ending of .npz, .csv, .pvd, .xdmf' run disc --save=a.hdf5
refused 1 '.pvd has a .vtu file for each row' run disc --save=a.vtu
refused 1 'did you mean kepler$' list keplr
refused 1 'did you mean schemes$' list schems
refused 1 'not "xyzzy"$' list xyzzy
refused 1 'has no parameter "nonsense"' list system 'H=p^2/2 + q^2/2' q=1 p=0 nonsense=4
# what makes the square's mesh has no effect on one from a file, and nothing is named without a file
refused 1 '^geomint: rows= has no effect here: the mesh comes from a file$' \
    run room "mesh=$meshes/room-small.msh" rows=20,30 steps=1
refused 1 'irregular= has no effect' render room "mesh=$meshes/room-small.msh" irregular=0.1 steps=1
refused 1 'columns= has no effect' run cavity "mesh=$meshes/square-small.msh" columns=8 steps=1
refused 1 'lid= has no effect here: it is for a mesh=FILE$' run cavity lid=lid steps=1
status 0 run room "mesh=none,$meshes/room-small.msh" rows=10 columns=0 steps=1 --json
python3 -c '
import json
square, drawn = (json.loads(line)["parameters"] for line in open("out"))
made, named = {"rows", "columns", "irregular"}, {"inlet"}
assert made <= set(square) and not named & set(square), square
assert named <= set(drawn) and not made & set(drawn), drawn' || fail 'parameters without effect in JSON'
status 0 stability room "mesh=$meshes/room-small.msh" reynolds=10 dt=0.01
# a mesh in another plane, and triangles that are there twice, are told of once, also where it is refined
plane='^geomint: the mesh lies in a plane of its own: x is its direction ([^()]*), y is ([^()]*)$'
for command in run 'render --size 320x200 --out upright'; do
    # shellcheck disable=SC2086 # words
    status 0 $command room "mesh=$meshes/upright.msh" inlet=in outlet=out dt=0.01,0.02 refine=2 steps=1
    [ "$(grep -c "$plane" err)" = 1 ] || fail "$command of an upright mesh: $(cat err)"
done
printf '%s\n' '$MeshFormat' '4.1 0 8' '$EndMeshFormat' '$Entities' '0 4 0 0' '1 0 0 0 1 0 0 1 9 0' '2 0 0 0 1 0 0 0 0' \
    '3 0 0 0 1 0 0 0 0' '4 0 0 0 1 0 0 0 0' '$EndEntities' '$Nodes' '1 4 1 4' '2 1 0 4' 1 2 3 4 '0 0 0' '1 0 0' \
    '1 1 0' '0 1 0' '$EndNodes' '$Elements' '2 4 1 4' '1 1 1 1' '1 1 2' '2 1 2 3' '2 1 2 3' '3 1 3 4' '4 3 1 2' \
    '$EndElements' >twice.msh
status 0 run cavity mesh=twice.msh lid=9 steps=1 --json
grep -q '^geomint: triangles that the mesh has twice count once: 1$' err || fail "a triangle that is there twice: $(cat err)"
grep -q '"triangles":2' out || fail "a triangle that is there twice counts: $(cat out)"
# sentences on numbers that options do not take say which they do
refused 1 '^geomint: --size 0x0 is not WIDTHxHEIGHT, each of them from 64 to 16384 pixels, or in cm or mm: 16x9cm$' render disc --size 0x0
refused 1 '^geomint: --fps 0 is not a number from 0.01 to 1000$' render disc --fps 0
refused 1 '^geomint: --every 0 is not a whole number from 1 to 1e9$' run disc --every 0
refused 1 '^geomint: --shard 3/2 is not I/N, the I-th of N shards, with I from 1 to N$' render disc --shard 3/2
refused 1 '^geomint: --out is empty$' render disc --out ''
# a word that names no tour is wrong usage, a folder that cannot be read is not
GEOMINT_TOURS=$folder refused 1 'there is no tour "nope"' tour nope
GEOMINT_TOURS=$folder/none refused 3 'could not be opened' tour nope
GEOMINT_TOURS=$folder/none refused 3 'could not be opened' tour
# a comma where the decimal point belongs
refused 1 'dt=0,01: the decimal mark is a point (0.01)' run kepler dt=0,01
refused 1 'the decimal mark is a point (0.1)' run kepler dt=0,1
refused 1 'the decimal mark is a point (0.5)' run kepler eccentricity=0,5
refused 1 'the decimal mark is a point (1.05)' run kepler dt=1,05
status 0 run kepler eccentricity=0,0.5 until=1
refused 1 'the nearest is 1e-7$' run kepler dt=0,2e9,1
# parameters that schemes bring
refused 1 'no scheme that fits scene disc takes tau0=' run disc tau0=0.1
refused 1 'these do: tao2, tao4$' run disc binding=3
refused 1 'which scene' run
refused 1 'not of the form key=value' run disc verlet
refused 1 'twice' run disc dt=1 dt=2
refused 1 'empty value' run disc dt=
refused 1 'empty value' run disc scheme=,rk4
refused 1 'is not a number' run disc dt=nan
refused 1 'is not a number' run disc dt=abc
refused 1 'the nearest is 1e-6' run disc dt=0
refused 1 'between 1e-6 and 100; key B of the explorer turns time' run disc dt=-1
refused 1 'the nearest is 100' run disc dt=1e308
refused 1 'out of range' run disc dt=1e308*1e308
refused 1 'the nearest is 3' run disc points=0
refused 1 'the nearest is 1e6' run disc points=1e12
refused 1 'whole number' run disc points=3.5
refused 1 'none of: oscillator, pendulum' run disc system=spring
refused 1 'steps=3 and until=4 are both given; type one of them, or until=4 dt=1.33333 for both$' run disc steps=3 until=4
refused 1 'or until=1e5 dt=100 for both$' run kepler steps=1000 until=1e5
refused 1 'are both given; type one of them$' run kepler steps=1000,2000 until=1e5
# of rows and columns the one that is not typed follows from the one that is
triangles() {
    status 0 run "$@" steps=0 --json
    sed -n 's/.*"triangles":\([0-9]*\).*/\1/p' out
}
while read -r scene typed same; do
    [ "$(triangles "$scene" "$typed")" = "$(triangles "$scene" $same)" ] || fail "$scene $typed is not $scene $same: $(cat out)"
done <<'END'
room rows=30 rows=30 columns=40
room columns=40 rows=30 columns=40
room rows=50 rows=50 columns=66
room columns=0 rows=50 columns=66
cavity columns=64 columns=64 rows=84
cavity rows=84 columns=64 rows=84
channel rows=20 rows=20 columns=166
channel columns=166 rows=20 columns=166
couette columns=32 rows=24 columns=32
poiseuille columns=32 rows=24 columns=32
taylor-green rows=42 columns=32 rows=42
END
[ "$(triangles channel)" = "$(triangles channel rows=14 columns=98)" ] || fail 'without either the mesh is the usual one'
refused 1 'acute triangles' run room rows=30 columns=66
refused 1 'acute triangles' run room columns=6 # rows are what the lips need
status 0 sweep cavity columns=8,16 steps=0 --measure triangles
[ "$(grep -c ',ok,' out)" = 2 ] || fail "a sweep over columns: $(cat out)"
# names that others use
refused 1 'scheme box does not fit scene kepler: it needs .*; geomint list kepler --long names those that do$' run kepler scheme=box
status 0 certify forward-euler
# a word of options opens the explorer too
status 1 tui --theme light
cp err tui.err
status 1 --theme light
cmp -s err tui.err || fail "--theme without a command: $(cat err)"
refused 1 'there is no option --foo' --foo
# a number and its noun
status 0 render disc scheme=rk4 steps=9 --frames 1 --size 64x64 --out single
[ "$(cat err)" = 'geomint: wrote 1 frame, single/disc-render-*.png' ] || fail "1 frame: $(cat err)"
status 0 render disc scheme=rk4 steps=9 --frames 1 --size 64x64 --out single
grep -q '1 of 1 frame is there already' err || fail "1 frame is there: $(cat err)"
status 0 sweep disc scheme=rk4 until=1 --table single.csv
grep -q '1 of 1 run made now' err || fail "1 run: $(cat err)"
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
refused 3 'not record how it was made\|could not be read\|No such file' again nothing.png

# output that cannot be written: one sentence, no half file
mkdir closed && chmod a-w closed
if [ "$(id -u)" != 0 ]; then
    refused 3 'closed' render disc --out closed
    refused 3 'closed' run disc --csv closed/a.csv
fi
refused 3 'could not be made\|not a directory\|Not a directory' render disc --out out/there
refused 3 'could not be written: Not a directory' run disc --csv out/a.csv
refused 3 'could not be made: Not a directory' run disc --csv out/there/a.csv
refused 3 'No space left' run disc --csv /dev/full steps=100000
timeout 600 "$geomint" run disc >/dev/full 2>err
[ $? = 3 ] || fail 'run to a full disk is not exit 3'
grep -q 'No space left' err || fail "a full disk is not told: $(cat err)"
(
    ulimit -f 8
    timeout 600 "$geomint" render disc --out limited 2>err
    [ $? = 3 ] || exit 1
) || fail 'a file-size limit is not exit 3'
[ "$(ls -A limited | wc -l)" = 0 ] || fail "a file-size limit left $(ls -A limited)"

# a broken pipe ends silently with 141
{
    timeout 600 "$geomint" run disc scheme=verlet --csv - steps=100000 2>err
    echo $? >code
} | head -n 1 >/dev/null
[ "$(cat code)" = 141 ] || fail "a broken pipe is exit $(cat code), not 141"
[ -s err ] && fail "a broken pipe is not silent: $(cat err)"
for words in 'render disc' 'stability --region rk4'; do
    for ending in png svg pdf; do
        {
            trap '' PIPE
            while echo 2>/dev/null; do sleep 0.02; done # until nobody reads
            # shellcheck disable=SC2086
            timeout 600 "$geomint" $words --format $ending -o - 2>err
            echo $? >code
        } | :
        [ "$(cat code)" = 141 ] || fail "$words -o - to a broken pipe, as $ending, is exit $(cat code), not 141"
        [ -s err ] && fail "$words -o - to a broken pipe is not silent: $(cat err)"
    done
done

# SIGINT in the middle of frames: what is finished stays whole, exit 130
"$geomint" render disc --frames 100000 --size 320x200 --out frames 2>err &
pid=$!
tries=0
while [ "$(ls frames 2>/dev/null | wc -l)" -lt 5 ] && [ $tries -lt 6000 ]; do
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

# so is certify, with whole certificates
rm -f out
"$geomint" certify all --json >out 2>err &
pid=$!
tries=0
while [ ! -s out ] && [ $tries -lt 6000 ]; do
    sleep 0.05
    tries=$((tries + 1))
done
kill -TERM $pid
wait $pid
[ $? = 130 ] || fail 'an interrupted certify is not exit 130'
python3 -c 'import json, sys; assert all([json.loads(line) for line in sys.stdin])' <out ||
    fail 'an interrupted certify cut a certificate off'

# an interrupted run says so, with the state and the time that it had come to
for how in --json "--csv -"; do
    rm -f interrupted.csv out
    # shellcheck disable=SC2086
    "$geomint" run disc scheme=verlet steps=1e12 --yes --every 100 $([ "$how" = --json ] && echo --csv interrupted.csv) $how >out 2>err &
    pid=$!
    tries=0
    while [ "$(cat interrupted.csv out 2>/dev/null | wc -l)" -lt 10 ] && [ $tries -lt 6000 ]; do
        sleep 0.05
        tries=$((tries + 1))
    done
    kill -INT $pid
    wait $pid
    [ $? = 130 ] || fail "an interrupted run $how is not exit 130"
    if [ "$how" = --json ]; then
        python3 - <<'END' || fail "an interrupted run: $(cat out)"
import csv, json
lane = json.loads(open("out").read())
assert lane["status"] == "interrupted" and "interrupted" in lane["message"], lane
assert 0 < lane["steps"] < 1e12 and abs(lane["t"] / (lane["steps"] * lane["parameters"]["dt"]) - 1) < 1e-12, lane
last = list(csv.DictReader(open("interrupted.csv")))[-1]
assert last["status"] == "interrupted" and float(last["t"]) == lane["t"], last
assert float(last["energy"]) == lane["observables"]["energy"], last
END
    else
        [ "$(tail -n 1 out | cut -d, -f 5)" = interrupted ] || fail "an interrupted CSV: $(tail -n 1 out)"
        grep -q 'interrupted after t = ' err || fail "an interrupted CSV says nothing: $(cat err)"
    fi
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
grep -q '"status":"ok","message":"","warning":"","t":5,"steps":250,"evaluations":250,"solves":0' out || fail "JSON counts: $(cat out)"
grep -q '"energy_error":0.10514882077' out || fail "energy error: $(cat out)"
status 0 run disc steps=3 points=3 --json --state --max
grep -q '"area_max":' out || fail '--max gives NAME_max'
grep -q '"layout":' out && grep -q '"state":\[' out || fail '--state gives state and layout'

# a run that is ok and yet lost what it should keep says so
warns()
{
    part=$1
    shift
    status 0 run "$@" --json
    grep -q "\"status\":\"ok\",\"message\":\"\",\"warning\":\"[^\"]*$part" out || fail "$*: no warning: $(cat out)"
}
warns 'energy_error is 9.87e+12' kepler scheme=verlet eccentricity=0.9999 steps=30
warns 'energy_error is' stiff system=spring-pendulum scheme=tao4 steps=1
warns 'energy_error is' kepler scheme=lobatto4 dt=10 steps=300
warns '_error is' sine-gordon scheme=midpoint-box
# at the stages of the boxes the energy is kept however long the step; at the nodes its error would be 237
status 0 run wave scheme=gauss-box3 dt=100 steps=10 --json --strict
grep -q '"warning":"".*"energy_error":[0-9.]*e-1[0-9]' out || fail "wave by gauss-box3: $(cat out)"
# what decays is lost like what grows
warns 'area_error is 1: the scheme has 2.5e-07 left of a quantity that the exact motion conserves' disc scheme=implicit-euler until=60
status 0 run disc scheme=implicit-euler until=60
grep -q '^  status  *ok (with a warning)$' out || fail "$(cat out)"
warns 'left of a quantity' stiff scheme=implicit-euler
# an orbit that is all but unbound is another one
warns 'angular_momentum_error is 1.18: the scheme has lost a quantity that the exact motion conserves' kepler eccentricity=0.6 scheme=tao2
warns 'energy_error is 0.723: the scheme has lost' vortices scheme=tao2
warns 'angular_impulse_error is 2.22: the scheme has lost' vortices scheme=tao4
warns 'angular_momentum_error is 10.8: the scheme has lost' kepler eccentricity=0.6 scheme=tao4
status 0 run kepler scheme=verlet eccentricity=0.9999 steps=30
grep -q '^  status  *ok (with a warning)$' out && grep -q '^  warning  *energy_error is' out || fail "$(cat out)"
status 2 run kepler scheme=verlet eccentricity=0.9999 steps=30 --strict
status 0 run kepler scheme=verlet steps=30 --strict
status 2 run disc scheme=implicit-euler until=60 --strict
# what was in the way, and the way out
status 2 run disc system=pendulum scheme=midpoint points=100 dt=40 until=4000 --json
grep -q 'the implicit step after t = [0-9]* was not solved: its .*; take dt below [0-9.e-]*, radau5 or gsl-msbdf",' out || fail "$(cat out)"
status 2 run system H='p^2/2 + q^2/2 - q^3/3' q=2 p=1 scheme=midpoint dt=1 steps=9 --json
grep -q 'its iteration still changes by [0-9.e-]* of the state; take dt below [0-9.e-]*, radau5 or gsl-msbdf",' out || fail "$(cat out)"
status 2 run nls scheme=euler-box dt=0.5 until=50 --json # a field, which radau5 does not fit
grep -q 'the implicit step after t = 1 was not solved to round-off; take a shorter dt",' out || fail "$(cat out)"
# an explicit scheme has no implicit equations
for scheme in rk4 gsl-rk4 gsl-rk8pd gsl-msadams explicit-euler; do
    status 2 run system rate='x = x^2 + exp(x)' x=3 scheme=$scheme dt=5 steps=9 --json
    grep -q '"message":"the \(step after\|scheme found no step\)' out || fail "$scheme: $(cat out)"
    grep -q implicit out && fail "$scheme has implicit equations: $(cat out)"
done
# a scheme that chooses its steps ends where it ends: that is told, and no fault
status 0 run oscillator scheme=variational-midpoint until=20 --strict --json
grep -q '"status":"ok","message":"the scheme is adaptive: the first step that reaches until = 20 ends at t = 20\.[0-9]*","warning":"","t":20\.' out ||
    fail "$(cat out)"
status 0 run oscillator scheme=variational-midpoint until=20
grep -q '^  status  *ok$' out && grep -q '^  message  *the scheme is adaptive' out || fail "$(cat out)"
for quiet in 'stiff' 'wave' 'wave courant=.5' 'disc until=0.6 dt=0.3' 'disc steps=7 dt=0.3' 'kepler scheme=rk2'; do
    # shellcheck disable=SC2086
    status 0 run $quiet --json
    grep -q '"warning":"",' out || fail "$quiet: a warning: $(cat out)"
done
status 0 render kepler scheme=verlet eccentricity=0.9999 steps=30 --size 300x200 --out warned
grep -q 'verlet: warning: energy_error is 9.87e+12' err || fail "render tells the warning: $(cat err)"
status 0 render disc scheme=implicit-euler until=60 --size 300x200 --out warned
grep -q 'implicit-euler: warning: area_error is 1: the scheme has 2.5e-07 left of a quantity that the exact motion conserves' err || fail "render tells the warning: $(cat err)"

# what is signed has its largest magnitude as its maximum; what is not there has a reason
status 0 run kepler scheme=verlet steps=2000 --json --max
python3 - out <<'END' || fail "--max of lrl_angle: $(cat out)"
import json, sys
lane = json.load(open(sys.argv[1]))["observables"]
assert lane["lrl_angle_max"] <= lane["lrl_angle"] < -0.3, lane
END
status 0 run vortices steps=3 --json
grep -q '"pair_distance_error":null' out || fail "pair distance without a pair: $(cat out)"
grep -q '"reasons":{[^}]*"pair_distance_error":"only configuration=collision' out || fail "the reason: $(cat out)"
status 0 run vortices configuration=collision steps=3 --json
grep -q '"pair_distance_error":[0-9]' out || fail "pair distance of a pair: $(cat out)"
status 0 run sine-gordon half_length=3 steps=2
grep -q '^  solution_error  *none: no exact solution' out || fail "a short ring: $(cat out)"

# titles say what is divided by, and what the unit of time is
status 0 list kepler
grep -q '^  energy_error  *energy error  *|H − H₀| / max(|H₀|, 0.5)$' out || fail 'what an error is divided by'
status 0 list disc
grep -q '^  area_tangent .* mean over the members$' out || fail 'of what it is the mean'
status 0 list room
grep -q '^The unit of time is τ = 4H/U,' out || fail 'the unit of time of the room'
status 0 list abc
grep -q '^  log_volume  *ln(volume / initial volume)$' out || fail 'the title of a signed observable'
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
head -n 1 history.csv | grep -q '^scene,lane,scheme,t,status,area,' || fail 'the head of a CSV'
[ "$(cut -d, -f 5 history.csv | sort -u | tr '\n' ' ')" = 'ok status ' ] || fail "the status of rows: $(cat history.csv)"

# JSON is UTF-8 whatever a file's name is
cp "$meshes/room-small.msh" "$(printf 'room\377.msh')"
status 0 run room mesh="$(printf 'room\377.msh')" steps=0 --json
python3 -c 'import json; assert json.load(open("out", encoding="utf-8"))["parameters"]["mesh"] == "room\ufffd.msh"' ||
    fail "JSON of a name that is no UTF-8: $(cat out)"

# standard output for the CSV alone; a column for every key that differs, empty where a scheme does not take it
status 0 run kepler scheme=tao2,verlet binding=1,2 dt=pi/10,0.1 zip=yes steps=2 --csv -
python3 - <<'END' || fail "a CSV of lanes that differ: $(cat out)"
import csv, math
rows = list(csv.DictReader(open("out")))
assert list(rows[0])[:8] == ["scene", "lane", "scheme", "dt", "until", "binding", "t", "status"], rows[0]
assert len(rows) == 6 and all(row["status"] == "ok" for row in rows)
first, last = rows[0], rows[-1]
assert float(first["dt"]) == math.pi / 10 and first["binding"] == "1" and first["lane"] == "0"
assert float(last["dt"]) == 0.1 and last["binding"] == "" and float(last["t"]) == float(last["until"]) == 0.2
END
status 2 run disc scheme=explicit-euler dt=2 until=1000 --csv -
grep -q '^geomint: explicit-euler: blow-up: the step after' err || fail "--csv - hides a failure: $(cat err)"
[ "$(cut -d, -f 5 out | uniq | tr '\n' ' ')" = 'status ok blow-up ' ] || fail "a CSV without its failure: $(tail -n 2 out)"
status 0 run cavity columns=4 rows=0 steps=1 scheme=semi-implicit,crank-nicolson --profile -
head -n 1 out | grep -q '^scene,lane,scheme,t,profile,' || fail "--profile - is not alone: $(head -n 1 out)"
refused 1 'standard output takes one of' run disc --csv - --json
refused 1 'standard output takes one of' run cavity --csv - --profile -

# the folders of what is written are made, and it is said what was
status 0 run cavity columns=4 rows=0 steps=1 --csv new/one/a.csv --profile new/two/b.csv
[ -s new/one/a.csv ] && [ -s new/two/b.csv ] || fail 'run does not make folders'
[ "$(cat err)" = 'geomint: wrote new/one/a.csv
geomint: wrote new/two/b.csv' ] || fail "run does not say what it wrote: $(cat err)"
cp out first
status 0 certify rk4 --json
refused 1 'selects the steps that have a row' run disc --every 3
refused 1 'energy_error is named twice' run kepler --measure energy_error,lrl_angle,energy_error
refused 1 'did you mean systems' list system
# what cannot be compared says why
status 0 work-precision kepler scheme=rk4,verlet until=2 --measure modified_energy2_error -o none.png
grep -q 'none: RK4 is not symplectic' out || fail "no reason of an empty row: $(cat out)"
status 0 work-precision kepler scheme=rk4,verlet until=2 --measure modified_energy2_error -o none.png --json
grep '"scheme":"rk4"' out | grep -q '"reason":"RK4 is not symplectic' || fail "no reason in JSON: $(cat out)"
# a step that goes on for a thousand times the run, where the reference would take millions of steps, has no error
status 0 work-precision outer-planets scheme=logh-kahan-li8,verlet dt=2.5 -o none.png --json
grep '"scheme":"logh-kahan-li8"' out | grep -q '"status":"ok","error":null' || fail "an error without a reference: $(cat out)"
grep '"scheme":"verlet"' out | grep -q '"error":[0-9.e-]*,' || fail "no error of a run with a reference: $(cat out)"
status 0 work-precision kepler perturbation=.01 scheme=logh2 until=.1 dt=.5 -o none.png --json
grep -q '"error":0\.0[0-9]*,' out || fail "no error of a step that the reference follows: $(cat out)"
# without names also RK4 that holds H, where H is constant
status 0 work-precision kepler until=1 dt=.1,.05 -o none.png
[ "$(grep -cE '^kepler,(projected|relaxed)\(rk4; H\),4,.*,ok,' none.csv)" = 4 ] || fail "RK4 that holds H: $(cat none.csv)"
status 0 work-precision duffing until=1 dt=.1,.05 -o none.png
grep -q 'rk4; H' none.csv && fail "a driven H is held: $(cat none.csv)"
for what in '' scenes schemes figures disc 'schemes --long' 'disc --json'; do
    # shellcheck disable=SC2086
    status 0 list $what
    [ -s out ] || fail "list $what prints nothing"
done

# a scheme is listed by its name, by another name of it, and by a word; all schemes of a name are
status 0 list gauss4
grep -q '^gauss4  .* 4  .*Gauss 4, for ordinary' out && grep -q 'a = \[1/4, ' out && grep -q ' gl4$' out || fail "list gauss4: $(cat out)"
status 0 list gauss-box2 --json
[ "$(grep -c '^{"scheme":"box",' out)" = 2 ] || fail "list gauss-box2: $(cat out)"
status 0 list 'composition(verlet; 0.5, 0.5)' --json
grep -q '^{"scheme":"composition(verlet; 0.5, 0.5)",' out || fail "list of a word: $(cat out)"
refused 1 'did you mean gauss4$' list gaus4

# a picture whose scheme was named by another name says which scheme is drawn
status 0 render klein-gordon scheme=box until=0.1 -o named.svg
sed 's/scheme=box/scheme=gauss-box2/' named.svg >older.svg
status 0 again older.svg -o newer.svg
grep -q '^geomint: gauss-box2 is box$' err || fail "no word on an older name: $(cat err)"
status 0 again named.svg -o newer.svg
grep -q ' is box' err && fail "a name is told to be itself: $(cat err)"

# list names the parameters that something takes, and what is taken by default; as wide as it is told
status 0 list scenes --json
python3 - "$geomint" <<'END' || fail 'list SCENE'
import json, os, re, subprocess, sys

def listed(*words, columns=None):
    surroundings = {key: value for key, value in os.environ.items() if key != "COLUMNS"}
    if columns:
        surroundings["COLUMNS"] = str(columns)
    done = subprocess.run([sys.argv[1], *words], env=surroundings, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    return done.returncode, done.stdout.decode(), done.stderr.decode()

brought = ["compensated", "binding", "tau0", "tolerance", "newmark_beta"]
standard = {"compensated": "yes", "binding": "1", "tau0": "0.01", "tolerance": "1e-6", "newmark_beta": "0.1"}
lists = [["scenes", "--long"], ["schemes"], ["figures"], ["schemes", "--long"], ["figures", "--long"]]
for scene in [json.loads(line)["scene"] for line in open("out")]:
    told = json.loads(listed("list", scene, "--json")[1])
    keys = [row["key"] for row in told["parameters"]]
    text = listed("list", scene)[1]
    for key in brought:
        # a parameter is listed exactly where some scheme that fits takes it; elsewhere it is refused and says so
        status, out, err = listed("run", scene, f"{key}={standard[key]}", "steps=0", "--json")
        nobody = f"no scheme that fits scene {scene} takes {key}=" in err
        own = status == 0 and key in json.loads(out)["parameters"]
        elsewhere = "; these do: " in err
        assert nobody + own + elsewhere == 1, (scene, key, err)
        assert (key in keys) == (not nobody) == bool(re.search(f"^  {key} ", text, re.M)), (scene, key)
    # the lanes that are named are those that are run
    assert f"\n  run     {told['run']}\n" in text and f"\n  render  {told['render']}\n" in text, text
    lanes = [json.loads(line) for line in listed("run", scene, "steps=0", "--json")[1].splitlines()]
    assert told["run"] == "scheme=" + ",".join(lane["scheme"] for lane in lanes), (scene, told["run"])
    lists.append([scene])
assert "scheme=box,zabusky-kruskal dt=0.05,0.0025 points=501 zip=yes" in listed("list", "kdv")[1]
for words in lists:
    for columns in (40, 60, 80, 100):
        for line in listed("list", *words, columns=columns)[1].splitlines():
            assert len(line) <= columns, (words, columns, line)
schemes = listed("list", "schemes")[1]
assert "claims: S symplectic, = symmetric, R reversible, " in schemes
rows = [line.split() for line in schemes.split("\n\n")[0].splitlines()]
names = [row[0] for row in rows]
several = [" ".join(row) for row in rows if names.count(row[0]) > 1]
assert len(several) > 5 and all(", for " in row for row in several), several
assert len({(row.split()[0], row.split(", for ")[1]) for row in several}) == len(several), several
END

status 0 --help
cp out help
for word in -h help; do
    status 0 $word
    cmp -s help out || fail "geomint $word is not geomint --help"
done
# a line for each command, and the options of one or of all commands
[ "$(wc -l <help)" -le 45 ] || fail "--help has $(wc -l <help) lines"
for columns in 80 60; do
    COLUMNS=$columns "$geomint" --help >out
    [ "$(wc -L <out)" -le $columns ] || fail "--help has $(wc -L <out) columns, not $columns"
done
[ "$(wc -L <help)" -le 80 ] || fail "--help has $(wc -L <help) columns"
[ "$(grep -c '^  [a-z-]*  ' help)" = "$(grep -c '^GM_COMMAND' "$source/app/commands/commands.def")" ] ||
    fail '--help does not have a line for each command'
grep -q -e --csv help && fail '--help has the options of commands'
status 0 --help --all
grep -q -e --csv out && grep -q -e --graphics out || fail '--help --all lacks options'
status 0 run --help
cp out help
grep -q -e '--csv FILE ' help || fail 'run --help lacks its options'
status 0 run disc -h
cmp -s help out || fail 'geomint run disc -h is not geomint run --help'
"$geomint" help run >out || fail 'geomint help run'
cmp -s help out || fail 'geomint help run is not geomint run --help'
refused 1 'did you mean render' help rendr

# an end that is no whole number of steps is told once, where an end was asked for; schemes for fields alone have one
"$geomint" render sine-gordon scheme=leapfrog,box dt=.03 until=.1 --size 128x96 -o end.png 2>err ||
    fail 'render until=.1 dt=.03'
[ "$(grep -c '^geomint: the run ends at t = 0.09: until = 0.1 is not a whole' err)" = 1 ] || fail "an end that was not told: $(cat err)"
"$geomint" run sine-gordon scheme=leapfrog dt=.03 until=.1 --json >out || fail 'run until=.1 dt=.03'
grep -q '"status":"ok","message":"the run ends at t = 0.09: until = 0.1 is [^"]*","warning":""' out ||
    fail "an end that is no note: $(cat out)"
for scheme in gsl-rk4 gsl-rk8pd gsl-msadams gsl-msbdf; do
    "$geomint" run disc scheme=$scheme dt=.3 until=1 --json >out || fail "run until=1 dt=.3 by $scheme"
    grep -q '"status":"ok","message":"","warning":"".*"t":1,"steps":4,' out || fail "$scheme ends elsewhere: $(cat out)"
done
# with a fixed step size the last step is shortened; steps= makes whole steps
for scheme in rk4 verlet gauss4 tao2 variational-newmark2 dopri5; do
    "$geomint" run disc scheme=$scheme dt=.3 until=1 --json >out || fail "run disc scheme=$scheme until=1"
    grep -q '"status":"ok","message":"","warning":"","t":1,.*"steps":4,' out || fail "another end: $(cat out)"
done
"$geomint" run kepler 'scheme=relaxed(rk4; H)' dt=.3 until=1 --measure relaxation,projection,I1_error --json >out || fail 'relaxed until=1'
grep -q '"message":"","warning":"","t":1,' out || fail "a measured run that does not end at until: $(cat out)"
"$geomint" run disc scheme=rk4 dt=.3 until=1 --measure lyapunov --json >out || fail 'whole steps'
grep -q '"t":1.2,' out || fail "an exponent of steps of two sizes: $(cat out)"
"$geomint" run disc scheme=rk4 dt=.3 steps=4 --json >out || fail 'run steps=4'
grep -q '"t":1.2,' out || fail 'steps= makes no whole steps'
"$geomint" run kepler scheme=rk4 dt=.3 until=1.05 --csv - >out || fail 'run --csv'
[ "$(sed -n '$p' out | cut -d, -f4)" = 1.05 ] || fail 'the last row is not at until'
"$geomint" run kepler scheme=rk4 dt=.3 until=1.05 --checkpoint part.checkpoint >out || fail 'run --checkpoint'
"$geomint" run kepler scheme=rk4 dt=.3 until=2.05 --continue part.checkpoint --json >out || fail 'run on'
"$geomint" run kepler scheme=rk4 dt=.3 until=2.05 --json >whole || fail 'run until=2.05'
sed -i 's/,"seconds":[^,]*//' out whole
cmp -s out whole || fail 'a checkpoint before a shortened step changes a later end'
# steps take time; of a linear wave the midpoint rule conserves its own energy to round-off
"$geomint" run kepler scheme=verlet steps=300000 --json >out || fail 'run steps=300000'
"$geomint" run wave scheme=midpoint-box steps=30 dt=0.01 --json >>out || fail 'run wave'
python3 -c '
import json
orbit, wave = (json.loads(line) for line in open("out"))
assert 1e-4 < orbit["seconds"] < 60, orbit["seconds"]
assert wave["observables"]["energy_error"] < 1e-13, wave' || fail 'the time of steps, or the energy of the midpoint rule'
"$geomint" run system 'rate=x = -1e9*x' x=1 dt=1 until=2 scheme=dopri5 >out
[ $? -eq 2 ] || fail 'dopri5 solves a stiff problem'
grep -q 'a stiff problem needs an implicit scheme, such as radau5$' out || fail "stiffness is not named: $(cat out)"
for tolerance in -1 1e-20 2; do
    refused 1 "tolerance=$tolerance is out of range: it is 0 or lies between 1e-15 and 1" \
        run kepler scheme=dopri5 tolerance=$tolerance
done
"$geomint" render disc scheme=rk4 --at 1 --size 128x96 -o end.png 2>err || fail 'render --at 1'
grep -q 'the run ends' err && fail 'a time in the middle is told as an end'
# a default as long as its column leaves the meanings where they are
COLUMNS=80 "$geomint" list oscillator >out
grep -A1 '^  q0 ' out | grep -q '^ \{30\}position at the start' || fail 'the column of meanings breaks'
status 0 -V
cp out version
status 0 version
cmp -s version out || fail 'geomint version is not geomint -V'
status 0 --version
cmp -s version out || fail 'geomint --version is not geomint -V'
for word in '^geomint [0-9]' '^pictures: PNG' '^loops: [a-z0-9]*; user-defined systems: interpreted' 'libpng [0-9]' 'GSL [0-9]'; do
    grep -q "$word" out || fail "--version does not say $word"
done
GEOMINT_PAINTER=own status 0 --version
grep -q '^painter: own$' out || fail '--version does not say which painter GEOMINT_PAINTER names'
GEOMINT_PAINTER=vulkan status 0 --version
grep -q "^painter: none, as \"vulkan\" is not a painter: $painters" out || fail '--version takes any word for a painter'
GEOMINT_PAINTER='' status 0 --version
grep -q '^painter: auto (osmesa for PNG' out || fail '--version does not say what paints'
# what is loaded only when it is used is missed only then
mkdir broken
for library in libcairo.so.2 libcholmod.so.3 libcholmod.so.4 libcholmod.so.5; do
    : >broken/$library
done
export LD_LIBRARY_PATH="$PWD/broken"
refused 1 'the equations of a flow are solved by SuiteSparse: .*libcholmod.so.[0-9]*: file too short$' \
    run couette steps=1
# OSMesa that cannot be loaded is missed where it was asked for, and else nowhere
mkdir lost
: >lost/libOSMesa.so.8
lost="geomint: osmesa cannot be loaded (.*libOSMesa.so.8: file too short): $painters"
LD_LIBRARY_PATH=$PWD/lost refused 1 "^$lost" render disc until=1 --out lost --painter osmesa
LD_LIBRARY_PATH=$PWD/lost GEOMINT_PAINTER=osmesa refused 1 "^$lost" render disc until=1 --out lost
LD_LIBRARY_PATH=$PWD/lost status 0 render disc until=1 -o lost/own.png --painter auto
grep -aq 'geomint:painter.own' lost/own.png || fail 'a picture without OSMesa is not its own rasteriser'"'"'s'
status 0 render disc until=1 -o lost/osmesa.png --painter auto
grep -aq 'geomint:painter.osmesa, OpenGL' lost/osmesa.png || fail 'a picture is not OSMesa'"'"'s'
LD_LIBRARY_PATH=$PWD/lost refused 1 "^geomint: lost/osmesa.png cannot be reproduced: ${lost#geomint: }" again lost/osmesa.png
LD_LIBRARY_PATH=$PWD/lost status 0 again lost/osmesa.png -o lost/again.svg
LD_LIBRARY_PATH=$PWD/lost status 0 again lost/osmesa.png -o lost/again.png --painter own
cmp -s lost/own.png lost/again.png || fail 'again --painter own is not own'
refused 3 'a PDF needs Cairo, but .*libcairo.so.2: file too short$' render disc until=1 -o broken/a.pdf
status 0 run disc steps=1
# a run opens few libraries, none of those that draw, pack, prove or know terminals; each is missed by what needs it
ldd "$geomint" >out
watched=$(grep -ac __asan_init "$geomint") # a sanitizer brings libraries of its own
[ "$watched" != 0 ] || [ "$(wc -l <out)" -le 6 ] || fail "the program is linked to more than 6 libraries: $(cat out)"
for scene in kepler couette; do
    LD_LIBRARY_PATH='' LD_DEBUG=libs "$geomint" run $scene steps=1 2>&1 >/dev/null | grep 'calling init' >out
    [ $scene = couette ] || [ "$watched" != 0 ] || [ "$(wc -l <out)" -le 6 ] || fail "run opens more than 6 libraries: $(cat out)"
    if grep -E 'lib(cairo|deflate|expat|fontconfig|freetype|gmp|mpfr|ncursesw|png16|tinfo)\.' out; then
        fail "run $scene opens a library that it does not need"
    fi
done
mkdir absent
for library in libdeflate.so.0 libfontconfig.so.1 libmpfr.so.6 libncursesw.so.6 libpng16.so.16; do
    : >absent/$library
done
export LD_LIBRARY_PATH="$PWD/absent"
missed='^geomint: a library is needed here, but .*/absent/lib'
status 0 run kepler steps=1
refused 3 "${missed}mpfr.so.6: file too short$" certify verlet
refused 3 "${missed}deflate.so.0: file too short$" run kepler steps=1 --save absent/a.npz
refused 3 "${missed}fontconfig.so.1: file too short$" render kepler steps=1 -o absent/a.svg
refused 3 "${missed}ncursesw.so.6: file too short$" terminal
rm absent/libfontconfig.so.1 absent/libdeflate.so.0
refused 3 "${missed}png16.so.16: file too short$" render kepler steps=1 --painter own -o absent/a.png
[ -z "$(ls absent | grep -v '^lib')" ] || fail "a library is missing, and something is written: $(ls absent)"
unset LD_LIBRARY_PATH
status 0 terminal
grep -q "painter  *own  *in the terminal$" out || fail 'terminal does not say what paints'
status 0 terminal --painter auto
grep -q "painter  *own  *in the terminal$" out || fail 'a terminal'"'"'s view is not painted by own'
grep -q '^  *osmesa, OpenGL [0-9].* of PNG files and movies$' out || fail 'terminal does not say which OpenGL paints'
# again paints by what has painted, whatever else is asked for in the variable, bit for bit
mkdir painted
for painter in osmesa egl own; do
    status 0 render kepler until=3 --size 320x200 --painter $painter -o painted/$painter.png
    GEOMINT_PAINTER=own status 0 again painted/$painter.png -o painted/again.png
    cmp -s painted/$painter.png painted/again.png || fail "again does not paint by $painter"
    status 0 stability --region rk2 --size 320x200 --painter $painter -o painted/region.png
    GEOMINT_PAINTER=own status 0 again painted/region.png -o painted/again.png
    cmp -s painted/region.png painted/again.png || fail "again does not paint a chart by $painter"
done
# frames and figures
status 0 render disc until=1 --frames 2 --size 320x200 --painter auto --out painted/frames
status 0 figures razafindralandy-2 --quick --painter auto --out painted/figures
for file in painted/frames/disc-render-000001.png painted/figures/razafindralandy-2.png \
    painted/figures/razafindralandy-2-dark.png; do
    grep -aq 'geomint:painter.osmesa, OpenGL' $file || fail "$file is not OSMesa's"
done

# the same input gives the same output, bit for bit, but for the seconds
"$geomint" run disc scheme=gauss4 system=pendulum --json --state | sed 's/"seconds":[^,]*//' >one
"$geomint" run disc scheme=gauss4 system=pendulum --json --state | sed 's/"seconds":[^,]*//' >two
cmp -s one two || fail 'two runs differ'

# pictures tell how they were made, and can be made again
status 0 render disc scheme=verlet,rk4 dt=0.1,0.2 --size 320x200 --at 3 --out pictures
[ "$(cat err)" = 'geomint: wrote pictures/disc-render.png' ] || fail "render does not say what it wrote: $(cat err)"
status 0 again pictures/disc-render.png --out new/three
[ "$(cat err)" = 'geomint: wrote new/three/disc-render-again.png' ] || fail "again does not say what it wrote: $(cat err)"
cmp -s pictures/disc-render.png new/three/disc-render-again.png || fail 'again makes no folder'
status 0 again pictures/disc-render.png --out pictures
cmp -s pictures/disc-render.png pictures/disc-render-again.png || fail 'again is another picture'
refused 1 '"q=2" is too much' again pictures/disc-render.png q=2
# what a panel says of an area without a number is short enough for three of them
status 0 render disc system=pendulum p0=1.9 scheme=midpoint,rk4,gauss4 dt=0.1 until=20 --size 640x400 -o pictures/edge.svg
[ "$(grep -c '>edge not resolved<' pictures/edge.svg)" = 3 ] || fail 'why a disc has no area is cut'
# a lane that failed fails again: its picture says when
status 0 render burgers scheme=ftcs lambda=1 until=0.3 --size 320x200 --out pictures
status 0 again pictures/burgers-render.png --out pictures
cmp -s pictures/burgers-render.png pictures/burgers-render-again.png || fail 'again leaves out that a lane failed'
# a picture of an earlier version may tell a key that has no effect any more
status 0 render room "mesh=$meshes/room-small.msh" steps=1 --size 320x200 --out pictures
python3 - pictures/room-render.png pictures/older.png <<'END' || fail 'the arguments of a picture'
import struct, sys, zlib
old = open(sys.argv[1], "rb").read()
new, at, found = old[:8], 8, 0
while at < len(old):
    size, kind = struct.unpack(">I4s", old[at:at + 8])
    data, at = old[at + 8:at + 8 + size], at + 12 + size
    if data.startswith(b"geomint:arguments"):
        data, found = data + b" rows=20", found + 1
    new += struct.pack(">I4s", len(data), kind) + data + struct.pack(">I", zlib.crc32(kind + data))
open(sys.argv[2], "wb").write(new)
sys.exit(found != 1)
END
status 0 again pictures/older.png --out pictures
status 0 again pictures/room-render.png --out pictures
python3 - pictures/room-render-again.png pictures/older-again.png <<'END' || fail 'a key without effect has one'
import sys
pixels = [data[data.index(b"IDAT"):] for data in (open(name, "rb").read() for name in sys.argv[1:])]
sys.exit(pixels[0] != pixels[1])
END
# a key that the scene had in an earlier version
status 0 render kepler scheme=verlet until=1 -o pictures/q1.svg
sed 's/>kepler scheme=verlet until=1</>kepler scheme=verlet until=1 q1=0.5</' pictures/q1.svg >pictures/earlier.svg
refused 3 'until=1 q1=0.5"; render them without the refused one: scene kepler has no parameter "q1"' again pictures/earlier.svg
status 0 render disc --frames 3 --size 320x200 --out sequence
[ "$(ls sequence | wc -l)" = 3 ] || fail '--frames 3 makes three files'
[ "$(cat err)" = 'geomint: wrote 3 frames, sequence/disc-render-*.png' ] || fail "frames are not told: $(cat err)"
status 0 render disc --frames 2 --size 320x200 --out deep/er/sequence
[ "$(ls deep/er/sequence | wc -l)" = 2 ] || fail 'the folders of --out are not made'
if command -v ffmpeg >/dev/null; then
    status 0 render disc --frames 2 --size 64x64 --movie new/four/disc.gif
    [ "$(cat err)" = 'geomint: wrote new/four/disc.gif' ] && [ "$(ls new/four)" = disc.gif ] ||
        fail "a movie in a new folder: $(cat err)"
fi
status 0 render disc --every 6 --size 320x200 --out every
[ "$(ls every | wc -l)" = 4 ] || fail "--every 6 of 18 steps makes four files, not $(ls every | wc -l)"
status 2 render disc scheme=explicit-euler dt=2 until=1000 --strict --size 320x200
status 0 render disc scheme=explicit-euler dt=2 until=1000 --size 320x200
# of render --strict looks at failures alone, which frames remember when a render goes on
status 0 render kepler scheme=verlet eccentricity=0.9999 steps=30 --strict --size 320x200
grep -q 'verlet: warning: energy_error is' err || fail "a picture's warning: $(cat err)"

# a page for a browser: its template comes from another build, and is two lines here
printf '<p>{{view}}\n</p>\n' >template
GEOMINT_WEB=$PWD/nowhere refused 3 'could not be read: No such file or directory; ./geomint setup web builds' web disc -o none.html
export GEOMINT_WEB="$PWD/template"
mkdir -p systems/deep
printf 'geomint: 1\ntitle: A </script><b> & "spring"\ncoordinates: q\nmomenta: p\nH: p^2/2 + q^2/2\nstart: q = 1, p = 0\n' >systems/deep/own.system
status 0 web systems/deep/own.system scheme=rk4,verlet dt=0.1 -o page.html
grep -qx 'geomint: wrote page.html' err || fail "what web prints: $(cat err)"
python3 - <<'END' || fail 'the view of a page'
import json
page = open("page.html").read()
assert page.startswith("<p>{") and page.endswith("\n</p>\n") and page.count("<") == 2, page
view = json.loads(page[3:-5])
assert view["words"] == ["own.system", "scheme=rk4,verlet", "dt=0.1"], view["words"]
assert view["title"] == 'A </script><b> & "spring"', view["title"]
assert view["files"] == {"own.system": open("systems/deep/own.system").read()}, view["files"]
END
GEOMINT_WEB=$PWD/page.html refused 3 'is not one of ./geomint setup web' web disc -o none.html
refused 1 'there is no tour "A"' web --tour A -o none.html
status 0 web --tour area --title 'Area for 7b' -o tour.html
python3 - <<'END' || fail 'the steps of a tour in a page'
import json
view = json.loads(open("tour.html").read()[3:-5])
steps = view["steps"]
assert view["title"] == "Area for 7b" and len(steps) == 7 and steps[1]["show"] == ["disc", "scheme=explicit-euler", "until=2*pi"], view
assert steps[5]["changes"] == [{"t": 30, "lane": 0, "text": "scheme=midpoint"}] and steps[5]["until"] == 60, steps[5]
assert view["tour"] == "area" and not any(step["exercise"] for step in steps), view
END
"$geomint" list exercises --source >own.tour
status 0 web --tour ./own.tour -o tour.html
python3 - <<'END' || fail 'the exercises of a tour in a page'
import json
view = json.loads(open("tour.html").read()[3:-5])
assert view["tour"] == "own.tour" and view["files"]["own.tour"] == open("own.tour").read(), view
assert all(step["exercise"] and step["hint"] for step in view["steps"]), view["steps"]
END
# a lesson is not written over what it is made of
printf 'title: x\nstep: a\nsay: b\nshow: ./systems/deep/own.system\n' >own.tour
cp own.tour own.html
refused 1 'would overwrite ./own.html, which is read' web --tour ./own.html -o own.html
refused 1 'a page is HTML: its name ends in .html or .htm, but not systems' web --tour ./own.tour -o systems/deep/own.system
refused 1 'a page is HTML' web disc -o Makefile
printf 'geomint: 1\ncoordinates: q\nmomenta: p\nH: p^2/2 + (\n' >wrong.system
refused 1 'wrong.system:4:' web wrong.system -o none.html
refused 1 'sphere' web disc scheme=sphere -o none.html
# what the page could not open is refused before: equations for SuiteSparse, and files that it does not have
for scene in cavity room; do
    refused 1 'the equations of a flow are solved by SuiteSparse: a browser does not have it' web $scene -o none.html
done
refused 3 'flow are solved by SuiteSparse: a browser does not have it' web --tour room -o none.html
refused 1 'forms are solved by SuiteSparse: a browser does not have it' web form-poisson -o none.html
refused 3 'forms are solved by SuiteSparse: a browser does not have it' web form-cochain -o none.html
status 0 web form-heat -o page.html
printf '%s\n' '$MeshFormat' '2.2 0 8' '$EndMeshFormat' '$Nodes' 4 '1 0 0 0' '2 1 0 0' '3 .5 .8 0' '4 1.5 .8 0' '$EndNodes' \
    '$Elements' 2 '1 2 2 1 1 1 2 3' '2 2 2 1 1 2 4 3' '$EndElements' >two.msh
printf 'mesh: two.msh\nfield: u = 0-form\nrate: u = laplace(u)\nstart: u = 1 + x\nschemes: rk4\ndt: 0.05\n' >plate.system
status 0 run plate.system steps=1
mkdir -p plates/meshes && cp plate.system plates && cp two.msh plates/meshes && sed -i 's/two.msh/meshes\/two.msh/' plates/plate.system
status 0 web plates/plate.system -o page.html
python3 - <<'END' || fail 'the mesh of a page'
import json
view = json.loads(open("page.html").read()[3:-5])
assert view["words"] == ["plate.system"] and view["files"]["meshes/two.msh"] == open("two.msh").read(), view["files"]
END
refused 1 'web takes a scene or --tour' web disc --tour area -o none.html
refused 3 'none/page.html could not be written: No such file' web disc -o none/page.html
"$geomint" list crouzeix3 --source >own.scheme
printf 'title: T\nabout: A\nstep: A\nsay: A.\nshow: disc scheme=rk4\nuntil: 1\nat: 0.5 scheme=deep/own.scheme\n' >systems/own.tour
cp own.scheme systems/deep
status 0 web disc 'scheme=rk4,./own.scheme,composition(verlet; 1/2, 1/2)' -o page.html
status 0 web --tour systems/own.tour -o tour.html
python3 - <<'END' || fail 'the schemes of a page'
import json
view, tour = (json.loads(open(name).read()[3:-5]) for name in ["page.html", "tour.html"])
assert view["words"] == ["disc", "scheme=rk4,own.scheme,composition(verlet; 1/2, 1/2)"], view["words"]
assert tour["steps"][0]["changes"][0]["text"] == "scheme=deep/own.scheme", tour["steps"]
assert view["files"]["own.scheme"] == tour["files"]["deep/own.scheme"] == open("own.scheme").read()
END
mkdir -p other/deep && sed 's/H: /H: 2*/' systems/deep/own.system >other/deep/own.system
printf 'title: T\nabout: A\nstep: A\nsay: A.\nshow: deep/own.system\nuntil: 1\nstep: B\nsay: B.\nshow: ../systems/deep/own.system\nuntil: 1\n' >other/two.tour
status 0 web --tour ./other/two.tour -o page.html
cp -r systems/deep .
sed -i 's/systems.deep/deep/' other/two.tour
refused 1 'two different files are called deep/own.system' web --tour ./other/two.tour -o none.html
# one file may be named in several ways; a path of this machine leads nowhere in a page; a system of the user's folder is one there
printf 'title: T\nstep: A\nsay: A.\nshow: own.system\nuntil: 1\nstep: B\nsay: B.\nshow: ./../deep/own.system\nuntil: 1\n' >deep/ways.tour
status 0 web --tour ./deep/ways.tour -o page.html
printf 'title: T\nstep: A\nsay: A.\nshow: %s/own.system\nuntil: 1\n' "$PWD/deep" >deep/absolute.tour
refused 1 'its tour names files by paths from its own folder' web --tour "$PWD/deep/absolute.tour" -o none.html
mkdir 'deep/a folder' && cp deep/own.system 'deep/a folder'
sed -i 's/own.system/a\\ folder\/own.system/' deep/absolute.tour
refused 1 'its tour names files by paths from its own folder' web --tour "$PWD/deep/absolute.tour" -o none.html
printf '# %s\ntitle: T\nstep: A\nsay: /A/.\nshow: a\\ folder/own.system\nuntil: 1\nstudy: stability own.system scheme=rk4\n' "$PWD/deep/own.system" \
    >deep/absolute.tour
status 0 web --tour "$PWD/deep/absolute.tour" -o page.html
grep -q '"study":"stability own.system scheme=rk4"' page.html || fail 'the study of a page'
printf 'title: T\nstep: A\nsay: A.\nshow: folders-own\nuntil: 1\n' >deep/folder.tour
mkdir -p of_user/meshes && cp plate.system of_user/folders-own.system && cp two.msh of_user/meshes
sed -i 's/two.msh/meshes\/two.msh/' of_user/folders-own.system
GEOMINT_SYSTEMS=$PWD/of_user status 0 web --tour ./deep/folder.tour -o folder.html
python3 - <<'END' || fail 'a system of the folder'
import json
view = json.loads(open("folder.html").read()[3:-5])
assert view["steps"][0]["show"][0] == "folders-own", view["steps"]
folder = "home/web_user/.config/geomint/"
assert sorted(view["files"]) == ["folder.tour", folder + "folders-own.system", folder + "meshes/two.msh"], list(view["files"])
END
cp "$GEOMINT_WEB" template.html
GEOMINT_WEB=./template.html refused 1 'would overwrite ./template.html, which is read' web disc -o template.html
[ ! -e none.html ] || fail 'a page was written that is refused'

[ $failures = 0 ] && echo 'all as it should be'
exit $failures
