#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What ends a run or changes its state in the middle of a step: stops, sections, events, and breaks of the rates.
# events.sh GEOMINT
set -u
. "$(dirname "$0")/answers.sh"

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
# what begins near a surface, but not on it, passes it, however long the first step is
printf 'components: y v\nrate: y = v, v = 0\nevent: bounce; y = 0, v < 0; v = -v\nstart: y = 1, v = -1\nuntil: 3\n' >near.system
sed 's/event: .*/stop: y/' near.system >ends.system
for y in 1e-7 5e-8 1e-9; do
    "$geomint" run near.system y=$y dt=0.1 scheme=rk4 --json --state >out || fail "near a surface, $y"
    python3 -c 'import json, sys; end = json.load(open("out")); assert end["observables"]["events"] == 1 and abs(end["state"][0] - 3 + float(sys.argv[1])) < 1e-9, end' $y || fail "near a surface, $y: $(cat out)"
    "$geomint" run ends.system y=$y dt=0.1 scheme=rk4 --json >out || fail "near an end, $y"
    python3 -c 'import json, sys; end = json.load(open("out")); assert end["stopped"] and abs(end["t"] - float(sys.argv[1])) < 1e-12, end' $y || fail "near an end, $y: $(cat out)"
done
# also where g is flat
sed 's/y = 0, v < 0/y^3 = 0, v < 0/' near.system >flat.system
"$geomint" run flat.system y=1e-9 dt=0.1 scheme=rk4 --json | grep -q '"events":1\b' || fail 'near a flat surface'
# a start on a surface is there by the rounding of its numbers, however large they are, and however short a step
printf 'rate: x = v, v = -x\nevent: x = 0.5, v < 0; v = 0.5*v\nstart: x = cos(pi/3), v = -sin(pi/3)\nuntil: 1\n' >round.system
for dt in 0.1 1e-3 1e-5; do
    "$geomint" run round.system dt=$dt scheme=rk4 --json | grep -q '"events":0\b' || fail "a rounded start, dt=$dt"
done
printf 'parameter: R = 6371e3\nparameter: a = 1\nrate: x = u, y = v, u = 0, v = 0\nstop: sqrt(x^2 + y^2) - R\n' >above.system
printf 'start: x = R*cos(a), y = R*sin(a), u = 100*cos(a), v = 100*sin(a)\nuntil: 1\ndt: 0.1\n' >>above.system
for a in 0.14 0.16 0.24 0.27 0.28 0.29; do
    "$geomint" run above.system a=$a scheme=rk4 --json | grep -q '"t":1,' || fail "a start on a large circle, $a"
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

[ $failures = 0 ] && echo 'all as it should be'
exit $failures
