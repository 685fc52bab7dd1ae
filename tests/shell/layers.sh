#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The layers by what files include: core sees only core, render only render, scenes everything but app and
# the painters. Linking alone would not notice a type or a macro. Usage: layers.sh SOURCE_FOLDER
cd "$1" || exit 1
status=0
include='^[[:space:]]*#[[:space:]]*include[[:space:]]*'

# forbid FOLDER PATTERN: no file below FOLDER includes what matches
forbid() {
    [ -d "$1" ] || { echo "there is no room $1"; status=1; return; }
    found=$(grep -rnE --include='*.[ch]' --include='*.def' "${include}[<\"]$2" "$1")
    if [ -n "$found" ]; then
        printf '%s must not include %s:\n%s\n' "$1" "$2" "$found"
        status=1
    fi
}

forbid loader '(core|render|scenes|app|library|tests)/'
forbid core '(render|scenes|app|library|tests)/'
forbid core '(curses|ncurses|png|GL|EGL)'
forbid render '(core|scenes|app|library|tests)/'
forbid render '(curses|ncurses)'
forbid scenes '(app|library|tests)/'
forbid scenes 'render/(gl|pixels|triangles|drawing|vector|cells|layout|clock|files/[^r])'
forbid app '(library|tests)/'
forbid library '(app/(commands|explorer)|tests)/'

# the floors of app: a room sees none above it, and the words of a command line stay with the commands
floors="tours
runs grid figures data
output
words
native
base"
known=" commands explorer completion $(echo $floors) "
for room in app/*/; do
    room=$(basename "$room")
    case $known in
    *" $room "*) ;;
    *) echo "app/$room stands on no floor"; status=1 ;;
    esac
done
above='commands|explorer'
saved_ifs=$IFS
IFS='
'
for floor in $floors; do
    IFS=$saved_ifs
    for room in $floor; do
        forbid "app/$room" "app/($above)/"
    done
    above="$above|$(echo "$floor" | tr ' ' '|')"
done
forbid app/explorer 'app/commands/'

# the hall of core includes no wing, and no wing another one
wings=$(sed -n 's/^GM_KIND(\(.*\))$/\1/p' core/kinds.def)
[ -n "$wings" ] || { echo "core/kinds.def names no kind"; exit 1; }
of_a_wing="${include}\"core/($(echo $wings | tr ' ' '|'))/"
found=$(grep -nE "$of_a_wing" core/*.[ch] core/functions/*.[ch] core/linear/*.[ch] core/linear/*/*.[ch] core/theory/*.[ch] core/expression/*.[ch] core/model/*.[ch])
# functions and expression serve all of core, and know nothing of it; model stands on these, linear, theory and what
# has no problem: arenas, tapes
found="$found$(grep -nE "${include}\"core/" core/expression/*.[ch] | grep -vE '"core/(expression|functions)/')"
found="$found$(grep -nE "${include}\"core/" core/functions/*.[ch] | grep -v '"core/functions/')"
found="$found$(grep -nE "${include}\"core/" core/model/*.[ch] | grep -vE '"core/((expression|functions|model|linear|theory)/|(arena|basics|tape)\.h)')"
for wing in $wings; do
    found="$found$(grep -rnE --include='*.[ch]' --include='*.def' "$of_a_wing" core/$wing |
        grep -vE "\"core/$wing/")"
done
if [ -n "$found" ]; then
    printf 'a wing of core is seen from outside of it:\n%s\n' "$found"
    status=1
fi

# what a scene asks of a scheme is told by its row or its family
found=$(grep -rnE 'str(n?cmp|str)\([^,]*scheme->name, *"' scenes)
if [ -n "$found" ]; then
    printf 'a scene goes by the name of a scheme:\n%s\n' "$found"
    status=1
fi

# a count of steps has 64 bits wherever it is compiled, and a long has not
found=$(grep -rnE --include='*.[ch]' '\blong \*?steps?( =|;|,|\)| <)|task->steps.*\blong\b' core render scenes app library)
if [ -n "$found" ]; then
    printf 'a count of steps is an int64_t:\n%s\n' "$found"
    status=1
fi

# every include of the project's own names its folder
found=$(grep -rnE --include='*.[ch]' "${include}\"" core loader render scenes app library tests |
    grep -vE '"(core|loader|render|scenes|app|library|tests)/')
if [ -n "$found" ]; then
    printf 'includes are rooted at the top folder:\n%s\n' "$found"
    status=1
fi
exit $status
