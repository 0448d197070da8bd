#!/usr/bin/env python3
"""Latency of `wale serve`: from the POST of an edit to the first picture of that edit, or a later one, on the wire.

usage: bench/serve_latency.py WALE [--scene SCENE] [--set KEY=VALUE ...] [--repeats 15] [--random 3000]   (--repeats 0: memory alone)
Prints a table: median, 90th percentile and worst of each kind of edit, before and after as many random edits, and the
server's resident memory on the way.
"""
import argparse, atexit, json, os, random, re, socket, subprocess, sys, threading, time
from urllib.parse import urlparse, parse_qs


class Editor:
    """A running `wale serve`, with one viewer on its stream."""

    def __init__(self, wale, scene, sets=(), size="512x512", environment=None):
        command = [wale, "serve", scene, "--port", "0", "--quiet", "--size", size]
        for one in sets:
            command += ["--set", one]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env={**os.environ, **(environment or {})})
        atexit.register(self.process.kill)
        self.address = self.process.stdout.readline().strip()
        url = urlparse(self.address)
        self.port, self.token = url.port, parse_qs(url.query)["token"][0]
        self.changed = threading.Condition()
        self.pictures, self.state, self.cost, self.bytes = {}, None, None, 0  # pictures: view -> (revision, arrival, head)
        threading.Thread(target=self._watch, daemon=True).start()
        self._post = None

    def head(self, method, path, body=None):
        lines = [f"{method} {path} HTTP/1.1", f"Host: 127.0.0.1:{self.port}", f"X-Wale-Token: {self.token}"]
        if body is not None:
            lines += ["Content-Type: application/json", f"Content-Length: {len(body)}"]
        return ("\r\n".join(lines) + "\r\n\r\n").encode()

    def _watch(self):
        s = socket.create_connection(("127.0.0.1", self.port))
        s.sendall(self.head("GET", "/stream"))
        f = s.makefile("rb")
        while f.readline() not in (b"\r\n", b""):
            pass
        buffer = b""

        def chunk():
            size = f.readline()
            if not size:
                return None
            n = int(size, 16)
            data = f.read(n)
            f.readline()
            return data if n else None

        while True:
            while b"\r\n\r\n" not in buffer:
                more = chunk()
                if more is None:
                    return
                buffer += more
            text, buffer = buffer.split(b"\r\n\r\n", 1)
            head = dict(line.split(": ", 1) for line in text.decode().split("\r\n") if ": " in line)
            length = int(head["Content-Length"])
            first = time.monotonic()  # the first bytes of this part are here
            while len(buffer) < length + 2:
                buffer += chunk()
            body, buffer = buffer[:length], buffer[length + 2:]
            with self.changed:
                topic = head["X-Wale-Topic"]
                if topic.startswith("picture."):
                    self.pictures[topic] = (int(head["X-Wale-Revision"]), time.monotonic(), head, body)
                elif topic == "state":
                    self.state = json.loads(body)
                elif topic == "cost":
                    self.cost = json.loads(body)
                self.bytes += length
                self.changed.notify_all()

    def post(self, path, value=None):
        body = json.dumps(value or {})
        for again in (False, True):
            try:
                if self._post is None:
                    self._post = socket.create_connection(("127.0.0.1", self.port))
                    self._post.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
                self._post.sendall(self.head("POST", path, body) + body.encode())
                f = self._post.makefile("rb")
                status = int(f.readline().split()[1])
                length, closed = 0, False
                while (line := f.readline()) not in (b"\r\n", b""):
                    name, value_text = line.decode().split(":", 1)
                    if name.lower() == "content-length":
                        length = int(value_text)
                    closed |= name.lower() == "connection" and "close" in value_text
                reply = json.loads(f.read(length) or b"{}")
                if closed:
                    self._post = None
                return status, reply
            except (OSError, IndexError):
                self._post = None
                if again:
                    raise

    def wait(self, revision, seconds=120, topic="picture.0"):
        """Arrival of the first picture of this revision or a later one."""
        end = time.monotonic() + seconds
        with self.changed:
            while topic not in self.pictures or self.pictures[topic][0] < revision:
                if self.process.poll() is not None:
                    raise RuntimeError("wale ended")
                if time.monotonic() > end:
                    raise TimeoutError
                self.changed.wait(0.5)
            return self.pictures[topic][1]

    def settle(self, samples, seconds=300):
        end = time.monotonic() + seconds
        with self.changed:
            while not (self.cost and self.state and self.cost["revision"] == self.state["revision"] and
                       (self.cost["samples"] >= samples or self.cost["status"] == "done")):
                if self.process.poll() is not None or time.monotonic() > end:
                    raise TimeoutError
                self.changed.wait(0.5)

    def latency(self, path, value):
        start = time.monotonic()
        status, reply = self.post(path, value)
        if status != 200:
            raise RuntimeError(f"{status} {reply}")
        return self.wait(reply["revision"]) - start

    def control(self, ending):
        return next(c for c in self.state["controls"] if c["id"].endswith(ending))

    def rss(self):
        with open(f"/proc/{self.process.pid}/status") as f:
            return int(re.search(r"VmRSS:\s+(\d+)", f.read()).group(1)) / 1024

    def end(self):
        self.post("/stop")
        return self.process.wait(30)


def values(control, generator):
    if control["type"] == "color":
        return "#%06x" % generator.randrange(1 << 24)
    if control["type"] == "choice":
        return generator.choice([w for w, _ in control["words"]])
    v = control["min"] + generator.random() * (control["max"] - control["min"])
    return max(control["min"], min(control["max"], round(v) if control["step"] == 1 else v))


def measure(editor, repeats, generator):
    def set_to(ending, value):
        return "/control", {"control": editor.control(ending)["id"], "value": value}

    kinds = {
        "colour": lambda i: set_to(".color", "#%06x" % generator.randrange(1 << 24)),
        "gloss": lambda i: set_to(".gloss", round(generator.random(), 3)),
        "translucency": lambda i: set_to(".translucency", round(generator.random(), 3)),
        "light direction": lambda i: set_to(".around", generator.randrange(-90, 90)),
        "light brightness": lambda i: set_to("lights.0.intensity", round(0.2 + generator.random(), 3)),
        "camera": lambda i: ("/camera", {"orbit": [0.05 if i % 2 else -0.05, 0]}),
        "density": lambda i: set_to("gauge.wales", editor.density * (1 + 0.02 * (i % 3 - 1))),
        "twist": lambda i: set_to("twist_pitch", 10 + i % 5),
        "pattern": lambda i: set_to(".pattern", ["rib_1x1", "stockinette"][i % 2]),
    }
    out = {}
    if not repeats:
        return out
    for name, make in kinds.items():
        times = []
        for i in range(repeats if name not in ("density", "pattern", "twist") else max(5, repeats // 2)):
            time.sleep(0.2 + 0.5 * generator.random())  # in the middle of what it renders
            times.append(editor.latency(*make(i)))
        times.sort()
        out[name] = (times[len(times) // 2], times[min(len(times) - 1, int(0.9 * len(times)))], times[-1])
        print(f"  {name}: {out[name]}", file=sys.stderr)
    return out


def main():
    parse = argparse.ArgumentParser()
    parse.add_argument("wale")
    parse.add_argument("--scene", default=os.path.join(os.path.dirname(__file__), "../scenes/swatch_front.json"))
    parse.add_argument("--set", action="append", default=[])
    parse.add_argument("--repeats", type=int, default=15)
    parse.add_argument("--random", type=int, default=3000)
    args = parse.parse_args()
    generator = random.Random(1)
    editor = Editor(args.wale, args.scene, args.set)
    editor.wait(0)
    editor.settle(2)
    editor.density = editor.control("gauge.wales")["value"]
    print(f"{editor.cost['segments']} segments, {editor.cost['mrays']} Mrays/s, load {os.getloadavg()[0]:.1f}")
    before = measure(editor, args.repeats, generator)
    memory = {0: editor.rss()}  # after so many random edits
    start = time.monotonic()
    cheap = [c for c in editor.state["controls"] if c["group"] in ("Colour", "Fibre", "Light", "View") and c["id"] != "camera.fov"]
    for i in range(args.random):
        # Mostly what a hand on a slider sends; now and then something is knitted.
        c = editor.control("twist_pitch") if i % 100 == 99 else generator.choice(cheap)
        value = generator.uniform(5, 15) if i % 100 == 99 else values(c, generator)
        status, reply = editor.post("/control", {"control": c["id"], "value": value})
        if status not in (200, 429):
            raise RuntimeError(f"{c['id']} {value}: {status} {reply}")
        if i % 10 == 0 and status == 200:
            editor.wait(reply["revision"])
        if i + 1 == 300 or (i + 1) % max(1, args.random // 6) == 0:
            memory[i + 1] = editor.rss()
    seconds = time.monotonic() - start
    editor.post("/reset")
    editor.settle(2)
    after = measure(editor, args.repeats, generator)
    print("| edit | median, s | 90 %% | worst | median after %d random edits | 90 %% | worst |" % args.random)
    print("|---|---|---|---|---|---|---|")
    for name in before:
        print("| " + name + " | " + " | ".join(f"{v:.3f}" for v in before[name] + after[name]) + " |")
    print(f"random edits took {seconds:.0f} s; resident MB after edits: " + ", ".join(f"{i}: {m:.0f}" for i, m in sorted(memory.items())))
    print("exit status", editor.end())


if __name__ == "__main__":
    main()
