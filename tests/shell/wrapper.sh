#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# The wrapper `geomint`, with stand-ins for the tools that it calls: what it installs, when it builds, and
# what it hands on. Usage: wrapper.sh SOURCE_FOLDER
source=$1
top=$(mktemp -d) || exit 1
trap 'rm -rf "$top"' EXIT
failures=0

# check DESCRIPTION COMMAND ...
check() {
    description=$1
    shift
    if ! "$@"; then
        printf 'failed: %s\n' "$description"
        sed 's/^/    /' "$top/out" "$top/err" "$top/log"
        failures=$((failures + 1))
    fi
}

says() {
    grep -qF -- "$2" "$top/$1"
}

silent() {
    ! says "$1" "$2"
}

same() {
    [ "$1" = "$2" ]
}

# run COMMAND ...: status, out, err; a new log of the stand-ins' calls
run() {
    : >"$top/log"
    (cd "$top/elsewhere" && "$@" </dev/null >"$top/out" 2>"$top/err")
    status=$?
}

# A stand-in called $1, whose text is standard input. Each notes how it was called.
stand_in() {
    {
        printf '#!/bin/sh\nTOP="%s"\necho "%s $*" >>"$TOP/log"\n' "$top" "$1"
        cat
    } >"$top/bin/$1"
    chmod +x "$top/bin/$1"
}

folder="$top/a folder"
mkdir "$folder" "$top/bin" "$top/elsewhere"
cp "$source/geomint" "$source/packages" "$folder"
ln -s "../a folder/geomint" "$top/elsewhere/link"

# nothing of the system but what a minimal one has
for tool in sh awk cat chmod cp dirname env flock grep mkdir mv printf readlink rm script sed sleep touch; do
    path=$(command -v "$tool")
    case $path in
    /*) ln -s "$path" "$top/bin/$tool" ;;
    esac
done
PATH=$top/bin
export PATH

for tool in cc ffmpeg tmux; do
    stand_in "$tool" </dev/null
done
stand_in pkg-config <<'END'
case $2 in libdeflate) [ ! -f "$TOP/no-deflate" ] ;; esac
END
stand_in meson <<'END'
case $1 in
setup)
    for argument; do
        case $argument in */build) build=$argument ;; esac
    done
    mkdir -p "$build/app"
    touch "$build/build.ninja" "$build/stale"
    ;;
test) echo "testing" ;;
esac
END
stand_in ninja <<'END'
if [ "$3" = -n ]; then
    [ -f "$2/stale" ] || echo "ninja: no work to do."
    exit
fi
[ ! -f "$TOP/broken" ] || exit 1
mkdir "$TOP/building" || { echo "two at once" >>"$TOP/log"; exit 1; }
sleep 0.2
printf '#!/bin/sh\npwd\nprintf "<%%s>" "$@"\n' >"$2/app/geomint"
chmod +x "$2/app/geomint"
rm -f "$2/stale"
rmdir "$TOP/building" 2>/dev/null || rm -rf "$TOP/building"
END
stand_in dpkg-query <<'END'
for package; do
    case $package in
    -*) ;;
    *) grep -qx "$package" "$TOP/absent" || echo "$package installed" ;;
    esac
done
END
stand_in apt-get <<'END'
[ "$2" != install ] || : >"$TOP/absent"
END
stand_in id <<'END'
cat "$TOP/user"
END
stand_in sudo <<'END'
[ -f "$TOP/sudoer" ] || exit 1
[ "$1" != -n ] || exit 0
exec "$@"
END

: >"$top/absent"
echo 1000 >"$top/user"

run "$top/elsewhere/link" render 'a b' '' '*' --out=x
check "the first command builds" same "$status" 0
check "it says so" says err building
check "arguments arrive whole" says out '<render><a b><><*><--out=x>'
check "the folder stays the caller's" says out "$top/elsewhere"
check "nothing was installed" silent log apt-get

run "$folder/geomint" list
check "the second command does not build" silent err building
check "it does not configure either" silent log 'meson'
check "it runs" says out '<list>'

stand_in python3 <<'END'
printf '<%s>' "$@"
END
run "$folder/geomint" figures --docs orbit.png
check "pictures of the documents are drawn" says out "/pictures.py><$folder/build/app/geomint><$folder><--write><orbit.png>"
run "$folder/geomint" figures --out docs
check "other figures are the program's" says out '<figures><--out><docs>'

touch "$folder/build/stale"
run "$folder/geomint"
check "what has changed is built" says err building
check "no argument is no argument" same "$status" 0

touch "$folder/build/stale" "$top/broken"
run "$folder/geomint" list
check "a failing build is told" says err 'the build failed'
check "by its status too" same "$status" 1
check "and nothing runs" silent out '<list>'
rm "$top/broken"

: >"$top/log"
"$folder/geomint" list >/dev/null 2>&1 &
"$folder/geomint" list >/dev/null 2>&1 &
wait
check "two wrappers build one after the other" silent log 'two at once'

mv "$folder" "$top/moved"
run "$top/moved/geomint" list
check "a folder that was moved is configured anew" says log '--wipe'
mv "$top/moved" "$folder"

printf 'libpng-dev\nffmpeg\ntmux\n' >"$top/absent"
run "$folder/geomint" list
check "no other command looks for packages" silent log dpkg-query

run "$folder/geomint" setup
check "without root nothing is installed" silent log apt-get
check "that is a failure" same "$status" 1
check "the line to type is printed" says err \
    'sudo apt-get install --no-install-recommends libpng-dev ffmpeg'
check "each with its reason" says err 'movies'

echo 0 >"$top/user"
run "$folder/geomint" setup
check "root installs without asking where nobody answers" says log \
    'apt-get -q install -y --no-install-recommends libpng-dev ffmpeg'
check "from fresh lists" says log 'apt-get -q update'
check "and looks anew for what is there now" says log 'meson configure --clearcache'
check "and configures with it" says log 'meson setup --reconfigure'
check "what is built stays built" silent log '--wipe'
check "successfully" same "$status" 0

run "$folder/geomint" setup
check "what is there is not installed again" silent log apt-get

echo 1000 >"$top/user"
touch "$top/sudoer"
echo tmux >"$top/absent"
run "$folder/geomint" test --all
check "sudo without a password does as well" says log \
    'sudo env DEBIAN_FRONTEND=noninteractive apt-get -q install'
check "the tests run" says log 'meson test'
check "all suites" says log '--suite fast --suite numbers'
run "$folder/geomint" test
check "the fast suite alone" silent log numbers

if [ -e "$top/bin/script" ]; then
    echo ffmpeg >"$top/absent"
    : >"$top/log"
    (sleep 1; echo n) | script -qec "'$folder/geomint' setup" /dev/null >"$top/out" 2>"$top/err"
    check "a person is asked" says out 'install them with apt-get? [Y/n]'
    check "and can say no" silent log 'apt-get -q install'
    script -qec "'$folder/geomint' setup --yes" /dev/null </dev/null >"$top/out" 2>"$top/err"
    check "--yes answers" says log 'apt-get -q install'
fi

run "$folder/geomint" demo
check "the demonstration is made" same "$status" 0
check "with the library, for Python" says log '/build -n app/geomint library/libgeomint.so.1'
check "it says how long it takes" says err 'which take about half a minute'
check "and what each picture shows" says err 'RK4 loses energy'
check "as it makes it" says out '<render><kepler><scheme=rk4,rk4sym>'
check "in its folder" says out "$folder/demo"
check "and what to do next" says err './geomint tour'

for words in '--fuzz' '5' '--fuzz 0' '--fuzz five'; do
    # shellcheck disable=SC2086 # words
    run "$folder/geomint" test $words
    check "test $words is refused" same "$status" 1
    check "with the usage" says err 'test --fuzz MINUTES'
done
run "$folder/geomint" test --fast
check "a wrong option is told" same "$status" 1

rm "$top/bin/apt-get"
run "$folder/geomint" setup
check "without apt it goes on if all is there" same "$status" 0
touch "$top/no-deflate"
run "$folder/geomint" setup
check "otherwise it stops" same "$status" 1
check "and names what is missing" says err 'libdeflate-dev'

rm "$top/bin/meson"
run "$folder/geomint" list
check "without tools the program that is there runs" says out '<list>'
rm -r "$folder/build"
run "$folder/geomint" list
check "without both the way out is told" says err 'please run ./geomint setup'
check "with a failure" same "$status" 1

[ "$failures" = 0 ] && echo "all checks passed"
exit "$failures"
