#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How many small faults in the program the tests see.

    mutants.py FOLDER [--count 200] [--seed 1] [--only WORDS] [--jobs 2] [--longest 40] [--patience 120] [--show]

A mutant is the program with one fault: a statement left out, a comparison turned, a number one too large, + for -, ||
for &&. FOLDER gets a copy of the committed sources in which all mutants stand side by side, behind a number that
GM_MUTANT chooses when the program runs. So one build serves all of them, and a mutant costs its tests alone. First every
test of the suite `fast` that waits for no terminal runs once without a fault, which shows the mutants that it reaches
(FOLDER/reached.json; those slower than --longest seconds are left out). Then the tests that reach a mutant run with it,
the quickest first, until one fails or they would have taken --patience seconds. A mutant that none of them kills is
printed; it wants a test, or a line in mutants.equivalent with the reason why no test can see it. --only: files that hold
one of these words; --show: the mutants, which are not built."""

import argparse
import concurrent.futures
import io
import json
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tarfile
import time

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))

FOLDERS = ("core", "scenes", "app/words", "app/data", "render/layout")
MOST = 4096  # mutants

HEAD = """#include <fcntl.h>
#include <stdlib.h>
#include <sys/mman.h>
int close(int); /* without <unistd.h>, whose names a file may have for functions of its own */
static _Bool gm_mutant(int number)
{
    static int chosen = -1;
    static char *reached;
    if (chosen < 0) {
        const char *text = getenv("GM_MUTANT"), *path = getenv("GM_MUTANTS_REACHED");
        const int file = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
        void *map = file < 0 ? MAP_FAILED : mmap(NULL, %d, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
        if (file >= 0) {
            close(file);
        }
        reached = map == MAP_FAILED ? NULL : map;
        chosen = text ? atoi(text) : 0;
    }
    if (reached) {
        reached[number] = 1;
    }
    return number == chosen;
}
""" % MOST

MUTANT = re.compile(r"gm_mutant\((\d+)\)")
OPERAND = r"[A-Za-z_][\w.\[\]]*(?:->[\w.\[\]]+)*(?:\([^()\"']*\))?|\d[\w.]*"
BEFORE, AFTER = r"(?<=[(,!&|=?:;])\s*|(?<=return)\s+", r"(?=\s*(?:[),;?:]|&&|\|\|))"
COMPARISON = re.compile(rf"(?:{BEFORE})(?P<a>{OPERAND}) (?P<op><=|>=|<|>|==|!=) (?P<b>{OPERAND}){AFTER}")
SUM = re.compile(rf"(?:{BEFORE})(?P<a>{OPERAND}) (?P<op>\+|-) (?P<b>{OPERAND}){AFTER}")
LOGIC = re.compile(r"(?:if|while) \((?P<a>[^()&|?]*(?:\([^()]*\)[^()&|?]*)*) (?P<op>&&|\|\|) (?P<b>[^()&|?]*(?:\([^()]*\)[^()&|?]*)*)\) \{$")
NUMBER = re.compile(r"(?<![\w.\[\"'%])(?P<a>\d+(?:\.\d+)?)(?![\w.\"'\]])")
STATEMENT = re.compile(r"^\s+(?P<a>(?:\*?[\w.\[\]]+(?:->[\w.\[\]]+)*(?: [-+*/|&]?= [^;{}\"]*|\+\+|--)|\w+\([^;{}]*\));)$")
TURNED = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "+": "-", "-": "+", "&&": "||", "||": "&&"}
DECLARES = re.compile(r"^\s*(?:static|const|enum|struct|case|#|extern|typedef|\}|\.|\{|double \*|size_t \w+\[|char \w+\[)|\[\w*\] = |sizeof|_Static_assert")


def bodies(text):
    """The lines of functions: (number, line, the line before). Others hold constant expressions."""
    inside, before, comment, prepares = False, "", False, False
    for number, line in enumerate(text.split("\n")):
        if line == "{":
            inside = True
        elif line == "}":
            inside = False
        elif inside and not comment and "/*" not in line and not prepares and not line.rstrip().endswith("\\"):
            yield number, line, before
        comment = ("/*" in line or comment) and "*/" not in line
        prepares = line.rstrip().endswith("\\")
        before = line.strip() or before


def places(name, text):
    """All faults that a file may have: (file, line number, begin, end, the faulty text, the kind)."""
    for number, line, before in bodies(text):
        declares = bool(DECLARES.search(line))
        for kind, pattern in (("comparison", COMPARISON), ("sum", SUM), ("logic", LOGIC)):
            for found in pattern.finditer(line):
                a, b, op = found["a"], found["b"], found["op"]
                quoted = '"' in a + b or line[: found.start("a")].count('"') % 2 != 0
                if declares or quoted or kind == "sum" and ("[" in line[: found.start("a")][-1:]):
                    continue
                right = f"({a}) {op} ({b})" if kind == "logic" else f"{a} {op} {b}"
                wrong = right.replace(f" {op} ", f" {TURNED[op]} ", 1)
                yield name, number, found.start("a"), found.end("b"), f"(gm_mutant(GM_NUMBER) ? {wrong} : {right})", kind
        for found in NUMBER.finditer(line):
            if not declares and '"' not in line and "?" not in line and found["a"] != "0":
                yield name, number, found.start("a"), found.end("a"), f"(gm_mutant(GM_NUMBER) ? {found['a']} + 1 : {found['a']})", "number"
        found = STATEMENT.match(line)
        if found and before[-1:] in ";{}" and not re.match(r"(?:return|free|va_|assert|longjmp|GM_)", found["a"]):
            yield name, number, found.start("a"), found.end("a"), f"if (!gm_mutant(GM_NUMBER)) {{ {found['a']} }}", "statement"


def chosen(count, seed, only):
    """Mutants, spread over folders and kinds."""
    files = subprocess.run(["git", "-C", ROOT, "ls-files", *FOLDERS], check=True, capture_output=True, text=True).stdout.split()
    every = {}
    for name in files:
        # what writes sources while the program is built runs in no test
        if name.endswith(".c") and not name.endswith((".loops.c", "/main.c")) and any(word in name for word in only.split() or [""]):
            with open(os.path.join(ROOT, name), encoding="utf-8") as file:
                for place in places(name, file.read()):
                    every.setdefault((folder_of(name), place[5]), []).append(place)
    numbers = random.Random(seed)
    for list_ in every.values():
        numbers.shuffle(list_)
    picked, taken = [], set()
    while len(picked) < count and any(every.values()):
        for key in sorted(every):
            place = every[key].pop() if every[key] else None
            if place and (place[0], place[1]) not in taken and len(picked) < count:
                taken.add((place[0], place[1]))  # one a line
                picked.append(place)
    return picked


def folder_of(name):
    """The folder that a mutant stands for: app/data, core/ode/user, scenes/field."""
    return "/".join(os.path.dirname(name).split("/")[:3])


def line_of(place):
    """The line of the source that a mutant changes."""
    with open(os.path.join(ROOT, place[0]), encoding="utf-8") as file:
        return file.read().split("\n")[place[1]].strip()


def change_of(place):
    """The change, as a reader names it."""
    found = re.fullmatch(r"\(gm_mutant\(GM_NUMBER\) \? (.*?) : (.*)\)", place[4])
    return f"{found[2]} -> {found[1]}" if found else "without " + re.search(r"\{ (.*) \}", place[4])[1]


def write(folder, picked):
    """A copy of the committed sources with the mutants; a file that is there as it should be is not written again."""
    by_file = {}
    for number, place in enumerate(picked, 1):
        by_file.setdefault(place[0], []).append((number, place))
    archive = subprocess.run(["git", "-C", ROOT, "archive", "HEAD"], check=True, capture_output=True).stdout
    with tarfile.open(fileobj=io.BytesIO(archive)) as files:
        for member in files:
            path = os.path.join(folder, member.name)
            if not member.isfile():
                files.extract(member, folder)
                continue
            content = files.extractfile(member).read()
            if member.name in by_file:
                lines = content.decode().split("\n")
                for number, (_, at, begin, end, text, _) in by_file[member.name]:
                    lines[at] = lines[at][:begin] + text.replace("GM_NUMBER", str(number)) + lines[at][end:]
                include = next(i for i, line in enumerate(lines) if line.startswith("#include"))
                content = "\n".join(lines[:include] + [HEAD] + lines[include:]).encode()
            if os.path.exists(path):
                with open(path, "rb") as file:
                    if file.read() == content:
                        continue
            os.makedirs(os.path.dirname(path), exist_ok=True)
            with open(path, "wb") as file:
                file.write(content)
            os.chmod(path, member.mode)


def build(folder, picked):
    """Builds; a mutant that is no C, as a number where C wants a constant, is put back, and left out. Returns them."""
    if not os.path.exists(os.path.join(folder, "build")):
        subprocess.run(["meson", "setup", os.path.join(folder, "build"), folder, "-Dtests=enabled", "-Dloops=baseline"], check=True,
                       stdout=subprocess.DEVNULL)
    bad = set()
    while True:
        made = subprocess.run(["ninja", "-k", "0", "-C", os.path.join(folder, "build")], capture_output=True, text=True)
        if made.returncode == 0:
            return bad
        fresh = set()
        for name, line in re.findall(r"^(?:\.\./)*([\w/.-]+\.c):(\d+):\d+: error", made.stdout, re.M):
            path = os.path.join(folder, name)
            if os.path.exists(path):
                with open(path, encoding="utf-8") as file:
                    fresh |= set(map(int, MUTANT.findall(file.read().split("\n")[int(line) - 1])))
        # an error inside of a macro is another line's; the compiler prints this one, too
        fresh = fresh or set(map(int, MUTANT.findall(made.stdout)))
        for number in fresh:
            name, at = picked[number - 1][:2]
            with open(os.path.join(folder, name), encoding="utf-8") as file:
                lines = file.read().split("\n")
            with open(os.path.join(ROOT, name), encoding="utf-8") as file:
                lines[at + HEAD.count("\n") + 1] = file.read().split("\n")[at]
            with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                file.write("\n".join(lines))
        if not fresh - bad:
            sys.exit(made.stdout[-3000:])
        bad |= fresh


def limit():
    """A mutant may run, write and allocate for ever."""
    resource.setrlimit(resource.RLIMIT_CPU, (600, 600))  # not less than a shell test sets: it could not raise it
    resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 28, 1 << 28))
    resource.setrlimit(resource.RLIMIT_DATA, (1 << 33, 1 << 33))  # RLIMIT_AS would choose another painter
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def passes(test, seconds, **more):
    """Whether a test passes, as meson runs it, within this time."""
    environment = dict(os.environ, GEOMINT_PAINTER="own", MALLOC_PERTURB_="85", **test["env"], **more)
    process = subprocess.Popen(test["cmd"], env=environment, cwd=test["workdir"], stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True, preexec_fn=limit)
    try:
        return process.wait(seconds) == 0
    except subprocess.TimeoutExpired:
        return False
    finally:
        try:
            os.killpg(process.pid, signal.SIGKILL)
        except ProcessLookupError:
            pass
        process.wait()


def reach(folder, test, longest):
    """The time that a test takes without a fault, and the mutants that it reaches; None where it does not pass."""
    path = os.path.join(folder, "reached." + test["name"].replace("/", " "))
    with open(path, "wb") as file:
        file.truncate(MOST)
    start = time.monotonic()
    passed = passes(test, longest, GM_MUTANTS_REACHED=path)
    seconds = time.monotonic() - start
    with open(path, "rb") as file:
        reached = [number for number, byte in enumerate(file.read()) if byte]
    os.unlink(path)
    return (seconds, reached) if passed else None


def reaches(folder, picked, pool, longest):
    """For every test its command, its time, and the mutants that it reaches, the quickest first."""
    introspected = subprocess.run(["meson", "introspect", "--tests", os.path.join(folder, "build")], check=True, capture_output=True)
    tests = {test["name"]: test for test in json.loads(introspected.stdout)
             if any(suite.endswith(":fast") for suite in test["suite"]) and not any(suite.endswith(":terminal") for suite in test["suite"])}
    path = os.path.join(folder, "reached.json")
    known = {}
    if os.path.exists(path):
        with open(path, encoding="utf-8") as file:
            known = json.load(file)
    if known.get("mutants") != [list(place) for place in picked]:
        tries = {name: pool.submit(reach, folder, test, longest) for name, test in tests.items()}
        known = {"mutants": picked, "tests": {name: done.result() for name, done in tries.items()}}
        with open(path, "w", encoding="utf-8") as file:
            json.dump(known, file)
    found = known["tests"]
    left_out = [name for name, result in found.items() if not result]
    print(f"{len(found)} tests; left out, for they take longer or fail: {', '.join(left_out) or 'none'}", flush=True)
    return sorted(((*result, tests[name]) for name, result in found.items() if result), key=lambda entry: entry[0])


def judge(number, entries, patience):
    """The first test that fails with this mutant, or None; how many were asked."""
    asked = 0
    for seconds, reached, test in entries:
        if number not in reached:
            continue
        patience -= seconds
        if asked and patience < 0:
            break
        asked += 1
        if not passes(test, 30 + 10 * seconds, GM_MUTANT=str(number)):
            return test["name"], asked
    return None, asked


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder")
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--longest", type=float, default=40)
    parser.add_argument("--patience", type=float, default=120)
    parser.add_argument("--show", action="store_true")
    words = parser.parse_args()
    picked = chosen(words.count, words.seed, words.only)
    if words.show:
        for number, place in enumerate(picked, 1):
            print(f"{number} {place[0]}:{place[1] + 1}: {change_of(place)}")
        return
    equivalent = {}
    with open(os.path.join(ROOT, "tests", "mutants.equivalent"), encoding="utf-8") as file:
        for line in file:
            if line.strip() and not line.startswith("#"):
                name, *text, change, reason = line.rstrip("\n").split(" | ")
                equivalent[name, " | ".join(text), change] = reason
    write(words.folder, picked)
    bad = build(words.folder, picked)
    killed = same = 0
    survivors = []
    with concurrent.futures.ThreadPoolExecutor(words.jobs) as pool:
        entries = reaches(words.folder, picked, pool, words.longest)
        tries = {pool.submit(judge, number, entries, words.patience): (number, place) for number, place in enumerate(picked, 1)
                 if number not in bad}
        for done in concurrent.futures.as_completed(tries):
            number, place = tries[done]
            where = f"{number} {place[0]}:{place[1] + 1}: {change_of(place)}"
            killer, asked = done.result()
            if killer:
                killed += 1
                print(f"{where}: killed by {killer}", flush=True)
            elif (place[0], line_of(place), change_of(place)) in equivalent:
                same += 1
                print(f"{where}: equivalent, {equivalent[place[0], line_of(place), change_of(place)]}", flush=True)
            else:
                survivors.append(where)
                print(f"{where}: SURVIVES {asked} tests", flush=True)
    print(f"seed {words.seed}: {len(picked) - len(bad)} mutants, {killed} killed, {same} equivalent, {len(survivors)} survive")
    sys.exit(1 if survivors else 0)


if __name__ == "__main__":
    main()
