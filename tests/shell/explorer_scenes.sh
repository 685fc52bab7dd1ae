#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Every scene in the smallest usual terminal, and in one that is smaller still: what there is can be reached and
# read. Usage: explorer_scenes.sh GEOMINT
set -u

. "$(dirname "$0")/tmux.sh"

# the scene's own parameters but the end, which `geomint run` alone knows, and what only a mesh file has
keys_of() {
    "$geomint" list "$1" --json | sed 's|"observables".*||' | grep -o '"key":"[^"]*"' | sed 's/"key":"//; s/"//' |
        grep -vxE "until|compensated|binding|tau0|tolerance|newmark_beta|inlet|lid|refine${2-|star}"
}

open_scene() { # WORDS
    keys "clear; \"$geomint\" $*; echo \"left \$?\"" Enter
    wait_for '×'
    pause
}

# no number that is none, no text that is cut within a letter
readable() {
    settled | grep -E '\bnan\b|\binf\b|\(null\)|�' && fail "$1: that cannot be read"
}

start 80x24 COLORTERM=truecolor TERM=tmux-256color
for scene in $("$geomint" list scenes --json | grep -o '"scene":"[^"]*"' | sed 's/"scene":"//; s/"//'); do
    open_scene "$scene"
    wait_for 'SCHEMES' || echo "  in $scene"
    # every parameter can be chosen, one after the other, and says what it is
    case $scene in
    form-*) own=$(keys_of "$scene" '' | grep -vxE 'azimuth|elevation|zoom|turn') ;; # their meshes are flat
    *) own=$(keys_of "$scene") ;;
    esac
    for key in $own; do
        # the portrait has no row where the system refuses it
        if [ "$key" = portrait ] && ! "$geomint" run "$scene" portrait=yes steps=1 >/dev/null 2>&1; then
            screen | grep -q "portrait" && fail "$scene: a row of a portrait that it cannot have"
            continue
        fi
        screen | grep -qE "▸ $key( |‹)" || keys Down
        wait_for "▸ $key( |‹)" || echo "  in $scene"
    done
    readable "$scene"
    keys '?'
    wait_for '^ KEYS' || echo "  in $scene"
    keys '?' i
    wait_for 'AS MEASURED' || echo "  in $scene"
    keys Escape
    wait_for 'SCHEMES'
    # forked, six, overlaid, one
    keys f Enter c c c c o
    readable "$scene with lanes"
    for ((i = 0; i < 30; i++)); do keys x; done # some scenes begin with many lanes
    wait_for 'The last lane stays' || echo "  in $scene"
    screen | grep -q 'all lanes' && fail "$scene: one lane is shown as all lanes"
    keys q
    wait_for 'left 0'
done

# the names of schemes are whole where there is little room: titles go on below, letters stand close
open_scene disc
wait_for '^ +explicit +implicit +symplectic '
wait_for '^ +Euler +Euler +Euler '
wait_for '━ explicit Euler +(L +1|! lost)'
wait_for '• symplectic Euler  SLA  1'
keys q
wait_for 'left 0'

# a sentence that does not fit into the last row has rows of its own
open_scene stiff
keys c c c c c
wait_for 'remove one with x before adding another\.'
wait_for 'space resume +\? help'
keys Down Down Down
wait_for '▸ springs'
wait_for 'springs: number of stiff springs, of which the energies of the first three are'
wait_for 'starts again'
wait_for 'enter type .*- \+ finely'
# by fine steps, and typed
keys Up Up Up
wait_for '▸ dt +0\.03'
keys +
wait_for '▸ dt +0\.0305'
keys - -
wait_for '▸ dt +0\.0295'
keys S-Right
wait_for '▸ dt +0\.03 '
keys Enter
wait_for 'dt = _'
keys 0.013 Enter
wait_for '▸ dt +0\.013'
# slow motion: single steps
keys Space
for ((i = 0; i < 30; i++)); do keys '['; done
wait_for '[0-9.e-]+ steps/s  ▸ 1e-07×'
keys q
wait_for 'left 0'

# a click in the picture is a new start where there is a parameter that means it
click() { # COLUMN ROW
    # shellcheck disable=SC2046
    tm send-keys -t "$pane" -H $(printf '\033[<0;%d;%dM\033[<0;%d;%dm' "$1" "$2" "$1" "$2" | od -An -tx1)
}
while read -r scene key standard words; do
    # shellcheck disable=SC2086
    open_scene "$scene" scheme=$words
    for ((i = 0; i < 12; i++)); do
        screen | grep -q "▸ $key " && break
        keys Down
        settled >/dev/null
    done
    wait_for "▸ $key +$standard" || echo "  in $scene"
    click 12 9
    wait_gone "▸ $key +$standard" || echo "  in $scene"
    keys q
    wait_for 'left 0'
done <<'LIST'
vortices angle pi/5 rk4
abc x 0.5 volume-splitting2
oscillator q0 0.29 midpoint
sine-gordon position -5 leapfrog initial=kink
kdv position -5 box initial=soliton
nls position -5 box
LIST

# a map of many runs is asked for, grows, and a click in it opens the run that it shows there
start 120x40 COLORTERM=truecolor TERM=tmux-256color
open_scene henon-heiles scheme=verlet
keys M
wait_for 'A map of runs'
wait_for 'measure=energy_error'
keys C-u 'henon-heiles scheme=verlet q2=0.1 measure=megno'
wait_for 'one key with several numbers, or of two, and not of 0'
keys C-u 'henon-heiles scheme=yoshida4 energy=0.125 q2=-0.3..0.6:10 p2=-0.4..0.4:9 until=50 measure=megno'
wait_for 'That is right'
keys Enter
wait_for 'mean MEGNO over q2 and p2'
wait_for 'sweep 100 %: Done'
click 1 20
wait_for 'sweep 100 %: Done'
click 65 20
wait_for '▸ ━━━ Yoshida 4'
wait_for 'q2 +0.2 '
wait_for 'p2 +0 '
wait_for 'energy +0.125'
keys M
wait_for 'q2=-0.3..0.6:10'
keys Enter
wait_for 'sweep 100 %: Done'
keys q
wait_for 'left 0'

# smaller still: the picture, and the panel when it is asked for
start 40x12 COLORTERM=truecolor TERM=tmux-256color
open_scene kepler
screen | grep -q 'SCHEMES' && fail "40x12: a panel beside the picture"
keys Down
wait_for 'eccentricity = 0\.5: '
keys Right
wait_for 'eccentricity = 0\.55: '
keys s
wait_for 'SWITCH TO'
keys verlet
wait_for '▸ +(● +)?Verlet' # one of its lanes may have it
keys Enter
wait_gone 'SWITCH TO'
keys v
wait_for 'SCHEMES'
wait_for '━━━ Verlet'
keys v
wait_for 'PARAMETERS'
wait_for '▸ eccentricity'
keys v
wait_for 'OBSERVED'
keys v
wait_gone 'OBSERVED'
keys q
wait_for 'left 0'

[ "$failures" = 0 ] && echo "scenes in the explorer: all passed"
exit $((failures > 0))
