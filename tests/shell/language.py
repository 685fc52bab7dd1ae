#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The style guide, docs/language.md, as numbers: language.py SOURCE [--show NUMBER]

Counts the words of tests/reference/words.tsv in documents, string literals, comments and files of share, and measures
sentences, paragraphs and table cells of the documents. --show prints the places of one entry of the list.
Fenced and indented blocks, headings and images are no prose; a list item is a paragraph; inline code is one word; a
link is its text; a sentence ends at . ! ? before a capital, a digit or code. Strings of one word are skipped."""
import glob
import os
import re
import sys

CODE = ("app", "core", "library", "render", "scenes")
SKIPPED = ("docs/scenes.md", "docs/schemes.md", "docs/rooms.md", "docs/systems.md")  # generated, and not rewritten yet
GUIDE = "docs/language.md"  # it quotes the words of the list
MEAN = 17  # words per sentence, in all documents
LIMITS = {"sentence": 35, "paragraph": 90, "cell": 30}  # words
LINES = {"README.md": 120, "docs/architecture.md": 150, GUIDE: 120}
EXCEPTIONS = 25
MAY_ONLY_FALL = {"documents": 0, "strings": 293, "wrapper, Python, share": 170, "comments": 2046, "openings": 1140}
OPENING = re.compile(r"(?:Of|What|That|Those|Where|Whether|As|By|How|Which|Whose|In|Also|Its|Their|For|To)\b")
SENTENCE = re.compile(r"(?<=[.!?])[)\"”*]*\s+(?=[(\"“*]*[^\W\d_a-z]|[(\"“*]*[\d`])")
TOKENS = re.compile(r"/\*.*?\*/|//[^\n]*|\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)+'", re.S)


def read(source, name):
    with open(os.path.join(source, name), encoding="utf-8") as text:
        return text.read()


def rows(source, name):
    lines = read(source, "tests/reference/" + name).splitlines()
    return [line.split("\t") for line in lines if line and not line.startswith("#")]


def names(source, *patterns):
    found = (name for pattern in patterns for name in glob.glob(pattern, root_dir=source, recursive=True))
    return sorted(name for name in found if name not in SKIPPED)


def line_of(begins, text, place):
    return begins + text.count("\n", 0, place)


def word_count(text):
    return sum(any(c.isalnum() or c == "`" for c in word) for word in text.split())


def plain(text):
    """Code as one word, links as their texts; lines stay lines."""
    text = re.sub(r"!\[[^]]*\]\([^)]*\)", "", text)
    text = re.sub(r"(`+)(.+?)\1", lambda code: "`x`" + "\n" * code[0].count("\n"), text, flags=re.S)
    return re.sub(r"\[([^]]*)\]\([^)\s]*\)", r"\1", text)


def prose(text):
    """The paragraphs and the table cells of a document, each after the number of its first line."""
    paragraphs, cells, fenced, joined = [], [], False, False
    for number, line in enumerate(text.split("\n"), 1):
        item = re.match(r" *(?:[*-]|\d+\.) +", line)
        fenced ^= line.lstrip().startswith("```")
        skipped = fenced or re.match("#|\\s*```|\\s*$", line) or (line.startswith("    ") and not joined)
        if line.startswith("|") and not fenced:
            row = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            cells += [(number, plain(cell)) for cell in row if not re.fullmatch(r":?-+:?", cell)]
        elif not skipped and joined and not item:
            paragraphs[-1] = (paragraphs[-1][0], paragraphs[-1][1] + "\n" + line.strip())
        elif not skipped:
            paragraphs.append((number, line[item.end():] if item else line.strip()))
        joined = not skipped and not line.startswith("|")
    return [(number, plain(text)) for number, text in paragraphs], cells


def sentences(paragraphs):
    found = []
    for begins, text in paragraphs:
        place = 0
        for sentence in SENTENCE.split(text):
            place = text.index(sentence, place)
            found.append((line_of(begins, text, place), sentence))
    return found


def tokens(text):
    """The comments and the joined string literals of a C file."""
    comments, strings, end = [], [], None
    for token in TOKENS.finditer(text):
        number = line_of(1, text, token.start())
        if token[0][0] == "/" and "SPDX-License" not in token[0]:
            words = re.sub(r"^[ \t]*\*(?!/)[ \t]*|^/\*+|\*+/$|^//|^[ \t]+", "", token[0], flags=re.M)
            comments.append((number, words.strip()))
        elif token[0][0] == '"':
            inner = token[0][1:-1].replace("\\n", " ").replace('\\"', '"')
            if end is not None and not text[end:token.start()].strip():
                number, inner = strings[-1][0], strings.pop()[1] + inner
            strings.append((number, inner))
            end = token.end()
    return comments, [string for string in strings if word_count(string[1]) > 1]


def main(source, show=None):
    entries = [(number, groups, re.compile(words, re.I)) for number, groups, words, *_ in rows(source, "words.tsv")]
    allowed = rows(source, "words-allowed.tsv")
    faults = [f"words-allowed.tsv: {len(allowed)} lines"] if len(allowed) > EXCEPTIONS else []
    places = {kind: [] for kind in MAY_ONLY_FALL}
    lengths = []

    def look(kind, group, name, units):
        for begins, text in units:
            flat = re.sub(r"\s", " ", text)
            for words in (words for file, words in allowed if file == name):
                flat = flat.replace(words, "_" * len(words))
            places[kind] += [(number, f"{name}:{line_of(begins, text, hit.start())}: {number}: {hit[0].strip()}")
                             for number, groups, words in entries if group in groups for hit in words.finditer(flat)]

    for name in names(source, "README.md", "docs/*.md"):
        text = read(source, name)
        paragraphs, cells = prose(text)
        counts = [[(line, word_count(unit)) for line, unit in units]
                  for units in (sentences(paragraphs), paragraphs, cells)]
        lengths += [words for _, words in counts[0]]
        print(f"{name}: {sum(words for _, words in counts[0]) / len(counts[0]):.1f} words per sentence, longest",
              ", ".join(f"{unit} {max(words for _, words in [(0, 0), *of])}" for unit, of in zip(LIMITS, counts)))
        faults += [f"{name}:{line}: a {unit} of {words} words, at most {LIMITS[unit]}"
                   for unit, of in zip(LIMITS, counts) for line, words in of if words > LIMITS[unit]]
        if text.count("\n") > LINES.get(name, text.count("\n")):
            faults.append(f"{name}: {text.count(chr(10))} lines, at most {LINES[name]}")
        look("documents", "-" if name == GUIDE else "d", name, paragraphs + cells)
    print(f"all documents: {sum(lengths) / len(lengths):.2f} words per sentence, at most {MEAN}")
    if sum(lengths) > MEAN * len(lengths):
        faults.append(f"documents: {sum(lengths) / len(lengths):.2f} words per sentence, at most {MEAN}")
    for name in names(source, "geomint", "python/geomint/*.py", *(f"share/**/*.{e}" for e in ("system", "room", "scheme"))):
        look("wrapper, Python, share", "s", name, list(enumerate(read(source, name).split("\n"), 1)))
    for name in names(source, *(f"{folder}/**/*.{ending}" for folder in CODE for ending in ("c", "h", "def"))):
        comments, strings = tokens(read(source, name))
        look("comments", "c", name, comments)
        look("strings", "s", name, strings)
        places["openings"] += [("opening", f"{name}:{line}: {text[:60]}") for line, text in comments if OPENING.match(text)]
    for kind, limit in MAY_ONLY_FALL.items():
        print(f"{kind}: {len(places[kind])}, at most {limit}")
        if len(places[kind]) > limit:
            faults += [place for _, place in places[kind]] + [f"{kind}: {len(places[kind])} places, at most {limit}"]
    if show is not None:
        print(*(place for found in places.values() for number, place in found if number == show), sep="\n")
    elif faults:
        sys.exit("\n".join(faults))


main(sys.argv[1], sys.argv[3] if sys.argv[2:3] == ["--show"] else None)
