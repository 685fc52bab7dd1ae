#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The style guide, docs/language.md, as numbers: language.py SOURCE [--show NUMBER]

Counts the words of tests/reference/words.tsv in documents, string literals, comments and files of share, and measures
sentences, paragraphs and table cells of the documents. --show prints the places of an entry.

Fenced and indented blocks, headings and images are no prose. A list item is a paragraph. Inline code is one word; a link
is its text. A sentence ends at `.`, `!` or `?` before a capital, a digit or code. Adjacent string literals of C are one
string, and strings of one word are skipped. The guide quotes what it forbids, so only its lengths are measured."""
import glob
import io
import os
import re
import sys
import tokenize

CODE = ("app", "core", "library", "loader", "render", "scenes")
SKIPPED = ("docs/scenes.md", "docs/schemes.md")  # generated
GUIDE = "docs/language.md"  # it quotes the words of the list
MEAN = 17  # words per sentence, in all documents
LIMITS = {"sentence": 35, "paragraph": 90, "cell": 30}  # words
LINES = {"README.md": 120, "docs/architecture.md": 150, GUIDE: 120}
MAY_ONLY_FALL = {"documents": 0, "strings": 0, "wrapper, Python, share": 0, "comments": 0, "openings": 0}
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
    return [(begins + text.count("\n", 0, text.index(sentence)), sentence)
            for begins, text in paragraphs for sentence in SENTENCE.split(text)]


def tokens(text):
    """The comments and the joined string literals of a C file."""
    comments, strings, end = [], [], None
    for token in TOKENS.finditer(text):
        number = 1 + text.count("\n", 0, token.start())
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


def texts(text, python):
    """The comments and strings of a Python file; the lines of another file, but for the words of claims."""
    if python:
        found = tokenize.generate_tokens(io.StringIO(text).readline)
        return [(token.start[0], token.string) for token in found if token.type in (tokenize.COMMENT, tokenize.STRING)]
    return [(number, line) for number, line in enumerate(text.split("\n"), 1) if not line.startswith("claims:")]


def main(source, show=None):
    entries = [(number, groups, re.compile(words, re.I)) for number, groups, words, *_ in rows(source, "words.tsv")]
    allowed = rows(source, "words-allowed.tsv")
    faults = [f"words-allowed.tsv: {len(allowed)} lines, at most 25"] if len(allowed) > 25 else []
    places = {kind: [] for kind in MAY_ONLY_FALL}
    lengths = []

    def look(kind, group, name, units):
        for begins, text in units:
            flat = re.sub(r"\s", " ", text)
            for words in (words for file, words in allowed if file == name):
                flat = flat.replace(words, "_" * len(words))
            for number, groups, words in entries:
                for hit in words.finditer(flat) if group in groups else ():
                    line = begins + text.count("\n", 0, hit.start())
                    places[kind].append((number, f"{name}:{line}: {number}: {hit[0].strip()}"))

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
        lines, most = text.count("\n"), LINES.get(name, sys.maxsize)
        faults += [f"{name}: {lines} lines, at most {most}"] if lines > most else []
        look("documents", "-" if name == GUIDE else "d", name, paragraphs + cells)
    mean = f"all documents: {sum(lengths) / len(lengths):.2f} words per sentence, at most {MEAN}"
    print(mean)
    faults += [mean] if sum(lengths) > MEAN * len(lengths) else []
    for name in names(source, "geomint", "python/geomint/*.py", *(f"share/**/*.{e}" for e in ("system", "room", "scheme"))):
        look("wrapper, Python, share", "s", name, texts(read(source, name), name.endswith(".py")))
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
