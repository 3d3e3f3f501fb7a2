"""What tools/read_release says of releases that are signed as they should be and yet not as documented, and of files that are none.

    python3 release_forged.py FOLDER SCRATCH CARD DESIGN PROFILE     a release for an EP loom and what it is held to, as release_test has them

Each case has a manifest of its own, signed with keys that are made here: what it says counts, and has to be judged by itself.
"""
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

FOLDER, SCRATCH, CARD, DESIGN, PROFILE = map(Path, sys.argv[1:])
BAD, TRUST, GIVEN = SCRATCH / "forged", SCRATCH / "forged-trust.json", SCRATCH / "given"
EP, WIF = (next(FOLDER.glob(kind)).name for kind in ("*.ep", "*.wif"))
FIRST_RECORD, FUNCTION_BYTES, RECORD, SELVEDGE_HOOK = 34, 4, 4 + 2688 // 8, 60
PYTHONS_WORDS = re.compile(r"\w(Error|Exception)\b|codec|object has no|object is not|recursion|invalid literal|Expecting")  # no user reads those
HELD = ["--card", CARD, "--design", DESIGN, "--loom", PROFILE]
fails = 0


def canonical(value):
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False).encode()


def openssl(*words):
    return subprocess.run(["openssl", *words], check=True, capture_output=True).stdout


class Key:
    def __init__(self, role):
        self.file = SCRATCH / f"{role}.pem"
        openssl("genpkey", "-algorithm", "ed25519", "-out", self.file)
        self.public = openssl("pkey", "-in", self.file, "-pubout", "-outform", "DER")[-32:]
        self.id = hashlib.sha256(self.public).hexdigest()
        self.entry = {"id": self.id, "public": self.public.hex(), "person": role, "roles": [role]}

    def signed(self, domain, body):
        message = SCRATCH / "message"
        message.write_bytes(domain.encode() + b"\n" + canonical(body))
        value = openssl("pkeyutl", "-sign", "-rawin", "-inkey", self.file, "-in", message)
        return canonical({"body": body, "signatures": [{"key": self.id, "value": value.hex()}]})


ROOT, RELEASE = Key("root"), Key("release")
TRUST_BODY = {"format": "weave-trust", "version": 1, "number": 1, "site": "mill", "issued": "2026-11-28T09:00:00.000Z",
              "keys": [ROOT.entry, RELEASE.entry], "thresholds": {"root": 1, "release": 1}}


def trusted(body):
    TRUST.write_bytes(ROOT.signed("weave trust document v1", body))
    return hashlib.sha256(canonical(body)).hexdigest()


def expect(status, words, place, *options, fingerprint=None, never=""):
    global fails
    command = ["tools/read_release", BAD, "--trust", TRUST, "--fingerprint", fingerprint or FINGERPRINT, *options]
    done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
    said = done.stdout + done.stderr
    if done.returncode != status or words not in said or "Traceback" in said or PYTHONS_WORDS.search(said) or (never and never in said) or len(done.stderr.splitlines()) > 1:
        print(f"{place}: ended with {done.returncode}, not {status}, does not say '{words}', or says '{never}':\n{said}")
        fails += 1


def body_of(folder):
    return json.loads((folder / "manifest.json").read_bytes())["body"]


def forge(change=lambda body: None, change_ep=lambda data: None):
    """A release of which the manifest, and the bytes of the EP file, say something else; sizes, hashes and signatures fit."""
    shutil.rmtree(BAD, ignore_errors=True)
    shutil.copytree(FOLDER, BAD)
    data, body = bytearray((BAD / EP).read_bytes()), body_of(FOLDER)
    change_ep(data)
    (BAD / EP).write_bytes(data)
    next(entry for entry in body["files"] if entry["path"] == EP)["sha256"] = hashlib.sha256(data).hexdigest()
    change(body)
    for stranger in set(os.listdir(BAD)) - {entry["path"] for entry in body["files"]}:
        (BAD / stranger).unlink()
    (BAD / "manifest.json").write_bytes(RELEASE.signed("weave release manifest v1", body))


def keep(*formats):
    def change(body):
        body["files"] = [entry for entry in body["files"] if entry["format"] in formats]
    return change


def documents():
    """Manifests and trust documents that are not as FORMAT.md has them."""
    for words, change in (
            ("body.format", {"format": "weave-trust"}), ("body.version", {"version": 2}), ("body.version", {"version": True}),
            ("unknown member more", {"more": 1}), ("body.loom", {"loom": "EP\n1"}), ("body.loom", {"loom": ""}), ("body.picks", {"picks": 0}),
            ("body.files is no list", {"files": {}}), ("body.reading", {"reading": []}), ("body.card_sha256", {"card_sha256": "A" * 64})):
        forge(lambda body, change=change: body.update(change))
        expect(3, words, f"manifest with {change}")
    forge(lambda body: body.update(picks=10**9, ends=10**9))
    expect(3, "larger than this program holds", "a cloth without end")
    for name in ("../x.ep", "CON.ep", ".x", "x.", "manifest.json"):
        forge(lambda body, name=name: body["files"][0].update(path=name))
        expect(3, "body.files[0].path", f"file with the name {name}")
    forge()
    for words, change in (("body.version", {"version": 2}), ("body.format", {"format": "weave-release"}), ("unknown member", {"x": 1})):
        expect(3, words, f"trust with {change}", fingerprint=trusted(TRUST_BODY | change))
    trusted(TRUST_BODY)
    TRUST.write_bytes(TRUST.read_bytes() + b" ")
    expect(1, "its bytes are not the canonical ones", "a blank in the trust document")
    trusted(TRUST_BODY)
    for path, whole in ((BAD / "manifest.json", (BAD / "manifest.json").read_bytes()), (TRUST, TRUST.read_bytes())):
        for words in (b"", b"[]", b"{", b"\xff\xfe", b'{"body":1e999,"signatures":[]}', b'{"body":NaN,"signatures":[]}', b"[" * 100000,
                      b'{"body":' * 5000 + b"1" + b"}" * 5000, b" " * (2 << 20), b'{"body":' + b"9" * 5000 + b"}"):
            path.write_bytes(words)
            expect(3, path.name, f"{path.name} of {words[:20]}")
        path.write_bytes(whole)
    trusted(TRUST_BODY)


def what_is_compared():
    forge()
    expect(0, "all the same", "nothing changed", *HELD)
    expect(0, "168 selvedge hooks rise as", "the selvedge", *HELD)
    expect(0, "cannot be seen from the files", "the word about recalls", *HELD)
    expect(0, "all the same", "fingerprint in capitals", *HELD, fingerprint=f" {FINGERPRINT.upper()} ")
    expect(1, "is not the trust document", "another fingerprint", fingerprint="0" * 64, never="signed by")
    forge(keep())
    expect(3, "no card in any file", "no files", never="all the same")
    forge(keep("pick-table-csv"))
    expect(3, "no card in any file", "the pick table alone", *HELD, never="all the same")
    forge(keep("wif", "pick-table-csv"))
    expect(0, "the wefts were not compared", "one source of wefts", never="all the same")
    expect(0, "all the same", "one source of wefts, and the design", *HELD)
    for kind in ("jc5", "raw", "bmp"):
        forge(lambda body, kind=kind: body["files"][0].update(format=kind))
        expect(3, f"NOT READ: this program reads no {kind}", kind, never="all the same")


def unsigned():
    """The files fit a manifest that too few signed: of the card they make it is not said that it was signed."""
    short = TRUST_BODY | {"thresholds": {"root": 1, "release": 2}}
    for told, body in (("1 of 2 people have signed it", short), ("has no right to it", TRUST_BODY | {"keys": [ROOT.entry]}),
                       ("is of the site mill, not other", TRUST_BODY | {"site": "other"})):
        forge()
        for words in (told, "and the card that the manifest names, which is not signed as it has to be"):
            expect(1, words, f"not signed: {told}", *HELD, fingerprint=trusted(body), never="the signed card")
    trusted(TRUST_BODY)
    expect(0, "and the signed card", "signed as it has to be", *HELD, never="the manifest names")


def hooks():
    """The layout that the manifest tells, held to the profile, and hooks that are no end's."""
    def turn(data):
        data[FIRST_RECORD + 2 * RECORD + FUNCTION_BYTES + SELVEDGE_HOOK // 8] ^= 1 << SELVEDGE_HOOK % 8
    forge(change_ep=turn)
    expect(1, "hooks that carry no end", "a hook of the selvedge", *HELD)
    expect(0, "selvedge hooks were not looked at", "a hook of the selvedge, without the profile")
    for member, value in (("selvedge", [[56, 139]]), ("constant_on", [[54, 54]]), ("body", [[145, 2543]]), ("cast_out", []), ("count", 2687)):
        forge(lambda body, member=member, value=value: body["reading"]["hooks"].update({member: value}))
        expect(1, f"reading.hooks.{member} is not what", f"hooks.{member}", *HELD)
        expect(1, "WRONG  " + EP, f"hooks.{member}, without the profile")
    forge(lambda body: body["reading"]["hooks"].update(body=[[0, 10**12]]))
    expect(1, "ranges of hooks", "hooks without end")
    forge(lambda body: body["reading"]["feeders"].update(places=[1, 0, 2, 3, 4, 5]))
    expect(1, "reading.feeders.places is not what", "places of feeders", *HELD)
    expect(1, "takes the loom's feeder", "places of feeders, without the profile")
    forge(lambda body: body["reading"]["files"][EP]["reading"].update(record_order="last woven first"))
    expect(1, "record_order is not what", "order of records", *HELD)
    expect(3, "NOT READ: its hooks", "order of records, without the profile", never="all the same")
    forge(lambda body: body["reading"].pop("hooks"))
    expect(1, "WRONG  " + EP, "no hooks")
    expect(3, PROFILE.name, "no hooks, and the profile", *HELD)


def folders():
    for path, target in ((EP, FOLDER / EP), (WIF, FOLDER / WIF), ("manifest.json", SCRATCH / "linked")):
        forge()
        shutil.copy(BAD / "manifest.json", SCRATCH / "linked")
        (BAD / path).unlink()
        (BAD / path).symlink_to(target)
        expect(1, f"{path}: is no plain file", f"a link in place of {path}", *HELD, never="all the same")
    forge()
    (BAD / WIF).unlink()
    (BAD / WIF).mkdir()
    expect(1, f"{WIF}: is no plain file", "a folder in place of a file", *HELD)
    forge()
    (BAD / os.fsdecode(b"a\xff\x1b[2J")).touch()
    expect(1, "is no file of this release", "a stranger whose name is no text", never="\x1b")


def given():
    """Files that are given beside the release."""
    forge()
    card = CARD.read_bytes()
    for size in (0, 7, 8, 20, 40, len(card) // 2, len(card) - 13, len(card) - 1):
        GIVEN.write_bytes(card[:size])
        expect(3, GIVEN.name, f"a card of {size} bytes", "--card", GIVEN)
    design = json.loads(DESIGN.read_bytes())
    for order in (7, None, ["1"], "1 x", "9", "1*x", "1*99999999999999999999999", "*"):
        GIVEN.write_bytes(canonical(design | {"weft": design["weft"] | {"feeder_order": order}}))
        expect(3, GIVEN.name, f"a design with the wefts {order}", "--design", GIVEN)
    for option in ("--design", "--loom"):
        for words in (b"", b"[]", b"7", b"null", b'{"weft":1e999}', b'{"weft":-Infinity}', b"[" * 100000, b"\xff", b'"\\ud800"'):
            GIVEN.write_bytes(words)
            expect(3, GIVEN.name, f"{option} of {words[:20]}", option, GIVEN)
    for option in ("--card", "--design", "--loom"):
        expect(3, SCRATCH.name, f"a folder for {option}", option, SCRATCH)
        expect(3, "No such file", f"nothing for {option}", option, SCRATCH / "nowhere")
    profile = json.loads(PROFILE.read_bytes())
    for change in ({"feeders": profile["feeders"] | {"count": 10**12}}, {"hooks": profile["hooks"] | {"areas": [{"name": "hooks", "hooks": 10**12}]}}):
        GIVEN.write_bytes(canonical(profile | change))
        forge(lambda body: body["profile"].update(sha256=hashlib.sha256(GIVEN.read_bytes()).hexdigest()))
        expect(3, f"{GIVEN.name}: has more hooks or feeders", "a loom without end", "--loom", GIVEN)
    forge()
    GIVEN.write_bytes(canonical(profile | {"notes": ""}))
    expect(1, "is not the profile", "another profile", "--loom", GIVEN)


FINGERPRINT = trusted(TRUST_BODY)
for part in (documents, what_is_compared, unsigned, hooks, folders, given):
    part()
sys.exit(1 if fails else 0)
