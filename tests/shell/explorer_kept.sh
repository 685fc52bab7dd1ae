#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What is kept of the explorer: movies, whatever way it is left; command lines. Usage: explorer_kept.sh GEOMINT
set -u

. "$(dirname "$0")/tmux.sh"

# ---- command lines ----

start 80x24 COLORTERM=truecolor TERM=tmux-256color
tm set-option -s set-clipboard on
# the words of a command on the page of key y, joined again
told() {
    screen | sed 's/▸/ /; s/^ *//' | awk -v heading="$1" '
        index($0, heading) { on = 1; next }
        on && /^$/ { exit }
        on { text = text (text == "" || text ~ /,$/ ? "" : " ") $0 }
        END { print text }'
}
copied() {
    local i
    for ((i = 0; i < 100; i++)); do # it is sent behind the screen
        [ "$(tm show-buffer 2>/dev/null)" = "$1" ] && return 0
        sleep 0.1
    done
    fail "the clipboard has \"$(tm show-buffer)\", not \"$1\""
}

keys "\"$geomint\" disc scheme=rk4,midpoint dt=0.2,0.1; echo \"left \$?\"" Enter
wait_for 'SCHEMES'
pause
keys r
wait_for 't = 0(\.0*)? '
keys . . .
wait_for 't = 0\.3'
keys y
wait_for 'THIS VIEW AS A PICTURE'
picture=$(told 'AS A PICTURE')
again=$(told 'THE EXPLORER, FROM')
copied "$picture"
[ "$again" = 'geomint disc scheme=rk4,midpoint dt=0.2,0.1' ] || fail "as typed: $again"
keys y
copied "$again"
keys y
copied "$picture"
keys Escape
wait_for 'SCHEMES'
# what is changed in flight: the picture redoes the change, the explorer begins with what it led to
keys Tab Tab s
wait_for 'SWITCH TO'
keys verlet
wait_for 'search: verlet'
keys Enter
wait_for 'Verlet'
keys Down Enter
wait_for 'system = _'
keys pendulum Enter
wait_for '‹ pendulum ›'
keys y
wait_for 'THIS VIEW AS A PICTURE'
again=$(told 'THE EXPLORER, FROM')
case $again in
'geomint disc '*verlet*system=pendulum*) ;;
*) fail "changed: $again" ;;
esac
keys q
wait_for 'left 0'
# it opens what it says, and says it again, also in a terminal that is narrower than its words
keys "clear; \"$geomint\" ${again#geomint }; echo \"left \$?\"" Enter
wait_for 'SCHEMES'
wait_for 'Verlet'
pause
keys y
wait_for 'THIS VIEW AS A PICTURE'
tm resize-window -t "$pane" -x 32 -y 24
wait_for 'scheme=rk4,.*,$'
settled >/dev/null
[ "$(told 'THE EXPLORER, FROM')" = "$again" ] || fail "opened again: $(told 'THE EXPLORER, FROM'), not $again"
keys q
wait_for 'left 0'
tm resize-window -t "$pane" -x 80 -y 24

# ---- movies ----

command -v ffprobe >/dev/null || {
    [ "$failures" = 0 ] && echo "kept: all passed but movies, for want of ffmpeg"
    exit $((failures > 0))
}

record() { # [NAME=VALUE]: opens the disc and records for a while
    keys "clear; $* \"$geomint\" disc; echo \"left \$?\"" Enter
    wait_for 'SCHEMES'
    keys R
    wait_for "● 0:0[1-9]"
}
is_movie() { # NAME
    local frames
    frames=$(ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 "$folder/$1" 2>&1)
    [ "${frames%%[!0-9]*}" -gt 20 ] 2>/dev/null || fail "$1 is no movie: $frames"
}

number=0
for way in q C-c TERM INT QUIT HUP; do
    number=$((number + 1))
    name=disc-000$number.mp4
    record
    case $way in
    q)
        keys q
        wait_for 'Quit\? The recording is not finished\. q again quits, any other key stays'
        keys z
        wait_gone 'Quit\?'
        keys q
        wait_for 'Quit\?'
        keys q
        ;;
    C-c) keys $way ;;
    *) kill -"$way" "$(explorer_pid)" ;;
    esac
    wait_for "geomint: Saved $name, a movie of [0-9.]+ s\\."
    case $way in
    q) wait_for 'left 0' ;;
    C-c | INT) wait_for 'left 130' ;;
    TERM) wait_for 'left 143' ;;
    QUIT) wait_for 'left (131|[0-9]+)' ;;
    HUP) wait_for 'left 129' ;;
    esac
    is_movie "$name"
done

# left for another scene, and a second one there
record
keys l
wait_for 'Type to search'
keys kepl Enter
wait_for 'A Kepler orbit'
keys R
wait_for "● 0:0[1-9]"
keys l
wait_for 'Type to search'
keys q
wait_for 'Quit\?'
keys q
wait_for 'geomint: Saved disc-0007.mp4'
wait_for 'geomint: Saved kepler-0001.mp4'
wait_for 'left 0'
is_movie disc-0007.mp4
is_movie kepler-0001.mp4

# ---- leaving takes a while ----

appears() { # FILE
    local i
    for ((i = 0; i < 400; i++)); do
        [ -e "$folder/$1" ] && return 0
        sleep 0.1
    done
    fail "$1 does not appear"
}
ended() { # PROCESS WHAT
    local i
    for ((i = 0; i < 400; i++)); do
        kill -0 "$1" 2>/dev/null || return 0
        sleep 0.1
    done
    fail "it outlives $2"
}
fake() { # its script: an ffmpeg that is first in the path
    mkdir -p "$folder/bin"
    cat >"$folder/bin/ffmpeg"
    chmod +x "$folder/bin/ffmpeg"
}

# a window that is closed says so more than once, and it does not matter when
fake <<END
#!/bin/sh
"$(command -v ffmpeg)" "\$@"
status=\$?
touch "$folder/complete"
while [ ! -e "$folder/go" ]; do sleep 0.05; done
exit \$status
END
record "PATH=$folder/bin:\$PATH"
kill -HUP "$(explorer_pid)"
appears complete
kill -HUP "$(explorer_pid)"
kill -HUP "$(explorer_pid)"
touch "$folder/go"
wait_for 'geomint: Saved disc-0008.mp4'
wait_for 'left 129'
is_movie disc-0008.mp4

# an ffmpeg that hangs holds up only who waits for it
fake <<END
#!/bin/sh
cat >/dev/null
sleep 8640$$
END
record "PATH=$folder/bin:\$PATH"
keys q
wait_for 'Quit\?'
keys q
wait_gone 'SCHEMES'
keys C-c
wait_for 'geomint: No movie: ffmpeg was interrupted and disc-0009.mp4 was not made'
wait_for 'left 0'
pgrep -f "sleep 8640$$" >/dev/null && fail 'an ffmpeg that hangs outlives it'
rm "$folder"/disc-0009.mp4.log

# the terminal is gone with its window
record
process=$(explorer_pid)
tm kill-session -t "$pane"
ended "$process" 'its window'
is_movie disc-0009.mp4

[ "$failures" = 0 ] && echo "kept: all passed"
exit $((failures > 0))
