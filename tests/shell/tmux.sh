# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=bash
# For tests that drive the explorer with keys in tmux: sourced with the program as $1.
# Nothing is timed: every step waits until the screen shows what it must, or gives up after a while.

geomint=$(realpath "$1")
folder=$(mktemp -d)
socket=geomint-test-$$
servers=0
failures=0
pane=main
unset TMUX COLORTERM NO_COLOR GEOMINT_COLOURS GEOMINT_GRAPHICS GEOMINT_THEME
export LC_ALL=C.UTF-8

tm() { tmux -L "$socket" -f /dev/null "$@"; }

finish() {
    tm kill-server 2>/dev/null
    rm -rf "$folder"
}
trap finish EXIT

command -v tmux >/dev/null || {
    echo "tmux is not installed"
    exit 77
}

fail() {
    echo "FAILED: $*"
    screen | sed 's/^/    |/'
    failures=$((failures + 1))
    # what follows would wait in vain for most of what it wants
    if [ "$failures" -ge 3 ]; then
        echo "explorer: given up"
        exit 1
    fi
}

# what the shell in the pane runs: other tests may run the same command
explorer_pid() { pgrep -P "$(tm display-message -p -t "$pane" '#{pane_pid}')"; }

in_colour() { tm capture-pane -e -p -t "$pane" 2>/dev/null; }
screen() { tm capture-pane -p -t "$pane" 2>/dev/null; }
keys() { tm send-keys -t "$pane" "$@"; }

# wait_for TEXT: until the screen has it; a pattern of grep -E
wait_for() {
    local i
    for ((i = 0; i < 400; i++)); do
        screen | grep -qE -- "$1" && return 0
        sleep 0.1
    done
    fail "waited for \"$1\" in vain (${FUNCNAME[1]}, line ${BASH_LINENO[0]})"
    return 1
}

wait_gone() {
    local i
    for ((i = 0; i < 400; i++)); do
        screen | grep -qE -- "$1" || return 0
        sleep 0.1
    done
    fail "\"$1\" stays (${FUNCNAME[1]}, line ${BASH_LINENO[0]})"
    return 1
}

# The screen once it is the same twice in a row.
settled() {
    local before now i
    before=$(screen)
    for ((i = 0; i < 50; i++)); do
        sleep 0.2
        now=$(screen)
        [ "$now" = "$before" ] && break
        before=$now
    done
    printf '%s\n' "$now"
}

# becomes NAME SCREEN: until the screen is that one
becomes() {
    local i now
    for ((i = 0; i < 200; i++)); do
        now=$(screen)
        [ "$now" = "$2" ] && return 0
        sleep 0.1
    done
    fail "$1: the screens differ"
    diff <(printf '%s\n' "$2") <(printf '%s\n' "$now")
}

# changes NAME SCREEN: until the screen is another one, and rests
changes() {
    local i
    for ((i = 0; i < 200; i++)); do
        [ "$(screen)" != "$2" ] && {
            settled
            return 0
        }
        sleep 0.1
    done
    fail "$1: the screen stays as it was" >&2
}

# rests WHEN: what was begun comes to its end, and then a second passes without any processor time
rests() {
    local pid before i
    pid=$(explorer_pid)
    for ((i = 0; i < 40; i++)); do
        before=$(cut -d' ' -f14,15 "/proc/$pid/stat")
        sleep 1
        [ "$(cut -d' ' -f14,15 "/proc/$pid/stat")" = "$before" ] && return 0
    done
    fail "$1, it uses processor time"
}

# start SIZE [NAME=VALUE ...]: a shell in a pane of that size
start() {
    local size=$1
    shift
    tm kill-server 2>/dev/null
    servers=$((servers + 1)) # a server that is about to end takes no new session
    socket=geomint-test-$$-$servers
    tm new-session -d -s "$pane" -x "${size%x*}" -y "${size#*x}" -c "$folder" \
        env PS1='ready> ' "$@" bash --norc --noprofile
    tm set-option -g status off
    tm set-option -g remain-on-exit off
    tm resize-window -t "$pane" -x "${size%x*}" -y "${size#*x}"
    wait_for 'ready>'
}

# pause, wait until the screen says so
pause() {
    keys Space
    wait_for 'paused'
}
