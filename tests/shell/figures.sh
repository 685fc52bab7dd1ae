#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# geomint figures: the page, a figure that fails among others, an interruption. figures.sh GEOMINT
set -u
. "$(dirname "$0")/answers.sh"

timeout 600 "$geomint" figures razafindralandy-1 razafindralandy-4 razafindralandy-26 --quick --out page >out 2>err
[ $? = 0 ] || fail "figures: $(cat err)"
page=page/figures.html
for wanted in '<!DOCTYPE html>' 'charset="utf-8"' 'name="viewport"' 'prefers-color-scheme' '@media print' \
    'id="razafindralandy-1"' 'geomint render disc scheme=explicit-euler,implicit-euler' '✓ holds' '✗ does not hold'; do
    grep -q -- "$wanted" $page || fail "the page lacks $wanted"
done
grep -q '<script\|src="http\|url(http\|src="[a-z]*-[0-9]*.png' $page && fail 'the page is not self-contained'
[ "$(grep -o 'data:image/png;base64,iVBORw0KGgo' $page | wc -l)" = 6 ] || fail 'three pictures in two themes are in the page'
# what is embedded is the file beside the page
grep -o 'src="data:image/png;base64,[^"]*' $page | head -n 1 | sed 's/.*,//' | base64 -d >embedded.png
cmp -s embedded.png page/razafindralandy-1.png || fail 'an embedded picture is another one'
grep -v 'base64' $page | sed 's/&amp;\|&lt;\|&gt;\|&quot;//g' | sed -n '/<body>/,$p' | grep -q '&' && fail 'an & is not escaped'
grep -q '  holds  ' out && grep -q 'does not hold' out || fail "verdicts are printed: $(cat out)"
ls page/.figures.html 2>/dev/null && fail 'a temporary file is left'

# JSON says what the text says
timeout 600 "$geomint" figures razafindralandy-1 razafindralandy-4 razafindralandy-26 --quick --json --out page >json 2>err
[ $? = 0 ] || fail "figures --json: $(cat err)"
[ "$(cat err)" = 'geomint: wrote page/figures.html and its pictures' ] || fail "figures does not say what it wrote: $(cat err)"
python3 - <<'END' || fail "figures --json: $(head -c 300 json)"
import json
figures = [json.loads(line) for line in open("json")]
text = open("out").read()
assert [one["figure"] for one in figures] == ["razafindralandy-1", "razafindralandy-4", "razafindralandy-26"]
for one in figures:
    assert one["made"] and one["lanes"] and one["figure"] + ": " + one["statement"] in text
    for statement in one["statements"]:
        assert f'  {statement["verdict"]:14} {statement["says"]}: ' in text, statement
        assert (statement["of"] == "ours") == statement["says"].startswith("(ours) "), statement
        assert statement["note"] == "" or f'); {statement["note"]}\n' in text, statement
        if statement["verdict"] != "not judged":
            low, high = (float("-inf") if statement["expected"][0] is None else statement["expected"][0],
                         float("inf") if statement["expected"][1] is None else statement["expected"][1])
            inside = low <= statement["found"][0] and statement["found"][1] <= high
            assert inside == (statement["verdict"] == "holds"), statement
END

# a system of one's own among them: nothing says what has to come out, its numbers are there
printf 'title: Two & one\nabout: A spring.\ncoordinates: q\nmomenta: p\nH: p^2/2 + q^2/2\nstart: q = 1, p = 0\n' >spring.system
timeout 600 "$geomint" figures ./spring.system razafindralandy-5 --quick --out own >out 2>err || fail "figures of a system: $(cat err)"
for wanted in 'id="spring"' 'Two &amp; one</a> <span class="soft">./spring.system' 'geomint render ./spring.system' 'id="razafindralandy-5"' \
    '<td>verlet<td>'; do
    grep -q -- "$wanted" own/figures.html || fail "the page of a system lacks $wanted"
done
grep -q '^  geomint render ./spring.system$' out || fail 'the line of a system has more than its name'
grep -qE '^ +t +energy_error$' out && grep -q '<th>t<th>energy_error</tr>' own/figures.html ||
    fail 'a system has columns of what nobody asked for'
[ -s own/spring.png ] && [ -s own/spring-dark.png ] || fail 'a system has no picture'
"$geomint" again own/spring.png -o again.png 2>err && cmp -s again.png own/spring.png || fail "a system's figure again: $(cat err)"
mkdir -p other
cp spring.system other
refused 1 'would have one name' figures ./spring.system other/spring.system
refused 3 'nosuch.system could not be read' figures ./nosuch.system
refused 1 'there is no figure "kepler"' figures kepler

# a name up to a hyphen names several
timeout 600 "$geomint" figures razafindralandy-34 --quick --out two >out 2>err || fail "razafindralandy-34: $(cat err)"
[ "$(grep -c '^razafindralandy-34-' out)" = 2 ] || fail 'razafindralandy-34 are two figures'

# as the documents state them, not as they come out well
judged() {
    sed -n "/^$1: /,/^[a-z]/p" out | grep -q "^  $2  *$3" || fail "$1, $3: $(cat out)"
}
names=
for number in 3 5 6 8 9 10 24 25 26; do
    names="$names razafindralandy-$number"
done
# shellcheck disable=SC2086
timeout 600 "$geomint" figures $names --size 320x180 --out judged >out 2>err || fail "as stated: $(cat err)"
judged razafindralandy-3-steps open 'the growth rate.*with dt=pi/200, not with dt=pi/50, dt=pi/100, not given'
judged razafindralandy-5-euler holds 'the error of symplectic Euler is much smaller than that of explicit Euler'
judged razafindralandy-5-euler open 'and than that of implicit Euler.*with until=60, not with until=5'
judged razafindralandy-6 holds 'the energy error of RK4 is smaller than that of the second-order scheme'
judged razafindralandy-8 open '.*with angle=pi/10 until=1600, not with angle=pi/5 until=1600'
judged razafindralandy-9 open 'RK4 reproduces.*with strength=1, not with strength=150, not given'
judged razafindralandy-9 open 'so does the symplectic RK4.*with strength=1, not with strength=150, not given'
judged razafindralandy-10 holds 'RK4 loses quasi-periodicity.*with strength=1, strength=150, not given'
judged razafindralandy-10 'does not hold' 'the symplectic RK4.*with strength=1, strength=150, not given'
judged razafindralandy-10 open '(ours) RK4 loses.*with strength=150, not with strength=1'
judged razafindralandy-26 'does not hold' '.*close to the exact solution: 0.04663 (at most 0.0226, 5 % of the'
judged razafindralandy-24 'does not hold' 'Lax-Wendroff oscillates'
judged razafindralandy-24-finer holds 'Lax-Wendroff oscillates'
judged razafindralandy-25 'does not hold' 'invariantised FTCS does not oscillate: 0.42'
judged razafindralandy-25 holds 'nor does invariantised Lax-Wendroff'
judged razafindralandy-25 'does not hold' 'nor does invariantised Crank-Nicolson'
judged razafindralandy-25-finer holds 'invariantised FTCS does not oscillate'
judged razafindralandy-25-finer holds 'nor does invariantised Crank-Nicolson'
documents=$(sed -n 's/.* figures made; \([0-9]*\) statements of the documents hold, \([0-9]*\) do not, \([0-9]*\) open;.*/\1 \2 \3/p' out)
[ "$documents" = "$(awk '/^razafindralandy/ { variant = $1 ~ /finer:$/ }
    /^  (holds|open|does not hold) / && !variant && !/\(ours\)/ { if (/^  holds/) hold++; else if (/^  open/) open++; else fail++ }
    END { print hold + 0, fail + 0, open + 0 }' out)" ] || fail "the sum counts others than the documents': $documents"
grep -q "Of $(($(echo "$documents" | tr ' ' +))) statements of the documents" judged/figures.html || fail 'the sum of the page'
grep -q '✗ does not hold</span><br><span class="soft">with strength=1, strength=150, not given' judged/figures.html ||
    fail 'the page does not name what the document leaves open'

timeout 600 "$geomint" figures tyranowski-11 tyranowski-14 --size 320x180 --out moving >out 2>err ||
    fail "moving meshes: $(cat err)"
judged tyranowski-11-schemes holds 'integrators of second order give very similar plots: the control-theoretic'
judged tyranowski-11-schemes open 'the multiplier strategy.*not with points=127'
judged tyranowski-14 holds 'Gauss, symplectic, shows virtually the same.*(0.95 to 1.05)'
judged tyranowski-11 holds 'the multiplier strategy converges slightly slower.*(0.75 to 1)'
judged tyranowski-11-uniform holds '.*uniform mesh becomes quadratically convergent'

# one that cannot be written stops no other
mkdir -p broken/razafindralandy-1.png/full
timeout 600 "$geomint" figures razafindralandy-1 razafindralandy-4 --quick --out broken >out 2>err
[ $? = 3 ] || fail 'a figure that cannot be written is exit 3'
grep -q 'razafindralandy-1 was not made' err || fail "it is told: $(cat err)"
[ -s broken/razafindralandy-4.png ] || fail 'the other figure is not made'
grep -q 'Not made' broken/figures.html || fail 'the page does not tell'
grep -q '1 of 2 figures made' out || fail "the sum: $(tail -n 1 out)"

# interrupted: what is finished stays, on the page too
"$geomint" figures --size 320x180 --out stopped >out 2>err &
pid=$!
tries=0
while [ "$(ls stopped 2>/dev/null | wc -l)" -lt 6 ] && [ $tries -lt 3000 ]; do
    sleep 0.1
    tries=$((tries + 1))
done
kill -TERM $pid
wait $pid
[ $? = 130 ] || fail 'an interrupted run is not exit 130'
grep -q 'data:image/png' stopped/figures.html || fail 'an interrupted run keeps no pictures'
grep -q 'Not made' stopped/figures.html || fail 'an interrupted run does not tell what is missing'
ls -A stopped | grep -q '^\.' && fail "an interrupted run left $(ls -A stopped | grep '^\.')"

[ $failures = 0 ] && echo 'all as it should be'
exit $failures
