#!/usr/bin/env python3
"""A whole client of simd in the standard library of Python, written from libweave/weave/wire/PROTOCOL.md alone.

    follow_live.py PLACE DESIGN.weave [--token-file FILE] [--fingerprint SHA256]

PLACE is unix:/path/of/socket, http://127.0.0.1:PORT or https://HOST:PORT, whose certificate has that fingerprint.
Relaxes the design in a session, with a connection cut in the middle, changes its warp, relaxes it again and ends the
session; then has a job relax it as it was. Prints what it saw as JSON. Ends with 1 and says why where that went wrong.
"""

import argparse
import collections
import hashlib
import json
import pathlib
import sys
import time
import uuid

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "wire"))
from follow import EVENTS, Broken, Follower, need  # reads frames, and holds events and frames to their order
from transport import BINARY, CLOSE, TEXT, Lost, Place, WebSocket

PATIENCE_S = 120  # without a connection
SIMULATION = {"plan": {"fidelity": "standard", "reduce": False, "held": [], "relaxing_N_per_mm": [None, None]},
              "solver": "relax"}
PARAMETERS = {"warp": {"strain": 1.02, "radius_scale": 1.1}, "weft": {}}


class Client(Follower):
    """Follows a session and jobs over as many connections as it takes."""

    def __init__(self, place):
        super().__init__()
        self.place, self.session, self.connections, self.closed, self.ended_jobs = place, None, 0, [], {}
        self.connect()

    def connect(self):
        self.socket = WebSocket(self.place)
        self.connections += 1
        self.send({"type": "hello", "versions": [1], "client": "follow_live.py"})
        self.welcome = self.receive()
        need(self.welcome["type"] == "welcome", "the server does not say welcome")
        if self.session:
            self.attach()

    def attach(self):
        self.ask_once({"type": "attach", "request": new_id(), "session": self.session, "seq": self.seq, "frame": self.frame})

    def connect_again(self):
        late = time.monotonic() + PATIENCE_S
        while True:
            try:
                return self.connect()
            except (Lost, OSError):
                need(time.monotonic() < late, "the server cannot be reached any more")
                time.sleep(0.2)

    def send(self, message):
        self.socket.send(TEXT, json.dumps(message).encode())

    def ask_once(self, message):
        self.send(message)
        while True:
            answer = self.receive()
            if answer.get("request") == message["request"] and answer["type"] not in EVENTS:
                need(answer["type"] != "refused", "refused: %s" % answer.get("error"))
                return answer

    def ask(self, message):
        """The answer. Where the connection breaks before it came, the message is sent again: its id makes that harmless."""
        message = {"request": new_id(), **message}
        while True:
            try:
                return self.ask_once(message)
            except (Lost, OSError):
                self.connect_again()

    def until(self, enough):
        while not enough():
            try:
                self.receive()
            except (Lost, OSError):
                self.connect_again()

    def receive(self):
        kind, payload = self.socket.receive()
        if kind == CLOSE:
            self.take_close(payload)
        if kind == BINARY:
            self.take_frame(payload)
            return {"type": "frame"}
        message = json.loads(payload)
        self.take_message(message)
        if message["type"] == "job_ended":
            self.ended_jobs[message["job"]] = message
        if message["type"] == "gap":
            need(message["first"] == self.frame + 1, "a gap does not begin behind the last frame")
        return message

    def take_event(self, message):
        super().take_event(message)
        self.send({"type": "acknowledge", "session": self.session, "seq": self.seq})

    def take_close(self, payload):
        self.closed.append(int.from_bytes(payload[:2], "big"))
        self.socket.send(CLOSE, payload)
        self.socket.socket.close()
        need(self.closed[-1] in (1000, 1001, 1011, 1013), "the server closes with %s" % payload)  # no others pass
        raise Lost("the server closes")

    def cut(self):
        self.socket.socket.close()

    def say_goodbye(self):
        self.socket.send(CLOSE, (1000).to_bytes(2, "big"))
        kind = None
        while kind != CLOSE:
            kind, payload = self.socket.receive()
        self.closed.append(int.from_bytes(payload[:2], "big"))


def new_id():
    return uuid.uuid4().hex


def said(client, kind, after=0):
    return [event for event in client.events if event["type"] == kind and event["seq"] > after]


def until_rest(client, after=0):
    """Waits until the cloth is at rest and shown so: the last frame may come before or after that event."""
    def is_at_rest():
        phases, frame = said(client, "phase", after), client.frames[-1]
        return phases and phases[-1]["phase"] == "at_rest" and frame["last"] and frame["step"] >= phases[-1]["step"]
    client.until(is_at_rest)
    shown = client.frames[-1]
    return {**{name: shown[name] for name in ("step", "residual", "size_mm", "layout")},
            "first_points_mm": [yarn[0] for yarn in shown["yarns"]]}


def follow_session(client, design):
    client.session = client.ask({"type": "create", "document": design, "simulation": SIMULATION})["session"]
    here = {"session": client.session}
    client.ask({"type": "run", **here})
    client.until(lambda: client.frames and client.frames[-1]["step"] > 0)

    # The connection breaks before an answer came: the next takes the session up, and the same message is done once.
    checkpoint, cut = {"type": "checkpoint", "request": new_id(), **here}, {"seq": client.seq, "frame": client.frame}
    client.send(checkpoint)
    client.cut()
    client.ask(checkpoint)
    rested = until_rest(client)
    client.until(lambda: said(client, "checkpointed"))  # may come after the answer: events go to the disk first
    written = [event for event in said(client, "checkpointed") if event.get("request") == checkpoint["request"]]
    need(len(written) == 1, "the checkpoint was written %d times" % len(written))

    change = {"type": "change", "request": new_id(), "parameters": PARAMETERS, **here}
    client.ask(change)
    client.until(lambda: said(client, "applied"))
    (applied,) = said(client, "applied")
    need(applied["request"] == change["request"] and "error" not in applied, "the change was not made: %s" % applied)
    changed = until_rest(client, applied["seq"])
    state = client.ask({"type": "read_state", **here})
    yarns = client.place.download("/api/v1/sessions/%d/yarns" % client.session)
    need(yarns.startswith(b"weave-yarns 1\n"), "these are no yarns")

    client.ask({"type": "close", **here})
    client.until(lambda: said(client, "ended"))
    (ended,) = said(client, "ended")
    return {"cut_at": cut, "rested": rested, "applied_at": applied["step"], "changed": changed, "state": state,
            "ended": {"why": ended["why"], "residual": ended["report"]["residual"]}}


def follow_job(client, design):
    job = client.ask({"type": "submit", "document": design, "simulation": SIMULATION, "flips": []})["job"]
    client.until(lambda: job in client.ended_jobs)
    ended = client.ended_jobs[job]
    need(ended["phase"] == "done", "the job is %s: %s" % (ended["phase"], ended.get("error")))
    yarns = client.place.download("/api/v1/jobs/%d/yarns" % job)
    need(hashlib.sha256(yarns).hexdigest() == ended["report"]["yarns_sha256"], "other yarns came than were reported")
    client.send({"type": "acknowledge_job", "job": job})
    left = client.ask({"type": "list_jobs"})["jobs"]
    need(job not in [one["job"] for one in left], "a job was acknowledged and is still there")
    return {"residual": ended["report"]["residual"], "steps": ended["report"]["iterations"]}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("place")
    parser.add_argument("design", type=pathlib.Path)
    parser.add_argument("--token-file", type=pathlib.Path)
    parser.add_argument("--fingerprint")
    words = parser.parse_args()
    token = words.token_file.read_text().strip() if words.token_file else None
    client, design = Client(Place(words.place, token, words.fingerprint)), words.design.read_text(encoding="utf-8")
    seen = {"person": client.welcome.get("person"), "session": follow_session(client, design)}
    seen["events"] = collections.Counter(event["type"] for event in client.events)
    seen["frames"] = {"came": len(client.frames), "missed": client.missed}
    client.session = None  # its end is acknowledged; the server closes, and jobs need no session
    client.until(lambda: client.closed)
    seen["job"] = follow_job(client, design)
    client.say_goodbye()
    json.dump({**seen, "connections": client.connections, "closed": client.closed}, sys.stdout)


if __name__ == "__main__":
    try:
        main()
    except (Broken, OSError) as error:
        sys.exit("follow_live.py: %s" % error)
