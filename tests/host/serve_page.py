#!/usr/bin/env python3
"""Drives the editor's page in headless Chromium: every control is turned and the picture must change as it says.

usage: serve_page.py WALE SCENE [--shots FOLDER]   with --shots: nothing is turned, screenshots are made
Exit status 77 where Chromium is absent. Standard library alone: Chrome's DevTools protocol over a WebSocket (RFC 6455).
"""
import base64, json, os, shutil, signal, socket, struct, subprocess, sys, tempfile, time
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


STATISTICS = """(() => {
  const out = [];
  for (const canvas of document.querySelectorAll('#stage canvas')) {
    const w = 16, h = 16, small = new OffscreenCanvas(w, h), paint = small.getContext('2d');
    paint.imageSmoothingQuality = 'high'; paint.drawImage(canvas, 0, 0, w, h);
    const d = paint.getImageData(0, 0, w, h).data, mean = [0, 0, 0];
    let detail = 0, row = [];
    for (let i = 0; i < w * h; ++i) for (let c = 0; c < 3; ++c) mean[c] += d[4 * i + c] / (w * h);
    for (let i = 0; i < w * h; ++i) row.push(d[4 * i] + d[4 * i + 1] + d[4 * i + 2]);
    for (let y = 0; y < h; ++y) for (let x = 1; x < w; ++x) detail += Math.abs(row[y * w + x] - row[y * w + x - 1]) / (3 * w * h);
    const left = row.filter((v, i) => i % w < w / 2).reduce((a, b) => a + b) , all = row.reduce((a, b) => a + b);
    out.push({mean, detail, left: left / all, row, revision: Number(canvas.dataset.revision || 0), samples: Number(canvas.dataset.samples || 0), size: [canvas.width, canvas.height]});
  }
  return out;
})()"""


def main():
    wale, scene = sys.argv[1:3]
    shots = sys.argv[4] if len(sys.argv) > 4 else None
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not chromium:
        print("Chromium is not installed (apt-get install chromium)")
        return 77
    server = subprocess.Popen([wale, "serve", scene, "--port", "0", "--quiet", "--size", "96x96" if not shots else "320x320"],
                              stdout=subprocess.PIPE, text=True)
    folder, page, failed = tempfile.mkdtemp(prefix="wale_page_"), None, []

    def expect(holds, what):
        print(("ok   " if holds else "FAIL ") + what, flush=True)
        if not holds:
            failed.append(what)

    try:
        address = server.stdout.readline().strip()
        page = Page(chromium, folder)
        page.call("Emulation.setDeviceMetricsOverride", width=1280, height=860, deviceScaleFactor=1, mobile=False)
        page.call("Page.navigate", url=address)

        def wait(condition, what, seconds=120):
            end = time.time() + seconds
            while not page.run(condition):
                if time.time() > end:
                    raise TimeoutError(what + ": " + str(page.run("document.body.innerText"))[:2000])
                time.sleep(0.05)

        def shown(samples=32):
            wait(f"state && waiting.size === 0 && [...document.querySelectorAll('#stage canvas')].length === state.views.length && "
                 f"[...document.querySelectorAll('#stage canvas')].every(c => Number(c.dataset.revision) >= state.revision && "
                 f"Number(c.dataset.samples) >= {samples})", "a picture")
            time.sleep(0.1)
            return page.run(STATISTICS)

        def turn(control, value):
            expect(page.run(f"rows.has({json.dumps(control)})"), f"{control} is there")
            before = page.run("state.revision")
            page.run(f"(() => {{ const i = rows.get({json.dumps(control)}).input; i.value = {json.dumps(value)}; "
                     "i.dispatchEvent(new Event('input')); i.dispatchEvent(new Event('change')); })()")
            wait(f"state.revision > {before} || rows.get({json.dumps(control)}).error.textContent", control)
            error = page.run(f"rows.has({json.dumps(control)}) ? rows.get({json.dumps(control)}).error.textContent : ''")
            expect(not error, f"{control} = {value} is taken {error}")
            return shown()

        def undo():
            before = page.run("state.revision")
            page.run("document.getElementById('undo').click()")
            wait(f"state.revision > {before}", "undo")
            return shown()

        def difference(a, b):
            return sum(abs(x - y) for x, y in zip(a["row"], b["row"])) / (3 * len(a["row"]))

        wait("typeof state === 'object' && state !== null", "the state")
        if shots:
            os.makedirs(shots, exist_ok=True)
            shown(6)
            for name, w, h, dark, phone in [("desktop_light", 1280, 860, False, False), ("desktop_dark", 1280, 860, True, False),
                                            ("phone_light", 360, 740, False, True), ("phone_dark", 360, 740, True, True)]:
                page.shot(os.path.join(shots, name + ".png"), w, h, dark, phone)
            page.run("(() => { const i = rows.get('view.lit').input; i.value = 'both'; i.dispatchEvent(new Event('input')); })()")
            time.sleep(1)
            shown(4)
            page.shot(os.path.join(shots, "phone_both_light.png"), 360, 740, False, True)
            page.shot(os.path.join(shots, "desktop_both_dark.png"), 1280, 860, True)
            return 0
        base = shown(32)[0]
        again = shown(64)[0]
        noise = difference(base, again)
        expect(base["mean"][0] > 10, f"a picture is shown: mean {base['mean']}, noise {noise:.2f}")
        base = again

        def changed(control, value, says, text):
            start = base
            if control.endswith(".detail"):  # fibres show only where pixels are as small as they are
                turn("camera.fov", 2)
                start = shown(64)[0]
            now = turn(control, value)
            d = difference(start, now[0])
            expect(d > max(1.3 * noise, 0.25), f"{control} = {value}: the picture changes, {d:.2f} against noise {noise:.2f}")
            expect(says(now), f"{control} = {value}: {text}")
            undo()
            if start is not base:
                undo()

        light = lambda s: sum(s["mean"])
        ids = page.run("[...rows.keys()]")
        find = lambda end: next(i for i in ids if i.endswith(end))
        checks = [
            (find(".color"), "#1030c0", lambda n: n[0]["mean"][2] - n[0]["mean"][0] > base["mean"][2] - base["mean"][0] + 10, "bluer"),
            (find(".gloss"), 1, lambda n: light(n[0]) != light(base), "another highlight"),
            (find(".translucency"), 1, lambda n: light(n[0]) != light(base), "another light through it"),
            (find(".preset"), "silk", lambda n: True, "another fibre"),
            ("fabrics.0.pattern", "rib_2x2", lambda n: True, "another pattern"),
            (find("gauge.wales"), page.run(f"rows.get('{find('gauge.wales')}').c.value") / 2, lambda n: n[0]["detail"] != base["detail"], "other stitches"),
            ("fabrics.0.yarn.plies", 1, lambda n: True, "one ply"),
            ("fabrics.0.yarn.twist_pitch", -10, lambda n: True, "twisted the other way"),
            ("fabrics.0.yarn.thickness", 0.5, lambda n: True, "thinner"),
            ("fabrics.0.detail", "none", lambda n: True, "smooth plies"),
            ("fabrics.0.flyaways.hairs", 8, lambda n: True, "hairs"),
            ("lights.0.intensity", 0.2, lambda n: light(n[0]) < 0.8 * light(base), "darker"),
            ("lights.0.position.around", 80, lambda n: n[0]["left"] < base["left"], "light from the right"),
            ("lights.0.position.above", -40, lambda n: True, "light from below"),
            ("lights.1.intensity", 4, lambda n: light(n[0]) > 1.1 * light(base), "a brighter sky"),
            ("camera.fov", 8, lambda n: True, "nearer"),
            ("film.exposure", 1, lambda n: light(n[0]) > 1.2 * light(base), "brighter"),
            ("film.view", "srgb", lambda n: True, "another tone curve"),
            ("accuracy", "draft", lambda n: True, "cheaper"),
            ("view.lit", "back", lambda n: light(n[0]) != light(base), "light through the cloth"),
        ]
        turned = {c[0] for c in checks} | {"view.goal"}
        expect(set(ids) <= turned, f"every control is turned; not: {sorted(set(ids) - turned)}")
        for check in checks:
            if check[0] == "view.lit":
                now = turn("view.lit", "back")
                expect(difference(base, now[0]) > 1.3 * noise, "lit from behind: the picture changes")
                both = turn("view.lit", "both")
                expect(len(both) == 2 and difference(both[0], both[1]) > 1.3 * noise, "front and back light side by side")
                turn("view.lit", "scene")
            else:
                changed(*check)
        back = shown()[0]
        expect(difference(base, back) < max(3 * noise, 1.5), f"undone, it is as it was: {difference(base, back):.2f}")

        # mouse, keyboard, wheel
        box = page.run("(() => { const r = document.getElementById('stage').getBoundingClientRect(); return [r.x + r.width / 2, r.y + r.height / 2]; })()")
        mouse = lambda kind, x, y, **more: page.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, **more)
        before = page.run("state.revision")
        mouse("mousePressed", *box, button="left", clickCount=1)
        for i in range(6):
            mouse("mouseMoved", box[0] + 15 * i, box[1] + 4 * i, button="left", buttons=1)
        mouse("mouseReleased", box[0] + 75, box[1] + 20, button="left", clickCount=1)
        wait(f"state.revision > {before}", "orbit")
        expect(difference(base, shown()[0]) > 1.3 * noise, "a drag turns the camera")
        expect(len(page.run("state.edits")) == 2, f"a drag is one edit: {page.run('state.edits')}")
        undo()
        before = page.run("state.revision")
        mouse("mouseWheel", *box, deltaX=0, deltaY=-200)
        wait(f"state.revision > {before}", "wheel")
        expect(difference(base, shown()[0]) > 1.3 * noise, "the wheel zooms")
        undo()
        before = page.run("state.revision")
        page.run("document.getElementById('stage').focus()")
        page.call("Input.dispatchKeyEvent", type="keyDown", key="ArrowRight", code="ArrowRight", windowsVirtualKeyCode=39)
        wait(f"state.revision > {before}", "key")
        expect(difference(base, shown()[0]) > 1.3 * noise, "the arrow keys turn")
        undo()

        # errors stand beside the control; saving asks; the command line is there
        page.run("document.getElementById('any').value = 'film.exposure=99'; document.getElementById('apply').click()")
        wait("document.getElementById('any-error').textContent.includes('out of range')", "an error")
        expect(True, "an error is shown by its field")
        turn(find(".color"), "#40a060")
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
