#!/usr/bin/env python3
"""Follows a recorded session of simd, written from libweave/weave/wire/PROTOCOL.md alone.

    follow.py RECORDING

A recording holds what one connection brought: for each message `t` (text) or `b` (binary), its length as u32, its bytes.
Prints what was seen as JSON: the numbers of every frame, every event, and what a client has to send. Ends with 1 and says
why where the server broke a rule of the protocol.
"""

import json
import struct
import sys


class Broken(Exception):
    """What came is not as the protocol says."""


def need(holds, why):
    if not holds:
        raise Broken(why)


class Bytes:
    """The bytes of a frame, read from the front."""

    def __init__(self, data):
        self.data, self.at = data, 0

    def varint(self):
        value = 0
        for k in range(7):
            need(self.at < len(self.data), "the frame ends within a number")
            byte = self.data[self.at]
            self.at += 1
            value |= (byte & 0x7F) << (7 * k)
            if byte < 0x80:
                need(byte != 0 or k == 0, "a number has more bytes than it needs")
                return value
        raise Broken("a number is longer than 7 bytes")

    def signed(self):
        value = self.varint()
        return value // 2 if value % 2 == 0 else -(value + 1) // 2


HEAD = struct.Struct("<4sHHQQQddddIIII")


def read_yarn(data, quantum, room):
    count = data.varint()
    need(1 <= count <= room, "a yarn has more points than are left")
    quanta = []
    for k in range(count):
        point = []
        for axis in range(3):
            if k == 0:
                expected = 0
            elif k == 1:
                expected = quanta[0][axis]
            else:
                expected = 2 * quanta[k - 1][axis] - quanta[k - 2][axis]
            point.append(expected + data.signed())
        need(all(abs(q) < 1 << 46 for q in point), "a place is too far away")
        quanta.append(point)
    return [[q * quantum for q in point] for point in quanta]


def read_frame(data):
    need(len(data) >= HEAD.size, "a frame is shorter than its head")
    (magic, version, flags, session, number, step, residual, quantum, size_x, size_y, layout, lost, yarns,
     points) = HEAD.unpack_from(data)
    need(magic == b"WVFR", "this is no frame")
    need(version == 1, "frames of version %d are not known" % version)
    need(flags < 16, "a frame has flags that are not known")
    rest = Bytes(data)
    rest.at = HEAD.size
    cloth, left = [], points
    for _ in range(yarns):
        cloth.append(read_yarn(rest, quantum, left))
        left -= len(cloth[-1])
    need(left == 0, "a frame has fewer points than it counts")
    need(rest.at == len(data), "a frame has bytes behind its last yarn")
    return {"session": session, "frame": number, "step": step, "residual": residual, "quantum_mm": quantum,
            "size_mm": [size_x, size_y], "layout": layout, "lost_crossings": None if lost == 0xFFFFFFFF else lost,
            "at_rest": bool(flags & 1), "last": bool(flags & 2), "coarse": bool(flags & 4),
            "flipping": bool(flags & 8), "yarns": cloth}


EVENTS = {"layout", "phase", "applied", "flipped", "checkpointed", "recovered", "ended"}
OTHERS = {"welcome", "unsupported", "accepted", "refused", "state", "jobs", "sessions", "job", "job_ended", "gap"}


class Follower:
    """Holds what is told of one session to its order: every event once, frames that rise and are as their layout says."""

    def __init__(self):
        self.frames, self.events, self.layouts = [], [], {}
        self.seq = self.frame = self.missed = 0

    def take_message(self, message):
        need(message["type"] in EVENTS | OTHERS, "there is no message " + message["type"])
        if message["type"] in EVENTS:
            self.take_event(message)

    def take_event(self, message):
        need(message["seq"] == self.seq + 1, "event %d does not come after %d" % (message["seq"], self.seq))
        self.seq = message["seq"]
        self.events.append(message)
        if message["type"] == "layout":
            self.layouts[message["layout"]] = [yarn["points"] for yarn in message["yarns"]]

    def take_frame(self, data):
        frame = read_frame(data)
        need(frame["frame"] > self.frame, "frames do not rise")
        need(frame["layout"] in self.layouts, "a frame has a layout that was not told")
        need([len(yarn) for yarn in frame["yarns"]] == self.layouts[frame["layout"]], "a frame is not as its layout says")
        self.missed += frame["frame"] - self.frame - 1
        self.frame = frame["frame"]
        self.frames.append(frame)


class Listener(Follower):
    """A client that attaches to session 7, of which it has nothing yet and nobody acknowledged anything, and listens."""

    def __init__(self):
        super().__init__()
        self.sent = [{"type": "hello", "versions": [1], "client": "follow.py"}]

    def take_message(self, message):
        super().take_message(message)
        if message["type"] == "welcome":
            need(message["version"] == 1, "another version was agreed on")
            self.sent.append({"type": "attach", "request": "follow-1", "session": 7, "seq": 0, "frame": 0})

    def take_event(self, message):
        super().take_event(message)
        self.sent.append({"type": "acknowledge", "session": message["session"], "seq": self.seq})


def follow(recording):
    listener, at = Listener(), 0
    while at < len(recording):
        need(len(recording) >= at + 5, "the recording ends within a message")
        kind, (length,) = recording[at:at + 1], struct.unpack_from("<I", recording, at + 1)
        payload = recording[at + 5:at + 5 + length]
        need(len(payload) == length, "the recording ends within a message")
        at += 5 + length
        if kind == b"t":
            listener.take_message(json.loads(payload.decode("utf-8")))
        else:
            listener.take_frame(payload)
    return {"frames": listener.frames, "events": listener.events, "missed": listener.missed,
            "sent": [json.dumps(message) for message in listener.sent]}


if __name__ == "__main__":
    try:
        with open(sys.argv[1], "rb") as file:
            json.dump(follow(file.read()), sys.stdout)
    except Broken as broken:
        sys.exit("follow.py: " + str(broken))
