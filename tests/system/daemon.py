"""The real cupolad with real sockets, for tests: a show in a folder of its own, a socket where systemd would
listen, and HTTP. Standard library only."""
import http.client
import json
import os
import select
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import time
import zlib
from pathlib import Path

PATIENCE = 60  # seconds until something that should happen is given up; never a measure


def free_port(kind=socket.SOCK_STREAM):
    with socket.socket(socket.AF_INET, kind) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def small_show(**changes):
    """A lettered room, drawn by both methods on two small headless outputs; the camera stands still."""
    show = {
        "version": 1,
        "name": "test",
        "frame_rate": 30,
        "scene": {"content": {"kind": "room", "size": 8}},
        "camera": {"position": [0, 0, 0]},
        "projections": {
            "flat": {"kind": "perspective", "horizontal_fov": 80},
            "dome": {"kind": "fisheye", "fov": 180},
        },
        "outputs": {
            "front": {"kind": "headless", "width": 160, "height": 120,
                      "viewports": {"all": {"projection": "flat", "method": "piecewise"}}},
            "dome": {"kind": "headless", "width": 96, "height": 96,
                     "viewports": {"all": {"projection": "dome", "method": "cubemap"}}},
        },
    }
    show.update(changes)
    return show


class NotifySocket:
    """Where systemd would listen; keeps all that came, with the time of its coming."""

    def __init__(self, folder):
        self.path = str(Path(folder) / "notify")
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.bind(self.path)
        self.messages = []
        self.arrived = threading.Condition()
        self.closed = False
        self.thread = threading.Thread(target=self._listen, daemon=True)
        self.thread.start()

    def _listen(self):
        while not self.closed:
            if select.select([self.socket], [], [], 0.1)[0]:
                text = self.socket.recv(65536).decode()
                with self.arrived:
                    for line in text.splitlines():
                        self.messages.append((time.monotonic(), line))
                    self.arrived.notify_all()

    def lines(self):
        with self.arrived:
            return [line for _, line in self.messages]

    def mark(self):
        with self.arrived:
            return len(self.messages)

    def wait(self, wanted, since=0, alive=lambda: True):
        """The index after the first line from `since` on that equals (or fulfils) `wanted`."""
        fits = wanted if callable(wanted) else lambda line: line == wanted
        give_up = time.monotonic() + PATIENCE
        with self.arrived:
            while True:
                for index in range(since, len(self.messages)):
                    if fits(self.messages[index][1]):
                        return index + 1
                if time.monotonic() > give_up or not alive():
                    raise AssertionError(f"waited in vain for {wanted}; came: {[m for _, m in self.messages[since:]]}")
                self.arrived.wait(0.2)

    def close(self):
        self.closed = True
        self.thread.join()
        self.socket.close()


class Daemon:
    """`with Daemon(binary, show) as daemon:` runs until the block ends. `show`: a document, or text."""

    def __init__(self, binary, show, arguments=(), environment=None, watchdog_seconds=None, wait=True):
        self.binary = str(Path(binary).resolve())  # it runs in a folder of its own
        self.folder_owner = tempfile.TemporaryDirectory(prefix="cupola-")
        self.folder = Path(self.folder_owner.name)
        self.port = free_port()
        self.osc_port = free_port(socket.SOCK_DGRAM)
        self.show_file = self.folder / "show.json"
        self.write_show(show)
        self.notify = NotifySocket(self.folder)
        self.log_file = self.folder / "log"
        env = {key: value for key, value in os.environ.items()
               if key not in ("DISPLAY", "WAYLAND_DISPLAY", "JOURNAL_STREAM", "WATCHDOG_USEC", "WATCHDOG_PID")}
        env["NOTIFY_SOCKET"] = self.notify.path
        if watchdog_seconds:
            env["WATCHDOG_USEC"] = str(int(watchdog_seconds * 1e6))
        env.update(environment or {})
        with open(self.log_file, "w") as log:
            self.process = subprocess.Popen([self.binary, "--config", str(self.show_file), *arguments], env=env,
                                            cwd=self.folder, stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        self.wait_at_start = wait

    def write_show(self, show):
        if isinstance(show, dict):
            show = dict(show)
            show.setdefault("control", {"http": {"port": self.port}, "osc": {"port": self.osc_port}})
            show = json.dumps(show, indent=2)
        self.show_file.write_text(show)

    def __enter__(self):
        if self.wait_at_start:
            try:
                self.wait_ready()
            except BaseException:
                self.__exit__()
                raise
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.notify.close()
        self.folder_owner.cleanup()

    def alive(self):
        return self.process.poll() is None

    def log(self):
        return self.log_file.read_text()

    def wait_ready(self, since=0):
        try:
            return self.notify.wait("READY=1", since, self.alive)
        except AssertionError as error:
            raise AssertionError(f"{error}\n{self.log()}") from None

    def send(self, number):
        self.process.send_signal(number)

    def stop(self, number=signal.SIGTERM):
        """Asks to end; returns (exit status, seconds that it took)."""
        begin = time.monotonic()
        self.process.send_signal(number)
        status = self.process.wait(PATIENCE)
        return status, time.monotonic() - begin

    # ---- HTTP ----------------------------------------------------------------------------------------------

    def request(self, method, path, body=None, headers=None):
        """(status, headers, bytes)"""
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=PATIENCE)
        try:
            data = json.dumps(body).encode() if isinstance(body, (dict, list)) else body
            kind = {"Content-Type": "application/merge-patch+json"} if data is not None else {}
            connection.request(method, path, data, {**kind, **(headers or {})})
            answer = connection.getresponse()
            return answer.status, dict(answer.getheaders()), answer.read()
        finally:
            connection.close()

    def get(self, path):
        status, _, body = self.request("GET", path)
        assert status == 200, (path, status, body[:500])
        return json.loads(body)

    def patch(self, change, wait_shown=True):
        """(status, answer)"""
        path = "/api/v1/show" + ("?wait=shown" if wait_shown else "")
        status, _, body = self.request("PATCH", path, change)
        return status, json.loads(body)

    def png(self, output):
        status, _, body = self.request("GET", f"/api/v1/outputs/{output}.png")
        assert status == 200, (output, status, body[:500])
        return body

    def picture(self, output):
        return decode_png(self.png(output))

    def wait_until(self, condition, what):
        give_up = time.monotonic() + PATIENCE
        while not condition():
            if time.monotonic() > give_up or not self.alive():
                raise AssertionError(f"waited in vain for {what}\n{self.log()}")
            time.sleep(0.02)


# ---- pictures ----------------------------------------------------------------------------------------------


class Picture:
    """8 bit RGB, rows from the top."""

    def __init__(self, width, height, rgb):
        self.width, self.height, self.rgb = width, height, rgb

    def at(self, x, y):
        start = (y * self.width + x) * 3
        return tuple(self.rgb[start:start + 3])

    def colors(self):
        return {self.rgb[i:i + 3] for i in range(0, len(self.rgb), 3)}

    def part(self, x, y, width, height):
        rows = (self.rgb[((y + row) * self.width + x) * 3:((y + row) * self.width + x + width) * 3]
                for row in range(height))
        return Picture(width, height, b"".join(rows))


def decode_png(data):
    """8-bit RGB or RGBA, not interlaced."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n", data[:16]
    at, packed, header = 8, b"", None
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        chunk = data[at + 8:at + 8 + size]
        assert zlib.crc32(kind + chunk) == struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0]
        if kind == b"IHDR":
            header = struct.unpack(">IIBBBBB", chunk)
        elif kind == b"IDAT":
            packed += chunk
        at += 12 + size
    width, height, depth, color, _, _, interlaced = header
    assert depth == 8 and color in (2, 6) and not interlaced, header
    channels = 3 if color == 2 else 4
    raw, stride = zlib.decompress(packed), width * channels
    rows, above = [], bytearray(stride)
    for y in range(height):
        kind = raw[y * (stride + 1)]
        row = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        _unfilter(kind, row, above, channels)
        rows.append(bytes(row))
        above = row
    rgb = b"".join(rows)
    if channels == 4:
        rgb = b"".join(rgb[i:i + 3] for i in range(0, len(rgb), 4))
    return Picture(width, height, rgb)


def _unfilter(kind, row, above, step):
    for i in range(len(row)):
        left = row[i - step] if i >= step else 0
        up = above[i]
        if kind == 1:
            row[i] = (row[i] + left) & 255
        elif kind == 2:
            row[i] = (row[i] + up) & 255
        elif kind == 3:
            row[i] = (row[i] + (left + up) // 2) & 255
        elif kind == 4:
            corner = above[i - step] if i >= step else 0
            guess = left + up - corner
            distances = (abs(guess - left), abs(guess - up), abs(guess - corner))
            row[i] = (row[i] + (left, up, corner)[distances.index(min(distances))]) & 255


# ---- a display ---------------------------------------------------------------------------------------------


class VirtualDisplay:
    """An X server of its own; `with VirtualDisplay() as display:` display.name is its DISPLAY."""

    def __init__(self, width=1280, height=800):
        self.size = f"{width}x{height}x24"

    def __enter__(self):
        self.folder_owner = tempfile.TemporaryDirectory(prefix="cupola-screen-")
        reading, writing = os.pipe()
        with open(Path(self.folder_owner.name) / "log", "w") as log:
            self.process = subprocess.Popen(
                ["Xvfb", "-displayfd", str(writing), "-screen", "0", self.size, "-fbdir", self.folder_owner.name,
                 "-noreset"], pass_fds=[writing], stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        os.close(writing)
        with os.fdopen(reading) as pipe:
            number = pipe.readline().strip()
        assert number, "Xvfb does not start"
        self.name = f":{number}"
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.terminate()
        self.process.wait()
        self.folder_owner.cleanup()

    def screen(self):
        """What the screen shows now; Xvfb keeps it in a file in the format of xwd."""
        data = (Path(self.folder_owner.name) / "Xvfb_screen0").read_bytes()
        words = struct.unpack(">25I", data[:100])
        header, width, height, row, colors = words[0], words[4], words[5], words[12], words[19]
        start = header + colors * 12
        rgb = bytearray(width * height * 3)
        pixels = b"".join(data[start + y * row:start + y * row + width * 4] for y in range(height))
        rgb[0::3], rgb[1::3], rgb[2::3] = pixels[2::4], pixels[1::4], pixels[0::4]
        return Picture(width, height, bytes(rgb))
