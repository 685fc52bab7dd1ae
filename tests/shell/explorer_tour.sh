#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Drives tours and background studies in tmux. Usage: explorer_tour.sh GEOMINT
set -u

. "$(dirname "$0")/tmux.sh"

open_tour() { # SIZE TOUR
    start "$1" COLORTERM=truecolor TERM=tmux-256color
    keys "\"$geomint\" tour $2; echo \"left \$?\"" Enter
    wait_for '1/[0-9]+: '
}

# ---- a tour in the smallest usual terminal ----

open_tour 80x24 area
wait_for 'Area 1/7: A disc of starting points'
wait_for 'Watch: the red disc'
wait_for 't = 2π.*geomint|2π +geomint.*paused|paused' # it runs to its end and stops there
keys n
wait_for '2/7: The simplest scheme'
wait_for 'Predict: One period later'
wait_for '0 +geomint.*paused'
screen | grep -q 'Larger: each step' && fail "the answer is there before the question is answered"
keys n
wait_for 'Larger: each step'
wait_for 'area × 4.909'
wait_for 'paused'

# the user changes what there is, and comes back
keys c
wait_for 'implicit E'
keys Right
wait_for '▸ dt +0\.3'
keys a
wait_for 'Predict: One period later'
wait_for 'explicit E'
wait_gone 'implicit E'
wait_for '▸ dt +pi/12'
keys N
wait_for '1/7: A disc'
keys N
wait_for '1/7: A disc'

# a change in flight, and back over it
keys n n n n n n n n n
wait_for '6/7: Mend it in flight'
wait_for 'midpoint, after RK4' # its name in the picture
wait_for '▸━+ midpoint|▸ ━+ midpoint'
wait_for 'paused'
keys r
wait_for 'RK4'
wait_for '▸━+ midpoint|▸ ━+ midpoint'
wait_for 'paused'
keys n n n
wait_for '7/7: What area cannot tell'
keys q
wait_for 'left 0'

# a step that goes on from the one before, entered from behind: the scene hurries to its begin
open_tour 120x40 chaos
keys n n n n
wait_for '4/6: Ask an invariant'
keys N
wait_for '3/6: The symmetry breaks'
wait_for 't = 90\.000'
wait_for 'paused'

# every size, down to nothing and back
full=$(settled)
for size in 80x24 20x5 1x1 3x2 160x45 120x40; do
    tm resize-window -t "$pane" -x "${size%x*}" -y "${size#*x}"
    settled >/dev/null
done
becomes "after all sizes" "$full"
keys q
wait_for 'left 0'

# in the smallest usual terminal the graph has its ticks
open_tour 80x24 chaos
wait_for '^ +10⁻¹[⁰¹²³⁴⁵⁶⁷⁸⁹]+[^ ⁰¹²³⁴⁵⁶⁷⁸⁹]' # the axis stands behind its number
wait_for '^ +0 +2 +4 +6 +8 +10 '
keys n n n n
wait_for '4/6: Ask an invariant'
keys n
wait_for 'Watch: the angular impulse error'
wait_for 'angular impulse err… +[0-9]'
keys q
wait_for 'left 0'

# ---- in the list of scenes ----

start 80x24 COLORTERM=truecolor TERM=tmux-256color
keys "\"$geomint\"; echo \"left \$?\"" Enter
wait_for '▸ disc'
keys Tab
wait_for '▸ area'
wait_for '7\. +What area cannot tell'
keys Tab
wait_for '▸ argon'
keys Tab
wait_for '▸ age'
keys Tab
wait_for '▸ disc'
keys train # a word of what a tour is about
wait_for 'search: train_'
wait_for '▸ galilei'
wait_gone 'kepler'
keys Enter
wait_for 'Moving with the flow 1/7'
keys n
wait_for 'Moving with the flow 2/7'
keys l
wait_for '▸ galilei'
keys Enter # as it was left
wait_for 'Moving with the flow 2/7'
keys l
wait_for '▸ galilei'
keys Home
wait_for '▸ disc'
keys Enter # a scene ends the tour
wait_for '▸━+ explicit Euler|▸ ━+ explicit Euler'
wait_gone 'Moving with the flow'
keys n # means nothing now
settled | grep -q 'Moving with the flow' && fail "the tour is not over"
keys l
wait_for '▸ disc'
keys End
wait_for '▸ shedding'
keys Home Tab
wait_for '▸ area'
for tour in energy chaos space-time mesh galilei room worth; do
    keys Down
    wait_for "▸ $tour"
done
keys Enter
wait_for 'What is it worth\? 1/6'
keys q
wait_for 'left 0'

# the terminal's options
start 80x24 TERM=xterm
keys "\"$geomint\" tour area --colours truecolor --theme light --graphics ascii; echo \"left \$?\"" Enter
wait_for '1/7: '
wait_for 'paused'
[[ $(in_colour) == *'38;2;29;31;36'* ]] || fail "a tour in the light theme has no dark ink"
settled | LC_ALL=C grep -q '[^ -~]' && fail "a tour in ASCII has other letters"
keys q
wait_for 'left 0'
[ "$("$geomint" tour area --theme mono --movie "$folder/x.mp4" 2>&1)" = \
    'geomint: --theme mono is none of: light, dark' ] || fail "a movie in no colours"

# ---- studies ----

start 100x30 COLORTERM=truecolor TERM=tmux-256color
keys "\"$geomint\" disc; echo \"left \$?\"" Enter
wait_for 'SCHEMES'
pause
keys w
wait_for 'what an accuracy costs'
wait_for 'work-precision [0-9]+ %'
wait_for 'error against run time'
keys Escape # it goes on behind the scene
wait_for 'SCHEMES'
wait_for 'work-precision of disc ([0-9]+ %|is ready)'
keys w
wait_for 'what an accuracy costs'
wait_for 'work-precision [1-9][0-9]* %'
keys x
wait_for 'Stopped|Done'
keys p
wait_for 'Saved disc-work-precision-0001.png and disc-work-precision-0001.csv'
[ "$(head -c 4 "$folder/disc-work-precision-0001.png" | tail -c 3)" = PNG ] || fail "the diagram is no PNG"
head -1 "$folder/disc-work-precision-0001.csv" | grep -q '^scene,scheme,order,dt' || fail "the diagram's CSV"
[ "$(wc -l <"$folder/disc-work-precision-0001.csv")" -gt 1 ] || fail "nothing was measured"
keys w
wait_for 'SCHEMES'
keys m
wait_for 'scene disc has no stability map'
keys z
wait_gone 'no stability map'
keys q # with a study in the background
wait_for 'left 0'

start 100x30 COLORTERM=truecolor TERM=tmux-256color
keys "\"$geomint\" kepler; echo \"left \$?\"" Enter
wait_for 'SCHEMES'
pause
keys m
wait_for 'which step is bounded'
wait_for 'stability 100 %: Done'
keys p
wait_for 'Saved kepler-stability-0001.png'
keys w # both at the same time
wait_for 'what an accuracy costs'
keys m
wait_for 'which step is bounded'
keys Escape
wait_for 'work-precision of kepler ([0-9]+ %|is ready)'
keys w x
wait_for 'Stopped|Done'
keys Escape
wait_for 'SCHEMES'
wait_for 'work-precision of kepler is ready: w shows it'
rests 'paused, with studies finished'
keys l # a notice leaves with its scene
wait_for 'Type to search'
keys vortices
wait_for '▸ vortices'
keys Enter
wait_for 'SCHEMES'
wait_gone 'is ready'
keys Escape
wait_for 'Type to search'
keys kepler
wait_for '▸ kepler'
keys Enter
wait_for 'SCHEMES'
keys w
wait_for 'work-precision [0-9]+ %: (Stopped|Done)'
keys q
wait_for 'left 0'

# where there is nothing to compare with, a sentence says so
start 80x24 COLORTERM=truecolor TERM=tmux-256color
keys "\"$geomint\" room rows=10 columns=0; echo \"left \$?\"" Enter
wait_for 'SCHEMES'
keys w
wait_for 'There is nothing to compare with: neither an exact solution nor a scheme of$'
wait_for 'order 4 or more to make a reference with'
wait_for 'not possible here'
keys Escape
wait_for 'SCHEMES'
# left and right walk through words
keys Space
for ((i = 0; i < 12; i++)); do
    screen | grep -q '▸ outlet' && break
    keys Down
    settled >/dev/null
done
wait_for '‹ soft ›'
keys Right
wait_for '‹ dirichlet ›'
keys Left Left
wait_for '‹ free ›'
keys Down
wait_for '▸ mesh' # without a mesh file there is no boundary to name as the inlet
keys Right
wait_for 'mesh is a word of your own'
keys q
wait_for 'left 0'

# a tour's study
open_tour 100x30 worth
keys n
wait_for 'Predict: Which line'
keys n
wait_for 'what an accuracy costs'
keys n
wait_for '3/6: Many schemes'
keys q q # its study may not be finished
wait_for 'left 0'

[ "$failures" = 0 ] && echo "tours in the explorer: all passed"
exit $((failures > 0))
