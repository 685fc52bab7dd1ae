#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs every fuzzer, two at once: run.sh FOLDER [MINUTES]. FOLDER is a build by clang with -Dfuzz=true and sanitizers,
# which is made if there is none. Without MINUTES for each, as often as its line below says, from the same seed, as .ci/run does.
export FOLDER=$1 MINUTES=${2-}
sources=$(cd "$(dirname "$0")/../.." && pwd) || exit 1
cd "$sources" || exit 1

# One fuzzer a line: its longest input, its runs and where its first inputs lie.
fuzzers='request 400 40000
tour 4000 10000 share/tours/*.tour
formula 2000 20000 share/systems/*.system share/subjects/*.subject tests/reference/*.system
room 2000 20000 share/rooms/*.room
scheme 600 20000 share/schemes/*.scheme
mesh 12000 50000 tests/reference/meshes/*.msh
png 2000 50000 tests/reference/texts.svg
checkpoint 200 2500
saved 60 5000
number 300 50000'

fuzz_one() {
    local name=$1 length=$2 often=-runs=$3 seed=1 inputs=$FOLDER/inputs/$1 log=$FOLDER/$1.log
    shift 3
    mkdir -p "$inputs"
    [ $# = 0 ] || cp "$@" "$inputs"
    [ -z "$MINUTES" ] || often=-max_total_time=$((MINUTES * 60)) seed=$RANDOM
    echo "$name: seed $seed"
    "$FOLDER/tests/fuzz_$name" "$often" -max_len="$length" -seed="$seed" -timeout=20 -artifact_prefix="$inputs-" \
        "$inputs" >"$log" 2>&1 && echo "$name: $(tail -n 1 "$log")" && return
    cat "$log"
    return 1
}
export -f fuzz_one

[ -f "$FOLDER/build.ninja" ] ||
    CC=clang meson setup "$FOLDER" -Dtests=enabled -Dloops=baseline --werror --buildtype=debugoptimized -Dfuzz=true \
        -Db_sanitize=address,undefined -Db_lundef=false || exit 1
printf '%s\n' "$fuzzers" | sed 's,^\([a-z]*\).*,tests/fuzz_\1,' | xargs ninja -C "$FOLDER" &&
    printf '%s\n' "$fuzzers" | xargs -P 2 -I LINE bash -c 'fuzz_one LINE'
