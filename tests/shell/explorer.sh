#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Drives the explorer with keys in tmux and compares what is on the screen. Usage: explorer.sh GEOMINT
set -u

. "$(dirname "$0")/tmux.sh"

open_scene() {
    keys "stty -a >before; \"$geomint\" $*; echo \"left \$?\"; stty -a >after" Enter
}

open_disc() {
    open_scene disc "$@"
    wait_for 'SCHEMES|A disc|× paused|×'
}


# clean CODE: after leaving, the shell's screen and settings are as they were
clean() {
    wait_for "left $1"
    screen | grep -q SCHEMES && fail "the alternate screen was not left"
    local i
    for ((i = 0; i < 50; i++)); do # the shell is still writing it
        cmp -s "$folder/before" "$folder/after" && break
        sleep 0.1
    done
    cmp -s "$folder/before" "$folder/after" || {
        fail "stty -a is not what it was"
        diff "$folder/before" "$folder/after"
    }
    keys "printf '\\n'; clear" Enter
    wait_gone 'left'
}

# ---- no terminal ----

for input in "</dev/null" "| cat"; do
    if [ "$input" = "| cat" ]; then
        message=$(cd "$folder" && TERM=xterm script -qec "'$geomint' disc | cat" /dev/null </dev/null 2>&1 | head -1)
        code=1
    else
        message=$("$geomint" disc </dev/null 2>&1 >/dev/null)
        code=$?
    fi
    [ "$code" = 1 ] || fail "without a terminal ($input) the exit status is $code"
    case $message in
    *"needs a terminal"*) ;;
    *) fail "without a terminal ($input) it says: $message" ;;
    esac
done

message=$(GEOMINT_COLOURS=mauve "$geomint" terminal 2>&1)
[ $? = 1 ] || fail "an unknown GEOMINT_COLOURS is accepted"
case $message in *mauve*"none, 16, 256 or truecolor"*) ;; *) fail "GEOMINT_COLOURS=mauve: $message" ;; esac
TERM=xterm-256color "$geomint" terminal | grep -q '256' || fail "terminal does not report 256 colours"
TERM=xterm-256color COLORTERM=truecolor "$geomint" terminal | grep -q 'truecolor.*COLORTERM' ||
    fail "terminal does not believe COLORTERM"
TERM=xterm-256color NO_COLOR=1 "$geomint" terminal | grep -q 'none.*NO_COLOR' || fail "NO_COLOR is not honoured"

start 100x30
keys "TERM=dumb '$geomint' disc; echo left \$?" Enter
wait_for 'cannot start because TERM is "dumb"'
wait_for 'left 1'

# ---- keys ----

# mouse REPORT ...: as the terminal would send them; column and row count from 1
mouse() {
    local report
    for report; do
        # shellcheck disable=SC2046
        tm send-keys -t "$pane" -H $(printf '\033[<%s' "$report" | od -An -tx1)
    done
}

# at TEXT: "column;row" of the first letter of a text on the screen, as the mouse reports it
at() {
    local line row=0
    while IFS= read -r line; do
        row=$((row + 1))
        [[ $line == *"$1"* ]] && {
            line=${line%%"$1"*}
            echo "$((${#line} + 1));$row"
            return
        }
    done < <(screen)
}

# The disc at its start, paused: from here on by steps.
begin() {
    pause
    keys r
    wait_for 't = 0 '
}

drive_time() {
    keys . . . .
    wait_for 't = π/3'
    local base forward
    base=$(settled)
    keys .
    forward=$(changes "step forward" "$base")
    keys ,
    becomes "step forward and back" "$base"
    keys , , ,
    wait_for 't = π/12'
    keys . . .
    becomes "three back and three forward" "$base"
    keys . . ,
    becomes "two forward and one back" "$forward"
    keys ,
    becomes "and back again" "$base"

    keys ']'
    wait_for '2× paused'
    keys '[' '['
    wait_for '0\.5× paused'
    keys ]
    wait_for ' 1× paused'

    # the past: its first and last snapshot, and those between
    keys Home
    wait_for 't = 0 '
    keys End
    becomes "to the start and to the end of the past" "$base"
    keys PPage PPage
    wait_for 't = π/6'
    keys NPage NPage
    becomes "through the past" "$base"

    # ahead, and not back
    keys '>'
    wait_for 'Run ahead to t = _ +\(enter alone: 4\.71239\)'
    keys Enter
    wait_for 't = 3π/2'
    keys '>'
    wait_for 'Run ahead to t = _'
    keys '20*pi' Enter
    wait_for 't = 20π'
    keys '>'
    wait_for 'Run ahead to t = _'
    keys '1' Enter
    wait_for 'has already passed'
    keys Escape
    wait_gone 'already passed'
}

# Backwards the symmetric scheme returns; the others do not.
drive_backwards() {
    keys r
    wait_for 't = 0 '
    keys s
    wait_for 'SWITCH TO'
    keys midpoint
    wait_for 'search: midpoint'
    keys Enter
    wait_for '▸ ?━━━ midpoint'
    keys . . . . . .
    wait_for 't = π/2'
    keys B
    wait_for 'from start'
    keys Space
    wait_for 'paused'
    wait_for 't = [−]?0'
    wait_for 'from start +(0|[0-9.]+e−1[5-7])'
    keys Tab
    wait_for '▸ ?╍╍╍'
    keys r
    wait_for 't = 0 '
    wait_gone 'from start'
    keys BTab
    wait_for '▸ ?━━━'
}

drive_parameters() {
    # a live parameter: dt acts on the present state, the time stays
    keys . . . .
    wait_for 't = π/3'
    keys Right
    wait_for '▸ dt +0\.3'
    wait_for 't = (π/3|1\.0)'
    wait_for 'time step, 1e-6 to 100; acts at once'
    keys Left Left
    wait_for '▸ dt +0\.2[^0-9]'
    keys Enter
    wait_for 'dt = _'
    keys '0.25' Enter
    wait_for '▸ dt +0\.25'
    keys BSpace
    wait_for '▸ dt +pi/12'

    # another one: it restarts
    keys Down
    wait_for '▸ system'
    keys Right
    wait_for '‹ pendulum ›'
    wait_for 'area × 1\.000|t = 0'
    keys Right
    wait_for '‹ oscillator ›'
    keys Up
    wait_for '▸ dt'
}

drive_lanes() {
    local base
    keys r
    wait_for 't = 0 '
    keys . . . .
    wait_for 't = π/3'
    keys s
    wait_for 'SWITCH TO'
    wait_for 'from its current state on'
    keys '?'
    wait_for 'AS MEASURED'
    keys '?'
    wait_for 'SWITCH TO'
    keys Escape
    wait_gone 'SWITCH TO'
    keys f
    wait_for 'FORK WITH'
    keys verlet
    wait_for '▸ +Verlet'
    keys Enter
    wait_for '▸ ?━•━ Verlet'
    base=$(settled)
    keys .
    changes "a fork goes on" "$base" >/dev/null
    keys ,
    becomes "a fork and back" "$base"
    keys o
    wait_for 'all lanes'
    keys o
    becomes "overlaid and side by side" "$base"
    keys x
    wait_gone '━•━'
    keys c
    wait_for '▸ ?━•━'
    keys x x x x
    wait_for 'The last lane stays'
    keys c c
    wait_for '•••'
    keys r
    wait_for 't = 0 '
}

drive_screen() {
    local base size=$1 colours=$2 i
    keys . . . .
    wait_for 't = π/3'
    base=$(settled)

    # what the side panel gives room to
    keys v
    wait_gone 'OBSERVED'
    keys v
    wait_gone 'SCHEMES'
    keys v
    wait_for 'OBSERVED'
    wait_gone 'PARAMETERS'
    keys v
    wait_gone 'SCHEMES'
    wait_for '‖ 1× paused'
    keys v
    becomes "all views" "$base"

    # pages
    keys '?'
    wait_for 'KEYS'
    for ((i = 0; i < 12; i++)); do
        screen | grep -q 'AS MEASURED' && break
        keys NPage
        settled >/dev/null
    done
    wait_for 'AS MEASURED'
    keys '?'
    becomes "help and back" "$base"
    keys i
    wait_for 'symplectic +(holds|not claimed)'
    keys Escape
    becomes "the page of a scheme and back" "$base"

    # themes: another ground in colours; in no colours the screen is the same
    local dark light
    if [ "$colours" != none ]; then
        dark=$(in_colour)
        keys t
        for ((i = 0; i < 200; i++)); do
            light=$(in_colour)
            [ "$dark" != "$light" ] && break
            sleep 0.1
        done
        [ "$dark" != "$light" ] || fail "the light theme looks like the dark one"
        keys t
        for ((i = 0; i < 200; i++)); do
            in_colour | grep -qE '38;[25];' || break
            sleep 0.1
        done
        in_colour | grep -qE '38;[25];' && fail "the monochrome theme has colours"
        keys t
        becomes "themes all around" "$base"
    fi

    # blocks: quadrants, half blocks, ASCII, and back to braille
    keys b
    changes "quadrants" "$base" >/dev/null
    keys b b
    wait_gone '[━●│]'
    settled | LC_ALL=C grep -q '[^ -~]' && fail "the ASCII screen has other letters"
    keys b
    becomes "blocks all around" "$base"
    keys C-l
    becomes "drawn again" "$base"
}

drive_mouse() {
    local base place
    base=$(settled)
    place=$(at SCHEMES)
    mouse "0;${place%;*};$((${place#*;} + 2))M" "0;3;4m"
    wait_for '▸ ?╍╍╍'
    mouse "0;${place%;*};$((${place#*;} + 1))M" "0;3;3m"
    becomes "lanes clicked" "$base"
    mouse "64;5;5M"
    wait_for '2× paused'
    mouse "65;5;5M"
    becomes "the wheel" "$base"
    # a click in the phase plane moves the disc there; a drag through the past
    mouse "0;12;9M" "0;12;9m"
    wait_gone '[ ▸] q0 +0  '
    wait_for 't = 0 '
    keys . . . .
    wait_for 't = π/3'
    local row=${1#*x}
    mouse "0;2;$((row - 2))M"
    wait_for 't = 0 '
    mouse "32;500;$((row - 2))M" "0;40;$((row - 2))m"
    wait_for 't = π/3'
}

# Every key at both sizes, in true colour, 256 colours and none; the same letters in all of them but for the
# shades that none cannot have.
for size in 80x24 160x45; do
    for colours in truecolor 256 none; do
        start $size TERM=tmux-256color GEOMINT_COLOURS=$colours
        open_disc
        wait_for 'explicit Euler'
        begin
        keys . . . .
        wait_for 't = π/3'
        settled >"$folder/screen-$colours"
        keys r
        wait_for 't = 0 '
        if [ $size$colours = 80x24truecolor ]; then # shots.py drives the same keys at other sizes
            drive_time
            drive_backwards
            keys q
            clean 0
            open_disc
            begin
            drive_parameters
            drive_lanes
            keys q
            clean 0
            open_disc
            begin
        fi
        drive_screen $size $colours
        drive_mouse $size
        keys q
        clean 0
    done
    cmp -s "$folder/screen-truecolor" "$folder/screen-256" || fail "$size: 256 colours show other letters"
done

# where a title is longer than its column, what tells it from others stays
start 80x24
open_disc scheme=symplectic-euler-adjoint dt=0.1,0.2
wait_for 'symplect… \(adjoint\), 0\.1'
wait_for 'symplect… \(adjoint\), 0\.2'
keys q
clean 0

# ---- the list of scenes ----

start 80x24
keys "stty -a >before; \"$geomint\"; echo \"left \$?\"; stty -a >after" Enter
wait_for 'Type to search'
wait_for '▸ disc'
wait_for 't = ' # a live look
keys kepl
wait_for 'search: kepl_'
wait_for '▸ kepler'
wait_gone 'taylor-green'
wait_for 'Watch the energy'
keys Escape
wait_for 'taylor-green'
keys Home
keys Down Down
wait_for '▸ vortices'
keys Enter
wait_for 'SCHEMES'
keys Space l
wait_for 'Type to search'
wait_for '▸ vortices'
keys Enter
wait_for 'paused' # as it was left
keys l
wait_for '▸ vortices'
# what is called so comes first, whatever else mentions it, and whatever is open
keys soliton
wait_for '^ ▸ soliton'
wait_for '^   sine-gordon'
keys Escape
wait_for 'Type to search'
wait_for '▸ soliton'
keys disc
wait_for '▸ disc'
keys BSpace BSpace BSpace BSpace
wait_for 'Type to search'
# help
keys '?'
wait_for 'KEYS HERE'
wait_for 'from the scenes to the tours'
keys NPage
wait_for 'run ahead to a time'
keys q
clean 0
open_disc
wait_for 'SCHEMES'
keys l
wait_for 'Type to search'
keys '?'
wait_for 'KEYS HERE'
keys '?'
wait_for 'Type to search'
keys q
clean 0

# names of lanes in one panel are whole, also at 80 columns
open_disc scheme=explicit-euler,symplectic-euler,midpoint overlay=yes
wait_for '─── explicit Euler'
wait_for '╌╌ symplectic Euler'
wait_for '··· midpoint'
keys q
clean 0

# ---- pictures, sizes, rest ----

start 140x40
open_disc --painter auto
wait_for 'explicit Euler'
begin
keys . . . .
wait_for 't = π/3'
keys p
wait_for 'Saved disc-0001.png|Not saved'
if [ -f "$folder/disc-0001.png" ]; then
    [ "$(head -c 4 "$folder/disc-0001.png" | tail -c 3)" = PNG ] || fail "disc-0001.png is no PNG"
    grep -aq 'geomint:painter.osmesa, OpenGL' "$folder/disc-0001.png" || fail "p does not paint by OSMesa"
    keys p
    wait_for 'Saved disc-0002.png'
else
    fail "no disc-0001.png"
fi
keys z
wait_gone 'Saved'

# resizing, down to nothing and back
full=$(settled)
for size in 80x24 20x5 1x1 3x2 200x60 140x40; do
    tm resize-window -t "$pane" -x "${size%x*}" -y "${size#*x}"
    case $size in
    80x24) wait_for 'SCHEMES' ;;
    20x5) wait_for 'paused' ;;
    200x60) wait_for 'OBSERVED' ;;
    *) settled >/dev/null ;;
    esac
done
becomes "after all sizes" "$full"

rests 'paused'

# ---- ways out ----

keys q
clean 0
for signal in TERM INT HUP SEGV; do
    open_disc
    wait_for 'SCHEMES'
    kill -"$signal" "$(explorer_pid)"
    case $signal in
    TERM) clean 143 ;;
    INT) clean 130 ;;
    HUP) clean 129 ;;
    SEGV) clean '[0-9]+' ;; # a sanitizer has a status of its own for a crash
    esac
done
open_disc
wait_for 'SCHEMES'
keys C-c
clean 130

# at 80 x 24 the keys are visible from the beginning, and what to watch gives way to them
start 80x24
open_disc
wait_for 'Watch the area'
seen=$(screen)
[[ $seen == *'Watch the area: a symplectic map may shear the disc, but it never grows.'*'? help'*'q quit'*'← → change'* ]] ||
    fail "what to watch and the keys are not both there: $seen"
wait_gone 'Watch the area'
wait_for 'space pause +\? help +esc back +q quit +s scheme +f fork +← → change'
keys Escape # back to the list, and again to the scene
wait_for 'Type to search'
keys Enter
wait_for 'SCHEMES'
screen | grep -q 'Watch the area' && fail 'what to watch is said twice'
keys q
clean 0

# the help's lines go on below, also what is measured
start 120x40
open_disc
wait_for 'SCHEMES'
keys '?'
wait_for 'not claimed'
screen | grep -q 'AS MEASURED' || fail 'the help has no measured claims'
screen | sed -n '/AS MEASURED/,$p' | cut -c62- | tr -s ' \n' ' ' | grep -q 'for ordinary differential equations)' ||
    fail 'what is measured is cut'
keys '?'
wait_for 'SCHEMES'
keys q
clean 0

# suspended and continued: the shell forgets the rest of its line, so it is asked anew
open_disc
wait_for 'SCHEMES'
pause
full=$(settled)
keys C-z
wait_for 'Stopped'
keys fg Enter
wait_for 'SCHEMES'
becomes "suspended and continued" "$full"
keys q
wait_gone 'SCHEMES'
keys 'stty -a >after; echo left "0"' Enter # what is typed is not what is waited for
clean 0

# a lane that blows up is shown, the others go on
open_disc scheme=explicit-euler,midpoint dt=2
for i in 1 2 3 4 5 6 7; do keys ']'; done
wait_for 'blow-up'
wait_for 'stands still; the others continue'
keys q
clean 0

# ---- what a small terminal has no room for ends with one ellipsis ----

start 24x16
open_scene soliton
wait_for 'Mesh points'
keys Down Down Down Down Down Down Down Down
wait_for 'a mix of both,'
screen | grep '….*…' && fail 'a cut text ends with two ellipses'
keys q
clean 0

# ---- a step that takes minutes: what is opened is shown before it, and who leaves does not wait for it ----

start 120x36
open_scene vortices configuration=patches count=1e4 multipole=1e-9 tracers=1e6 scheme=gauss8 dt=1e-6
wait_for 'stir a dye'
keys q
clean 0

# ---- terminals ----

for environment in "TERM=tmux-256color COLORTERM=truecolor" "TERM=tmux-256color" "TERM=xterm" "TERM=vt100" \
    "TERM=tmux-256color GEOMINT_THEME=light" "TERM=tmux-256color LC_ALL=C" "TERM=linux"; do
    # shellcheck disable=SC2086
    start 120x36 $environment
    open_disc
    wait_for 'explicit Euler' || fail "$environment"
    pause
    settled >"$folder/screen"
    colours=$(tm capture-pane -e -p -t "$pane")
    case $environment in
    *truecolor*) [[ $colours == *'38;2;'* ]] || fail "$environment: no true colour" ;;
    "TERM=tmux-256color") [[ $colours == *'38;5;'* && $colours != *'38;2;'* ]] || fail "$environment: no 256 colours" ;;
    TERM=vt100) [[ $colours != *$'\e['[349][0-7]m* && $colours != *'38;'* ]] || fail "$environment: colours" ;;
    *LC_ALL=C) LC_ALL=C grep -q '[^ -~]' "$folder/screen" && fail "$environment: letters beyond ASCII" ;;
    esac
    keys q
    clean 0
done

[ "$failures" = 0 ] && echo "explorer: all passed"
exit $((failures > 0))
