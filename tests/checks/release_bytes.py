"""Turns single bits over in a release for an EP loom of 2,688 hooks, and asks tools/read_release each time, as release_test runs it.

    python3 release_bytes.py FOLDER TRUST SCRATCH FINGERPRINT [OPTION...]     the options go to read_release
"""
import random
import shutil
import subprocess
import sys
from pathlib import Path

FOLDER, TRUST, SCRATCH = map(Path, sys.argv[1:4])
BAD, BAD_TRUST = SCRATCH / "turned", SCRATCH / "turned-trust.json"
FIRST_RECORD, FUNCTION_BYTES, RECORD, FIRST_BODY_HOOK = 34, 4, 4 + 2688 // 8, 144
CASES = 25


def damage(path, change):
    """A fresh copy of everything, with one file changed."""
    shutil.rmtree(BAD, ignore_errors=True)
    shutil.copytree(FOLDER, BAD)
    shutil.copy(TRUST, BAD_TRUST)
    data = bytearray(path.read_bytes())
    change(data)
    path.write_bytes(data)


def turn(at, bit):
    def change(data):
        data[at % len(data)] ^= 1 << bit
    return change


def expect(statuses, words, place):
    """Status 1 is for what was found, 3 for what cannot be read, and each comes with its words: no crash counts as found."""
    command = ["tools/read_release", BAD, "--trust", BAD_TRUST, "--fingerprint", *sys.argv[4:]]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    said = done.stdout + done.stderr
    told = {0: "all the same", 1: "WRONG  ", 3: "read_release: "}.get(done.returncode)
    if done.returncode not in statuses or words not in said or told not in said or "Traceback" in said or "Error" in said:
        sys.exit(f"{place}: ended with {done.returncode}, or does not say '{words}':\n{said}")


def main():
    ep = BAD / next(FOLDER.glob("*.ep")).name
    third = FIRST_RECORD + 2 * RECORD
    hook = FIRST_BODY_HOOK + 4
    damage(ep, lambda data: None)
    expect([0], "all the same", "nothing changed")
    damage(ep, turn(third + FUNCTION_BYTES + hook // 8, hook % 8))
    expect([1], "pick 3, end 5 is", "a hook")
    damage(ep, turn(third, 3))
    expect([1], "pick 3 takes the loom's feeder", "a feeder")
    damage(ep, turn(third + FUNCTION_BYTES, 0))
    expect([1], "hooks that carry no end", "a hook that is cast out")
    damage(ep, lambda data: data.pop())
    expect([1], "blocks, and has", "a byte less")
    seed = random.randrange(2**32)
    chance = random.Random(seed)
    files = sorted(BAD / entry.name for entry in FOLDER.iterdir()) + [BAD_TRUST]
    for _ in range(CASES):
        path, at, bit = chance.choice(files), chance.randrange(2**30), chance.randrange(8)
        damage(path, turn(at, bit))
        may = [1, 3] if path.suffix == ".json" else [1]
        expect(may, path.name, f"seed {seed}: {path.name}, byte {at}, bit {bit}")


main()
