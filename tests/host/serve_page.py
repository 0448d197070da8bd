#!/usr/bin/env python3
"""Drives the editor's page in headless Chromium: every control is turned and the picture must change as it says.

usage: serve_page.py WALE SCENE [--shots FOLDER]   with --shots: nothing is turned, screenshots are made
Exit status 77 where Chromium is absent. Standard library alone: Chrome's DevTools protocol over a WebSocket (RFC 6455).
"""
import base64, json, math, os, shutil, signal, socket, struct, subprocess, sys, tempfile, time
import urllib.request


class Socket:
    def __init__(self, port, path):
        self.s = socket.create_connection(("127.0.0.1", port), timeout=120)
        key = base64.b64encode(os.urandom(16)).decode()
        self.s.sendall(f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                       f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        self.f = self.s.makefile("rb")
        while self.f.readline() != b"\r\n":
            pass

    def send(self, text):
        data, mask = text.encode(), os.urandom(4)
        n = len(data)
        head = b"\x81" + (bytes([0x80 | n]) if n < 126 else bytes([0xFE]) + struct.pack(">H", n) if n < 65536
                          else bytes([0xFF]) + struct.pack(">Q", n))
        self.s.sendall(head + mask + bytes(b ^ mask[i % 4] for i, b in enumerate(data)))

    def receive(self):
        whole = b""
        while True:
            a, b = self.f.read(2)
            n = b & 0x7F
            n = struct.unpack(">H", self.f.read(2))[0] if n == 126 else struct.unpack(">Q", self.f.read(8))[0] if n == 127 else n
            whole += self.f.read(n)
            if a & 0x80:
                return whole.decode()


class Page:
    def __init__(self, chromium, folder):
        self.process = subprocess.Popen(
            [chromium, "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
             "--remote-debugging-port=0", "--remote-allow-origins=*", f"--user-data-dir={folder}", "about:blank"],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True)
        active = os.path.join(folder, "DevToolsActivePort")
        end = time.time() + 60
        while not (os.path.exists(active) and open(active).read().count("\n")):
            if time.time() > end:
                raise TimeoutError("Chromium does not start")
            time.sleep(0.1)
        port = int(open(active).readline())
        pages = json.load(urllib.request.urlopen(f"http://127.0.0.1:{port}/json"))
        path = next(p for p in pages if p["type"] == "page")["webSocketDebuggerUrl"].split(str(port), 1)[1]
        self.socket, self.count, self.problems = Socket(port, path), 0, []
        self.call("Runtime.enable"), self.call("Page.enable"), self.call("Log.enable")

    def call(self, method, **params):
        self.count += 1
        self.socket.send(json.dumps({"id": self.count, "method": method, "params": params}))
        while True:
            reply = json.loads(self.socket.receive())
            if reply.get("method") == "Runtime.exceptionThrown":
                self.problems.append(reply["params"]["exceptionDetails"].get("exception", {}).get("description", "?"))
            if reply.get("method") == "Log.entryAdded" and reply["params"]["entry"]["level"] == "error":
                self.problems.append(reply["params"]["entry"]["text"] + " " + reply["params"]["entry"].get("url", ""))
            if reply.get("id") == self.count:
                if "error" in reply:
                    raise RuntimeError(f"{method}: {reply['error']}")
                return reply["result"]

    def run(self, text):
        out = self.call("Runtime.evaluate", expression=text, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in out:
            raise RuntimeError(out["exceptionDetails"])
        return out["result"].get("value")

    def shot(self, file, width, height, dark, phone=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=phone)
        self.call("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}])
        time.sleep(0.5)
        data = self.call("Page.captureScreenshot", format="png", captureBeyondViewport=False)["data"]
        with open(file, "wb") as f:
            f.write(base64.b64decode(data))

    def end(self):
        os.killpg(self.process.pid, signal.SIGKILL)
        self.process.wait()


# Keeps the first picture of every version that has so many samples, as luminance and means of the colours. Versions are
# compared at this count and with the same seed; those that differ only in how they are shown have more, as they go on.
SAMPLES, NEAR_SAMPLES = 16, 64
WATCH = """(() => {
  window.kept = new Map();
  window.wanted = %d;
  const show = showPicture;
  showPicture = async (view, head, bytes) => {
    await show(view, head, bytes);
    const samples = Number(head['x-wale-samples']), key = view + ':' + head['x-wale-revision'];
    if (samples < wanted || kept.has(key)) return;
    const bitmap = await createImageBitmap(new Blob([bytes], {type: 'image/jpeg'}));
    const w = bitmap.width, h = bitmap.height, paint = new OffscreenCanvas(w, h).getContext('2d');
    paint.drawImage(bitmap, 0, 0);
    const d = paint.getImageData(0, 0, w, h).data, mean = [0, 0, 0], luma = [];
    for (let i = 0; i < w * h; ++i) {
      for (let c = 0; c < 3; ++c) mean[c] += d[4 * i + c] / (w * h);
      luma.push((d[4 * i] + d[4 * i + 1] + d[4 * i + 2]) / 3);
    }
    kept.set(key, {mean, luma, w, h, samples});
  };
})()""" % SAMPLES


# Lets the test cut the stream of pictures.
STREAM = """(() => {
  const all = window.fetch;
  window.fetch = (path, more) => path === '/stream' ? all(path, {...more, signal: (window.line = new AbortController()).signal}) : all(path, more);
})()"""


class Picture:
    def __init__(self, kept):
        self.mean, self.luma, self.w, self.h = kept["mean"], kept["luma"], kept["w"], kept["h"]
        self.light, self.samples = sum(self.mean) / 3, kept["samples"]
        self.columns = [sum(self.luma[x::self.w]) / self.h for x in range(self.w)]
        self.rows = [sum(self.luma[y * self.w:(y + 1) * self.w]) / self.w for y in range(self.h)]

    def difference(self, other, side=4):
        """Mean distance of blocks of that many pixels a side, in steps of 1 / 255."""
        blocks, wide = {}, self.w // side
        for i, (a, b) in enumerate(zip(self.luma, other.luma)):
            key = i // self.w // side * wide + i % self.w // side
            blocks[key] = blocks.get(key, 0) + (a - b) / side**2
        return sum(abs(v) for v in blocks.values()) / len(blocks)

    def change(self, other):
        """The same by the size at which it stands out most: noise falls with a block's side, what is seen does not."""
        return max(self.difference(other, side) * side / 4 for side in (4, 8, 12, 24))

    def share(self, horizontal, first):
        """Of the light, in the left or upper half."""
        line = self.columns if horizontal else self.rows
        return sum(line[:len(line) // 2]) / sum(line)

    def stitches(self):
        """Columns of stitches across the picture: where a comb of three harmonics holds most of the spectrum."""
        n, mean = len(self.columns), sum(self.columns) / len(self.columns)
        windowed = [(v - mean) * (0.5 - 0.5 * math.cos(2 * math.pi * (i + 0.5) / n)) for i, v in enumerate(self.columns)]

        def power(f):
            re = sum(v * math.cos(2 * math.pi * f * i / n) for i, v in enumerate(windowed))
            im = sum(v * math.sin(2 * math.pi * f * i / n) for i, v in enumerate(windowed))
            return math.hypot(re, im)

        return max((3 + 0.1 * k for k in range(270)), key=lambda f: sum(power(f * m) for m in (1, 2) if f * m < n / 2))

    def tone(self, cycles):
        """Amplitude of so many cycles across the picture, of the largest within a tenth, in steps of 1 / 255."""
        n, mean = len(self.columns), sum(self.columns) / len(self.columns)
        windowed = [(v - mean) * (0.5 - 0.5 * math.cos(2 * math.pi * (i + 0.5) / n)) for i, v in enumerate(self.columns)]

        def amplitude(f):
            re = sum(v * math.cos(2 * math.pi * f * i / n) for i, v in enumerate(windowed))
            im = sum(v * math.sin(2 * math.pi * f * i / n) for i, v in enumerate(windowed))
            return 4 * math.hypot(re, im) / n

        return max(amplitude(cycles * (0.9 + 0.02 * k)) for k in range(11))

    def shift(self, before, horizontal):
        """Pixels by which this is `before` moved to the right or down, at most a tenth of the picture."""
        a, b = (before.columns, self.columns) if horizontal else (before.rows, self.rows)
        reach = len(a) // 10

        def distance(d):
            pairs = [(a[i - d], b[i]) for i in range(reach, len(a) - reach)]
            return sum((x - y) ** 2 for x, y in pairs)

        return min(range(-reach, reach + 1), key=distance)


def main():
    wale, scene = sys.argv[1:3]
    shots = sys.argv[4] if len(sys.argv) > 4 else None
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not chromium:
        print("Chromium is not installed (apt-get install chromium)")
        return 77
    server = subprocess.Popen([wale, "serve", scene, "--port", "0", "--quiet", "--size", "96x96" if not shots else "320x320"],
                              stdout=subprocess.PIPE, text=True)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # by way of `finally`
    folder, page, failed = tempfile.mkdtemp(prefix="wale_page_"), None, []

    def expect(holds, what):
        print(("ok   " if holds else "FAIL ") + what, flush=True)
        if not holds:
            failed.append(what)

    try:
        address = server.stdout.readline().strip()
        page = Page(chromium, folder)
        page.call("Emulation.setDeviceMetricsOverride", width=1280, height=860, deviceScaleFactor=1, mobile=False)
        page.call("Page.addScriptToEvaluateOnNewDocument", source=STREAM)
        page.call("Page.navigate", url=address)

        def wait(condition, what, seconds=120):
            end = time.time() + seconds
            while not page.run(condition):
                if time.time() > end:
                    raise TimeoutError(what + ": " + str(page.run("document.body.innerText"))[:2000])
                time.sleep(0.05)

        def shown(exact=True):
            for _ in range(8):
                wait("state && waiting.size === 0 && state.views.every((v, i) => kept.has(i + ':' + state.revision))", "a picture")
                pictures = [Picture(k) for k in page.run("state.views.map((v, i) => kept.get(i + ':' + state.revision))")]
                if not exact or all(p.samples == page.run("wanted") for p in pictures):
                    return pictures
                # The viewer was slow and that picture is gone: the same version once more, after another one.
                there, back = ("redo", "undo") if page.run("state.can_redo") else ("undo", "redo")
                for button in (there, back):
                    before = page.run("state.revision")
                    page.run(f"document.getElementById('{button}').click()")
                    wait(f"state.revision > {before} && document.querySelector('#stage canvas').dataset.revision > {before}", button)
            raise TimeoutError("no picture of so many samples")

        def refined(samples):
            wait(f"state && document.querySelectorAll('#stage canvas').length === state.views.length && "
                 f"[...document.querySelectorAll('#stage canvas')].every(c => Number(c.dataset.revision) >= state.revision && "
                 f"Number(c.dataset.samples) >= {samples})", "a picture")

        def turn(control, value):
            expect(page.run(f"rows.has({json.dumps(control)})"), f"{control} is there")
            before = page.run("state.revision")
            page.run(f"(() => {{ const i = rows.get({json.dumps(control)}).input; i.value = {json.dumps(value)}; "
                     "i.dispatchEvent(new Event('input')); i.dispatchEvent(new Event('change')); })()")
            wait(f"state.revision > {before} || rows.get({json.dumps(control)}).error.textContent", control)
            error = page.run(f"rows.has({json.dumps(control)}) ? rows.get({json.dumps(control)}).error.textContent : ''")
            expect(not error, f"{control} = {value} is taken {error}")
            return shown(exact=not control.startswith("film."))

        def undo():
            before = page.run("state.revision")
            page.run("document.getElementById('undo').click()")
            wait(f"state.revision > {before}", "undo")

        def set_any(text):
            before = page.run("state.revision")
            page.run(f"document.getElementById('any').value = {json.dumps(text)}; document.getElementById('apply').click()")
            wait(f"state.revision > {before}", text)

        wait("typeof state === 'object' && state !== null", "the state")
        if shots:
            os.makedirs(shots, exist_ok=True)
            refined(6)
            for name, w, h, dark, phone in [("desktop_light", 1280, 860, False, False), ("desktop_dark", 1280, 860, True, False),
                                            ("phone_light", 360, 740, False, True), ("phone_dark", 360, 740, True, True)]:
                page.shot(os.path.join(shots, name + ".png"), w, h, dark, phone)
            page.run("(() => { const i = rows.get('view.lit').input; i.value = 'both'; i.dispatchEvent(new Event('input')); })()")
            time.sleep(1)
            refined(4)
            page.shot(os.path.join(shots, "phone_both_light.png"), 360, 740, False, True)
            page.shot(os.path.join(shots, "desktop_both_dark.png"), 1280, 860, True)
            return 0
        page.run(WATCH)
        set_any("integrator.seed=1")
        other = shown()[0]
        undo()
        first = shown()[0]
        set_any("camera.fov=21")
        undo()
        base = shown()[0]
        # With one seed and equal counts most of the noise is the same in both; what is left is that of a version again.
        noise = max(base.difference(first), 0.125)
        expect(base.light > 10, f"a picture is shown: mean {base.mean}")
        expect(noise < 0.2 < base.difference(other), f"noise {base.difference(first):.3f}, of another seed {base.difference(other):.2f}")
        differs = lambda a, b: a.difference(b) > 2 * noise

        def changed(start, limit, control, value, says, text):
            now = turn(control, value)[0]
            d = start.change(now)
            expect(d > 2 * limit, f"{control} = {value}: the picture changes, {d:.2f} against noise {limit:.2f}")
            holds, figure = says(now)
            expect(holds, f"{control} = {value}: {text}, {figure}")
            undo()

        def blueness(p):
            return p.mean[2] - p.mean[0]

        def figure(value, reference, holds):
            return holds(value, reference), f"{value:.3g} (before {reference:.3g})"

        ids = page.run("[...rows.keys()]")
        find = lambda end: next(i for i in ids if i.endswith(end))
        wales = page.run(f"rows.get('{find('gauge.wales')}').c.value")
        stitches = base.stitches()
        expect(abs(stitches / 13.6 - 1) < 0.08, f"stitches across: {stitches:.1f}")
        brighter = lambda factor: lambda n: figure(n.light, base.light, lambda v, r: v > factor * r)
        darker = lambda factor: lambda n: figure(n.light, base.light, lambda v, r: v < factor * r)
        another = lambda n: (True, "")
        crosswise = lambda factor: lambda n: figure(n.stitches(), stitches, lambda v, r: abs(v / (factor * r) - 1) < 0.08)
        nearer = math.tan(math.radians(10)) / math.tan(math.radians(6))
        segments = lambda: int(page.run("document.getElementById('segments').textContent.replaceAll(',', '')"))
        few = segments()
        # Ribs are that many stitches wide: what a plain cloth has there is noise.
        ribs = lambda wide: lambda n: figure(n.tone(stitches / wide), base.tone(stitches / wide), lambda v, r: v > 5 * r)

        # What a preset costs is seen in its segments; paths that end early, and shadows without what plies let pass,
        # leave light out.
        def preset(light, pieces):
            def says(n):
                (bright, a), (many, b) = figure(n.light, base.light, light), figure(segments(), few, pieces)
                return bright and many, f"light {a}, segments {b}"
            return says

        cheaper = preset(lambda v, r: 0.8 * r < v < 0.98 * r, lambda v, r: v < 0.8 * r)
        dearer = preset(lambda v, r: abs(v / r - 1) < 0.01, lambda v, r: v > 1.3 * r)
        checks = [
            (find(".color"), "#1030c0", lambda n: figure(blueness(n), blueness(base), lambda v, r: r < 0 < v), "the hue follows"),
            ("fabrics.0.pattern", "rib_2x2", ribs(4), "ribs of four stitches"),
            ("fabrics.0.pattern", "rib_1x1", ribs(2), "ribs of two stitches"),
            (find("gauge.wales"), wales * 0.6, crosswise(0.6), "as many stitches fewer"),
            ("lights.0.intensity", 0.2, darker(0.8), "darker"),
            ("lights.0.position.around", 80, lambda n: figure(n.share(True, True), base.share(True, True), lambda v, r: v < r),
             "light from the right"),
            ("lights.0.position.above", -40, lambda n: figure(n.share(False, True), base.share(False, True), lambda v, r: v < r),
             "light from below"),
            ("lights.1.intensity", 4, brighter(1.1), "a brighter sky"),
            ("camera.fov", 12, crosswise(1 / nearer), "nearer, so fewer stitches"),
            ("film.exposure", 1, brighter(1.2), "brighter"),
            ("film.exposure", -1, darker(0.8), "darker"),
            ("film.view", "srgb", another, "another tone curve"),
            ("accuracy", "draft", cheaper, "fewer segments and less light from bounces"),
            ("accuracy", "paper", cheaper, "fewer segments and less light from bounces"),
            ("accuracy", "reference", dearer, "more segments, the same light"),
        ]
        # Seen from near by, where a pixel is as small as a fibre, and against the noise of another seed: other paths alone
        # are not taken for another picture.
        near_checks = [
            (find(".translucency"), 1, another, "another light through it"),
            (find(".preset"), "silk", another, "another fibre"),
            ("fabrics.0.yarn.plies", 1, another, "one ply"),
            ("fabrics.0.yarn.twist_pitch", -10, another, "twisted the other way"),
            ("fabrics.0.yarn.thickness", 0.5, another, "thinner"),
        ]
        # These leave most paths as they are, so that one seed's noise is common to both pictures.
        fine_checks = [
            (find(".gloss"), 1, another, "another highlight"),
            ("fabrics.0.detail", "none", another, "smooth plies"),
            # Hairs are thinner than such a pixel: what they add to the scene is told beside the picture.
            ("fabrics.0.flyaways.hairs", 8, lambda n: figure(segments(), few, lambda v, r: v > 1.2 * r), "more segments"),
        ]
        turned = {c[0] for c in checks + near_checks + fine_checks} | {"view.goal", "view.lit"}
        expect(set(ids) <= turned, f"every control is turned; not: {sorted(set(ids) - turned)}")
        for check in checks:
            changed(base, noise, *check)
        page.run(f"wanted = {NEAR_SAMPLES}")
        near = turn("camera.fov", 2)[0]
        set_any("integrator.seed=1")
        near_noise = near.change(shown()[0])
        undo()
        for check in near_checks:
            changed(near, near_noise, *check)
        for check in fine_checks:
            changed(near, noise, *check)
        undo()
        page.run(f"wanted = {SAMPLES}; kept.clear()")
        expect(differs(base, turn("view.lit", "back")[0]), "lit from behind: the picture changes")
        both = turn("view.lit", "both")
        expect(len(both) == 2 and differs(*both), "front and back light side by side")
        turn("view.lit", "scene")
        back = shown()[0]
        expect(base.difference(back) <= noise, f"undone, it is as it was: {base.difference(back):.3f}")

        # mouse, keyboard, wheel
        box = page.run("(() => { const r = document.getElementById('stage').getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()")
        mouse = lambda kind, x, y, **more: page.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)
        before = page.run("state.revision")
        mouse("mousePressed", *box, button="left", clickCount=1)
        for i in range(6):
            mouse("mouseMoved", box[0] + 15 * i, box[1] + 4 * i, button="left", buttons=1)
        mouse("mouseReleased", box[0] + 75, box[1] + 20, button="left", clickCount=1)
        wait(f"state.revision > {before}", "orbit")
        expect(differs(base, shown()[0]), "a drag turns the camera")
        expect(len(page.run("state.edits")) == 2, f"a drag is one edit: {page.run('state.edits')}")
        undo()
        # With Shift the cloth follows the pointer, by a part of a stitch.
        size = page.run("document.querySelector('#stage canvas').clientHeight")
        for horizontal in (True, False):
            before, by = page.run("state.revision"), 3 * size / base.w
            to = [box[0] + by * horizontal, box[1] + by * (not horizontal)]
            mouse("mousePressed", *box, button="left", clickCount=1, modifiers=8)
            mouse("mouseMoved", *to, button="left", buttons=1, modifiers=8)
            mouse("mouseReleased", *to, button="left", clickCount=1, modifiers=8)
            wait(f"state.revision > {before}", "pan")
            now = shown()[0].shift(base, horizontal)
            expect(abs(now - 3) <= 1, f"a drag with Shift moves the cloth {'to the right' if horizontal else 'down'}: {now} of 3 pixels")
            undo()
        before = page.run("state.revision")
        mouse("mouseWheel", *box, deltaX=0, deltaY=-200)
        wait(f"state.revision > {before}", "wheel")
        now = shown()[0].stitches()
        expect(now < 0.9 * stitches, f"the wheel zooms: {now:.1f} stitches across, {stitches:.1f} before")
        undo()
        before = page.run("state.revision")
        page.run("document.getElementById('stage').focus()")
        page.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowRight", code="ArrowRight", windowsVirtualKeyCode=39)
        wait(f"state.revision > {before}", "key")
        expect(differs(base, shown()[0]), "the arrow keys turn")
        undo()

        # errors stand beside the control; saving asks; the command line is there
        page.run("document.getElementById('any').value = 'film.exposure=99'; document.getElementById('apply').click()")
        wait("document.getElementById('any-error').textContent.includes('out of range')", "an error")
        expect(True, "an error is shown by its field")
        # so it is where the edit is found out later to be none that can be shown, until the next one
        set_any("fabrics.0.gauge.wales=0.1")
        wait("document.getElementById('any-error').textContent.includes('larger than the cloth')", "an error found out later")
        expect("wales=0.1" not in page.run("state.edits.join()"), "such an edit is taken back")
        turn(find(".color"), "#40a060")
        wait("document.getElementById('any-error').textContent === ''", "no error any more")
        say = "document.getElementById('say').textContent"
        prop, mesh = os.path.join(os.path.dirname(os.path.abspath(scene)), "prop.obj"), "v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n"
        open(prop, "w").write(mesh)
        set_any('objects=[{"type": "mesh", "mesh": "prop.obj"}]')
        turn("view.lit", "both")
        open(prop, "w").write("no mesh")
        wait(f"{say}.startsWith('Stopped') && {say}.includes('prop.obj')", "that it has stopped, and why")
        open(prop, "w").write(mesh)
        turn("camera.fov", 25)
        wait(f"!{say}.includes('topped') && !{say}.includes('prop.obj')", "that it goes on")
        expect(not page.run("[...document.querySelectorAll('.error')].some(e => e.textContent)"), "no control is to blame")
        # the state and the status come in either order
        line = {"control": "", "line": "a file has gone"}
        parts = [f"showFault({json.dumps(line)})",
                 "showCost({status: 'stopped', samples: 0, error: 0, goal: 1, segments: 0, edit_seconds: 0})"]
        for order in (parts, parts[::-1]):
            text = page.run("(() => { const was = [lastStatus, told]; lastStatus = 'rendering'; told = null; " + "; ".join(order) +
                            f"; const text = {say}; [lastStatus, told] = was; sayStatus(); return text; }})()")
            expect(text == "Stopped until the next edit: a file has gone", f"stopped, and why: {text}")
        turn("view.lit", "scene")
        page.run("window.said = []; new MutationObserver(() => said.push($('say').textContent)).observe($('say'), {childList: true}); line.abort()")
        wait("said.some(t => t.startsWith('Connection lost'))", "that the connection is lost", 20)
        wait(f"!{say}.startsWith('Connection lost')", "that it is there again", 20)
        expect(True, "a connection that is there again is not said to be lost")
        expect("#40a060" in page.run("document.getElementById('command').textContent"), "the command line holds the edit")
        page.run("document.getElementById('file').value = 'page_saved.json'; document.getElementById('save').click()")
        wait("document.getElementById('say').textContent.includes('Saved')", "saving")
        saved = os.path.join(os.path.dirname(os.path.abspath(scene)), "page_saved.json")
        expect("#40a060" in open(saved).read(), "the saved scene holds the edit")
        os.remove(saved)

        # everything has a name, fits 360 pixels, and can be reached by keyboard
        unnamed = page.run("[...document.querySelectorAll('input, select, button')].filter(e => !(e.labels && e.labels.length) && !e.textContent.trim() && !e.getAttribute('aria-label')).map(e => e.outerHTML)")
        expect(not unnamed, f"every control has a name: {unnamed}")
        page.call("Emulation.setDeviceMetricsOverride", width=360, height=740, deviceScaleFactor=1, mobile=True)
        time.sleep(0.3)
        expect(page.run("document.documentElement.scrollWidth") <= 360, f"fits 360 pixels: {page.run('document.documentElement.scrollWidth')}")
        real = [p for p in page.problems if "400" not in p and "favicon" not in p]
        expect(not real, f"no error on the page: {real}")
        page.run("window.confirm = () => true; document.getElementById('stop').click()")
        expect(server.wait(60) == 0, "the page's stop ends the program")
    except Exception as error:
        expect(False, f"{type(error).__name__}: {error}")
    finally:
        if page:
            page.end()
        if server.poll() is None:
            server.kill()
        shutil.rmtree(folder, ignore_errors=True)
    print(f"{len(failed)} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
