"""Looks at the picture that tools/read_release drew of what it read, as release_test runs it; or turns over what a picture has to ring.

    python3 release_drawn.py PICTURE CARD whole|ringed
    python3 release_drawn.py --turn FILE.ep
"""
import sys
import zlib
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, "tools")
from release_files import pixels_of_png

if sys.argv[1] == "--turn":
    path = Path(sys.argv[2])
    data = bytearray(path.read_bytes())
    data[34 + 2 * (4 + 2688 // 8) + 4 + 144 // 8 + 2] ^= 1  # pick 3, end 17
    path.write_bytes(data)
    sys.exit()

RED, GAP = 2, 16
data = Path(sys.argv[1]).read_bytes()
drawn = pixels_of_png(data)[::-1]  # from the top
card = pixels_of_png(Path(sys.argv[2]).read_bytes())
high, wide = len(card), len(card[0])
at = data.index(b"IDAT")
raw = zlib.decompress(data[at + 4:at + 4 + int.from_bytes(data[at - 4:at], "big")])
rings = raw.count(RED)
panels = [[row[x:x + wide] for row in drawn[y:y + high]][::-1] for y in range(0, len(drawn), high + GAP) for x in (0, wide + GAP)]
if len(drawn[0]) != 2 * wide + GAP or len(drawn) != 2 * high + GAP:  # the design's card, and those of the controller file, the picture and the WIF
    sys.exit(f"the picture is {len(drawn[0])} x {len(drawn)} pixels, which is not four cards of {wide} x {high}")
if panels[0] != card:
    sys.exit("what stands first is not the card of the design")
if sys.argv[3] == "whole" and (rings or any(panel != card for panel in panels)):
    sys.exit("cards that are the same are not drawn so")
if sys.argv[3] == "ringed" and (not rings or [panel != card for panel in panels].count(True) != 1):
    sys.exit("not one card alone has a ring")
