# SPDX-License-Identifier: GPL-3.0-or-later
# shellcheck shell=sh
# For tests of what the program answers: sourced with the program as $1. The test is then in an empty folder of
# its own; `fail` counts in `failures`, with which it ends.

geomint=$(realpath "$1")
folder=$(mktemp -d) || exit 1
trap 'chmod -R u+w "$folder"; rm -rf "$folder"' EXIT
cd "$folder" || exit 1
unset DISPLAY
failures=0

# The system's own Python starts ten times as fast as one behind a version manager.
[ -x /usr/bin/python3 ] && python3() { /usr/bin/python3 "$@"; }

fail() {
    printf 'FAILED: %s\n' "$*"
    failures=$((failures + 1))
}

# turn N WHAT: whether item N of a list belongs to this run: with WHAT "all" each does, with "third" every third, another
# one each day, so that a quick run is short and no item goes long unseen
day=$(($(date +%s) / 86400))
turn() {
    [ "$2" = all ] || [ $((($1 + day) % 3)) = 0 ]
}

# What else every answer is looked at for, with the command as its words; a test may bring its own.
inspect() { :; }

# Reads err into `said`, its lines that are not indented counted in `sentences`, its first line in `sentence`: by the
# shell itself, since thousands of answers are looked at.
read_answer() {
    said=
    sentence=
    sentences=0
    while IFS= read -r line || [ -n "$line" ]; do
        sentence=${sentence:-$line}
        said="$said$line
"
        case $line in
        '  '*) ;;
        *) sentences=$((sentences + 1)) ;;
        esac
    done <err
}

# Seconds of processor time after which an answer counts as one that never comes; a test of short commands sets fewer.
longest=600

# status STATUS WORDS...: the exit status, without a sign of a crash; what it said is in out and err
status() {
    wanted=$1
    shift
    (ulimit -t "$longest" && exec timeout 600 "$geomint" "$@") >out 2>err </dev/null
    got=$?
    read_answer
    [ "$got" = "$wanted" ] || fail "geomint $*: exit $got, not $wanted: $(head -c 300 err)"
    case $said in
    *[Ss]anitizer* | *[Aa]ssert* | *[Ss]egmentation*) fail "geomint $*: $(head -n 3 err)" ;;
    esac
    inspect "$@"
    return 0
}

# refused STATUS PATTERN WORDS...: one sentence on standard error that holds the pattern; further lines, as that
# of a file with a mark below, are indented
refused() {
    wanted=$1
    pattern=$2
    shift 2
    status "$wanted" "$@"
    [ "$sentences" = 1 ] || fail "geomint $*: not one sentence: $said"
    printf '%s\n' "$sentence" | grep -q -- "$pattern" || fail "geomint $*: says \"$said\", not \"$pattern\""
}

# value FILE KEY: of the first lane
value() {
    python3 -c 'import json, sys; run = json.loads(open(sys.argv[1]).readline())
for key in sys.argv[2].split("."): run = run[int(key) if key.isdigit() else key]
print(run)' "$1" "$2"
}
