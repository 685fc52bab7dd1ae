#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Short runs of every scene, system and room, compared with the numbers that an earlier program wrote:
recorded_runs.py GEOMINT REFERENCE [--record]

Each line of REFERENCE holds one lane: the words after `run`, its scheme, time, observables, and its state (of a long
state, evenly spaced entries and the mean magnitude of all). All agree to 1e-12 of the largest entry of the state, or of
the observable where that is above 1. Steps are counted, not timed, and are few: what differs is a formula or its order
of evaluation, not the growth of rounding. With --record, the runs named in REFERENCE are computed and written anew."""
import json
import subprocess
import sys

TOLERANCE = 1e-12
ENTRIES = 24  # of a state at most


def run(geomint, words):
    """The lanes of one run, or a sentence on its failure."""
    command = [geomint, "run", *words.split(), "--json", "--state"]
    done = subprocess.run(command, check=False, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if done.returncode not in (0, 2):
        sys.exit(f"run {words}: exit {done.returncode}: {done.stderr.decode()}")
    lanes = []
    for line in done.stdout.decode().splitlines():
        lane = json.loads(line)
        state = lane["state"]
        stride = -(-len(state) // ENTRIES)
        lanes.append({"words": words, "scheme": lane["scheme"], "status": lane["status"], "t": lane["t"],
                      "steps": lane["steps"], "observables": lane["observables"], "components": len(state),
                      "mean": sum(map(abs, state)) / len(state), "state": state[::stride]})
    return lanes


def same(value, expected, scale):
    if value is None or expected is None:
        return value is expected
    return abs(value - expected) <= TOLERANCE * scale


def differences(lane, recorded):
    """Sentences on what differs."""
    found = [f"{key} is {lane[key]}, recorded {recorded[key]}" for key in ("scheme", "status", "steps", "components")
             if lane[key] != recorded[key]]
    if found:
        return found
    scale = max([recorded["mean"], *map(abs, recorded["state"])])
    if not same(lane["t"], recorded["t"], max(1, abs(recorded["t"]))):
        found.append(f"t is {lane['t']}, recorded {recorded['t']}")
    if not same(lane["mean"], recorded["mean"], scale):
        found.append(f"the mean of the state is {lane['mean']}, recorded {recorded['mean']}")
    found += [f"entry {index} of the state is {value}, recorded {expected}"
              for index, (value, expected) in enumerate(zip(lane["state"], recorded["state"]))
              if not same(value, expected, scale)]
    for key, expected in recorded["observables"].items():
        if key not in lane["observables"]:
            found.append(f"there is no {key}")
        elif not same(lane["observables"][key], expected, max(1, abs(expected or 0))):
            found.append(f"{key} is {lane['observables'][key]}, recorded {expected}")
    return found


def main():
    geomint, reference = sys.argv[1:3]
    recorded = [json.loads(line) for line in open(reference, encoding="utf-8")]
    by_words = {}
    for lane in recorded:
        by_words.setdefault(lane["words"], []).append(lane)
    if "--record" in sys.argv:
        lanes = [lane for words in by_words for lane in run(geomint, words)]
        with open(reference, "w", encoding="utf-8") as out:
            out.writelines(json.dumps(lane) + "\n" for lane in lanes)
        return 0
    wrong = compared = 0
    for words, expected in by_words.items():
        lanes = run(geomint, words)
        if len(lanes) != len(expected):
            print(f"run {words}: {len(lanes)} lanes, recorded {len(expected)}")
            wrong += 1
            continue
        for lane, before in zip(lanes, expected):
            compared += 1
            found = differences(lane, before)
            wrong += bool(found)
            if found:
                print(f"run {words}: {lane['scheme']}: " + "; ".join(found[:5]))
    print(f"{compared} lanes compared, {wrong} differ")
    return 1 if wrong or compared < 60 else 0


sys.exit(main())
