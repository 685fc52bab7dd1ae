#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Drives the explorer with keys in tmux and compares what is on the screen. Usage: explorer.sh GEOMINT
set -u

. "$(dirname "$0")/tmux.sh"

open_disc() {
    keys "stty -a >before; \"$geomint\" disc $*; echo \"left \$?\"; stty -a >after" Enter
    wait_for 'SCHEMES|A disc|× paused|×'
}

explorer_pid() { pgrep -n -f "^$geomint disc"; }

# clean CODE: after leaving, the shell's screen and settings are as they were
clean() {
    wait_for "left $1"
    screen | grep -q SCHEMES && fail "the alternate screen was not left"
    sleep 0.2
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

start 140x40
open_disc
wait_for 'explicit Euler'
wait_for 'A disc of initial conditions'
pause
wait_for 't = ' # whatever it is; from here on by steps
keys r
wait_for 't = 0 '
keys . . . .
wait_for 't = π/3'
base=$(settled)

keys .
sleep 0.3
forward=$(settled)
differ "step forward" "$base" "$forward"
keys ,
sleep 0.3
same "step forward and back" "$base" "$(settled)"
keys , , ,
sleep 0.3
keys . . .
sleep 0.3
same "three back and three forward" "$base" "$(settled)"
keys . .
sleep 0.3
keys ,
sleep 0.3
same "two forward and one back" "$forward" "$(settled)"
keys ,
wait_for 't = π/3'

# a live parameter: dt acts on the present state, the time stays
clock=$(screen | grep -oE 't = [^ │]+' | head -1)
keys Right
wait_for '▸ dt +0\.3'
[ "$(screen | grep -oE 't = [0-9π/]+' | head -1)" = "$clock" ] || [ -n "$clock" ] || fail "no clock"
wait_for 'time step; acts at once'
keys Left Left
wait_for '▸ dt +0\.2[^0-9]'
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

# schemes: switch in flight, compare, select, remove
keys . . .
sleep 0.3
keys s
wait_for 'SWITCH TO'
wait_for 'from its present state on'
keys Down Enter
wait_for 'SCHEMES'
wait_gone 'SWITCH TO'
wait_gone '▸ ━━━ explicit Euler'
keys c
wait_for 'four schemes'
keys Tab
wait_for '▸ ━━━'
keys x
wait_for 'three schemes'
keys x x x
wait_for 'The last lane stays'
keys c c
wait_for 'three schemes'
keys r
wait_for 't = 0 '

# speed
keys ]
wait_for '2× paused'
keys '[' '['
wait_for '0\.5× paused'
keys ]
wait_for ' 1× paused'

# help
keys '?'
wait_for 'KEYS'
wait_for 'symplectic'
wait_for 'THE SELECTED SCHEME'
keys '?'
wait_for 'SCHEMES'

# blocks: quadrants, half blocks, ASCII, and back to braille
keys . . . .
sleep 0.3
braille=$(settled)
for i in 1 2 3; do
    keys b
    sleep 0.3
done
ascii=$(settled)
printf '%s' "$ascii" | LC_ALL=C grep -q '[^ -~]' && fail "the ASCII screen has other letters"
keys b
sleep 0.3
same "blocks all around" "$braille" "$(settled)"

# a picture
keys p
wait_for 'Saved disc-0001.png|Not saved'
if [ -f "$folder/disc-0001.png" ]; then
    [ "$(head -c 4 "$folder/disc-0001.png" | tail -c 3)" = PNG ] || fail "disc-0001.png is no PNG"
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
    sleep 0.3
    case $size in
    80x24) wait_for 'SCHEMES' ;;
    20x5) wait_for 'paused' ;;
    200x60) wait_for 'OBSERVED' ;;
    esac
done
same "after all sizes" "$full" "$(settled)"

# paused: no processor time
pid=$(explorer_pid)
before=$(cut -d' ' -f14,15 "/proc/$pid/stat")
sleep 1
after=$(cut -d' ' -f14,15 "/proc/$pid/stat")
[ "$before" = "$after" ] || fail "paused, it used processor time: $before, then $after"

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

# suspended and continued: the shell forgets the rest of its line, so it is asked anew
open_disc
wait_for 'SCHEMES'
pause
full=$(settled)
keys C-z
wait_for 'Stopped'
keys fg Enter
wait_for 'SCHEMES'
same "suspended and continued" "$full" "$(settled)"
keys q
wait_gone 'SCHEMES'
keys 'stty -a >after; echo "left 0"' Enter
clean 0

# a lane that blows up is shown, the others go on
open_disc scheme=explicit-euler,midpoint dt=2
for i in 1 2 3 4 5 6 7; do keys ']'; done
wait_for 'blow-up'
wait_for 'stands still; the others go on'
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
