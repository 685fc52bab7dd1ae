#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Movies whatever ffmpeg does: it ends early, says why or not, never reads, never ends, is not there, leaves what is
# no movie. Every time there is a sentence and an exit status, and nothing of it outlives geomint; any file name will
# do. movies.sh GEOMINT TOURS
set -u
tours=$2
. "$(dirname "$0")/answers.sh"
nap=$((1000000 + $$)) # seconds, a number that only our sleepers have

# fake NAME, its script on standard input: what stands in ffmpeg's place
fake() {
    name=$1
    rm -f ready
    mkdir -p bin
    { echo '#!/bin/sh'; cat; } >bin/ffmpeg
    chmod +x bin/ffmpeg
}

# so many frames that neither the pipe nor the queue holds them
waves="disc --frames 20 --size 640x400"

limited() { PATH=$folder/bin:$PATH timeout -k 5 240 "$@" 2>err </dev/null; }

alone() {
    pgrep -f "sleep $nap" >/dev/null && {
        fail "$name: it outlives geomint"
        pkill -f "sleep $nap"
    }
}

# told STATUS WORDS: what came of it, in one sentence that has the words
told() {
    [ "$status" = "$1" ] || fail "$name: exit status $status: $(cat err)"
    grep -q -- "$2" err || fail "$name says: $(cat err)"
    alone
}

gone() {
    [ -e x.mp4 ] && fail "$name: there is a movie"
    [ "$(grep -vc 'there already$' err)" = 1 ] || fail "$name says too much: $(cat err)"
}

# ---- it ends by itself ----

fake 'a dead ffmpeg' <<'END'
exit 1
END
for ending in mp4 webm gif; do
    limited "$geomint" render $waves --movie x.$ending
    status=$?
    told 3 "^geomint: ffmpeg gave up (exit status 1) and x.$ending was not made"
    gone
done
[ "$(ls x.mp4.frames | grep -c 'png$')" -gt 0 ] || fail 'a dead ffmpeg: the frames that were made are lost'

fake 'an ffmpeg that says why' <<'END'
head -c 10 >/dev/null
echo 'the encoder broke' >&2
exit 7
END
limited "$geomint" render $waves --movie x.mp4
status=$?
told 3 '(exit status 7) and x.mp4 was not made; its last message: the encoder broke$'
gone
limited "$geomint" render $waves --movie x.mp4 # its frames are there in part
status=$?
told 3 'the encoder broke$'
limited "$geomint" tour "$tours/area.tour" --movie x.mp4 --size 640x400
status=$?
told 3 '(exit status 7) and x.mp4 was not made; its last message: the encoder broke$'

fake 'an ffmpeg that has enough' <<'END'
head -c 2304000 >/dev/null
END
limited "$geomint" render $waves --movie x.mp4
status=$?
told 3 '^geomint: ffmpeg gave up (exit status 0) and x.mp4 was not made'
gone

fake 'an ffmpeg that leaves a child with its input' <<END
sleep $nap &
exit 2
END
limited "$geomint" render $waves --movie x.mp4
status=$?
told 3 'gave up (exit status 2)'
gone

fake 'an ffmpeg that leaves nothing' <<'END'
cat >/dev/null
END
limited "$geomint" render $waves --movie x.mp4
status=$?
told 3 '^geomint: ffmpeg says that it is done, but what it left is not x.mp4$'
gone

fake 'an ffmpeg that leaves rubbish' <<'END'
for last; do :; done
cat >/dev/null
echo 'some rubbish' >"$last"
END
for ending in mp4 webm gif; do
    limited "$geomint" render $waves --movie x.$ending
    status=$?
    told 3 "but what it left is not x.$ending$"
done
gone

name='no ffmpeg'
rm bin/ffmpeg
PATH=$folder/bin "$geomint" render $waves --movie x.mp4 2>err
status=$?
told 3 '^geomint: ffmpeg was not found'
gone

# ---- it does not end ----

# leaves SIGNAL ...: a render is sent the signals, each when there is a file "ready"
leaves() {
    PATH=$folder/bin:$PATH "$geomint" render $waves --movie x.mp4 2>err </dev/null &
    pid=$!
    for signal; do
        tries=0
        while [ ! -e ready ] && [ $tries -lt 2000 ]; do
            sleep 0.02
            tries=$((tries + 1))
        done
        rm -f ready
        kill -"$signal" $pid || fail "$name: it was over before it was sent $signal"
    done
    tries=0
    while kill -0 $pid 2>/dev/null && [ $tries -lt 1500 ]; do # a fifth of what is waited for where nobody asks
        sleep 0.04
        tries=$((tries + 1))
    done
    kill -KILL $pid 2>/dev/null && fail "$name: $* do not end geomint"
    wait $pid
    status=$?
    told 130 'ffmpeg was interrupted and x.mp4 was not made'
    [ -e x.mp4 ] && fail "$name: there is a movie"
    ls -A | grep '^\.x' && fail "$name: a file is left"
}

fake 'a deaf ffmpeg' <<END
touch ready
sleep $nap
END
leaves INT
leaves TERM
grep -q 'the same command resumes' err || fail "$name: $(cat err)"

fake 'a stubborn ffmpeg' <<END
trap '' HUP INT QUIT TERM
head -c 1000000 >/dev/null
touch ready
sleep $nap
sleep $nap
END
leaves TERM

fake 'an ffmpeg that does not end' <<END
cat >/dev/null
touch ready
sleep $nap
END
leaves INT

# one that works is left only if the user insists
fake 'a busy ffmpeg' <<'END'
touch ready
cat >/dev/null
touch ready
while :; do :; done
END
leaves INT INT

# ---- with ffmpeg itself: the frames of the failed renders are gone on with ----

rm -rf bin
"$geomint" render $waves --movie whole.mp4 2>err || fail "a movie: $(cat err)"
"$geomint" render $waves --movie x.mp4 2>err || fail "a movie that goes on: $(cat err)"
cmp whole.mp4 x.mp4 || fail 'a movie that goes on differs'
rm -rf x.*.frames x.*.log x.mp4
ls -A | grep '^\.\?x' && fail 'files are left'

# names that mean something to printf or to ffmpeg
mkdir '50%' '%d%s%n'
for movie in 'a%d.mp4' 'a%03d.gif' '50%/a.mp4' '50%/a.gif' '%d%s%n/%%d.webm' '%d%s%n/a.gif'; do
    "$geomint" render disc --frames 3 --size 160x100 --movie "$movie" 2>err || fail "$movie: $(cat err)"
    frames=$(ffprobe -v error -count_frames -show_entries stream=nb_read_frames -of csv=p=0 "file:$movie")
    [ "${frames%%[!0-9]*}" -ge 3 ] || fail "$movie has $frames frames"
    [ -e "$movie.frames" ] && fail "$movie: its frames are left"
done
for out in 'x%03d' '50%/y' '%d%s%n/%%'; do
    "$geomint" render disc --frames 2 --size 160x100 --out "$out" 2>err || fail "$out: $(cat err)"
    "$geomint" render disc --size 160x100 --out "$out" 2>err || fail "$out: $(cat err)"
    [ "$(ls "$out" | tr '\n' ' ')" = 'disc-render-000000.png disc-render-000001.png disc-render.png ' ] ||
        fail "$out holds $(ls "$out")"
done

[ $failures = 0 ]
