#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The explorer without a terminal: what each key does, at 60, 80, 120 and 200 columns, read from text files that
`--shot` writes. Usage: shots.py GEOMINT SOURCE"""
import os
import re
import subprocess
import sys
import tempfile

GEOMINT, SOURCE = map(os.path.realpath, sys.argv[1:3])
COLUMNS = (60, 80, 120, 200)
faults = 0


def check(holds, what, lines=()):
    global faults
    if not holds:
        faults += 1
        print(f"shots: {what}", *[f"    |{line}" for line in lines], sep="\n", file=sys.stderr)


def run(*words):
    return subprocess.run([GEOMINT, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300,
                          env={"PATH": os.environ["PATH"], **{k: v for k, v in os.environ.items() if "SAN" in k or "GEOMINT_" in k}})


def shot(words, keys, columns=80, rows=24):
    """Returns the lines of the screen after the keys."""
    done = run("tui", *words.split(), "--shot", "a.txt", "--screen", f"{columns}x{rows}", "--keys", keys)
    check(done.returncode == 0 and not done.stderr, f"{words} --keys '{keys}': {done.returncode} {done.stderr}")
    return open("a.txt", encoding="utf-8").read().split("\n")[:-1]


def has(pattern, words, keys, columns=80, rows=24):
    lines = shot(words, keys, columns, rows)
    check(re.search(pattern, "\n".join(lines), re.M), f"{words} {columns}x{rows} --keys '{keys}': no {pattern}", lines)


def lacks(pattern, words, keys, columns=80, rows=24):
    lines = shot(words, keys, columns, rows)
    check(not re.search(pattern, "\n".join(lines), re.M), f"{words} {columns}x{rows} --keys '{keys}': {pattern}", lines)


def same(one, other, words, what, columns=80):
    """Both scripts lead to one screen, which another one differs from."""
    first, second = shot(words, one, columns), shot(words, other, columns)
    check(first == second, f"{what}: the screens differ", [*first, "", *second])


def files():
    for ending in ("txt", "svg", "png"):
        texts = []
        for name in (f"one.{ending}", f"other.{ending}"):
            done = run("tui", "kepler", "--shot", name, "--keys", "2s SPACE s rk4 ENTER 1s")
            check(done.returncode == 0, f"{name}: {done.returncode} {done.stderr}")
            texts.append(open(name, "rb").read())
        check(texts[0] == texts[1], f"two files {ending} differ")
    lines = open("one.txt", encoding="utf-8").read().split("\n")
    check(len(lines) == 25 and {len(line) for line in lines[:-1]} == {80}, "not 24 lines of 80 cells", lines)
    check("RK4" in "".join(lines) and "space resume" in lines[23], "RK4 or the keys are missing", lines)
    check(b"geomint:command" in texts[0], "a PNG does not store its command")
    again = run("again", "one.png", "-o", "again.png")
    check(again.returncode == 0 and open("again.png", "rb").read() == texts[0], f"again: {again.stderr}")
    for words in (["--keys", "t"], ["--theme", "mono"], ["--colours", "16"]):
        run("tui", "kepler", "--shot", "coloured.png", *words)
        again = run("again", "coloured.png", "-o", "again.png")
        check(again.returncode == 0 and open("again.png", "rb").read() == open("coloured.png", "rb").read(),
              f"again of {words}: {again.stderr}")
    svg = open("one.svg", encoding="utf-8").read()
    check(">RK4<" in svg and "<circle" in svg, "the SVG has no letters or no dots")
    run("tui", "kepler", "--shot", "light.svg", "--theme", "light")
    check(open("light.svg", encoding="utf-8").read() != svg, "a light theme changes nothing")


def refusals():
    for words, sentence in (
            (["--shot", "a.pdf"], r"--shot a\.pdf is not a \.txt, \.svg or \.png file"),
            (["--shot", "a"], r"--shot a is not a \.txt, \.svg or \.png file"),
            (["--shot", "b.txt", "--screen", "5x5"], r"--screen 5x5 is not COLUMNSxROWS from 20x6 to 400x120"),
            (["--shot", "b.txt", "--screen", "80"], r"--screen 80 is not COLUMNSxROWS"),
            (["--shot", "b.txt", "--keys", "2s FOO"], r"--keys has no key FOO; its keys are ENTER, ESC, "),
            *((["--shot", "b.txt", "--keys", f"1s {key}"], rf"--keys has no key {key}; its keys are ENTER, ESC, .*, F1, CTRL-U")
              for key in ("CTRL-C", "ALT-R", "Alt-R", "shift-tab", "F2", "DEL")),
            (["--shot", "b.txt", "--keys", "1e9s"], r"--keys 1e9s is too long"),
            (["--shot", "b.txt", "--theme", "mauve"], r"--theme is \"mauve\""),
            (["--shot", "b.txt", "--graphics", "sixel"], r"--graphics sixel needs a terminal"),
            (["--keys", "q"], r"--keys and --screen need --shot FILE")):
        before = sorted(os.listdir())
        done = run("tui", "kepler", *words)
        check(done.returncode == 1 and re.fullmatch(rf"geomint: {sentence}.*\n", done.stderr) and not done.stdout,
              f"{words}: {done.returncode} {done.stderr}")
        check(sorted(os.listdir()) == before, f"{words}: a file is written")
    done = run("tui", "kepler", "--shot", "one.txt/a.txt")
    check(done.returncode == 3 and done.stderr.count("\n") == 1, f"no folder: {done.returncode} {done.stderr}")


def names_of_keys():
    for key in ("Space", "space", "SPACE"):
        has("paused", "kepler", f"1s {key}")
    same("s rk4 Esc 1s", "s rk4 esc 1s", "kepler", "names in any case")
    has("^ zz", "kepler", "1s e ctrl-u zz")
    has("search: RK4_", "kepler", "1s s RK4")  # a figure after letters is no key


def footer():
    # what to watch takes two rows at most: whole sentences, or the words that fit
    for columns, end in ((40, "methods…"), (60, "grows and…"), (80, "theirs does not.")):
        lines = shot("kepler", "1s", columns)
        check("Watch the energy" in lines[21] and lines[22].rstrip().endswith(end), f"{columns} columns: no two rows to watch up to {end}", lines)
    check("q quit" in shot("kepler", "1s", 40)[-1], "40 columns: no q quit", shot("kepler", "1s", 40))
    keys = ["space pause", "? help", "esc back", "q quit", "s scheme", "f fork", "← → change"]
    for columns in COLUMNS:
        for wait in ("0s", "1s", "9s"):
            last = shot("kepler", wait, columns)[-1]
            check(all(key in last for key in keys[:4 if columns < 80 else None]), f"{columns} columns: keys", [last])
            check(columns >= 80 or len(last.strip()) > 40, f"{columns} columns: few keys", [last])
        has("Watch", "kepler", "1s", columns)
        lacks("Watch", "kepler", "9s", columns)
        has("Watch", "kepler", "9s ? ESC", columns)
        has("resume", "kepler", "1s SPACE", columns)
    for keys in ("DOWN", "k", "SPACE . ,"):
        check(re.search(r"\? help.*esc back", shot("kepler", keys)[-1]), f"{keys}: no help or way back")


def levels():
    for columns in COLUMNS:
        has("Type to search", "kepler", "3s ESC", columns)
        for inner in ("s", "f", "ENTER", "?", "i", "y", "e", ">", "M"):
            has("SCHEMES", "kepler", f"9s {inner} ESC", columns)
            has("Type to search", "kepler", f"9s {inner} ESC ESC", columns)
        has("search: kep_", "", "kep", columns)
        has("Type to search", "", "kep ESC", columns)
        same("ESC ESC", "0s", "", "esc in the list", columns)
        has("q quit", "", "ESC", columns) if columns > 60 else None
    # what is left goes on
    has("▸ kepler", "kepler", "1s l")
    has("paused", "kepler", "1s SPACE l ENTER")


def quitting():
    same("1s q ? 1s", "1s", "kepler", "q leaves at once")
    typed = "e ENTER 1s"
    question = r"Quit\? The formula is not saved\. q again quits, any other key stays"
    words = "system H=p^2/2-cos(q) q=2 p=0"
    for columns in (80, 120, 200):
        has(question, words, typed + " q", columns)
    lacks(r"Quit\?", words, typed + " q k")
    lacks(r"Quit\?", words, "1s q")
    has("KEYS", words, typed + " q z ?")  # it stays
    lacks("KEYS", words, typed + " q q ?")  # it has left: no page opens


def hints():
    for columns in COLUMNS:
        has(r"k does nothing here; \? lists the keys", "kepler", "9s k", columns)
        lacks("does nothing", "kepler", "9s k k", columns)
        lacks("does nothing", "kepler", "9s k 4s", columns)
        has("j does nothing", "kepler", "9s k k j", columns)
        for key in ("?", "h", "F1"):
            has("KEYS", "kepler", f"1s {key}", columns)
    has("KEYS HERE", "", "F1")
    has("search: h_", "", "h")


def help_texts():
    """Returns the texts of the help, by the table of keys."""
    table = open(os.path.join(SOURCE, "app/runs/keys.def"), encoding="utf-8").read()
    return re.findall(r'KEYS\("[^"]*", (?:NULL|"[^"]*"), \d+,\s*"([^"]*)"', table)


def pages():
    """No line of the help is cut, at any width."""
    texts = help_texts()
    check(len(texts) > 25, "the table of keys is not read")
    for columns in (*range(40, 240, 9), 60, 80, 120, 200, 240):
        lines = shot("kepler", "?", columns, 120)
        if columns - 2 >= 110:  # two columns: the keys are at the left
            lines = [line[:1 + (columns - 2 - 4) // 2] for line in lines]
        page = re.sub(r"\s+", " ", " ".join(line.strip() for line in lines))
        for text in texts:
            check(text in page, f"{columns} columns: the help has not '{text}'", lines)
        check("…" not in page.replace("measuring …", ""), f"{columns} columns: the help is cut", lines)


def labels():
    for columns in COLUMNS:
        has("▸ *[━•╍]+ RK4", "kepler scheme=verlet", "SPACE . . . . f rk4 ENTER", columns)
    has("RK4, after Verlet", "kepler scheme=verlet", "SPACE . . . . s rk4 ENTER", 200, 40)
    has("^ *RK4, aft|^ *RK4 ", "kepler scheme=verlet", "SPACE . . . . s rk4 ENTER", 60)
    # the notes of all lanes have one form
    for columns in COLUMNS:
        lines = shot("disc scheme=explicit-euler,rk4,rk2 dt=2", "3s", columns)
        forms = {re.sub(r"[\d.e−]+$", "", note) for note in re.findall(r"(?:! |✕ )\S.*?(?=\s*$)", "\n".join(lines), re.M)}
        check(len({form.split(" ")[0] + str(len(form.split(" ")) > 2) for form in forms}) <= 2, f"{columns}: notes {forms}", lines)


def values():
    for value, sentence in (("5e9", "dt=5e9 is out of range: it lies between 1e-[67] and"),
                            ("-0.01", "dt=-0.01 is out of range: it lies between 1e-[67] and 1000; key B of the explorer turns time"),
                            ("x", "dt=x is not a number")):
        command = run("run", "kepler", f"dt={value}", "steps=1").stderr.split("geomint: ")[1].strip()
        check(re.search(sentence, command), f"run: {command}")
        page = " ".join(line.strip() for line in shot("kepler", f"1s ENTER {value} ENTER", 200, 40))
        check(command in page, f"dt={value}: not the sentence of the command line: {command}")
    has(r"steps per second: press .* to shorten dt", "kepler", "9s" + " [" * 30 + " 1s", 120, 40)


def undoing():
    for columns in COLUMNS:
        start = "SPACE . . . . ."
        has(r"▸ dt +0\.1 ", "kepler", start + " ENTER 0.1 ENTER", columns, 40)
        has(r"Undone: dt is pi/50 again", "kepler", start + " ENTER 0.1 ENTER ENTER 0.2 ENTER u u", columns, 40)
        has(r"▸ dt +pi/50", "kepler", start + " RIGHT RIGHT LEFT u u u", columns, 40)
        has(r"Undone: the scheme is Verlet again", "kepler scheme=verlet", start + " s rk4 ENTER u", columns, 40)
        has("There is nothing to undo", "kepler", start + " u", columns, 40)
    has(r"▸ eccentricity +0\.5 ", "kepler", "SPACE DOWN RIGHT u", 120, 40)
    has(r"Undone: dt is 0\.1 again", "kepler", "SPACE ENTER 0.1 ENTER ENTER 0.1 ENTER ENTER 0.2 ENTER u")
    has("There is nothing to undo", "kepler", "SPACE" + " RIGHT" * 40 + " u" * 40)
    # what all lanes have changed stays when one of them is removed
    for columns in COLUMNS:
        has("Undone: dt is pi/50 again", "kepler scheme=verlet,rk4", "SPACE ENTER 0.1 ENTER x u", columns)
        has("Undone: dt is pi/50 again", "kepler scheme=verlet,rk4", "SPACE ENTER 0.1 ENTER TAB x u", columns)
    has(r"▸ dt +pi/50", "kepler scheme=verlet,rk4,rk2", "SPACE ENTER 0.1 ENTER TAB s gauss4 ENTER x u", 120, 40)
    has(r"Undone: the scheme is RK2 \(Heun\) again", "kepler scheme=verlet,rk4,rk2", "SPACE TAB TAB s gauss4 ENTER TAB x u", 120, 40)
    has("There is nothing to undo", "kepler scheme=verlet eccentricity=0.1,0.2", "SPACE DOWN RIGHT x u", 120, 40)
    # a removed lane takes its own changes along
    has("There is nothing to undo", "kepler scheme=verlet,rk4", "SPACE . . . . s rk2 ENTER x u")


def movies():
    """A movie's length does not depend on the time that its frames take: here its program begins late."""
    with open("ffmpeg", "w", encoding="utf-8") as program:
        program.write('#!/bin/sh\nsleep 1\ncat >/dev/null\nfor last in "$@"; do :; done\necho movie >"$last"\n')
    os.chmod("ffmpeg", 0o755)
    path = os.environ["PATH"]
    os.environ["PATH"] = os.getcwd() + ":" + path
    done = run("tui", "kepler", "--shot", "a.txt", "--screen", "120x40", "--keys", "1s R 2s")
    os.environ["PATH"] = path
    lines = open("a.txt", encoding="utf-8").read().split("\n")
    check(done.returncode == 0 and any("● 0:02.0" in line for line in lines), f"a slow movie: {done.stderr}", lines)


def aliases():
    for columns in COLUMNS:
        has("^ *velocity-verlet: verlet", "kepler", "9s s velo", columns)
        lacks(": verlet", "kepler", "9s s verl", columns)
    has("▸ ?━━━ Verlet", "kepler scheme=rk4", "SPACE s velocity-verlet ENTER")
    # what a system refuses is not among its parameters
    lacks("portrait", "kepler", "1s", 120, 40)
    has("portrait", "system H=p^2/2-cos(q) q=2 p=0", "1s", 120, 40)
    has("portrait needs a plane", "kepler", "1s d 1s", 120, 40)


def lists():
    for columns, rows in ((40, 24), (60, 24), (80, 24), (132, 43)):
        page = " ".join(line[-columns:].split("│")[-1].strip() for line in shot("kepler", "9s s rkf45", columns, rows))
        check("rkf45 is not here; dopri5 is the adaptive scheme of order 5" in page, f"{columns}: rkf45: {page}")
        page = " ".join(line.split("│")[-1].strip() for line in shot("kepler", "9s f xyzzy", columns, rows))
        check('there is no scheme "xyzzy"; backspace takes a letter back' in page, f"{columns}: xyzzy: {page}")
        page = " ".join(line.split("│")[-1].strip() for line in shot("kepler", "9s s verlat", columns, rows))
        check('there is no scheme "verlat"; did you mean verlet' in page, f"{columns}: verlat: {page}")
        # the formula is whole, and wrapped between its words
        page = " ".join(line.split("│")[-1].strip() for line in shot("kepler", "9s s gauss4", columns, rows))
        check("y₁ = y₀ + h/2 [f(Y₁) + f(Y₂)] a = [1/4, 1/4 − √3/6; 1/4 + √3/6, 1/4]" in page, f"{columns}: the formula: {page}")
    has(r"│ Yᵢ = y₀ \+ h Σⱼ aᵢⱼ f\(Yⱼ\), +…", "kepler", "9s s", 80)  # or cut after a word


def ranges():
    """The ends of ranges have all their digits."""
    for columns in COLUMNS:
        page = " ".join(line.strip() for line in shot("kepler", "9s DOWN", columns))
        check("0 to 0.9999; starts again" in page, f"{columns} columns: the range of eccentricity: {page}")
    # the end of a range can be reached although it has no short decimal
    lacks("out of range", "henon-heiles", "1s DOWN" + " RIGHT" * 12)
    has(r"energy is at the end of its range", "henon-heiles", "1s DOWN" + " RIGHT" * 12, 120)
    has(r"eccentricity 0\.5 +0 ━+●─+ 0\.9999 *$", "kepler", "9s", 132, 43)


def portraits():
    """A legend that fits, and arrows that leave room: most cells of a small panel were full of them."""
    system = "system rate=x=x*(3-x-2*y) rate=y=y*(2-x-y) x=0.4 y=0.3 scheme=rk4 portrait=yes window=-0.5,3.5,-0.5,2.5"
    for columns, rows in ((60, 24), (80, 24), (132, 43)):
        lines = shot(system, "4s", columns, rows)
        page = "\n".join(lines)
        check(columns == 60 or re.search("○ unstable  ● stable  ◐ saddle|● stable  ○ unstable  ◐ saddle", page), f"{columns}x{rows}: legend", lines)
        check("centre" not in page, f"{columns}x{rows}: a kind that is not there", lines)
    lines = shot("lotka-volterra portrait=yes", "4s")
    panel = "".join(line[3:45] for line in lines[4:12])
    check(panel.count(" ") > len(panel) / 4, "the arrows of a small portrait are too dense", lines)
    has("◌ centre", "lotka-volterra portrait=yes", "4s", 60)


def invariants():
    """What the equations conserve, for the values that the parameters have; why it is not searched."""
    typed = "system H=(px^2+py^2)/2+(x^2+y^2)/2+C*x^2*y+2*y^3 coordinates=x,y momenta=px,py x=.1 y=.1 px=0 py=0 C=1"
    has("angular_momentum = q1", "kepler", "SPACE V", 100)
    has("proved: 2, 2 of them", typed, "SPACE V", 100)
    has("proved: 1, 1 of them", typed.replace("C=1", "C=1.1"), "SPACE V", 100)
    has("proved: 1, 1 of them", "henon-heiles", "SPACE V")
    has("not searched: it is a field", "kdv", "SPACE V")
    has("are those of a system", "vortices", "SPACE V")
    same("SPACE", "SPACE V V", "kepler", "the page and back")


def notices():
    has("stability of kepler is ready: m shows it", "kepler", "SPACE m ESC 1s", 120)
    lacks("is ready", "kepler", "SPACE m ESC 21s", 120)
    lacks("is ready", "kepler", "SPACE m ESC l ENTER", 120)


def drive():
    """The keys of time, of parameters, lanes and the screen."""
    words, start = "disc", "SPACE r . . . ."
    for columns in COLUMNS:
        has("t = π/3", words, start, columns)
        same(start, start + " . ,", words, "a step forward and back", columns)
        same(start, start + " , , , . . .", words, "three back and forward", columns)
        check(shot(words, start, columns) != shot(words, start + " .", columns), "a step changes nothing")
        has("t = π/12", words, start + " , , ,", columns)
        has("2× paused", words, start + " ]", columns)
        has(r"0\.5× paused", words, start + " ] [ [", columns)
        has("t = 0 ", words, start + " HOME", columns)
        same(start, start + " HOME END", words, "to the start and the end of the past", columns)
        same(start, start + " PGUP PGUP PGDN PGDN", words, "through the past", columns)
        has(r"Run ahead to t = _ +\(enter alone: 4\.71239\)", words, start + " >", columns)
        has("t = 3π/2", words, start + " > ENTER", columns)
        has("has already passed", words, start + " > 20*pi ENTER > 1 ENTER", columns)
        lacks("already passed", words, start + " > 20*pi ENTER > 1 ENTER ESC", columns)
        # a live parameter acts on the present state; another one restarts
        has(r"▸ dt +0\.3", words, start + " RIGHT", columns)
        has("t = π/3|t = 1.0", words, start + " RIGHT", columns)
        has("acts at once", words, start + " RIGHT", columns)
        has(r"▸ dt +0\.25 ", words, start + " ENTER 0.25 ENTER", columns)
        has("▸ dt +pi/12", words, start + " ENTER 0.25 ENTER BACKSPACE", columns)
        has("‹ pendulum ›", words, start + " DOWN RIGHT", columns)
        has("t = 0", words, start + " DOWN RIGHT", columns)
        # lanes
        has("SWITCH TO", words, start + " s", columns)
        has("AS MEASURED", words, start + " s ?", columns, 40)
        has("SWITCH TO", words, start + " s ? ?", columns)
        has("▸ +Verlet", words, start + " f verlet", columns)
        has("▸ ?━•━ Verlet", words, start + " f verlet ENTER", columns)
        same(start + " f verlet ENTER", start + " f verlet ENTER . ,", words, "a fork and back", columns)
        has("all lanes", words, start + " f verlet ENTER o", columns)
        same(start + " f verlet ENTER", start + " f verlet ENTER o o", words, "overlaid and back", columns)
        lacks("━•━", words, start + " f verlet ENTER x", columns)
        has("The last lane stays", words, start + " x x x x", columns)
        # what the panel shows
        lacks("OBSERVED", words, start + " v", columns)
        lacks("SCHEMES", words, start + " v v", columns)
        lacks("PARAMETERS", words, start + " v v v", columns)
        has("‖ 1× paused", words, start + " v v v v", columns)
        same(start, start + " v v v v v", words, "all views", columns)
        has("[▖-▟]", words, start + " b", columns)
        lacks("[^ -~\n]", words, start + " b b b", columns)
        same(start, start + " b b b b", words, "blocks all around", columns)
    # time turned: the symmetric scheme returns
    turned = "SPACE r s midpoint ENTER . . . . . . B SPACE 9s"
    has("from start +(0|[0-9.]+e−1[5-7])", words, turned)
    has("t = [−]?0", words, turned)


def counts():
    """A whole number is written in full."""
    has(r"edges +2352 +2352", "form-cahn-hilliard", "SPACE", 100, 30)


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        for part in (files, refusals, footer, levels, quitting, hints, pages, labels, values, undoing, movies, aliases,
                     names_of_keys, lists, ranges, portraits, invariants, notices, counts, drive):
            part()
        os.chdir("/")
    print("shots: all passed" if not faults else f"shots: {faults} faults")
    return faults > 0


sys.exit(main())
