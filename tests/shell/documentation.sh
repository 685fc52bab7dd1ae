#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The documentation's commands, executed. documentation.sh GEOMINT SOURCE quick|slow
# Blocks that begin with ```sh are run, line by line of one shell for a document, in an empty folder; pictures are made
# small. Those of ```sh slow are run by the second form only, those of ```sh wrapper (they install) and of adding.md
# (it has a test of its own) never; the generated pages have to be what the program prints.
set -u
geomint=$1
source=$2
what=$3
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
failures=0

fail() {
    printf 'FAILED: %s\n' "$1"
    failures=$((failures + 1))
}

# geomint as the documents call it
mkdir "$folder/bin"
cat >"$folder/bin/geomint" <<'SCRIPT'
#!/bin/sh
case " $* " in
*' --size '*) ;;
' render '* | ' figures '* | ' work-precision '* | ' stability '* | ' backward '* | ' sweep '*' --out '*) set -- "$@" --size 160x90 ;;
esac
exec "$GEOMINT_TESTED" "$@"
SCRIPT
chmod +x "$folder/bin/geomint"
GEOMINT_TESTED=$geomint GEOMINT_KERNEL=$source XDG_CACHE_HOME=$folder/caches
PATH=$folder/bin:$PATH
export GEOMINT_TESTED GEOMINT_KERNEL XDG_CACHE_HOME PATH

# blocks FILE KIND: the text of the blocks with that first line
blocks() {
    awk -v first="\`\`\`$2" '
        inside && /^```/ { inside = 0; next }
        inside { print; next }
        # a block of another kind is passed over whole
        other && /^```/ { other = 0; next }
        /^```/ && !other { if ($0 == first) inside = 1; else other = 1 }
    ' "$1"
}

for document in "$source/README.md" "$source"/docs/*.md; do
    name=$(basename "$document" .md)
    [ "$name" = adding ] && continue
    kinds=sh
    [ "$what" = slow ] && kinds='sh slow'
    blocks "$document" "$kinds" >"$folder/commands"
    [ -s "$folder/commands" ] || continue
    mkdir "$folder/$name"
    ln -s ../bin/geomint "$folder/$name/geomint" # as it is called in the source tree
    (cd "$folder/$name" && timeout 280 sh -eux "$folder/commands" >"$folder/out" 2>&1 </dev/null) ||
        fail "$name: $(tail -n 4 "$folder/out")"
    echo "$name: $(grep -c . "$folder/commands") lines"
done

if [ "$what" = quick ]; then
    for page in schemes scenes; do
        "$geomint" list $page --markdown | cmp -s - "$source/docs/$page.md" ||
            fail "docs/$page.md is not what the program prints: geomint list $page --markdown >docs/$page.md"
    done
    "$geomint" manual >"$folder/geomint.1" || fail 'manual'
    if command -v man >/dev/null; then
        said=$(MANWIDTH=100 man -l --warnings=w "$folder/geomint.1" 2>&1 >"$folder/page")
        [ -z "$said" ] || fail "the manual: $said"
        grep -q 'GEOMINT(1)' "$folder/page" || fail 'the manual has no head'
    fi
    # every command, option, scene and scheme is in the manual
    for word in work-precision --movie taylor-green midpoint-suzuki4 eccentricity; do
        sed 's/\\-/-/g' "$folder/geomint.1" | grep -q -- "$word" || fail "the manual lacks $word"
    done
    # links and pictures exist
    for document in "$source/README.md" "$source"/docs/*.md; do
        grep -o '](\([^)#:]*\))' "$document" | sed 's/](\(.*\))/\1/' | while read -r link; do
            [ -e "$(dirname "$document")/$link" ] || echo "$document: $link"
        done
    done >"$folder/dead"
    [ -s "$folder/dead" ] && fail "dead links: $(cat "$folder/dead")"
fi
[ $failures = 0 ] && echo 'all as it should be'
exit $failures
