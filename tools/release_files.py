"""Makes cards and wefts of the files of a release by their written formats alone: EP, TIFF, PNG, WIF and the pick table (for read_release).

A card is a list of picks, pick 1 first, each a list of ends, end 1 first: True where the end is lifted.
The orders of the wefts are lists of picks, each a list of the loom's feeders. The formats: loomlink/export/README.md and
libweave/weave/io/CONTROLLER_FILES.md.
"""
import csv
import itertools
import struct
import zlib


class Unreadable(Exception):
    """A file that is not what its format says."""


class NotRead(Exception):
    """A file in a format, or laid out in a way, that this program does not know."""


def expect(is_so, message):
    if not is_so:
        raise Unreadable(message)


def bits(data, count, least_first):
    return [bool(data[k >> 3] >> (k & 7 if least_first else 7 - (k & 7)) & 1) for k in range(count)]


MOST_HOOKS = 65536
MOST_CROSSINGS = 1 << 28  # of a card; some bytes each in memory


def hooks_in(ranges):
    expect(all(0 <= first <= last < MOST_HOOKS for first, last in ranges), "has ranges of hooks in its manifest that are none")
    return [hook for first, last in ranges for hook in range(first, last + 1)]


def lies_as_known(hooks, reading, manifest):
    """Whether an EP file is laid out as this program knows it: one run of body hooks that carry the cloth once, and a function bit a feeder."""
    return (reading["hook_places"] == "as counted" and reading["lead_in_picks"] == 0 and hooks["rule"] == "straight" and len(hooks["body"]) == 1
            and reading["bit_order"] == "least significant bit first" and reading["record_order"] == "as woven" and reading["selected_function_bit"] == 1
            and len(hooks["areas"]) == 1 and hooks["areas"][0]["hooks"] == hooks["count"] and hooks["regulator"] == hooks["feeders"] == []
            and manifest["reading"]["feeders"]["encoding"] == "one-hot" and manifest["reading"]["repeats"] == {"across": 1, "along": 1})


def rises_and_rests(lifted, hooks, selvedge, pick):
    """How many hooks that carry no end do otherwise than they should; those of the selvedge are known by the profile alone."""
    wanted = {hook: False for hook in hooks_in(hooks["cast_out"])} | {hook: True for hook in hooks_in(hooks["constant_on"])}
    if selvedge:
        row = selvedge[pick % len(selvedge)]
        wanted |= {hook: row[place % len(row)] == "1" for place, hook in enumerate(hooks_in(hooks["selvedge"]))}
    return sum(lifted[hook] != rises for hook, rises in wanted.items())


def ep(data, manifest, path, faults, selvedge):
    """Card and feeders of an EP file: 34 bytes in front, records of function bytes and hooks, FF and zeros behind."""
    reading, hooks = manifest["reading"]["files"][path]["reading"], manifest["reading"]["hooks"]
    expect(len(data) > 34, "is cut off")
    blocks, _, picks, _, name = struct.unpack_from("<HBHB8s", data)
    function_bytes, count = data[15], struct.unpack_from("<H", data, 32)[0]
    record = function_bytes + (count + 7) // 8
    end = 34 + picks * record
    expect(picks == manifest["picks"] and count == hooks["count"] and function_bytes == reading["function_bytes"],
           f"says {picks} picks, {count} hooks and {function_bytes} function bytes")
    expect(blocks == -(-(32 + picks * record) // 4096) and len(data) == 1024 + 4096 * blocks, f"says {blocks} blocks, and has {len(data)} bytes")
    expect(data[2] == data[5] == data[14] == 0 and data[16:32] == bytes(15) + b"\x12", "bytes of unknown meaning are not as in the files that were seen")
    expect(data[end:2 + 4096 * blocks].strip(b"\xff") == b"" and data[2 + 4096 * blocks:] == bytes(1022), "what fills it up is not FF and zeros")
    expect(name.rstrip(b"\0 ").decode("ascii") == manifest["reading"]["files"][path]["name_in_file"], "has another name in it")
    if not lies_as_known(hooks, reading, manifest):
        raise NotRead("its hooks are laid out in a way that this program does not know")
    first, last = hooks["body"][0]
    ends, places = manifest["ends"], manifest["reading"]["feeders"]["places"]
    forward, uses = hooks["end_1_at_first_body_hook"], ("body", "selvedge", "constant_on", "cast_out")
    at_ends = range(first, first + ends) if forward else range(last, last - ends, -1)
    expect(sorted(hook for use in uses for hook in hooks_in(hooks[use])) == list(range(count)), "has hooks of no use, or of two, in its manifest")
    expect(ends <= last + 1 - first and reading["end_1_hooks"] == [at_ends[0]], "has another hook for end 1 than its body hooks say")
    expect({reading["lifted_hook_bit"], reading["down_hook_bit"]} == {0, 1} and reading["cast_out_hook_bit"] == reading["down_hook_bit"],
           "has bits for lifted, down and cast-out hooks that do not fit together")
    spare = set(range(first, last + 1)) - set(at_ends)
    card, feeders, odd = [], [], 0
    for pick in range(picks):
        at = 34 + pick * record
        function = bits(data[at:at + function_bytes], 8 * function_bytes, True)
        lifted = [bit == bool(reading["lifted_hook_bit"]) for bit in bits(data[at + function_bytes:at + record], count, True)]
        feeders.append([feeder + 1 for feeder, place in enumerate(places) if function[place]])
        card.append([lifted[hook] for hook in at_ends])
        odd += rises_and_rests(lifted, hooks, selvedge, pick) + sum(lifted[hook] for hook in spare)
        odd += sum(bit for place, bit in enumerate(function) if place not in places)
    if odd:
        faults(path, f"hooks that carry no end, or function bits of no feeder, do otherwise than they should, {odd} times")
    elif hooks["selvedge"] and selvedge:
        print(f"{path}: its {len(hooks_in(hooks['selvedge']))} selvedge hooks rise as the loom's profile says")
    if hooks["selvedge"] and not selvedge:
        print(f"{path}: its {len(hooks_in(hooks['selvedge']))} selvedge hooks were not looked at: --loom tells their weave")
    return card, feeders


def expect_upright(manifest, path):
    """Pictures are known as the ones of the shipped looms lie."""
    reading = manifest["reading"]["files"][path]["reading"]
    if [reading[member] for member in ("lifted_end", "pick_1", "end_1")] != ["black", "bottom row", "left column"]:
        raise NotRead("its picture lies in a way that this program does not know")


def tiff(data, manifest, path, *_):
    """A bilevel TIFF as the TC2 takes it: little-endian, uncompressed, white is zero, pick 1 at the bottom."""
    expect_upright(manifest, path)
    expect(data[:4] == b"II*\0", "is no little-endian TIFF")
    at = struct.unpack_from("<I", data, 4)[0]
    values = {}
    for k in range(struct.unpack_from("<H", data, at)[0]):
        tag, kind, count = struct.unpack_from("<HHI", data, at + 2 + 12 * k)
        if count == 1:
            values[tag] = struct.unpack_from("<H" if kind == 3 else "<I", data, at + 10 + 12 * k)[0]
    width, height = values[256], values[257]
    said = [values.get(tag, usual) for tag, usual in ((258, 1), (259, 1), (262, -1), (274, 1), (277, 1))]
    expect(said == [1, 1, 0, 1, 1] and 273 in values, "is no bilevel, uncompressed TIFF in one strip with white as zero")
    row = (width + 7) // 8
    expect(values[273] + row * height <= len(data), "is cut off")
    rows = [bits(data[values[273] + k * row:], width, False) for k in range(height)]
    return rows[::-1], None


def unfiltered(raw, height, row):
    """The rows of a PNG without its filters; one byte or less a pixel, so the neighbour to the left is one byte away."""
    before, rows = bytes(row), []
    for k in range(height):
        kind, line = raw[k * (row + 1)], bytearray(raw[k * (row + 1) + 1:(k + 1) * (row + 1)])
        for x in range(row):
            left, up, corner = (line[x - 1] if x else 0), before[x], (before[x - 1] if x else 0)
            near = left + up - corner
            paeth = min((left, up, corner), key=lambda value: abs(near - value))
            line[x] = (line[x] + (0, left, up, (left + up) // 2, paeth)[kind]) & 255
        before = bytes(line)
        rows.append(before)
    return rows


def png(data, manifest, path, *_):
    expect_upright(manifest, path)
    return pixels_of_png(data), None


def pixels_of_png(data):
    """A PNG of two colours in grey levels or by a palette: black is lifted, pick 1 at the bottom."""
    expect(data[:8] == b"\x89PNG\r\n\x1a\n", "is no PNG")
    parts, at = {}, 8
    while b"IEND" not in parts:
        expect(at + 12 <= len(data), "is cut off")
        size, kind = struct.unpack_from(">I4s", data, at)
        expect(at + 12 + size <= len(data), "is cut off")
        content = data[at + 8:at + 8 + size]
        expect(zlib.crc32(kind + content) == struct.unpack_from(">I", data, at + 8 + size)[0], f"its part {kind.decode('latin-1')} is damaged")
        parts[kind] = parts.get(kind, b"") + content
        at += 12 + size
    width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", parts[b"IHDR"])
    expect(colour in (0, 3) and depth <= 8 and not interlaced, "is no plain picture of grey levels or a palette")
    row = (width * depth + 7) // 8
    whole = height * (row + 1)
    expect(width * height <= MOST_CROSSINGS, "is larger than this program holds")
    raw = zlib.decompressobj().decompress(parts[b"IDAT"], whole + 1) if whole else b""
    expect(len(raw) == whole and whole > 0, f"has not the pixels of {width} x {height}")
    rows = unfiltered(raw, height, row)
    most = (1 << depth) - 1
    is_black = [False] * (most + 1)
    for value in range(most + 1):
        entry = parts.get(b"PLTE", b"")[3 * value:3 * value + 3]
        is_black[value] = value == 0 if colour == 0 else entry == bytes(3)
    pixel = lambda line, x: line[x * depth >> 3] >> (8 - depth - (x * depth & 7)) & most
    return [[is_black[pixel(line, x)] for x in range(width)] for line in reversed(rows)]


def wif(data, manifest, *_):
    """Threading and lift plan of a WIF with a rising shed: the shafts of a pick lift the ends that are threaded on them."""
    sections, name = {}, ""
    for line in data.decode().splitlines():
        if line.startswith("["):
            name = line.strip("[] ").upper()
        elif "=" in line and not line.startswith(";"):
            key, value = line.split("=", 1)
            sections.setdefault(name, {})[key.strip().upper()] = value.strip()
    ends, picks = int(sections["WARP"]["THREADS"]), int(sections["WEFT"]["THREADS"])
    expect((picks, ends) == (manifest["picks"], manifest["ends"]), f"has {picks} picks and {ends} ends, the manifest says {manifest['picks']} and {manifest['ends']}")
    shafts = [int(sections["THREADING"][str(end + 1)]) for end in range(ends)]
    card = []
    for pick in range(picks):
        lifted = {int(shaft) for shaft in sections["LIFTPLAN"].get(str(pick + 1), "").split(",") if shaft}
        card.append([shaft in lifted for shaft in shafts])
    return card, None


def pick_table(data, *_):
    rows = list(csv.DictReader(data.decode().splitlines()))
    expect([int(row["pick"]) for row in rows] == list(range(1, len(rows) + 1)), "its picks do not count from 1")
    return None, [[int(feeder) for feeder in row["loom feeder"].split("+") if feeder.strip()] for row in rows]


READERS = {"ep": ep, "tiff": tiff, "png": png, "wif": wif, "pick-table-csv": pick_table}
