#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# A render that was killed goes on by the same command, and shards make the frames of one render; the result is
# that of a render that nobody disturbed, bit for bit. resume.sh GEOMINT
set -u
. "$(dirname "$0")/answers.sh"

# kill_at SIGNAL COUNT FOLDER WORDS...: kills a render when FOLDER holds COUNT frames; it stands still while they are
# counted. On a busy machine it may be over before it is looked at again: then it is made anew.
kill_at() {
    signal=$1
    count=$2
    where=$3
    shift 3
    tries=0
    while [ $tries -lt 50 ]; do
        "$geomint" "$@" 2>err </dev/null &
        pid=$!
        while kill -STOP $pid 2>/dev/null && [ "$(ls "$where" 2>/dev/null | grep -c 'png$')" -lt "$count" ]; do
            kill -CONT $pid
            sleep 0.02
        done
        kill -"$signal" $pid 2>/dev/null
        kill -CONT $pid 2>/dev/null
        wait $pid
        [ $? -le 128 ] || return
        rm -rf "$where" "${where%.frames}"
        tries=$((tries + 1))
    done
    fail "render $* was over before it was killed"
}

same() {
    diff -r "$1" "$2" >difference 2>&1 || fail "$3: $(head -n 3 difference)"
}

# pictures: killed at three moments, the last time in the middle of a checkpointed stop
orbit="kepler scheme=rk4,verlet --frames 90 --size 320x200"
"$geomint" render $orbit --out whole || fail 'an undisturbed render'
for moment in 5 30 60; do
    kill_at KILL $moment killed render $orbit --out killed
done
"$geomint" render $orbit --out killed 2>err || fail "a resumed render: $(cat err)"
grep -q 'of 90 frames .* there already' err || fail "a resumed render does not say so: $(cat err)"
same whole killed 'a killed render'
"$geomint" render $orbit --out killed 2>err || fail 'a render of frames that are all there'
grep -q '90 of 90' err || fail "frames that are all there: $(cat err)"

# a stop by a signal that can be caught leaves the state; it is used, and gone at the end
kill_at TERM 40 stopped render $orbit --out stopped
[ -f stopped/kepler-render.checkpoint ] || fail 'a stopped render leaves no checkpoint'
grep -q 'the same command resumes' err || fail "a stopped render says: $(cat err)"
cp -r stopped damaged
cp -r stopped holed
"$geomint" render $orbit --out stopped 2>err || fail 'a stopped render does not go on'
same whole stopped 'a stopped render'
# a checkpoint that is damaged, a frame that is damaged, one that is gone
printf 'x' | dd of=damaged/kepler-render.checkpoint bs=1 seek=900 conv=notrunc 2>/dev/null
printf 'x' | dd of=damaged/kepler-render-000003.png bs=1 seek=700 conv=notrunc 2>/dev/null
"$geomint" render $orbit --out damaged 2>err || fail 'a damaged checkpoint'
same whole damaged 'a damaged checkpoint'
rm holed/kepler-render-000007.png
"$geomint" render $orbit --out holed 2>err || fail 'a frame that is gone'
same whole holed 'a frame that is gone'
# frames of another command are made anew
"$geomint" render kepler scheme=rk2,verlet --frames 90 --size 320x200 --out killed 2>err || fail 'other frames'
grep -q 'already' err && fail 'frames of another command were taken for ours'

# a movie: its frames are kept beside it until it is complete
waves="disc --frames 90 --size 320x200"
"$geomint" render $waves --movie whole.mp4 || fail 'an undisturbed movie'
kill_at KILL 30 killed.mp4.frames render $waves --movie killed.mp4
[ -f killed.mp4 ] && fail 'a killed render left a movie'
"$geomint" render $waves --movie killed.mp4 2>err || fail "a resumed movie: $(cat err)"
cmp whole.mp4 killed.mp4 || fail 'a resumed movie differs'
ls -A | grep killed.mp4. && fail 'a resumed movie leaves files behind'

# shards
"$geomint" render $waves --out one || fail 'one render'
if command -v parallel >/dev/null; then
    seq 3 | parallel -q -j 2 "$geomint" render $waves --out many --shard '{}/3' 2>err || fail "shards: $(cat err)"
else
    for i in 1 2 3; do
        "$geomint" render $waves --out many --shard $i/3 || fail "shard $i"
    done
fi
same one many 'shards'
"$geomint" render $waves --out many --movie joined.mp4 2>err || fail "shards joined: $(cat err)"
cmp whole.mp4 joined.mp4 || fail 'shards joined differ from the movie'
"$geomint" render $waves --shard 2/3 --movie x.mp4 2>err && fail 'a shard of a movie'
"$geomint" render disc --shard 2/3 2>err && fail 'a shard of one picture'
"$geomint" render $waves --shard 4/3 2>err && fail 'a shard too many'

# a run goes on from a checkpoint with the bits of the run that nobody stopped, also where flows of two steps are one
bits() {
    "$geomint" run outer-planets scheme="$1" dt=100 --json --state $2 2>err | grep -o '"state":.*'
}
for split in 'saba2(kepler, interaction)' wisdom-holman2 'split(kepler, interaction; 1/3, 1/2, 2/3, 1/2)' \
    'projected(saba2(kepler, interaction); H)'; do
    bits "$split" 'steps=137 --checkpoint planets.checkpoint' >part && bits "$split" 'steps=300' >undisturbed &&
        bits "$split" 'steps=300 --continue planets.checkpoint' >resumed || fail "planets by $split"
    cmp -s undisturbed resumed || fail "$split from a checkpoint differs: $(cat undisturbed resumed)"
done

# the failures of lanes are told by frames that are all there, too
limit="disc scheme=explicit-euler dt=2 until=1000 --frames 20 --size 320x200 --strict --out failed"
"$geomint" render $limit 2>first
[ $? = 2 ] || fail "a failed lane is not exit 2: $(cat first)"
"$geomint" render $limit 2>second
[ $? = 2 ] || fail 'a failed lane of frames that are there is not exit 2'
grep -v 'already\|wrote' second >told
grep -v wrote first | cmp -s - told || fail "a failed lane is told differently: $(cat first second)"

[ $failures = 0 ]
