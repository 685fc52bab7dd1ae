#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# geomint figures: the page, a figure that fails among others, an interruption. figures.sh GEOMINT
set -u
geomint=$1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

fail() {
    printf 'FAILED: %s\n' "$1"
    failures=$((failures + 1))
}

timeout 120 "$geomint" figures razafindralandy-1 razafindralandy-5 tyranowski-2 --quick --out page >out 2>err
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

# a name up to a hyphen names several
timeout 120 "$geomint" figures razafindralandy-34 --quick --out two >out 2>err || fail "razafindralandy-34: $(cat err)"
[ "$(grep -c '^razafindralandy-34-' out)" = 2 ] || fail 'razafindralandy-34 are two figures'

# one that cannot be written stops no other
mkdir -p broken/razafindralandy-1.png/full
timeout 120 "$geomint" figures razafindralandy-1 razafindralandy-4 --quick --out broken >out 2>err
[ $? = 3 ] || fail 'a figure that cannot be written is exit 3'
grep -q 'razafindralandy-1 was not made' err || fail "it is told: $(cat err)"
[ -s broken/razafindralandy-4.png ] || fail 'the other figure is not made'
grep -q 'Not made' broken/figures.html || fail 'the page does not tell'
grep -q '1 of 2 figures made' out || fail "the sum: $(tail -n 1 out)"

# interrupted: what is finished stays, on the page too
"$geomint" figures --size 320x180 --out stopped >out 2>err &
pid=$!
tries=0
while [ "$(ls stopped 2>/dev/null | wc -l)" -lt 6 ] && [ $tries -lt 600 ]; do
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
