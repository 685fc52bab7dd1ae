#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# geomint complete, and the completions of those shells that are there. completion.sh GEOMINT SOURCE
set -u
geomint=$1
completion=$2/app/completion
failures=0
files=$(mktemp -d) || exit 1
trap 'rm -rf "$files"' EXIT
PATH=$(dirname "$geomint"):$PATH
export PATH

fail() {
    printf 'FAILED: %s\n' "$1"
    failures=$((failures + 1))
}

# offers WORDS... : CANDIDATES: exactly these, in any order
offers() {
    wanted=$1
    shift
    got=$("$geomint" complete "$@" | cut -f 1 | sort)
    # shellcheck disable=SC2086 # a list of words
    wanted=$(printf '%s\n' $wanted | sort)
    [ "$got" = "$wanted" ] || fail "complete $*: \"$got\", not \"$wanted\""
}

offers 'render' ren
offers 'room' run roo
offers 'scheme=' run disc sch
offers 'coordinates=' run system co
offers 'system=oscillator system=pendulum' run disc system=
offers 'outlet=dirichlet outlet=free outlet=soft' run room outlet=
offers 'scheme=rk4,rk2' run disc scheme=rk4,rk2
offers 'scheme=leapfrog' run sine-gordon scheme=leap
offers 'scheme=leapfrog' run disc scheme=leap
offers 'scheme=rk4,velocity-verlet' run disc scheme=rk4,velo
offers 'dormand-prince' certify dorm
offers 'leapfrog' certify leapf
offers '--theme' render disc --th
offers 'light dark' render disc --theme ''
offers '--theme=dark' render disc --theme=d
offers 'pdf png svg' render disc --format ''
offers '' render disc -o ''
offers 'zip=no zip=yes' run disc zip=
offers '' run disc tau
offers 'binding=' run disc bin
offers '' run channel bin
offers 'dt=pi/12' run disc dt=
offers 'area area_error area_tangent' work-precision disc --measure area
offers 'dt=2*pi/100 dt=1e-7..1000:log11' sweep kepler dt=
offers 'energy_error,position_error' sweep kepler --measure energy_error,pos
offers 'mesh-crossing' sweep kepler --retry mesh
offers 'accurate accurate=1e-2 bounded' stability kepler --judge ''
offers '' again pic
offers '' run room mesh=
offers '' run room mesh=a
offers '' nonsense x
# a typed V on a ring and on a moving mesh, between walls not
printf 'field: u\nV: u^2/2\nstart: u = exp(-x^2), u_t = 0\n' >"$files/bump.system"
bump=$files/bump.system
offers 'scheme=multiplier-lobatto2 scheme=multiplier-lobatto4' run "$bump" scheme=multiplier-l
offers 'alpha=' run "$bump" scheme=multiplier-lobatto4 al
offers 'scheme=leapfrog' run "$bump" scheme=multiplier-lobatto4 scheme=leap
printf 'boundary: walls\n' >>"$bump"
offers '' run "$bump" scheme=multiplier-l
# tours: those of the program, and those of a folder
offers "$(cd "$2/share/tours" && ls | sed 's/\.tour$//')" tour ''
offers 'mesh' tour me
offers '' tour nothing
offers '--theme' tour --th
offers 'dark light mono' tour --theme ''
offers 'kitty' tour --graphics k
offers '16 256 none truecolor' terminal --colours ''
offers 'dark light' render disc --theme ''
touch "$files/mine.tour"
GEOMINT_TOURS=$files offers 'made mesh mine' tour m
GEOMINT_TOURS=/nowhere offers 'mesh' tour me
[ "$("$geomint" complete | wc -l)" -gt 15 ] || fail 'without a word, commands and scenes'

# bash asks a function; only what stands behind = is replaced
bash -c '
. "$1/geomint.bash"
try() {
    COMP_LINE=$1 COMP_POINT=${#1} COMPREPLY=()
    _geomint geomint
    [ "${COMPREPLY[*]}" = "$2" ] || { echo "bash: $1: ${COMPREPLY[*]}, not $2"; exit 1; }
}
try "geomint ren" render
try "geomint run disc sys" system=
try "geomint run disc system=pen" pendulum
try "geomint run disc scheme=rk4,midpoint-su" rk4,midpoint-suzuki4
try "geomint render disc --theme d" dark
try "geomint tour gal" galilei
# files are left to readline, also where the path has a blank
try "geomint run room mesh=" ""
try "geomint run room mesh=a" ""
try "geomint run room mesh=a\\ st" ""
' bash "$completion" || fail 'bash'

if command -v fish >/dev/null; then
    got=$(fish --no-config -c "source '$completion/geomint.fish'; complete -C 'geomint run disc system=pen'" | cut -f 1)
    [ "$got" = 'system=pendulum' ] || fail "fish: $got"
    got=$(fish --no-config -c "source '$completion/geomint.fish'; complete -C 'geomint tour gal'" | cut -f 1)
    [ "$got" = galilei ] || fail "fish: $got"
    mkdir -p "$files/a folder"
    : >"$files/a folder/one.msh"
    got=$(cd "$files" && fish --no-config -c "source '$completion/geomint.fish'; complete -C 'geomint run room mesh=a\ folder/o'" | cut -f 1)
    [ "$got" = 'mesh=a folder/one.msh' ] || fail "fish: $got"
fi
if command -v zsh >/dev/null; then
    zsh -n "$completion/_geomint" || fail 'zsh does not read it'
    # the file as the shell would call it, with what it hands to the shell printed
    got=$(zsh -f -c '
        compadd() { print -r -- "${(P)${@[-1]}}" }
        compset() { PREFIX=${PREFIX#*=} }
        _files() { print files $PREFIX }
        try() { words=("$@"); CURRENT=$#; PREFIX=${words[-1]}; source "$completion/_geomint" }
        completion=$1
        try geomint run disc system=pen
        try geomint ren
        try geomint tour gal
        try geomint again pic
        try geomint run room mesh=my
    ' zsh "$completion")
    [ "$got" = "system=pendulum
render
galilei
files pic
files my" ] || fail "zsh: $got"
fi

[ $failures = 0 ] && echo 'all as it should be'
exit $failures
