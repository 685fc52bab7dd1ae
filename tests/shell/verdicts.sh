#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# What geomint figures says of the documents' statements: verdicts.sh GEOMINT
set -u
. "$(dirname "$0")/answers.sh"

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

[ $failures = 0 ] && echo 'all as it should be'
exit $failures
