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
