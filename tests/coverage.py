#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the share of lines and branches that the tests reach, a folder a line.

usage: coverage.py SUMMARY (gcovr --json-summary)
"""
import collections
import json
import sys

COUNTS = "line_covered", "line_total", "branch_covered", "branch_total"
folders = collections.defaultdict(lambda: [0] * len(COUNTS))
with open(sys.argv[1], encoding="utf-8") as summary:
    for file in json.load(summary)["files"]:
        parts = file["filename"].split("/")
        for folder in {"/".join(parts[: min(depth, len(parts) - 1)]) for depth in (1, 2)} | {"all"}:
            folders[folder] = [a + file[name] for a, name in zip(folders[folder], COUNTS)]
print(f"{'folder':<20} {'lines':>7} {'reached':>8} {'branches':>9} {'reached':>8}")
for folder, (reached, lines, taken, branches) in sorted(folders.items()):
    print(f"{folder:<20} {lines:>7} {100 * reached / max(lines, 1):>7.1f}% {branches:>9} {100 * taken / max(branches, 1):>7.1f}%")
