#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# libgeomint as it is installed: what it shows, and that its example is compiled and runs against a prefix that was
# moved. Usage: library.sh BUILD SOURCE LIBRARY
build=$1
source=$2
library=$3
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
status=0

fail() {
    printf 'FAILED: %s\n' "$1"
    status=1
}

# a name that goes, or that is there by accident
nm -D --defined-only --with-symbol-versions "$library" | awk '$2 == "T" { print $3 }' | LC_ALL=C sort >"$folder/symbols"
diff "$source/tests/reference/symbols.txt" "$folder/symbols" ||
    fail 'the symbols of the library are not those of tests/reference/symbols.txt'
awk '/^GEOMINT_/ { version = $1 } /^    geomint_/ { print substr($1, 1, length($1) - 1) "@@" version }' \
    "$source/library/geomint.map" | LC_ALL=C sort >"$folder/mapped"
cmp "$folder/symbols" "$folder/mapped" || fail 'the map names a function that is not there'
for name in $(sed 's/@.*//' "$folder/symbols"); do
    grep -q "[ *]$name(" "$source/library/geomint.h" || fail "geomint.h does not have $name"
done
needed=$(readelf -d "$library" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | grep -E 'ncurses|tinfo')
[ -z "$needed" ] || fail "the library needs $needed"

DESTDIR=$folder/root meson install -C "$build" --no-rebuild --quiet >"$folder/log" 2>&1 || fail "install: $(tail -n 3 "$folder/log")"
pc=$(find "$folder/root" -name geomint.pc)
[ -n "$pc" ] || fail 'there is no geomint.pc'
PKG_CONFIG_PATH=$(dirname "$pc") PKG_CONFIG_SYSROOT_DIR=$folder/root
export PKG_CONFIG_PATH PKG_CONFIG_SYSROOT_DIR
# shellcheck disable=SC2046 # options
cc -std=c17 -Wall -Wextra -Werror -o "$folder/example" "$source/library/example.c" $(pkg-config --cflags --libs geomint) ||
    fail 'the example is not compiled'
printf '#include <geomint.h>\nint main() { return geomint_version() == 0; }\n' >"$folder/plus.cpp"
if command -v c++ >/dev/null; then
    # shellcheck disable=SC2046
    c++ -Wall -Werror -o "$folder/plus" "$folder/plus.cpp" $(pkg-config --cflags --libs geomint) || fail 'geomint.h is no C++'
fi
LD_LIBRARY_PATH=$(dirname "$(dirname "$pc")")
export LD_LIBRARY_PATH
(cd "$folder" && unset GEOMINT_KERNEL && ./example >out 2>err) || fail 'the example fails'
[ -s "$folder/err" ] && fail "the example complains: $(cat "$folder/err")"
[ "$(wc -l <"$folder/out")" = 10 ] || fail "the example prints $(cat "$folder/out")"
grep -q '^<svg' "$folder/pendulum.svg" || grep -q '<svg' "$folder/pendulum.svg" || fail 'the example draws nothing'
# its systems are found beside it
cat >"$folder/beside.c" <<'END'
#include <geomint.h>
#include <stdio.h>
int main(void)
{
    geomint *run = geomint_open(1, (const char *[]){"double-pendulum"});
    puts(geomint_message(run));
    const int status = geomint_status(run);
    geomint_close(run);
    return status;
}
END
# shellcheck disable=SC2046
cc -o "$folder/beside" "$folder/beside.c" $(pkg-config --cflags --libs geomint) && "$folder/beside" || fail 'its systems are not beside it'

# the installed program has all that its compiler of loops includes: a system is run by them, where there is a compiler
program=$(find "$folder/root" -path '*/bin/geomint' -type f)
if [ -n "$program" ] && command -v cc >/dev/null; then
    (unset GEOMINT_KERNEL && XDG_CACHE_HOME=$folder/cache GEOMINT_COMPILER_SECONDS=300 \
        "$program" run system 'H=p^2/2 - cos(q)' q=1 p=0 dt=.1 scheme=verlet steps=10 --engine native --json) \
        >"$folder/native" 2>&1
    grep -q '"engine":"native"' "$folder/native" || fail "the installed engine: $(tail -n 1 "$folder/native" | cut -c1-300)"
fi

# the package finds the library that it was installed with
package=$(find "$folder/root" -path '*geomint/__init__.py' | head -n 1)
python=/usr/bin/python3
[ -x $python ] || python=python3
if [ -n "$package" ] && $python -c 'import cffi, numpy' 2>/dev/null; then
    (unset GEOMINT_LIBRARY PYTHONPATH && cd "$folder" && PYTHONPATH=$(dirname "$(dirname "$package")") $python -c '
import geomint
assert geomint.run("double-pendulum", steps=3).t.shape == (4,), "rows"') || fail 'the installed package'
fi
exit $status
