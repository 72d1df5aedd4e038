#!/usr/bin/env python3
"""Field of view changed 60 times a second: no torn or black picture, and refused changes alter nothing.

live-change.py --bin FOLDER [--short] [--seconds N]

Every picture taken during the run must equal, byte for byte, the picture that one single revision showed when
it was alone: a frame that mixed two revisions, or a black one, equals none of them. One request in ten is to be
refused; it asks for a valid field of view beside an invalid value, so that taking half of it would be seen.
"""
import argparse
import http.client
import json
import sys
import threading
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "system"))
from daemon import Daemon, decode_png, small_show  # noqa: E402

RATE = 60
FIELDS = [40 + 5 * step for step in range(16)]  # degrees; of both projections in one change
FORBIDDEN = 33.0  # of the refused changes only


def change(field):
    return {"projections": {"flat": {"horizontal_fov": field}, "dome": {"fov": 100 + field}}}


class Sender(threading.Thread):
    """Sends at a fixed rate over one connection and keeps what was answered."""

    def __init__(self, daemon, seconds):
        super().__init__()
        self.daemon, self.seconds = daemon, seconds
        self.times, self.accepted, self.refused, self.wrong = [], 0, 0, []
        self.last_field, self.elapsed = None, 0.0

    def run(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.daemon.port, timeout=60)
        begin = time.monotonic()
        for number in range(int(self.seconds * RATE)):
            pause = begin + number / RATE - time.monotonic()
            if pause > 0:
                time.sleep(pause)
            bad = number % 10 == 9
            field = FIELDS[number * 7 % len(FIELDS)]
            body = change(FORBIDDEN if bad else field)
            if bad:
                body["projections"]["flat"]["zoom"] = -1
            sent = time.monotonic()
            connection.request("PATCH", "/api/v1/show", json.dumps(body),
                               {"Content-Type": "application/merge-patch+json"})
            answer = connection.getresponse()
            text = answer.read()
            self.times.append(time.monotonic() - sent)
            if bad and answer.status == 422:
                self.refused += 1
            elif not bad and answer.status == 200:
                self.accepted += 1
                self.last_field = field
            else:
                self.wrong.append((number, answer.status, text[:300]))
        self.elapsed = time.monotonic() - begin
        connection.close()


class Watcher(threading.Thread):
    """Takes pictures of an output as fast as they come; those unlike every reference are kept."""

    def __init__(self, daemon, output, references):
        super().__init__()
        self.daemon, self.output, self.references = daemon, output, references
        self.stopping, self.count, self.seen, self.strange = False, 0, set(), []

    def run(self):
        while not self.stopping:
            png = self.daemon.png(self.output)
            self.count += 1
            if png in self.references:
                self.seen.add(self.references[png])
            elif len(self.strange) < 3:
                self.strange.append(png)
            else:
                return


def references(daemon):
    """What each field of view looks like when nothing else happens: {output: {png: field}}."""
    found = {"front": {}, "dome": {}}
    for field in FIELDS:
        status, answer = daemon.patch(change(field))
        assert status == 200, answer
        for output, pictures in found.items():
            png = daemon.png(output)
            assert png == daemon.png(output), "the same revision twice gives the same bytes"
            assert png not in pictures, f"{field}° looks like {pictures.get(png)}°"
            assert len(decode_png(png).colors()) > 10, "not black"
            pictures[png] = field
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bin", type=Path, required=True)
    parser.add_argument("--short", action="store_true")
    parser.add_argument("--seconds", type=float)
    options = parser.parse_args()
    seconds = options.seconds or (5 if options.short else 60)

    problems = []
    with Daemon(options.bin / "cupolad", small_show(frame_rate=60)) as daemon:
        known = references(daemon)
        before = daemon.get("/api/v1/status")
        print(f"{len(FIELDS)} references of {len(known)} outputs taken; {RATE} requests a second for {seconds:g} s",
              flush=True)
        watchers = [Watcher(daemon, output, pictures) for output, pictures in known.items()]
        sender = Sender(daemon, seconds)
        for thread in [*watchers, sender]:
            thread.start()
        sender.join()
        for watcher in watchers:
            watcher.stopping = True
            watcher.join()
        # The last accepted change is the one that stays, whatever was refused after it.
        status, answer = daemon.patch(change(sender.last_field))
        if status != 200:
            problems.append(f"the last change again: {status} {answer}")
        for output, pictures in known.items():
            if pictures.get(daemon.png(output)) != sender.last_field:
                problems.append(f"{output} does not show {sender.last_field}° at the end")
        after = daemon.get("/api/v1/status")
        status, _ = daemon.stop()
        if status != 0:
            problems.append(f"the daemon ended with {status}")

    problems += [f"answer to request {number}: {status} {text}" for number, status, text in sender.wrong[:5]]
    for watcher in watchers:
        for index, png in enumerate(watcher.strange):
            name = f"/tmp/live-change-{watcher.output}-{index}.png"
            Path(name).write_bytes(png)
            problems.append(f"{watcher.output}: a picture of no single revision, kept as {name}")
        if not watcher.seen:
            problems.append(f"{watcher.output}: no picture was taken")
    times = sorted(sender.times)
    print(f"requests: {len(times)} in {sender.elapsed:.1f} s, {sender.accepted} accepted, {sender.refused} refused as meant, "
          f"{len(sender.wrong)} wrong")
    print(f"answers: median {1e3 * times[len(times) // 2]:.1f} ms, 99 % {1e3 * times[len(times) * 99 // 100]:.1f} ms, "
          f"longest {1e3 * times[-1]:.1f} ms")
    for watcher in watchers:
        print(f"{watcher.output}: {watcher.count} pictures of {len(watcher.seen)} fields of view, "
              f"{len(watcher.strange)} torn or black")
    print(f"frames: {after['frames'] - before['frames']}, late {after['late_frames'] - before['late_frames']}, "
          f"{after['fps']:.1f} a second at the end")
    for problem in problems:
        print(f"FAILED {problem}")
    print(f"{0 if problems else 1} passed, {1 if problems else 0} failed")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
