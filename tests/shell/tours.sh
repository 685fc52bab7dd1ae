#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Tours are rendered small; broken ones are refused in one sentence. tours.sh GEOMINT TOURS all|third
set -u
which=$3
tours=$2
. "$(dirname "$0")/answers.sh"

# broken PATTERN: the tour on standard input is refused with that
broken() {
    cat >broken.tour
    refused 3 "$1" tour ./broken.tour --list
}

# ---- the list, and every tour without a screen ----

"$geomint" tour >list 2>err || fail "the list: $(cat err)"
[ -s err ] && fail "the list complains: $(cat err)"
"$geomint" list tours >same || fail 'list tours'
cmp -s list same || fail 'list tours and tour differ'
"$geomint" list tours --json >same || fail 'list tours --json'
[ "$(grep -c '^{"tour":".*","title":".*","about":".*","steps":[0-9]*}$' same)" = "$(find "$tours" -name '*.tour' | wc -l)" ] ||
    fail "list tours --json: $(cat same)"
for title in 'Area' 'Energy' 'Chaos or error?' 'Both directions of space-time' 'Let the mesh run' \
    'Moving with the flow' 'A room with no leaks' 'What is it worth?' \
    'Chaos that the scheme made'; do
    grep -qF "$title" list || fail "no tour is called $title"
done
number=0
for file in "$tours"/*.tour; do
    number=$((number + 1))
    name=$(basename "$file" .tour)
    steps=$(grep -c '^step:' "$file")
    questions=$(grep -c '^ask:' "$file")
    if [ "$steps" -lt 4 ] || [ "$steps" -gt 10 ]; then
        fail "$name has $steps steps"
    fi
    "$geomint" tour "$name" --list >text || fail "$name: --list"
    [ "$(grep -cE '^[0-9]+\. ' text)" = "$steps" ] || fail "$name: --list has other steps"
    [ "$(grep -cE '^   at ' text)" = "$(grep -c '^at:' "$file")" ] || fail "$name: --list has other changes"
    turn $number "$which" || continue
    timeout 600 "$geomint" tour "$name" --out pages --size 480x300 2>err || fail "$name: $(cat err)"
    [ "$(find pages -name "$name-??.png" | wc -l)" = "$steps" ] || fail "$name: not a picture a step"
    [ "$(find pages -name "$name-??-question.png" | wc -l)" = "$questions" ] || fail "$name: not one a question"
done

# what a text names is there in a small terminal too, which has one graph
grep -nE '(second|third|first) graph' "$tours"/*.tour && fail "a tour counts graphs"

# ---- a tour of one's own, found by its path, its name and its title ----

mkdir own
cat >own/mine.tour <<'END'
# mine
title: My own tour
about: A line.

step: One
say: A planet,
 and a text that goes on.
show: kepler scheme=rk4,verlet
until: 4*pi
at: 2*pi lane=1 scheme=gauss4
at: pi dt=pi/100
step: Two
say: It goes on.
until: 6*pi
seconds: 1
ask: What next?
answer: The same.
END
"$geomint" tour own/mine.tour --list | grep -q 'A planet, and a text that goes on.' || fail "a text over two lines"
GEOMINT_TOURS=own "$geomint" tour 'My own tour' --list >text || fail "a tour is not found by its title"
GEOMINT_TOURS=own "$geomint" tour mine --list | cmp -s - text || fail "a tour is not found by its name"
"$geomint" tour own/mine.tour --out own --size 320x200 || fail "a tour of one's own"

# a system that lies beside it
printf 'coordinates: q\nmomenta: p\nH: p^2/2 + q^4/4\nstart: q = 1, p = 0\n' >own/spring.system
printf 'title: Beside\nabout: a\nstep: one\nsay: b\nshow: ./spring.system scheme=verlet\nuntil: 1\nseconds: 1\n' >own/beside.tour
"$geomint" tour own/beside.tour --out own --size 320x200 || fail "a system beside a tour"

# what a step's picture tells of itself makes the same scene again, changes in flight included
"$geomint" again own/mine-02.png --out pages || fail "again"
strings -n 3 own/mine-02.png | grep -q 'scheme=gauss4' || fail "the change in flight is not in the picture"

# a movie, whose length follows from the texts
if command -v ffmpeg >/dev/null; then
    "$geomint" tour own/mine.tour --movie new/mine.mp4 --fps 2 --size 320x200 2>err || fail "a movie: $(cat err)"
    grep -q '^geomint: wrote new/mine.mp4$' err || fail "a movie is not told: $(cat err)"
    ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 new/mine.mp4 >frames
    [ "$(tr -dc 0-9 <frames)" -gt 20 ] || fail "the movie has $(cat frames) frames"
fi

# ---- what is refused ----

refused 1 'did you mean area' tour aera
refused 1 'which tour' tour --movie x.mp4
refused 1 'takes one name' tour a b
refused 3 'could not be read' tour ./nowhere.tour
GEOMINT_TOURS=$folder/nowhere refused 3 'could not be opened' tour
refused 1 'needs a terminal' tour area

broken 'broken.tour, line 1: a tour begins with title:' </dev/null
broken 'line 1: there is no step: after this' <<'END'
title: x
END
broken 'line 2: a line needs a word and a colon' <<'END'
title: x
hello
END
broken 'line 2: a tour has no line "stp"; did you mean step' <<'END'
title: x
stp: y
END
broken 'line 1: this line continues another, but it is the first' <<'END'
 and more
END
broken 'line 2: say: belongs after the first step:' <<'END'
title: x
say: y
END
broken 'line 4: there is no scene "dics"; did you mean disc' <<'END'
title: x
step: one
say: y
show: dics
END
broken 'line 4: scene disc has no parameter "raduis"; did you mean radius' <<'END'
title: x
step: one
say: y
show: disc
 raduis=3
END
broken 'line 2: the step "one" has no say:' <<'END'
title: x
step: one
show: disc
END
broken 'line 2: the first step has no show:' <<'END'
title: x
step: one
say: y
END
broken 'line 2: the step "one" has ask: but no answer:' <<'END'
title: x
step: one
say: y
show: disc
ask: z
END
broken 'line 5: until=-1 is out of range' <<'END'
title: x
step: one
say: y
show: disc
until: -1
END
broken 'line 5: until=0.5 lies before the start' <<'END'
title: x
step: one
say: y
show: burgers test=shock
until: 0.5
END
broken 'line 7: until: 0.5 lies before' <<'END'
title: x
step: one
say: y
show: disc
step: two
say: y
until: 0.5
END
broken 'line 5: "soon" is not a number' <<'END'
title: x
step: one
say: y
show: disc
until: soon
END
broken 'line 5: seconds: 1000 does not lie between' <<'END'
title: x
step: one
say: y
show: disc
seconds: 1000
END
broken 'line 5: a change is' <<'END'
title: x
step: one
say: y
show: disc
at: 1
END
broken 'line 5: lane=9: there are lanes 1 to 3' <<'END'
title: x
step: one
say: y
show: disc
at: 1 lane=9 scheme=rk4
END
broken 'line 5: there is no scheme "rk44"' <<'END'
title: x
step: one
say: y
show: disc
at: 1 scheme=rk44
END
broken 'line 5: radius=1 cannot be changed during the run' <<'END'
title: x
step: one
say: y
show: disc
at: 1 radius=1
END
broken 'line 5: at: 9 lies outside' <<'END'
title: x
step: one
say: y
show: disc until=5
at: 9 scheme=rk4
END
broken 'line 5: a study is work-precision, stability, backward or sweep' <<'END'
title: x
step: one
say: y
show: disc
study: astrology disc
END
broken 'line 5: scene disc has no stability map' <<'END'
title: x
step: one
say: y
show: disc
study: stability disc
END
broken 'line 5: say: is given twice' <<'END'
title: x
step: one
say: y
show: disc
say: z
END
printf 'title: a\033[2Jb\n' | broken 'line 1: it holds a character that cannot be shown'
printf 'title: \377\n' | broken 'line 1: the byte 0xff is not UTF-8'
printf 'title: x\nstep: \000\n' | broken 'line 2: a byte is 0: this is not text'

[ "$failures" = 0 ] && echo "tours: all passed"
exit $((failures > 0))
