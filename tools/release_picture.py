"""Draws cards beside one another, and rings what is wrong in them (for read_release)."""
import itertools
import os
import struct
import tempfile
import zlib
from pathlib import Path

WHITE, BLACK, RED, BESIDE = range(4)
COLOURS = bytes((255, 255, 255, 0, 0, 0, 200, 30, 30, 214, 206, 190))
GAP = 16  # pixels between two cards
NEAR, FAR = 7, 9  # a ring lies so far from the crossing in its middle
MOST_RINGED = 100


def panel(card, places):
    """A card as rows of pixels, pick 1 at the bottom, with a ring round each of these crossings."""
    rows = [bytearray(BLACK if lifted else WHITE for lifted in pick) for pick in card]
    for pick, end in places[:MOST_RINGED]:
        for y in range(max(0, pick - FAR), min(len(rows), pick + FAR + 1)):
            for x in range(max(0, end - FAR), min(len(rows[y]), end + FAR + 1)):
                if max(abs(y - pick), abs(x - end)) >= NEAR:
                    rows[y][x] = RED
    return rows[::-1]


def part(kind, content):
    return struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))


def png(rows):
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 3, 0, 0, 0)
    raw = b"".join(b"\0" + row for row in rows)
    return b"\x89PNG\r\n\x1a\n" + part(b"IHDR", header) + part(b"PLTE", COLOURS) + part(b"IDAT", zlib.compress(raw)) + part(b"IEND", b"")


def beside(panels):
    """The rows of two panels, or of one, with a gap between them; what has nothing in it is of the gap's colour."""
    for y in range(max(map(len, panels))):
        yield (bytes([BESIDE]) * GAP).join(one[y] if y < len(one) else bytes([BESIDE]) * len(one[0]) for one in panels)


def draw(path, cards):
    """Cards, each with the places that are wrong in it, as a PNG: two beside one another, and the next two below. The file appears whole or not at all."""
    panels = [panel(card, places) for card, places in cards]
    rows = [row for k in range(0, len(panels), 2) for row in itertools.chain([b""] * (GAP if k else 0), beside(panels[k:k + 2]))]
    width = max(map(len, rows))
    with tempfile.TemporaryDirectory(dir=path.parent) as folder:
        made = Path(folder, "picture.png")
        made.write_bytes(png([row + bytes([BESIDE]) * (width - len(row)) for row in rows]))
        os.replace(made, path)
