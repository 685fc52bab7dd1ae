#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Rooms of files: numbers, and what is wrong with one, in a sentence. rooms.sh GEOMINT ROOMS
set -u
rooms=$2
meshes=$(cd "$(dirname "$0")/../reference/meshes" && pwd) || exit 1
. "$(dirname "$0")/answers.sh"

# NAME in the JSON of a run that went well, between two numbers
within() {
    python3 -c 'import json, sys; run = json.load(open("out")); value = run["observables"][sys.argv[1]]
assert run["status"] == "ok" and float(sys.argv[2]) <= value <= float(sys.argv[3]), (sys.argv[1:], value)' "$@" ||
        fail "$*"
}

# observables that are formulas of the flow's forms: the same numbers as those that the program has by a name
formulas() {
    geomint_room=$1
    shift
    status 0 list "$geomint_room" --source
    {
        cat out
        echo 'let: energy = inner(u, u)/2'
        echo 'observe: of_energy = energy; title mine'
        echo 'observe: of_enstrophy = inner(w, w)/2'
        echo 'observe: of_scalar = integral(scalar)'
        echo 'observe: of_area = integral(1)'
        echo 'observe: of_time = t'
        for line in "$@"; do
            echo "$line"
        done
    } >forms.room
}
equal() {
    python3 -c 'import json, sys; seen = json.load(open("out"))["observables"]
for pair in sys.argv[1:]:
    mine, its = (eval(part, {}, seen) for part in pair.split("=="))
    assert abs(mine - its) <= 1e-13*abs(its), (pair, mine, its)' "$@" || fail "$*"
}
cp "$rooms/heated.msh" "$rooms/office.msh" .
formulas heated 'observe: of_heat = integral(temperature)'
status 0 run ./forms.room until=0.2 --json
equal of_energy==kinetic_energy of_enstrophy==enstrophy of_heat/of_area==temperature_mean of_time==0.2
for star in circumcentric barycentric; do
    formulas office
    status 0 run ./forms.room until=0.2 star=$star --json
    equal of_energy==kinetic_energy of_enstrophy==enstrophy of_scalar==scalar_total of_scalar/of_area==scalar_mean
done
formulas cavity 'let: u = 3' 'observe: of_name = u*min(psi)'
refused 1 'inner is of two forms of one type, and these are a number and a number' run ./forms.room
formulas cavity 'observe: psi_least = min(psi)' 'observe: wrong = psi'
refused 1 'psi is a 0-form, and has to be a number here' run ./forms.room
formulas cavity 'wall: bottom tangential = max(psi)'
refused 1 'forms of the flow, such as psi, are for the lines let: and observe:' run ./forms.room
formulas cavity 'wall: bottom tangential = energy'
refused 1 'forms of the flow, such as psi, are for the lines let: and observe:' run ./forms.room
formulas cavity 'wall: bottom tangential = integral(1)'
refused 1 'integral' run ./forms.room
formulas cavity 'observe: triangles = 3'
refused 1 'observe: is given twice' run ./forms.room
formulas cavity 'observe: warm = max(temperature)'
refused 1 'there is no name temperature' run ./forms.room

# rooms have names, which are proposed
status 0 list rooms
grep -q '^heated  *A heated room' out || fail "list rooms: $(head -n 3 out)"
refused 1 'did you mean heated' run heeted

# a group that no edge belongs to is no inlet of a room without wind; one without a name is known by its number
sed '/PhysicalNames/{n;s/^5$/6/}; /^1 11 "in"/i 1 15 "nowhere"' "$meshes/groups-2.2.msh" >empty.msh
refused 1 "no edge of the mesh's boundary belongs to \"nowhere\"" run room mesh=empty.msh inlet=nowhere outlet=out:soft steps=1
refused 1 'there are: 7, 8' run room "mesh=$meshes/unnamed.msh" inlet=7 outlet=9:soft steps=1
status 0 run room "mesh=$meshes/unnamed.msh" inlet=7 outlet=8:soft steps=1

# what enters leaves, budgets close, and there is a force on the desk
status 0 run "$rooms/office.room" until=2 --json
within door_flow 0.11999 0.12001
within vent_flow 0.05 0.05
within window_flow 0.1 0.1
within hatch_flow 0.06999 0.07001
within door_scalar_flow 0.11999 0.12001
within budget_defect 0 1e-12
within divergence 0 2.3e-16
within desk_drag 0.0060 0.0069
# the benchmark's drag, 5.57 to 5.59 times 0.002, within 10 % on a coarse mesh
status 0 run "$rooms/cylinder.room" scheme=steady steps=12 --json
within cylinder_drag 0.0100 0.0118
within cylinder_lift -2e-5 2e-5
# the pressure difference, .1172 to .1176: .1111 on this mesh, .1164 where edges are half as long
python3 -c 'import json; seen = json.load(open("out"))["observables"]
assert 0.110 < seen["front_pressure"] - seen["back_pressure"] < 0.118' || fail "the pressure difference of the cylinder"
within cylinder_circulation -3e-4 3e-4 # U D is 0.02
# what the program brings goes by name, and is listed
status 0 run lab until=1 --json
grep -q '"scene":"lab"' out || fail "a room is not known by its name"
within supply_flow 0.23999 0.24001
within hood_flow 0.19999 0.20001
within door_flow 0.03999 0.04001
status 0 list lab
grep -q 'supply_scalar_flow' out || fail "list does not know what a room observes"
status 0 list "$rooms/lab.room" --json
grep -q '"observables":\[.*"chemist_speed"' out || fail "list FILE.room --json"
cp "$rooms/lab.room" ./mine.room && cp "$rooms/lab.msh" .
status 0 list ./mine.room # that no folder of the program has
grep -q 'supply_scalar_flow' out || fail "list does not know a room of one's own"
refused 3 'nowhere.room could not be read' list ./nowhere.room
status 0 complete run he
grep -q '^heated' out || fail "a room is not offered"

# warm air rises; what the walls give stays in the room
status 0 run "$rooms/heated.room" until=5 --json
within temperature_mean 290.5 291.5
within heater_heat 1 4
within window_heat -2 -0.1
within heater_circulation -1 1
within seat_temperature 289 292
status 0 run "$rooms/heated.room" until=1 scheme=crank-nicolson show=temperature --json
status 0 render "$rooms/office.room" until=0.1 --size 320x200 --out pictures
[ -s pictures/office-render.png ] || fail "no picture of a room"

# walls may give heat instead of holding a temperature: what one gives the other takes in a steady state
{ sed '/^wall: heater/d' "$rooms/heated.room"; echo 'wall: heater  heat = 0.5'; } >flux.room
cp "$rooms/heated.msh" .
status 0 run ./flux.room scheme=steady until=3 --json
within heater_heat 0.7499999 0.7500001 # 1.5 m of it
within window_heat -0.7500001 -0.7499999
{ sed '/^wall: heater/d' "$rooms/heated.room"; echo 'wall: heater  heat = 0.5*(1 - exp(-t))'; } >rising.room
status 0 run ./rising.room until=1 --json
within heater_heat 0.4740904 0.4740905
status 0 render ./flux.room until=0.5 --size 320x200 --out pictures
sed '/^wall: window/d' flux.room >alone.room
"$geomint" run ./alone.room scheme=steady >out 2>err
grep -q 'nothing holds the temperature or lets heat out' out || fail "no word of heat that nothing takes"

# pictures tell in which units
status 0 render "$rooms/heated.room" until=0.5 -o units.svg
for text in 'viscosity 0.002 m²/s' 'temperature / K' 'mean temperature / K' 'kinetic energy / (m⁴/s²)' 'x / m'; do
    grep -qF "$text" units.svg || fail "no $text in a picture"
done

# what the boundary gives may change in time: the same bits where it does not, the order of each scheme where it
# does, what enters at every moment what the line says, and budgets that close
timed() { # NAME FACTOR: the office, whose door's speed has a factor
    sed "s|(1 - s)|(1 - s)*($2)|; s/window  flow = 0.1/window/" "$rooms/office.room" >"$1.room"
    cp "$rooms/office.msh" .
}
state_of() { "$geomint" run "$@" --json --state | sed 's/"seconds":[^,]*,//; s/.*"state"/"state"/'; }
timed constant 1
timed still '1 + 0*t'
[ "$(state_of ./constant.room steps=20)" = "$(state_of ./still.room steps=20)" ] || fail "a time that does nothing does"
timed rising '1 - exp(-t/5)'
status 0 run ./rising.room until=10 --measure door_flow,vent_flow,window_flow,hatch_flow,divergence,budget_defect --max --json
within door_flow 0.1037597 0.1037599 # 0.2*4/6 of its length 0.9, and 1 - exp(-2)
within vent_flow 0.04999999 0.05000001
within budget_defect_max 0 1e-12
within divergence_max 0 1e-16
timed breathing '1 + sin(t)/2'
order() { # SCHEME LOW HIGH: of the speed at the seat
    for dt in 0.1 0.05 0.025; do
        "$geomint" run ./breathing.room "scheme=$1" "dt=$dt" until=4 --measure seat_speed --json
    done | grep -o '"seat_speed":[^,}]*' | cut -d: -f2 | paste -sd' ' |
        awk -v low="$2" -v high="$3" '{order = log(($1 - $2)/($2 - $3))/log(2); exit !(order > low && order < high)}' ||
        fail "the order of $1 with a door that breathes"
}
order semi-implicit 0.9 1.1
order crank-nicolson 1.9 2.1
timed ending 'sqrt(2 - t)'
"$geomint" run ./ending.room until=4 >out 2>err
[ $? = 2 ] || fail "a speed that ends is no failure"
grep -q 'the step after t = 2 failed: ./ending.room:9:22: the speed is not finite at (0, 3' out ||
    fail "no word of where the speed ends"
timed closing '2 - t'
"$geomint" run ./closing.room until=4 >out 2>err
grep -q 'after t = 2 failed: ./closing.room:9:8: no more enters by the profile' out || fail "no word of a door that closes"
"$geomint" run ./rising.room scheme=steady >out 2>err
grep -q 'changes in time, and so there is no steady state' out || fail "a steady state of what changes"

# what walls hold and inlets let in may vary along them
{ sed '/^wall/d; s/scalar = 1/scalar = 2*y/' "$rooms/office.room"; echo 'wall: desk  scalar = x + y'; } >varied.room
status 0 run ./varied.room until=1 --json
grep -q '"desk_drag"' out || fail "the desk has no name"

# the age of air: in a steady state as much of it leaves as there is air in the room
status 0 run "$rooms/age.room" scheme=steady --json
within budget_defect 0 1e-13
within scalar_outflow 11.1 11.4 # the area, but for the cells of inlets
within scalar_mean 66 68
within seat_scalar 49 51
status 0 run "$rooms/office.room" smoke=yes steps=2 --json
status 0 render "$rooms/age.room" until=1 smoke=yes --size 320x200 --out pictures

# finer meshes of the same room, and what an accuracy costs: by more than half less where edges are halved
status 0 run "$rooms/office.room" refine=2 until=0.2 --json
within triangles 12932 12932
within budget_defect 0 1e-12
within door_flow 0.11999 0.12001
refused 1 'refine=3: edges are halved' run "$rooms/office.room" refine=3 steps=1
refused 1 'refine=64 makes more than 5000000 triangles' run "$rooms/office.room" refine=64 steps=1
cp "$meshes/hole.msh" .
printf '%s\n' 'mesh: hole.msh' 'viscosity: 0.05' 'inlet: door  flow = 0.3  scalar = 1' 'outlet: window' >small.room
status 0 work-precision ./small.room until=8 dt=0.1,0.05 refine=1,2,4 --json -o small.svg
python3 - out <<'END' || fail "work-precision of a room"
import json, sys
lines = [json.loads(line) for line in open(sys.argv[1])]
assert [line["scheme"] for line in lines] == ["semi-implicit", "crank-nicolson"]
for line in lines:
    assert line["against"] == "a run of crank-nicolson with a step of 0.025 and refine=8", line["against"]
    errors = [min(p["error"] for p in line["points"] if p["refine"] == refine) for refine in (1, 2, 4)]
    assert errors[0] < 0.5 and errors[1] < 0.55 * errors[0] and errors[2] < 0.55 * errors[1], errors
END

# sums have their index in parentheses, where no key begins
{ sed '/^wall/d; s/scalar = 1/scalar = sum(k = 1 .. 3, k*y)/' "$rooms/office.room"; } >sums.room
sed 's/sum(k = 1 .. 3, k\*y)/y + 2*y + 3*y/' sums.room >terms.room
status 0 run ./sums.room steps=5 --json
summed=$(grep -o '"scalar_total":[^,]*' out)
status 0 run ./terms.room steps=5 --json
[ "$summed" = "$(grep -o '"scalar_total":[^,]*' out)" ] || fail "a sum over an index in a room"

# a let stands for what it holds, and holds only what its line may
{ sed '/^wall/d; s/0.2\*4\*s\*(1 - s)/parabola(s)/; s/scalar = 1/scalar = fresh/' "$rooms/office.room"
    printf '%s\n' 'let: parabola(u) = 0.2*4*u*(1 - u)' 'let: fresh = 1 + 0*exp(-t)'; } >let.room
[ "$(state_of ./let.room steps=5)" = "$(state_of "$rooms/office.room" steps=5)" ] || fail 'a let changes a room'

# neither a checkpoint nor `again` goes on with another room, or another mesh
cp "$rooms/office.room" "$rooms/office.msh" .
status 0 run ./office.room steps=1 --checkpoint kept.checkpoint
status 0 render ./office.room steps=1 --size 320x200 -o kept.png
status 0 run ./office.room steps=2 --continue kept.checkpoint
status 0 again kept.png -o same.png
cmp -s kept.png same.png || fail 'again makes another picture of a room'
sed -i 's/^1.6 1.1 0$/1.61 1.1 0/' office.msh
cmp -s office.msh "$rooms/office.msh" && fail 'the mesh is the same'
refused 3 'a checkpoint of something else' run ./office.room steps=2 --continue kept.checkpoint
refused 3 'its room is another one now' again kept.png -o other.png
cp "$rooms/office.msh" .
sed -i 's/0.004/0.005/' office.room
refused 3 'its room is another one now' again kept.png -o other.png
[ ! -e other.png ] || fail 'a picture of another room'

# a body that no scalar is brought to: drag and lift are what is shown
status 0 render "$rooms/cylinder.room" steps=2 -o force.svg
grep -q 'cylinder force along x' force.svg || fail 'no drag beside a body'
grep -q 'cylinder force along y' force.svg || fail 'no lift beside a body'

# a mesh with two inlets and two outlets by the short form; the lists are groups, and not lanes
status 0 run room "mesh=$meshes/hole.msh" inlet=door,vent outlet=window,4 steps=2 --json
[ "$(wc -l <out)" -eq 1 ] || fail "groups became lanes"
status 0 run room outlet=soft,free rows=10 columns=0 steps=1 --json
[ "$(wc -l <out)" -eq 2 ] || fail "outlets are lanes without a mesh"
refused 1 'the group "door" is named twice$' run room "mesh=$meshes/hole.msh" inlet=door,door outlet=window steps=1
refused 1 'no physical group "dor" on its boundary .*: door, vent, window, hatch, pillar' \
    run room "mesh=$meshes/hole.msh" inlet=dor outlet=window steps=1
refused 1 'on the wall of a hole' run room "mesh=$meshes/hole.msh" inlet=pillar outlet=window steps=1
refused 3 'must be Delaunay, or star=barycentric$' run room "mesh=$meshes/hole.msh" star=circumcentric inlet=door outlet=window steps=1
refused 1 'star= has no effect here' run room star=barycentric steps=1
status 0 run room "mesh=$meshes/hole.msh" star=galerkin inlet=door outlet=window steps=1 --json
grep -q '"star":"barycentric"' out || fail "galerkin is another star"
refused 1 'refine= has no effect here' run room refine=2 steps=1
status 0 run room "mesh=$meshes/hole.msh" inlet=door,vent outlet=window,4 refine=1 steps=2 --json
coarse=$(grep -o '"triangles":[0-9]*' out | cut -d: -f2)
status 0 run room "mesh=$meshes/hole.msh" inlet=door,vent outlet=window,4 refine=2 steps=2 --json
within triangles $((4 * coarse)) $((4 * coarse))
refused 1 'refine=3: edges are halved' run room "mesh=$meshes/hole.msh" inlet=door outlet=window refine=3 steps=1

# an edge may be in several groups, in both formats, and on finer meshes
python3 - <<'END' || fail 'no mesh with groups over each other'
cells = 6
nodes = [(i / cells, j / cells) for j in range(cells + 1) for i in range(cells + 1)]
corner = lambda i, j: 1 + i + j * (cells + 1)
triangles = []
for j in range(cells):
    for i in range(cells):
        a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
        triangles += [(a, b, c), (a, c, d)]
sides = [[(corner(0, j), corner(0, j + 1)) for j in range(cells)], [(corner(cells, j), corner(cells, j + 1)) for j in range(cells)],
         [(corner(i, 0), corner(i + 1, 0)) for i in range(cells)], [(corner(i, cells), corner(i + 1, cells)) for i in range(cells)]]
groups = [[5, 1], [5, 2], [3, 5, 4], []] # all, and in, out, floor with another name
names = '$PhysicalNames\n5\n1 1 "in"\n1 2 "out"\n1 3 "floor"\n1 4 "ground"\n1 5 "all"\n$EndPhysicalNames\n'
def section(name, lines):
    return '$%s\n%s\n$End%s\n' % (name, '\n'.join(lines), name)
lines = [(tag, edge) for side, tags in zip(sides, groups) for tag in tags for edge in side]
open('groups22.msh', 'w').write(section('MeshFormat', ['2.2 0 8']) + names +
    section('Nodes', [str(len(nodes))] + ['%d %r %r 0' % (k + 1, *p) for k, p in enumerate(nodes)]) +
    section('Elements', [str(len(lines) + len(triangles))] + ['%d 1 2 %d 1 %d %d' % (k + 1, tag, *edge) for k, (tag, edge) in enumerate(lines)] +
            ['%d 2 2 9 1 %d %d %d' % (1000 + k, *t) for k, t in enumerate(triangles)]))
edges = sum(map(len, sides))
open('groups41.msh', 'w').write(section('MeshFormat', ['4.1 0 8']) + names +
    section('Entities', ['0 4 1 0'] + ['%d 0 0 0 1 1 0 %d %s 0' % (k + 1, len(g), ' '.join(map(str, g))) for k, g in enumerate(groups)] +
            ['1 0 0 0 1 1 0 1 9 4 1 2 3 4']) +
    section('Nodes', ['1 %d 1 %d' % (len(nodes), len(nodes)), '2 1 0 %d' % len(nodes)] + [str(k + 1) for k in range(len(nodes))] +
            ['%r %r 0' % p for p in nodes]) +
    section('Elements', ['5 %d 1 %d' % (edges + len(triangles), edges + len(triangles))] +
            [line for k, side in enumerate(sides) for line in ['1 %d 1 %d' % (k + 1, len(side))] +
             ['%d %d %d' % (100 * k + i + 1, *e) for i, e in enumerate(side)]] +
            ['2 1 2 %d' % len(triangles)] + ['%d %d %d %d' % (1000 + k, *t) for k, t in enumerate(triangles)]))
END
for mesh in groups22 groups41; do
    printf '%s\n' "mesh: $mesh.msh" 'viscosity: 0.05' 'inlet: in  flow = 0.1  scalar = 1' 'outlet: out' \
        'wall: ground  tangential = -2' >$mesh.room
    for refine in 1 2; do
        status 0 run ./$mesh.room refine=$refine steps=3 --json
        within in_flow 0.09999 0.10001
        within speed_max 1.99999 2.00001
    done
    echo 'wall: all  scalar = 1' >>$mesh.room
    refused 1 "$mesh.room:6:7: curves of the group all have a line already: ground" run ./$mesh.room
    status 0 run room mesh=$mesh.msh inlet=in outlet=2 steps=1 --json
done

# wrong ones: the lines of a good room, of which one is another
wrong() {
    cp "$meshes/hole.msh" .
    { printf '%s\n' 'mesh: hole.msh' 'viscosity: 0.01' 'inlet: door  flow = 0.2  scalar = 1' 'outlet: window'
        printf '%b\n' "$2"; } | sed "${3:-}" >wrong.room
    refused 1 "$1" run ./wrong.room steps=1
}
wrong 'wrong.room:5:1: a room has no line "inlt"; did you mean inlet' 'inlt: vent flow = 1'
wrong 'wrong.room:5:8: inlet: needs speed = or flow =' 'inlet: vent'
wrong 'wrong.room:5:13: inlet: takes speed =, flow =, scalar =, temperature =' 'inlet: vent tangential = 1'
wrong 'wrong.room:5:20: a flow is a number that is not negative' 'inlet: vent flow = -1'
wrong 'the speed is not finite at (0, ' 'inlet: vent speed = 1/(x*y)'
wrong 'wrong.room:5:21: .*did you mean' 'inlet: vent speed = sinn(s)'
wrong 'wrong.room:5:21: y is not a list' 'inlet: vent speed = y[1]'
wrong 'wrong.room:5:24: ) was expected, not "s"' 'inlet: vent speed = (s scalar = 1'
wrong 'wrong.room:5:36: what .* may change in time: no start, no source' 'source: printer x = 1 y = 1 rate = t'
wrong 'wrong.room:5:17: what .* may change in time: no start' 'start: scalar = t'
wrong 'door is named twice' 'inlet: door flow = 1'
wrong 'no physical group "dor" on its boundary (there are: door, vent, window, hatch, pillar)' 'wall: dor'
wrong 'printer at (2, 1.4) is not in the room' 'source: printer x = 2 y = 1.4 rate = 1'
wrong 'wrong.room:5:28: a temperature or heat needs a line buoyancy:' 'wall: pillar temperature = 300'
wrong 'wrong.room:5:21: a temperature or heat needs a line buoyancy:' 'wall: pillar heat = 300'
wrong 'wrong.room:5:7: wall: holds its temperature = or gives heat =, not both' 'wall: pillar heat = 3 temperature = 300'
wrong 'wrong.room:5:21: the heat is not finite at (' 'wall: pillar heat = log(x - 2)\nbuoyancy: 1'
wrong 'wrong.room:5:13: inlet: takes speed =' 'inlet: vent heat = 1'
wrong 'wrong.room:5:1: buoyancy: needs a temperature =' 'buoyancy: 0.03'
wrong 'buoyancy: is a finite number' 'wall: pillar temperature = 1\nbuoyancy: inf'
wrong 'wrong.room:5:1: reference-temperature: needs a temperature =' 'reference-temperature: 290'
wrong 'wrong.room:5:28: the temperature is not finite at (1.7, 1.1' 'wall: pillar temperature = 1/0\nbuoyancy: 1'
wrong 'wrong.room:5:23: the scalar is not finite at (1.7, 1.1' 'wall: pillar scalar = 1/(y - 1.1)'
wrong 'wrong.room:5:27: the tangential speed is not finite at (' 'wall: pillar tangential = log(x - 2)'
wrong 'wrong.room:5:32: the scalar is not finite at (0, 0.8' 'inlet: vent flow = 1  scalar = 1/s'
wrong 'wrong.room:6:17: what .* may change in time: no start' 'let: late = 2*t\nstart: scalar = late'
wrong 'wrong.room:5:23: measures of the flow are for the lines time:' 'wall: pillar scalar = area'
wrong 'wrong.room:5:23: s runs along an inlet' 'wall: pillar scalar = s'
wrong 'wrong.room:5:17: s runs along an inlet' 'start: scalar = s'
wrong 'wrong.room:5:20: a flow is that of a whole side' 'inlet: vent flow = x'
wrong 'wrong.room:5:14: .* a place is two numbers' 'probe: q x = y y = 1'
wrong 'too much for a number' 'inlet: vent flow = 1e308\ninlet: 4 flow = 1e308'
wrong 'the temperature is not finite at' 'start: temperature = 1/(x-x)\nbuoyancy: 1'
wrong 'wrong.room:5:7: start: has no value' 'start:'
wrong 'start: takes scalar =, temperature =' 'start: rate = 1'
wrong 'wrong.room:5:1: viscosity: and reynolds: say the same' 'reynolds: 100'
wrong 'wrong.room:6:1: diffusivity: and schmidt: say the same' 'diffusivity: 1\nschmidt: 1'
wrong 'schmidt: is a positive number' 'schmidt: 0'
wrong 'source: needs rate =' 'source: printer x = 1 y = 1'
wrong 'source: has x = and y =, or neither' 'source: printer x = 1 rate = 1'
wrong 'the rate is not finite at (0, ' 'source: printer rate = 1/x'
wrong 'wrong.room:5:10: this program reads files of format 1, not 2$' 'geomint: 2'
wrong 'scalar: is given twice' 'scalar: age\nscalar: dust'
wrong 'viscosity: is a positive number' '' 's/0.01/-1/'
wrong 'wrong.room:2:12: viscosity: lies between 1e-12 and 1e+06' '' 's/0.01/1e300/'
wrong 'wrong.room:5:5: dt: lies between 1e-09 and 1e+06' 'dt: 1e300'
wrong 'wrong.room:5:8: until: lies between 0 and 1e+12' 'until: 1e13'
wrong 'wrong.room:5:1: viscosity / diffusivity is 1e+08; it lies between 1e-06 and 1e+06' 'diffusivity: 1e-10'
wrong 'wrong.room:4:11: reynolds: lies between 1e-06 and 1e+12' 'reynolds: 1e13' '/viscosity/d'
wrong 'a room needs a line viscosity:' '' '/viscosity/d'
wrong 'an inlet but no outlet' '' '/outlet/d'
wrong 'wrong.room:4:23: all flows are given, and what enters does not leave: 0.2 in, 0.1 out$' '' 's/outlet: window/outlet: window flow = 0.1/'
wrong 'wrong.room:4:23: the outlets with a given flow take more than enters$' 'outlet: 4' 's/outlet: window/outlet: window flow = 10/'
wrong 'wrong.room:5:8: .*on the wall of a hole' 'inlet: pillar flow = 1'
wrong 'wrong.room:5:21: the speed is not finite at (0, 0.8' 'inlet: vent speed = 1/s'
wrong 'wrong.room:5:13: .*double quotes' 'wall: front pillar scalar = 1'
wrong 'wrong.room:5:7: .*no closing quote' 'wall: "pillar scalar = 1'
wrong 'wrong.room:5:18: scalar: needs = and a value' 'wall: dor scalar nonsense here = 1'
wrong 'wrong.room:5:12: x: needs = and a value' 'probe: q x 3'
wrong 'wrong.room:5:21: the speed is not finite' 'inlet: vent speed = 1/(s-s)'
wrong 'no more enters by the profile' 'inlet: vent flow = 0.05 speed = sin(2*pi*s)'
wrong 'wrong.room:5:8: no more enters by the profile' 'inlet: vent speed = -0.01'
wrong 'start: is given twice' 'start: scalar = 1\nstart: scalar = 2'
wrong 'there are two observables a_b_scalar' 'probe: a-b x = 1 y = 1\nprobe: a_b x = 1 y = 1'
wrong 'at most 160 observables' "$(for i in $(seq 70); do printf 'probe: p%s x = 1 y = 1\\n' "$i"; done)"
# parameters, choices and rectangles of one's own
wrong 'wrong.room:5:12: a name was expected' 'parameter: 3 = 1'
wrong 'wrong.room:5:21: each parameter of a room has a line of its own' 'parameter: a = 1, b = 2'
wrong 'wrong.room:6:12: a is defined twice, first in line 5' 'parameter: a = 1\nparameter: a = 2'
wrong 'wrong.room:5:19: a range.s lower end comes first' 'parameter: a = 1; 2 .. 1'
wrong 'wrong.room:5:9: a choice has a name, a default and words' 'choice: a = b'
wrong 'wrong.room:5:13: there is no word "d"' 'choice: a = d of b, c'
wrong 'wrong.room:5:7: there is no choice "domain"' 'when: domain = box'
wrong 'wrong.room:6:23: a is a choice of words: write lines below' 'choice: a = b of b, c\nwall: pillar scalar = a'
wrong 'wrong.room:6:23: a is a word, not a number' 'parameter: a = soft\nwall: pillar scalar = a'
wrong 'boundary: needs stream_function =' 'boundary: pillar scalar = 1'
wrong 'exact: needs stream_function =' 'exact: scalar = 1'
wrong 'wrong.room:1:7: a rectangle has a width, a height and a number of edges' '' 's/mesh: hole.msh/mesh: rectangle; width 1; height 1/'
wrong 'wrong.room:5:10: this is nothing that is observed of a room' 'observe: nonsense'
wrong 'wrong.room:5:8: graph: nonsense is not an observable' 'graph: nonsense'
wrong 'wrong.room:5:14: .*nonsense' 'levels: 0.1, nonsense'
wrong 'wrong.room:5:10: schemes: rk4 does not fit this system' 'schemes: rk4'
wrong 'wrong.room:5:17: schemes: stedy is not a scheme' 'schemes: steady stedy'
wrong 'wrong.room:5:10: a profile has a name' 'profile: middle u; 0.5; 1; 3'
wrong 'wrong.room:5:8: a table has a name and a profile' 'table: of nothing; a = 1; 0 1'
wrong 'work: errors are three numbers that fall' 'work: until=1; errors 1, 2'
wrong 'stability: a parameter and its values are missing' 'stability: until=1'

# what a line says once, or with one name, is said once
wrong 'wrong.room:6:1: geomint: is given twice' 'geomint: 1\ngeomint: 1'
wrong 'wrong.room:6:1: observe: is given twice' 'observe: divergence\nobserve: divergence; title another'
wrong 'wrong.room:6:1: profile: is given twice' 'profile: a; 0, 1; 1, 1; 3\nprofile: a; 0, 1; 1, 1; 5'
wrong 'wrong.room:2:1: viscosity: is given twice, here and as a parameter' 'parameter: viscosity = 1'
wrong 'wrong.room:4:12: viscosity: is a positive number' 'parameter: viscosity = -1; -2 .. 2' '/^viscosity/d'
wrong 'wrong.room:4:12: reynolds: is a positive number' 'parameter: reynolds = -1; -2 .. 2' '/^viscosity/d'
# names of parameters mean nothing else, and their usual values can be had
for name in dt until scheme x s t pi perimeter; do
    wrong "wrong.room:5:12: the name $name is reserved" "parameter: $name = 1"
done
wrong 'wrong.room:5:9: the name until is reserved' 'choice: until = b of b, c'
wrong 'wrong.room:5:12: the usual value lies outside of the range' 'parameter: a = 2; 0 .. 1'
wrong 'wrong.room:5:5: dt is 2, and its range is from 0.1 to 1' 'dt: 2; 0.1 .. 1'
wrong 'wrong.room:13:12: a room has at most 8 parameters' "$(for i in $(seq 9); do printf 'parameter: p%s = 1\\n' "$i"; done)"
# options
wrong 'wrong.room:5:10: colours: end at positive numbers' 'colours: foo 3'
wrong 'wrong.room:5:14: there is no name nope' 'subtitle: x {nope}'
wrong 'wrong.room:5:8: words key=value were expected, with keys of the room' 'lanes: foo=bar'
wrong 'wrong.room:5:16: work: has no option "junk"' 'work: until=1; junk 3'
wrong 'wrong.room:5:22: observe: has no option "junk"' 'observe: divergence; junk'
wrong 'wrong.room:5:12: junk is not of the form key=value' 'figure: a; junk; what it shows'
wrong 'wrong.room:7:' 'parameter: a = 1\nprofile: p; 0, 1; 1, 1; 3\ntable: t p; a = 1; 0 1; junk'
wrong 'wrong.room:5:10: a profile shows u, v or scalar' 'profile: a foo; 0, 1; 1, 1; 3'
wrong 'wrong.room:5:7: a unit of time is a positive number' 'time: 0; s'
wrong 'wrong.room:5:21: slip is 1, or 0 where the wall holds the air' 'wall: pillar slip = 2'
wrong 'wrong.room:5:20: the vorticity is not finite at (0, 0)' 'start: vorticity = 1/(x - x)'
wrong 'wrong.room:5:7: side: is of a rectangle' 'side: in; x = 0'
wrong 'wrong.room:5:1: a room has no line "zzzzzzz"; geomint list office --source prints a room' 'zzzzzzz: 1'
wrong 'wrong.room:7:1: this line cannot depend on a choice' 'choice: a = b of b, c\nwhen: a = c\nuntil: 3'
refused 1 '^geomint: curves of the group door have a line already: door$' \
    run room "mesh=$meshes/hole.msh" inlet=door outlet=door steps=1

# rectangles: numbers that make no mesh, at their place; names of their sides
boxed() { # SENTENCE OPTIONS LINES
    printf '%b\n' "mesh: rectangle; $2" 'viscosity: 0.1' "${3:-wall: all}" >boxed.room
    refused 1 "$1" run ./boxed.room steps=1
}
boxed 'boxed.room:1:34: height: is a number from 1e-09 to 1e+09' 'width 1; height 1e300; edges 8'
boxed '8 edges and .* strips make more than 20000000 triangles' 'width 1; height 1e6; edges 8'
boxed 'boxed.room:1:43: edges: is a whole number from 1 to 100000' 'width 1; height 1; edges 0'
boxed 'boxed.room:1:53: strips: is a whole number from 0 to 100000' 'width 1; height 1; edges 8; strips -6'
boxed 'boxed.room:1:56: irregular: is a number from 0 to 0.45' 'width 1; height 1; edges 8; irregular 5'
boxed 'boxed.room:1:55: multiple: is a whole number from 1 to 100000' 'width 1; height 1; edges 8; multiple 1e30'
boxed 'keep: has two numbers, x, y' 'width 1; height 1; edges 8; keep 0, 1, 2'
boxed 'boxed.room:3:8: no edge of the rectangle is called door: it needs a line side: door; x = 0' \
    'width 1; height 1; edges 8' 'inlet: door  flow = 1'
boxed 'boxed.room:4:1: side: is given twice' 'width 1; height 1; edges 8' 'side: a; x = 0\nside: a; x = 1'

# the numbers of a rectangle in their order, or with their names
shaped() {
    printf '%s\n' "mesh: rectangle$1" 'viscosity: 0.1' 'start: vorticity = x*(1 - x)' 'wall: all  scalar = 0' >shaped.room
    state_of ./shaped.room steps=3
}
[ "$(shaped ' 1 0.5 8 6; irregular 0.1')" = "$(shaped '; height 0.5; width 1; edges 8; strips 6; irregular 0.1')" ] ||
    fail 'numbers with names make another rectangle'
boxed 'a rectangle has width, height' 'width 1; height 1; edges 8; heigth 2'

# a wall slips where it says so
slipping() {
    printf '%s\n' 'mesh: rectangle; width 1; height 1; edges 8' 'viscosity: 0.1' 'start: vorticity = x*(1 - x)' \
        "wall: all  scalar = 0$1" >slipping.room
    state_of ./slipping.room steps=3
}
[ "$(slipping '  slip = 0')" = "$(slipping '')" ] || fail 'a wall that does not slip slips'
[ "$(slipping '  slip = 1')" != "$(slipping '')" ] || fail 'a wall that slips does not'

# openings and probes of a rectangle are observed; where lines list what is, probes are
printf '%s\n' 'mesh: rectangle; width 1; height 1; edges 8' 'viscosity: 0.1' 'parameter: a = 0.3' 'side: in; x = 0, y > 0.4' \
    'side: out; x = 1, y > 0.4' 'inlet: in  flow = a' 'outlet: out' 'probe: seat  x = 0.5  y = 0.5' >observed.room
status 0 run ./observed.room steps=2 viscosity=0.2 --json
within in_flow 0.29999 0.30001
within out_flow 0.29999 0.30001
within seat_speed 0.001 1
echo 'observe: divergence' >>observed.room
status 0 run ./observed.room steps=2 --json
within seat_speed 0.001 1
grep -q in_flow out && fail 'a room observes what its lines do not list'

# the words of a choice choose the rectangle, too, and what is best for it
printf '%s\n' 'viscosity: 0.1' 'parameter: columns = 8; 4 .. 100' 'parameter: rows = 12; 0 .. 400' \
    'choice: domain = square of square, wide' 'when: domain = square' \
    'mesh: rectangle; width 1; height 1; edges columns; strips rows' 'when: domain = wide' \
    'mesh: rectangle; width 4; height 1; edges columns; strips rows' >chosen.room
sed '/^choice/d; /^when/d; /width 1/d' chosen.room >wide.room
for room in chosen wide; do
    "$geomint" run ./$room.room columns=32 $([ $room = wide ] || echo domain=wide) steps=1 --json | grep -o '"rows":[0-9]*,\|"triangles":[0-9]*' >$room.out
done
[ -s wide.out ] && cmp -s chosen.out wide.out || fail 'the best strips are those of another rectangle'

# lines of pictures hold on any mesh
{ cat "$rooms/office.room"; printf '%s\n' 'time: 2; min, two seconds' 'graph: divergence; 0 .. 1e-15' \
    'subtitle: viscosity {viscosity}, in an office of {area} square metres'; } >looks.room
cp "$rooms/office.msh" .
status 0 render ./looks.room until=0.1 -o looks.svg
for text in 'in an office of' 'divergence' '0.10 min'; do
    grep -qF "$text" looks.svg || fail "no $text in a picture"
done

# scenes that are files of the program: their copies give the same bits
while read -r scene words; do
    status 0 list "$scene" --source
    cp out "./$scene.room"
    status 0 list "$scene" --json
    grep -q "\"file\":\"rooms/$scene.room\"" out || fail "list $scene names no file"
    # shellcheck disable=SC2086 # words
    [ "$(state_of "$scene" $words steps=3)" = "$(state_of "./$scene.room" $words steps=3)" ] || fail "a copy of $scene"
done <<'END'
couette rows=8
poiseuille rows=8 irregular=0.2
channel rows=5 columns=0 outlet=soft
cavity columns=8 rows=0 scheme=semi-implicit
taylor-green columns=8
taylor-green columns=8 domain=box speed=1
room rows=10 columns=0
END

# the scalar moves beside the flow where there is another core: no bit depends on it
for cores in 0 0-1; do
    taskset -c $cores "$geomint" run room rows=40 columns=52 steps=5 tracers=0 --state --json |
        sed "s|\"seconds\":[^,]*,||" >cores$cores
done
if taskset -c 0-1 true; then
    [ "$(wc -c <cores0)" -gt 10000 ] && cmp -s cores0 cores0-1 || fail "bits depend on the number of cores"
fi
# balanced, but for round-off
printf '%s\n' 'mesh: hole.msh' 'viscosity: 0.01' 'inlet: door flow = 0.3' 'outlet: window flow = 0.1' \
    'outlet: vent flow = 0.2' 'outlet: hatch' >even.room
status 0 run ./even.room steps=1
refused 3 'missing.room could not be read' run ./missing.room
sed 's/hole.msh/missing.msh/' even.room >lost.room
refused 3 'missing.msh could not be read' run ./lost.room
printf '%s\n' '$MeshFormat' '4.1 0 8' '$EndMeshFormat' '$Nodes' '1 6 1 16' '2 1 0 6' 1 2 3 14 15 16 '0 0 0' '1 0 0' \
    '.5 1 0' '5 0 0' '6 0 0' '5.5 1 0' '$EndNodes' '$Elements' '1 2 1 2' '2 1 2 2' '1 1 2 3' '2 14 15 16' \
    '$EndElements' >missing.msh
refused 3 'several pieces: triangle 2 (nodes 14 15 16) is not joined to triangle 1' run ./lost.room

[ "$failures" = 0 ]
