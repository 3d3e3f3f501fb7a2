"""A WebSocket of simd, and its downloads, in the standard library of Python: what a library does in most languages.
Written from RFC 6455 and libweave/weave/wire/PROTOCOL.md alone."""

import base64
import hashlib
import http.client
import os
import socket
import ssl
import urllib.parse

from follow import need

TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


class Lost(Exception):
    """The connection is gone, and another may do."""


class Place:
    """Where the server is, and as whom it is spoken to."""

    def __init__(self, text, token, fingerprint):
        self.url, self.fingerprint = urllib.parse.urlsplit(text), fingerprint
        self.host = "localhost" if self.url.scheme == "unix" else self.url.netloc
        self.headers = {"Authorization": "Bearer " + token} if token else {}

    def connect(self):
        if self.url.scheme == "unix":
            connection = socket.socket(socket.AF_UNIX)
            connection.connect(self.url.path)
            return connection
        connection = socket.create_connection((self.url.hostname, self.url.port), 20)
        if self.url.scheme == "http":
            return connection
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname, context.verify_mode = False, ssl.CERT_NONE  # it is known by its fingerprint
        connection = context.wrap_socket(connection)
        seen = hashlib.sha256(connection.getpeercert(binary_form=True)).hexdigest()
        need(seen == self.fingerprint, "the server has another certificate, " + seen)
        return connection

    def download(self, path):
        connection = http.client.HTTPConnection(self.host)
        connection.sock = self.connect()
        connection.request("GET", path, headers=self.headers)
        answer = connection.getresponse()
        need(answer.status == 200, "%s brings %d" % (path, answer.status))
        return answer.read()


class WebSocket:
    """As much of RFC 6455 as a client needs."""

    def __init__(self, place):
        self.came, self.socket = bytearray(), place.connect()
        self.socket.settimeout(20)
        key = base64.b64encode(os.urandom(16)).decode()
        head = {"Host": place.host, "Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13",
                "Sec-WebSocket-Key": key, **place.headers}
        lines = ["GET /api/v1/wire HTTP/1.1"] + ["%s: %s" % field for field in head.items()]
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        while b"\r\n\r\n" not in self.came:
            self.read_on()
        status, *fields = self.take(self.came.index(b"\r\n\r\n") + 4).decode("latin-1").split("\r\n")
        if " 503 " in status:
            raise Lost(status)
        need(" 101 " in status, "the server answers " + status)
        accept = hashlib.sha1((key + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11").encode()).digest()
        need("sec-websocket-accept: " + base64.b64encode(accept).decode().lower() in map(str.lower, fields),
             "the server speaks no WebSocket")

    def read_on(self):
        data = self.socket.recv(1 << 16)
        if not data:
            raise Lost("the connection broke")
        self.came += data

    def take(self, count):
        silent = 0
        while len(self.came) < count:
            try:
                self.read_on()
            except TimeoutError:
                silent += 1
                if silent == 3:
                    raise Lost("the server is silent")
                self.send(PING, b"")  # says that we live, and asks whether the server does
        taken = bytes(self.came[:count])
        del self.came[:count]
        return taken

    def send(self, kind, payload):
        size, mask = len(payload), os.urandom(4)
        if size < 126:
            head = bytes([0x80 | kind, 0x80 | size])
        elif size < 1 << 16:
            head = bytes([0x80 | kind, 0x80 | 126]) + size.to_bytes(2, "big")
        else:
            head = bytes([0x80 | kind, 0x80 | 127]) + size.to_bytes(8, "big")
        self.socket.sendall(head + mask + bytes(byte ^ mask[k % 4] for k, byte in enumerate(payload)))

    def receive(self):
        """The next message: TEXT, BINARY or CLOSE, and its bytes. One may come in parts, with pings between them."""
        message_kind, message = None, b""
        while True:
            first, second = self.take(2)
            need(first & 0x70 == 0 and second < 0x80, "the server uses an extension or a mask")
            size = int.from_bytes(self.take(2 if second == 126 else 8), "big") if second >= 126 else second
            kind, payload = first & 15, self.take(size)
            if kind == PING:
                self.send(PONG, payload)
            elif kind == CLOSE:
                return CLOSE, payload
            elif kind != PONG:
                message_kind, message = message_kind or kind, message + payload
                if first & 0x80:
                    return message_kind, message
