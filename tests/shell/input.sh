#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Files and words that are not what they should be: one clear sentence at once, without a byte that a terminal
# would obey. input.sh GEOMINT MESHES
set -u
meshes=$2
. "$(dirname "$0")/answers.sh"
longest=60

# every answer is put by, and all are looked at together, at the end
mkdir answers
answered=0
inspect() {
    answered=$((answered + 1))
    cat out err >answers/$answered.text
    printf 'geomint %s' "$*" >answers/$answered.words
}

# nothing but regular files is read
mkfifo pipe.png pipe.tour
ln -s /dev/zero zero.png
ln -s /dev/zero zero.tour
mkdir folder.png folder.tour
truncate -s 3G huge.png huge.tour
: >empty.png
refused 3 'No such file' again ''
for file in pipe folder zero huge; do
    case $file in
    pipe) reason='it is a pipe' ;;
    folder) reason='Is a directory' ;;
    zero) reason='it is a device' ;;
    huge) reason='3072 MB, more than' ;;
    esac
    refused 3 "$reason" again $file.png
    refused 3 "$reason" tour ./$file.tour --list
    refused 3 "$reason" run room mesh=$file.png
    refused 3 "$reason" render cavity mesh=$file.png
done
refused 3 'not a PNG' again empty.png
refused 3 'reads PNG and SVG' again drawn.pdf
# what stands where frames and a checkpoint would be is no frame and no checkpoint
mkdir frames
mkfifo frames/disc-render-000000.png.pipe
"$geomint" render disc --frames 2 --size 64x64 --out frames 2>err || fail "frames: $(cat err)"
rm -f frames/*.png
mkfifo frames/disc-render.checkpoint
timeout 600 "$geomint" render disc --frames 2 --size 64x64 --out frames 2>err
[ $? = 0 ] || fail "a render beside a pipe that is called like its checkpoint: $(cat err)"

# pictures that were forged: texts
cat >forge.py <<'END'
import struct, sys, zlib

def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

def picture(path, chunks, size=64):
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, 2, 0, 0, 0)))
        for kind, data in chunks:
            file.write(chunk(kind, data))
        file.write(chunk(b"IEND", b""))

def text(key, value):
    return (b"tEXt", b"geomint:" + key + b"\0" + value)

def packed(key, value):
    return (b"zTXt", b"geomint:" + key + b"\0\0" + value)

good = {b"arguments": b"disc scheme=rk4 points=3", b"changes": b"", b"steps": b"1", b"picture": b"64x64 light"}

def forge(path, **other):
    texts = {**good, **{key.encode(): value for key, value in other.items()}}
    picture(path, [text(key, value) for key, value in texts.items()])

forge("good.png")
forge("escape.png", arguments=b"disc scheme=\x1b]52;c;YWFh\x07")
forge("c1.png", arguments="disc scheme=\u009b31m\u202etxt".encode())
forge("bytes.png", arguments=b"disc\xff\xfe points=3")
forge("steps.png", steps=b"99999999999999999999")
forge("changes.png", changes=b"0 99999999999999999999 dt=1\n")
forge("lane.png", changes=b"99999999999999999999 1 dt=1\n")
forge("size.png", picture=b"99999x99999 light")
forge("command.png", command=b"stability \x1b[2J")
# a thousand texts that unpack to a megabyte each
megabyte = zlib.compress(bytes(1 << 20), 9)
picture("bomb.png", [packed(b"x%d" % i, megabyte) for i in range(1000)])
picture("large.png", [packed(b"arguments", zlib.compress(b"x" * (1 << 26), 1))])
picture("many.png", [text(b"x", b"y" * 1000)] * 20000)
# four gigabytes of pixels, packed
pixels = zlib.compressobj(1)
picture("pixels.png", [(b"IDAT", pixels.compress(bytes(1 << 28)) + pixels.flush())], 65535)
data = open("good.png", "rb").read()
open("cut.png", "wb").write(data[:-20])
open("damaged.png", "wb").write(data.replace(b"rk4", b"rk2"))
END
python3 forge.py || exit 1
status 0 again good.png
refused 3 'scheme=?\]52;c;YWFh?" holds' again escape.png
refused 3 'scheme=?31m?txt" holds' again c1.png
refused 3 'no scene "disc??"' again bytes.png
refused 3 'steps are damaged' again steps.png
refused 3 'changes is damaged' again changes.png
refused 3 'changes is damaged' again lane.png
refused 3 'size is damaged' again size.png
refused 1 'no scene "?\[2J"' again command.png
refused 3 'damaged or too large' again large.png
refused 3 'more than 4 MB' again many.png
refused 3 'does not record how it was made' again pixels.png
refused 3 'cut short' again cut.png
refused 3 'damaged' again damaged.png
(
    ulimit -v 100000 # kB: what is not asked for is not unpacked
    "$geomint" --help >/dev/null 2>&1 || exit 0 # a sanitizer wants more
    "$geomint" again bomb.png >out 2>err
    [ $? = 3 ] && grep -q 'does not record how it was made' err
) || fail "texts of a gigabyte: $(cat err)"

# words and names that a terminal would obey
escape=$(printf '\033]52;c;YWFh\007')
refused 1 'no command or scene "?\]52;c;YWFh?"' "$escape"
refused 1 'no scheme\|cannot be shown' run disc "scheme=$escape"
refused 1 'cannot be shown' run room "mesh=$escape"
refused 1 'cannot be shown' run room "mesh=$(printf 'a\302\233b')"
refused 1 'cannot be shown' run room "mesh=$(printf 'a\342\200\256b')"
refused 3 'a?b could not be read' run room "mesh=$(printf 'a\377b')"
cp "$meshes/room-small.msh" "$(printf 'a\233b.msh')"
status 0 run room "mesh=$(printf 'a\233b.msh'),$meshes/room-small.msh" steps=0
refused 1 'no option' run disc "--$escape"
refused 3 '' again "$escape.png"
refused 3 '' tour "./$escape.tour"
status 0 run disc --csv "new/$escape"
printf '$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$\033]52;c;YWFh\007\n' >section.msh
refused 3 '' run room mesh=section.msh
sed 's/"inlet"/"\x1b[2Jinlet"/' "$meshes/channel-small.msh" >names.msh
refused 1 'no physical group' run room mesh=names.msh
mkdir "out$escape"
cp good.png "out$escape/good.png"
status 0 again "out$escape/good.png" --out "out$escape"

# a mesh may have blanks in its path, and a picture of it is made again
mkdir 'my meshes'
cp "$meshes/room-small.msh" 'my meshes/a \ room.msh'
status 0 render room 'mesh=my meshes/a \ room.msh' steps=2 --size 64x64 --out blanks
status 0 again blanks/room-render.png --out blanks
cmp -s blanks/room-render.png blanks/room-render-again.png || fail 'a picture of a mesh with blanks in its path'
printf 'title: a\nstep: b\nsay: c\nshow: room mesh=my\\ meshes/a\\ \\\\\\ room.msh\nuntil: 1\n' >blank.tour
status 0 tour ./blank.tour --list
# what a mesh lacks is wrong usage, what cannot be read is a file's fault
refused 1 'no physical group' run room "mesh=$meshes/room-small.msh" inlet=nowhere
for command in run render work-precision stability; do
    scene=room
    [ $command = stability ] && continue
    refused 3 'line [0-9]*' $command $scene "mesh=$meshes/truncated.msh"
done

# options that contradict each other, are given twice or say what cannot be
for pair in '--frames 3' '--every 3' '--rate 1' '--fps 10' '--from 0' '--movie x.mp4'; do
    # shellcheck disable=SC2086 # two words
    refused 1 'contradict each other: the first makes one picture' render disc --at 1 $pair
done
refused 1 'contradict each other' render disc --frames 3 --rate 1
refused 1 'contradict each other' render disc --frames 3 --every 2
refused 1 'contradict each other' render disc --every 2 --rate 1
refused 1 'given twice' run disc --csv a.csv --csv b.csv
refused 1 'given twice' run disc --max --max
refused 1 'to one file' run kdv --csv a.csv --profile a.csv
for at in 1e308 100 -1; do
    refused 1 'lies after the end\|lies before the start' render disc --at $at
    refused 1 'lies after the end\|lies before the start' render disc --from $at --frames 2
done
refused 1 'is not a number' render disc --at 1e308*10
refused 1 'is not a number' render disc --at nan
refused 1 'from 0.01 to 1000' render disc --fps 0
refused 1 'from 0.01 to 1000' render disc --fps 1e300
refused 1 'above 0' render disc --rate 0
refused 1 'above 0' render disc --rate -1
refused 1 'frames; 1e7 is the most' render disc --rate 1e-300
refused 1 'frames; 1e7 is the most' render disc --frames 1e9
refused 1 'whole number from 1 to 1e9' render disc --frames 99999999999999999999
refused 1 'whole number from 1 to 1e9' run disc --every 0.5
refused 1 'WIDTHxHEIGHT' render disc --size 99999999999999999999x100
refused 1 'is not I/N' render disc --frames 3 --shard 99999999999999999999/1
refused 1 'LANE:STEP:KEY=VALUE' render disc --changes 0:99999999999999999999
refused 1 'LANE:STEP:KEY=VALUE' render disc --changes 0:99999999999999999999:dt=1
refused 1 'LANE:STEP:KEY=VALUE' render disc --changes 99999999999999999999:1:dt=1
refused 1 'LANE:STEP:KEY=VALUE' render disc --changes 0:-1:dt=1
refused 1 'LANE:STEP:KEY=VALUE' render disc --changes '0:1:dt'
refused 1 'comes too late' render disc --changes 0:1000000:dt=1
refused 1 'is not a step' render disc --changes 0:1:dt=1e308*10
refused 1 'dt=5e9 is out of range: it lies between' render kepler --changes 0:1:dt=5e9
refused 1 'no scheme' render disc --changes 0:1:scheme=nothing
refused 1 'cannot be changed' render disc --changes 0:1:points=7
refused 1 'whole number from 0 to 1e15' run disc steps=99999999999999999999
refused 1 'steps; 1e15 is the most' run disc dt=1e-6 until=1e12
# what would take very long is asked about first, with how many steps and how long
for command in run render backward work-precision; do
    refused 1 '^geomint: these are 1e+15 steps, which take about [0-9.e+]* years; --yes makes them$' \
        $command disc scheme=midpoint until=1e12 dt=1e-3
done
refused 1 '; --yes makes them$' stability kepler until=1e12
refused 1 '^geomint: these are 2 runs, which take about .*; --yes makes them$' \
    sweep disc scheme=midpoint radius=0.1,0.2 until=1e12 dt=1e-3
refused 1 'no .mp4, .webm or .gif' render disc --movie a.avi
refused 1 'no .mp4, .webm or .gif' tour area --movie a.avi
[ -n "$(find . -name '*.csv')" ] && fail 'a refused command wrote a file'

# where a scheme chooses its steps, frames lie between the start and until
status 0 render kepler scheme=levi-civita until=10 --frames 3 --size 64x64 --out own
grep -q '3 of 3 from t = 0 to 10,' own/kepler-render-000002.png || fail 'frames of a scheme that chooses its steps'
refused 1 'need until=' render kepler scheme=levi-civita steps=10 --frames 3

# no control character but ends of lines
[ "$answered" -gt 50 ] || fail "only $answered answers were looked at"
python3 - <<'END' || fail 'answers hold what a terminal would obey'
import glob, sys, unicodedata
wrong = 0
for name in glob.glob("answers/*.text"):
    text = open(name, "rb").read().decode("utf-8")
    if any(letter != "\n" and unicodedata.category(letter) in ("Cc", "Cf") for letter in text):
        print(ascii(open(name[:-4] + "words", "rb").read()), ascii(text)[:300])
        wrong += 1
sys.exit(wrong > 0)
END

[ $failures = 0 ] && echo 'all as it should be'
exit $failures
