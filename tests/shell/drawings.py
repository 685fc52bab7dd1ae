#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures as SVG and PDF: made of pixels again by librsvg and poppler they are the PNG, their texts are texts, the same
picture has the same bytes; --title, --scale, --size and --dpi, alike in all formats.

    drawings.py GEOMINT [few]        few: where a sanitizer watches, pictures of each kind once"""

import base64
import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree
import zlib

from with_numpy import numpy
for tool in ("rsvg-convert", "pdftoppm", "pdftotext", "ffmpeg"):
    if not shutil.which(tool):
        print(f"drawings: {tool} is not installed")
        sys.exit(77)

GEOMINT = os.path.abspath(sys.argv[1])
FEW = "few" in sys.argv[2:]
LIKE = 0.95  # the least structural similarity
MOST_BYTES = 2000000
SVG = "{http://www.w3.org/2000/svg}"
faults = 0


def check(holds, what):
    global faults
    if not holds:
        faults += 1
        print("drawings:", what, file=sys.stderr)


def geomint(words, status=0, **more):
    done = subprocess.run([GEOMINT] + (words.split() if isinstance(words, str) else words), capture_output=True,
                          timeout=600, **more)
    check(done.returncode == status, f"{words}: exit status {done.returncode}, not {status}: {done.stderr.decode()}")
    return done


def luminance(data):
    """Of a PPM (P6, 8 bits)."""
    head = re.match(rb"P6\s+(\d+)\s+(\d+)\s+255\s", data)
    width, height = int(head[1]), int(head[2])
    rgb = numpy.frombuffer(data, dtype=numpy.uint8, offset=head.end(), count=3 * width * height)
    return rgb.reshape(height, width, 3) @ numpy.array([0.299, 0.587, 0.114])


def pixels(path, dpi=96):
    if path.endswith(".pdf"):
        made = subprocess.run(["pdftoppm", "-r", str(dpi), path], capture_output=True, check=True)
        return luminance(made.stdout)
    if path.endswith(".svg"):
        subprocess.run(["rsvg-convert", "--dpi-x", str(dpi), "--dpi-y", str(dpi), path, "-o", "drawn.png"], check=True)
        path = "drawn.png"
    made = subprocess.run(["ffmpeg", "-v", "error", "-i", path, "-f", "image2pipe", "-c:v", "ppm", "-"],
                          capture_output=True, check=True)
    return luminance(made.stdout)


def window_mean(values, side=8):
    sums = numpy.pad(values.cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    return (sums[side:, side:] - sums[:-side, side:] - sums[side:, :-side] + sums[:-side, :-side]) / side**2


def similarity(one, other):
    """Structural similarity (Wang, Bovik, Sheikh & Simoncelli, 2004), with windows of 8 x 8."""
    a, b = window_mean(one), window_mean(other)
    var_a, var_b = window_mean(one * one) - a * a, window_mean(other * other) - b * b
    both = window_mean(one * other) - a * b
    small, little = (0.01 * 255)**2, (0.03 * 255)**2
    return ((2 * a * b + small) * (2 * both + little) /
            ((a * a + b * b + small) * (var_a + var_b + little))).mean()


def alike(name, words, dpi=96):
    """The three files of one picture: as large as each other, and like each other."""
    for ending in ("png", "svg", "pdf"):
        geomint(f"{words} -o {name}.{ending}")
    png = pixels(f"{name}.png")
    for ending in ("svg", "pdf"):
        drawn = pixels(f"{name}.{ending}", dpi)
        if drawn.shape != png.shape:
            check(False, f"{words}: {ending} has {drawn.shape} pixels, the PNG {png.shape}")
            continue
        like = similarity(png, drawn)
        check(like > LIKE, f"{words}: the {ending} is like the PNG by {like:.3f} only")
        check(os.path.getsize(f"{name}.{ending}") < MOST_BYTES, f"{words}: the {ending} is too large")
    return png


def test_likeness():
    alike("kepler", "render kepler --theme dark")
    alike("couette", "render couette until=0.1")  # a mesh
    alike("wave", "render wave --theme dark")  # an image
    alike("sphere", "render form-poisson level=3 grid=yes")  # a surface in a light
    if FEW:
        return
    alike("disc", "render disc")
    alike("disc-dark", "render disc --theme dark --size 900x700 scheme=verlet,rk4,midpoint,symplectic-euler until=30")
    alike("room", "render room rows=15 columns=0 dt=0.01 until=0.5")  # tracers and streamlines, on few triangles
    alike("cavity", "render cavity columns=32 rows=0 --theme dark")
    alike("stiff", "render stiff --size 960x540")  # a line that fills an area
    alike("region", "stability --region rk4 --size 700x600")
    alike("map", "stability kepler scheme=verlet,rk4 until=20 --size 800x500 --theme dark")
    alike("one", "render sine-gordon scheme=box until=4 --size 640x640")
    small = alike("cm", "render kepler scheme=verlet until=30 --size 80x60mm", 300)
    check(small.shape == (709, 945), f"80x60mm at 300 dpi are not 945x709 pixels but {small.shape}")
    scaled = alike("scaled", "render kepler scheme=verlet,rk4 until=30 --scale 1.5 --size 800x450")
    plain = alike("plain", "render kepler scheme=verlet,rk4 until=30 --size 800x450")
    check(similarity(scaled, plain) < 0.9, "--scale 1.5 changes nothing")
    check(similarity(plain, plain[::-1]) < LIKE, "the similarity tells nothing")


def test_painters():
    """What paints is not seen: OSMesa's pixels are those of the program's own rasteriser, but for single steps."""
    cases = ["render disc --theme dark", "render kepler", "render couette until=0.1", "render wave", "stability --region rk4"]
    for words in cases[:3] if FEW else cases + ["render cavity columns=32 rows=0", "render form-poisson level=3 streamlines=yes",
                                                "render rigid-body --size 900x700",
                                                "render kepler scheme=verlet until=30 --size 80x60mm"]:
        for painter in ("own", "osmesa"):
            geomint(f"{words} --painter {painter} -o {painter}.png")
        like = similarity(pixels("own.png"), pixels("osmesa.png"))
        check(like >= 0.9995, f"{words}: OSMesa's picture is like that of the rasteriser by {like:.6f} only")


def texts_of(path):
    return ["".join(node.itertext()) for node in xml.etree.ElementTree.parse(path).iter(SVG + "text")]


def test_texts():
    """Title, axes and ticks are letters that can be found and copied."""
    texts = texts_of("kepler.svg")
    found = subprocess.run(["pdftotext", "-layout", "kepler.pdf", "-"], capture_output=True, text=True).stdout
    for text in ("A Kepler orbit, followed by four schemes for 20 periods", "t = 125.66", "Verlet", "100",
                 "apsidal precession, rad", "10⁻³"):
        check(text in texts, f"the SVG has no text {text!r}")
        check(text in found, f"the PDF has no text {text!r}")
    check(texts_of("wave.svg").count("t") >= 1 and "x" in texts_of("wave.svg"), "the SVG has no names of axes")
    fonts = subprocess.run(["pdffonts", "kepler.pdf"], capture_output=True, text=True).stdout.splitlines()[2:]
    check(fonts and all("DejaVuSans" in font and re.search(r"yes yes yes", font) for font in fonts),
          f"the PDF's fonts are not in it, or others: {fonts}")
    root = xml.etree.ElementTree.parse("kepler.svg").getroot()
    check("'DejaVu Sans'" in root.get("font-family"), "the SVG does not name its font")
    dashes = {node.get("stroke-dasharray") for node in root.iter()} - {None}
    check(len(dashes) >= 3, f"of the lanes' lines only {dashes} are dashed")


def test_title():
    title = "a < b & \"c\" > 'd', ü x₁"
    for ending in ("svg", "pdf", "png"):
        geomint(["render", "disc", "until=1", "--title", title, "-o", f"title.{ending}"])
    check(title in texts_of("title.svg"), "the SVG has another title than --title")
    found = subprocess.run(["pdftotext", "title.pdf", "-"], capture_output=True, text=True).stdout
    check(title in found, f"the PDF has another title than --title: {found[:80]}")
    told = subprocess.run(["pdfinfo", "title.pdf"], capture_output=True, text=True).stdout
    check(f"Title:           {title}" in told and re.search("arguments: disc .*until=1\n", told) and "2000" in told, f"pdfinfo tells {told}")
    check(similarity(pixels("title.png"), pixels("title.svg")) > LIKE, "the PNG has another title")
    lacking = [f"U+{0xE000 + i:04X}" for i in range(12)]  # of private use: no font has them
    for count, told in ((1, f"letter {lacking[0]}: a box stands"), (2, f"letters {lacking[0]} and {lacking[1]}: boxes stand"),
                        (9, f"letters {', '.join(lacking[:8])} and others: boxes stand")):
        said = geomint(["render", "disc", "until=1", "--title", "".join(chr(0xE000 + i) for i in range(count)), "-o", "box.pdf"])
        check(told in said.stderr.decode(), f"{count} letters that the font lacks: {said.stderr}")


def test_bytes():
    """The same picture has the same bytes, to a file and to standard output."""
    for ending in ("png", "svg", "pdf"):
        words = "render couette until=0.05 --size 400x300"
        geomint(f"{words} -o first.{ending}")
        done = geomint(f"{words} -o - --format {ending}")
        with open(f"first.{ending}", "rb") as file:
            first = file.read()
        check(first == done.stdout, f"{ending}: standard output gets other bytes than a file")
        check(b"wrote" not in done.stderr, f"{ending}: {done.stderr}")
        geomint(f"{words} -o second.{ending}")
        with open(f"second.{ending}", "rb") as file:
            check(file.read() == first, f"{ending}: not the same bytes again")
    said = geomint("render couette until=0.05 -o said.svg").stderr.decode().splitlines()
    check(len(said) == 2 and said[0] == "geomint: wrote said.svg" and "image" in said[1], f"couette: {said}")
    said = geomint("render disc until=pi/3 -o said.pdf").stderr.decode()
    check(said == "geomint: wrote said.pdf\n", f"disc: {said}")


def test_field():
    """The image within is a PNG whose every pixel has a colour of the map, and whose rows can be read."""
    image = next(xml.etree.ElementTree.parse("couette.svg").iter(SVG + "image"))
    data = base64.b64decode(image.get("{http://www.w3.org/1999/xlink}href").split(",", 1)[1])
    check(data.startswith(b"\x89PNG\r\n\x1a\n"), "the image within is no PNG")
    place, chunks = 8, {}
    while place < len(data):
        size, kind = int.from_bytes(data[place:place + 4], "big"), data[place + 4:place + 8]
        body = data[place + 8:place + 8 + size]
        check(zlib.crc32(kind + body) == int.from_bytes(data[place + 8 + size:place + 12 + size], "big"),
              f"a checksum of the image within is wrong: {kind}")
        chunks[kind] = body
        place += 12 + size
    width, height = int.from_bytes(chunks[b"IHDR"][:4], "big"), int.from_bytes(chunks[b"IHDR"][4:8], "big")
    check(width == 2 * int(image.get("width")) and height == 2 * int(image.get("height")), "the image's size is wrong")
    check(len(zlib.decompress(chunks[b"IDAT"])) == (width + 1) * height, "the image's rows are not whole")


def test_again():
    """What a picture tells makes it once more, bit for bit, and in other formats."""
    for words in ("render kepler until=3", "render kepler until=3 --size 9x6cm --dpi 150 --scale 1.3 --theme dark",
                  "stability kepler scheme=verlet until=20 --size 12x9cm --scale 0.8"):
        geomint(words.split() + ["--title", "two words \\ and a stroke", "-o", "p.png"])
        geomint("again p.png -o q.png")
        with open("p.png", "rb") as one, open("q.png", "rb") as other:
            check(one.read() == other.read(), f"{words}: again makes another picture")
        geomint(words.split() + ["--title", "two words \\ and a stroke", "-o", "p.svg"])
        geomint("again p.png -o q.svg")
        with open("p.svg", "rb") as one, open("q.svg", "rb") as other:
            check(re.search(rb"<svg[^>]*>", one.read())[0] == re.search(rb"<svg[^>]*>", other.read())[0],
                  f"{words}: again makes an SVG of another size")
        check(texts_of("p.svg") == texts_of("q.svg"), f"{words}: again makes another SVG")
        geomint("again p.svg -o r.png")
        with open("p.png", "rb") as one, open("r.png", "rb") as other:
            check(pixels("p.png").tolist() == pixels("r.png").tolist(), f"{words}: again of the SVG is another picture")
            check(one.read() == other.read(), f"{words}: again of the SVG tells something else")


def test_paper():
    """A PNG whose size on paper was given tells it, and VTK's reader takes it from there; others tell nothing."""
    geomint("render disc until=1 --size 8x6cm -o told.png")
    geomint("render disc until=1 --size 800x600 --dpi 200 -o dots.png")
    geomint("render disc until=1 --size 8x6cm --dpi 100 --frames 2 --out told")
    geomint("render disc until=1 --size 800x600 -o untold.png")
    geomint("render disc until=1 --size 8cmx6cm -o each.png")
    with open("told.png", "rb") as file, open("each.png", "rb") as each:
        check(file.read() == each.read(), "a unit behind each length")
    geomint("render disc until=1 --size 8cmx60mm -o none.png", 1)
    with open("untold.png", "rb") as file:
        check(b"pHYs" not in file.read(), "a PNG tells a size on paper that was not given")
    try:
        import vtk
    except ImportError:
        print("drawings: VTK is not installed: its reader of PNG is not asked")
        return
    for name, width, height in (("told.png", 80, 60), ("dots.png", 101.6, 76.2), ("told/disc-render-000001.png", 80, 60)):
        reader = vtk.vtkPNGReader()
        reader.SetFileName(name)
        reader.ReadSpacingFromFileOn()  # millimetres
        reader.Update()
        image = reader.GetOutput()
        sides = [image.GetDimensions()[axis] * image.GetSpacing()[axis] for axis in (0, 1)]
        check(abs(sides[0] - width) < 0.1 and abs(sides[1] - height) < 0.1, f"{name} is {sides} mm")


def test_charts():
    geomint("work-precision disc scheme=verlet,rk4 until=1 -o new/folder/w.svg --size 640x480")
    check(sorted(os.listdir("new/folder")) == ["w.csv", "w.svg"], f"work-precision wrote {os.listdir('new/folder')}")
    with open("new/folder/mine.csv", "w", encoding="utf-8") as file:
        file.write("day,weather\n")
    refused = geomint("work-precision disc scheme=verlet until=1 -o new/folder/mine.svg", 3).stderr
    with open("new/folder/mine.csv", encoding="utf-8") as file:
        check(b"mine.csv is there" in refused and file.read() == "day,weather\n", f"a table of someone's: {refused!r}")
    check(sorted(os.listdir("new/folder")) == ["mine.csv", "w.csv", "w.svg"], "nothing is left of a refused picture")
    geomint("work-precision disc scheme=verlet until=1 -o new/folder/w.pdf")
    geomint("work-precision disc scheme=verlet until=1 --measure energy_error -o new/folder/w.svg")
    done = geomint("stability kepler scheme=verlet until=20 -o - --format svg --size 640x480")
    check(done.stdout.startswith(b"<?xml") and done.stdout.endswith(b"</svg>\n"), "stability -o - writes something else")
    geomint("figures razafindralandy-8 --format svg --quick --out page")
    check({"razafindralandy-8.svg", "razafindralandy-8-dark.svg", "razafindralandy-8.png", "figures.html"} <=
          set(os.listdir("page")), f"figures --format svg wrote {os.listdir('page')}")
    xml.etree.ElementTree.parse("page/razafindralandy-8.svg")


def test_refusals():
    for words, status, sentence in (
            ("render disc -o a.gif", 1, "--output a.gif is no .png, .svg or .pdf file"),
            ("render disc -o folder.svg/a", 1, "--output folder.svg/a is no .png, .svg or .pdf file"),
            ("render disc -o a.svg --format pdf", 1, "--output a.svg and --format pdf name two formats"),
            ("render disc -o a.svg --frames 3", 1, "--output and --frames contradict each other: the first makes one picture"),
            ("render disc -o a.svg --out b", 1, "--output and --out contradict each other: the first names the file"),
            ("render disc --frames 2 --format svg", 1, "--format svg is for one picture: frames are PNG"),
            ("render disc --format gif", 1, "--format gif is none of: png, svg, pdf"),
            ("render disc --scale 0", 1, "--scale 0 is not a number from 0.25 to 4"),
            ("render disc --dpi 1e9", 1, "--dpi 1e9 is not a number from 24 to 2400"),
            ("render disc --size 9x6in", 1, "--size 9x6in is not WIDTHxHEIGHT, each of them from 64 to 16384 pixels, "
             "or in cm or mm: 16x9cm"),
            ("render disc --size 9x5mm", 1, "--size 9x5mm is 106x59 pixels at 300 dpi; each must be from 64 to 16384"),
            ("render disc --size 9x6m", 1, None),
            ("render disc --size 9x-6cm", 1, None),
            ("render disc --size 1e9x6cm", 1, None),
            ("render disc --title \x1b[31m", 1, "--title has characters that are not shown"),
            ("stability kepler -o - --json", 1, "--output - and --json are both to write to standard output"),
            ("render disc until=1 -o /dev/null/a.svg", 3, None),
            ("render disc until=1 -o full.svg", 3, "cannot write full.svg: No space left on device"),
            ("render disc until=1 -o full.pdf", 3, "cannot write full.pdf: No space left on device")):
        if "full" in words:
            link = words.split()[-1]
            os.path.islink(link) or os.symlink("/dev/full", link)
        said = geomint(words, status).stderr.decode().rstrip("\n")
        check(said.count("\n") == 0 and said.startswith("geomint: "), f"{words}: not one sentence: {said}")
        check(sentence is None or said == "geomint: " + sentence, f"{words}: {said}")
    with open("fonts.conf", "w", encoding="ascii") as file:
        file.write("<fontconfig></fontconfig>")
    for ending in ("png", "svg", "pdf"):
        said = geomint(f"render disc until=1 -o a.{ending}", 3, env=dict(os.environ, FONTCONFIG_FILE=os.path.abspath("fonts.conf")))
        check(said.stderr.decode().startswith("geomint: No font was found"), f"{ending} without a font: {said.stderr}")
    check(not any(name.startswith(".") for name in os.listdir(".")), f"temporary files are left: {os.listdir('.')}")


if __name__ == "__main__":
    folder = tempfile.mkdtemp()
    os.chdir(folder)
    try:
        for test in (test_likeness, test_painters, test_texts, test_title, test_bytes, test_field, test_again, test_paper, test_charts, test_refusals):
            test()
    finally:
        os.chdir("/")
        shutil.rmtree(folder)
    sys.exit(1 if faults else 0)
