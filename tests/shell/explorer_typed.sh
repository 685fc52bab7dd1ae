#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# The prompts of the explorer: a system of one's own is typed, corrected, edited and saved; so is a scheme.
# Usage: explorer_own.sh GEOMINT
set -u

. "$(dirname "$0")/tmux.sh"

open() { # WORDS
    keys "clear; \"$geomint\" $*; echo \"left \$?\"" Enter
}

# caret TEXT: below the first letter of TEXT stands the caret
caret() {
    local i line before
    for ((i = 0; i < 100; i++)); do
        before=
        while IFS= read -r line; do
            [[ $before == *"$1"* && $line =~ ^\ *\^\ *$ ]] && {
                before=${before%%"$1"*}
                line=${line%%^*}
                [ "${#before}" = "${#line}" ] && return 0
            }
            before=$line
        done < <(screen)
        sleep 0.1
    done
    fail "no caret below $1"
}

click() { # COLUMN ROW
    # shellcheck disable=SC2046
    tm send-keys -t "$pane" -H $(printf '\033[<0;%d;%dM\033[<0;%d;%dm' "$1" "$2" "$1" "$2" | od -An -tx1)
}

for size in 80x24 160x45; do
    start $size TERM=tmux-256color GEOMINT_COLOURS=truecolor
    rm -f "$folder"/*.system
    # from the start screen: the example, something wrong, and right again
    open
    wait_for 'Type to search'
    keys own
    wait_for '▸ your own system'
    keys Enter
    wait_for 'H=p\^2/2 - cos\(q\)▏ q=2 p=0'
    wait_for 'That is right'
    keys ' + 2q'
    wait_for 'there is no operator'
    caret 'q▏ q=2'
    keys Enter
    keys BSpace BSpace BSpace BSpace BSpace
    wait_for 'That is right'
    keys End ' k=3'
    wait_for 'no parameter "k"'
    caret 'k=3'
    keys BSpace BSpace BSpace BSpace
    wait_for 'That is right'
    keys Enter
    wait_for 'SCHEMES'
    wait_for '[▸ ] q +2 '
    # edited: what runs stays until the line is right and entered
    keys e
    wait_for 'H=p\^2/2 - cos\(q\)▏'
    keys '*cso(q)'
    wait_for 'did you mean cos'
    wait_for 'SCHEMES'
    keys Escape
    wait_gone 'did you mean'
    keys e
    wait_for 'cos\(q\)▏'
    keys '*k' End ' k=2'
    wait_for 'That is right'
    keys Enter
    wait_for '[▸ ] k +2 '
    # told as a shell reads it, and saved
    keys y
    wait_for "H='p\^2/2 - cos\(q\)\*k'"
    keys s
    wait_for 'Saved system-0001.system'
    keys q
    wait_for 'left 0'
    grep -q '^parameter: k = 2$' "$folder/system-0001.system" || fail "saved: $(cat "$folder/system-0001.system")"
    open ./system-0001.system
    wait_for 'SCHEMES'
    # of a file its formula is edited, behind its name
    keys e
    wait_for 'system-0001.system H=p\^2/2 - cos\(q\)\*k▏'
    keys ' + q^2/8'
    wait_for 'That is right'
    keys Enter
    wait_gone 'That is right'
    keys y
    wait_for "system-0001.system H='p\^2/2"
    keys Escape
    wait_for 'SCHEMES'
    # what is typed ahead is for the page that opens
    keys y s
    wait_for 'Saved system-0001-0001.system'
    keys Escape
    wait_for 'SCHEMES'
    [ $size = 80x24 ] || continue

    # a click in the phase plane is a new start, in both of its components: left of the middle and below it,
    # once the orbit has gone round and fills the plane
    keys q
    wait_for 'left 0'
    printf 'coordinates: x\nmomenta: v\nH: v^2/2 - cos(x)\nstart: x = 1.25, v = 0\n' >"$folder/own.system"
    open ./own.system
    wait_for '[▸ ] x +1\.25 '
    wait_for 't = [0-9]{2,}\.'
    keys Space
    wait_for 'paused'
    click 7 10
    wait_for '[▸ ] x +-(0|1)\.[0-9]+ '
    wait_for '[▸ ] v +-(0|1)\.[0-9]+ '
    # beside it nothing is clicked
    before=$(screen | grep -oE '[▸ ] [xv] +-[0-9.]+')
    click 2 2
    keys y
    wait_for 'x=-'
    keys Escape
    wait_for 'SCHEMES'
    [ "$(screen | grep -oE '[▸ ] [xv] +-[0-9.]+')" = "$before" ] || fail 'a click beside the plane is a start'

    # a scheme, switched to and forked with
    keys s
    wait_for 'SWITCH TO'
    keys 'your own'
    wait_for '▸ +your own scheme'
    keys Enter
    wait_for 'composition\(verlet;'
    wait_for 'That is right'
    keys C-u 'composition(verlet; 1, 0.5)'
    wait_for 'the steps sum to 1.5'
    keys Enter
    keys C-u 'composition(vrlet; 1)'
    wait_for 'vrlet'
    # what the scheme lacks at once, without what is on the screen
    keys C-u 'strang(A, B)'
    wait_for '^ it needs a part A \(column 8\)'
    screen | grep -q 'geomint list' && fail 'a command that cannot be given here'
    keys C-u 'projected(rk4; H, no)'
    wait_for '^ it needs an invariant no'
    wait_for '^ +\^ *$'
    keys Escape
    wait_for 'SCHEMES'
    keys f
    wait_for 'FORK WITH'
    keys 'your own'
    wait_for '▸ +your own scheme'
    keys Enter
    wait_for 'That is right'
    keys C-u 'runge-kutta(0, 0 | 2/3, 0; 1/4, 3/4)'
    wait_for 'That is right'
    keys Enter
    wait_gone 'That is right'
    wait_for '▸.*\(b: 0\.25, 0\.75\)'
    keys q
    wait_for 'left 0'
done

# in space one goes around what is seen: by keys, the mouse and the wheel; no step is made anew, and the command
# line tells the camera as if it had been typed
drag() { # COLUMN ROW COLUMN ROW
    # shellcheck disable=SC2046
    tm send-keys -t "$pane" -H $(printf '\033[<0;%d;%dM\033[<32;%d;%dM\033[<0;%d;%dm' "$1" "$2" "$3" "$4" "$3" "$4" |
        od -An -tx1)
}
start 100x40 TERM=tmux-256color GEOMINT_COLOURS=truecolor
open rigid-body scheme=rkmk4
wait_for 'azimuth +-60'
wait_for 't = [1-9]'
keys Space
wait_for 'paused'
time=$(screen | grep -oE 't = [0-9.]+' | head -n 1)
keys S-Right S-Right
wait_for 'azimuth +-50'
keys S-Up
wait_for 'elevation +30'
keys S-Down S-Down
wait_for 'elevation +20'
keys z
wait_for 'zoom +1.25'
keys Z Z
wait_for 'zoom +0.8'
drag 40 20 20 20
wait_for 'azimuth +-14'
drag 20 10 20 15
wait_for 'elevation +38'
tm send-keys -t "$pane" -H $(printf '\033[<64;20;20M' | od -An -tx1)
wait_for 'zoom +1 '
[ "$(screen | grep -oE 't = [0-9.]+' | head -n 1)" = "$time" ] || fail 'the camera moved the time'
keys y
wait_for 'azimuth=-14'
wait_for 'elevation=38'
screen | grep -q -- '--changes' && fail 'the camera is a change in flight'
keys Escape
wait_for 'SCHEMES'
keys ,
wait_gone "$time"
wait_for 'azimuth +-14' # in the past it stands where it stands
keys '?'
wait_for 'in space: go around it'
keys Escape q
wait_for 'left 0'

# nothing breaks it: control characters, letters of two cells, halves of them, a long paste, deep parentheses
start 60x14 TERM=tmux-256color
open
wait_for 'Type to search'
keys own Enter
wait_for 'H=p'
keys C-u
keys -H 00 01 02 1d e6 bc a2 c3
keys -l 'H=漢字é+1 q=1 p=0'
wait_for 'no character of a formula|H=\?\?é'
screen | LC_ALL=C grep -q "$(printf '[\001-\010\016-\037]')" && fail 'a control character is shown'
keys C-u
head -c 100000 /dev/zero | tr '\0' x | tm load-buffer -
tm paste-buffer -t "$pane"
wait_for 'A line has room for'
keys C-u
printf 'H=%400sq%400s q=1 p=0' '' '' | sed 's/ \{400\}q/(&/; s/q \{400\}/&)/' | tr -s ' ' | tm load-buffer -
tm paste-buffer -t "$pane"
keys C-u
tm resize-window -t "$pane" -x 30 -y 6
keys -l 'H=p^2/2 q=1 p='
wait_for 'p=▏'
tm resize-window -t "$pane" -x 80 -y 24
keys 1
wait_for 'That is right'
keys Enter
wait_for 'SCHEMES'
keys q
wait_for 'Quit\? The formula is not saved'
keys q
wait_for 'left 0'

# in a small terminal, too, the sentence is there to its end, and the caret below its letter
start 40x12 TERM=tmux-256color
open
wait_for 'Type to search'
keys own Enter
wait_for 'H=p'
keys C-u
keys -l 'H=p^2/2+q^2/2+q^4/8+q^6/12+q^8/16+kk q=1 p=0'
wait_for 'the formula needs values that are not'
wait_for 'given: kk='
caret 'kk q=1'
keys Escape
wait_gone 'given: kk='
keys Escape q
wait_for 'left 0'

# the list of what there is has the systems of one's own folder; one that is wrong says why, and a pipe is no file
mkdir -p "$folder/config/geomint"
printf 'title: a spring of mine\ncoordinates: q\nH: p_q^2/2 + q^2\nstart: q = 1, p_q = 0\n' \
    >"$folder/config/geomint/mine.system"
printf 'title: a broken spring\ncoordinates: q\nH: p_q^2/2 + qq\nstart: q = 1, p_q = 0\n' \
    >"$folder/config/geomint/broken.system"
mkfifo "$folder/config/geomint/pipe.system"
start 80x24 TERM=tmux-256color GEOMINT_COLOURS=truecolor XDG_CONFIG_HOME="$folder/config"
open
wait_for 'Type to search'
keys rigid
wait_for '▸ rigid-body'
wait_for 'A free rigid body, by'
keys zzz
wait_for 'nothing found'
keys Tab
keys Escape
keys pipe
wait_for 'it is a pipe, and no file'
keys Enter
wait_for 'Type to search'
wait_for '▸ pipe'
keys broken
wait_for 'there is no name qq'
caret qq
keys Enter
wait_for 'Type to search'
wait_for '▸ broken'
keys mine
wait_for 'a spring of mine, by'
# what is typed ahead, at once, is for the scene that opens
keys -H 0d 20
wait_for 'SCHEMES'
wait_for 'paused'
keys l
wait_for '▸ mine'
keys Enter
wait_for 'SCHEMES'
keys q
wait_for 'left 0'
# a page that has no answer says why, without the prefix of the command line
open duffing
wait_for 'SCHEMES'
keys V
wait_for '^ *the invariants of this system are not searched'
keys q
wait_for 'left 0'

[ "$failures" = 0 ] && echo "explorer, one's own: all passed"
exit $((failures > 0))
