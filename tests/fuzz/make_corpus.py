#!/usr/bin/env python3
"""Writes the seeds of the readers' fuzzers: the smallest files that reach every branch of a format.

usage: make_corpus.py [FOLDER]   (pictures need oiiotool)
"""
import io
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent / "corpus")


def write(target, name, data):
    (ROOT / target).mkdir(parents=True, exist_ok=True)
    (ROOT / target / name).write_bytes(data if isinstance(data, bytes) else data.encode())


def pyp(period, radius, points, edges):
    rows = [f"*pattern\n{period[0]} {period[1]} {radius} {len(points)}\n*Q"]
    rows += [" ".join(map(str, p)) for p in points] + ["*E"]
    return "\n".join(rows + [" ".join(map(str, e)) for e in edges]) + "\n"


def patterns():
    write("pyp", "row", "# one yarn\n" + pyp((1, 1), 0.1, [(0.2, 0.5, 0), (0.7, 0.5, 0.1)], [(0, 1, 0, 0), (1, 0, 1, 0)]))
    write("pyp", "ring", pyp((1, 1), 0.1, [(0.2, 0.2, 0), (0.7, 0.2, 0), (0.5, 0.7, 0)],
                             [(0, 1, 0, 0), (1, 2, 0, 0), (2, 0, 0, 0)]))
    write("pyp", "weave", pyp((1, 1), 0.1, [(0, 0.5, 0.1), (0.5, 0.5, -0.1), (0.5, 0, 0.1), (0.5, 0.5, 0.1)],
                              [(0, 1, 0, 0), (1, 0, 1, 0), (2, 3, 0, 0), (3, 2, 0, 1)]))

    def leaf(*curves):
        text = f"Num Yarns: {len(curves)}\n"
        return text + "".join(f"\n{len(c)}\n" + "".join("%g %g %g\n" % p for p in c) for c in curves)

    row = [(x / 2, 0, 0) for x in range(5)]
    write("leaf", "grid", leaf(row, [(1, y / 2, 1) for y in range(5)]))
    write("leaf", "overlap", leaf(row + [(2.5, 0, 0)], [(1, y / 2, 1) for y in range(6)]))
    write("leaf", "twice", leaf(row, row[::-1], [(0.7, 0, 0.2), (0.7, 2, 0.2)], [(0.7, 2, 0.2), (0.7, 0, 0.2)]))

    def bcc(kind, up, *curves):
        total = sum(len(c) for c, _ in curves)
        out = b"BCC\x44" + kind + bytes([3, up]) + struct.pack("<QQ", len(curves), total)
        out += bytes(64 - len(out))
        for points, closed in curves:
            out += struct.pack("<i", -len(points) if closed else len(points))
            out += b"".join(struct.pack("<3f", *p) for p in points)
        return out

    line = [(0, 0.5, 0), (0.5, 0.5, 0.1), (1, 0.5, 0)]
    write("bcc", "line", bcc(b"C0", 2, (line, False)))
    write("bcc", "ring", bcc(b"BS", 1, ([(0, 0, 0), (0.3, 0, 0), (0, 0, 0.3), (0, 0, 0)], True)))
    write("bcc", "up", bcc(b"PL", 0, ([(0.5, 0, 0), (0.5, 0, 1)], False)))

    tile = {"wale_tile": 1, "name": "row", "period": [0.01, 0.01], "yarn_radius": 0.001, "stitches": [1, 1],
            "kind": "bspline", "curves": [{"points": [[0, 0.005, 0], [0.005, 0.005, 0], [0.01, 0.005, 0]], "closed": False}]}
    write("tile_json", "row", json.dumps(tile))
    tile["curves"] = [{"points": [[0.001, 0.002, 0], [0.004, 0.002, 0], [0.002, 0.004, 0.001]], "closed": True}]
    del tile["stitches"], tile["kind"], tile["name"]
    write("tile_json", "ring", json.dumps(tile))


def sequences():
    def matrix(rows, columns, kind, values):
        return struct.pack("<II", rows, columns) + struct.pack(f"<{rows * columns}{kind}", *values)

    def empty(columns):
        return struct.pack("<II", 0, columns)

    def frame(vertices, triangles, uv, uv_triangles, obstacles=0):
        out = matrix(len(vertices) // 3, 3, "f", vertices)
        out += matrix(len(triangles) // 3, 3, "I", triangles) if triangles else empty(3)
        out += matrix(len(uv) // 2, 2, "f", uv) if uv else empty(2)
        out += matrix(len(uv_triangles) // 3, 3, "I", uv_triangles) if uv_triangles else empty(3)
        out += bytes([obstacles])
        for _ in range(obstacles):
            out += struct.pack("<f", 1) + matrix(3, 1, "f", [0] * 3) + matrix(4, 1, "f", [0] * 4)
        out += bytes([obstacles]) + matrix(2, 3, "f", [0] * 6) * obstacles
        return out + bytes([obstacles]) + matrix(1, 3, "I", [0] * 3) * obstacles

    square, faces, uv = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], [0, 1, 2, 0, 2, 3], [0, 0, 1, 0, 1, 1, 0, 1]
    up = [x + (i % 3 == 2) for i, x in enumerate(square)]
    write("frames", "moves", b"\x02" + frame(square, faces, uv, faces) + frame(up, [], [], []))
    write("frames", "obstacle", b"\x01" + frame(square, faces, uv, faces, 1))
    write("frames", "remeshed", b"\x02" + frame(square, faces, uv, faces) + frame(square[:9], faces[:3], uv[:6], faces[:3]))
    write("frames", "long", b"\x80\x82" + frame(square, faces, [], []) + frame(up, [], [], []) * 129)

    def cache(points, samples, rate):
        head = b"POINTCACHE2\0" + struct.pack("<iiffi", 1, points, 1, rate, samples)
        return head + struct.pack(f"<{3 * points * samples}f", *[i % 7 for i in range(3 * points * samples)])

    write("pc2", "one", cache(3, 1, 1))
    write("pc2", "half", cache(3, 4, 0.5))


def charts():
    write("chart", "rib", "name: rib\nk2 p2\n")
    write("chart", "lace", "# holes\nk6\nk3 yo k2tog k\nk6\nssk o k4\n")
    write("chart", "cable", "p2k4p2\np2 c2/2f p2\np k c2/1b k2 p\n")
    write("chart", "colors", "yarn a: #1d3f72\nyarn b:\nk4 | ab2a\nk s S k | b\nk4 | a\nk t T k | b\n")
    write("chart_json", "rows", json.dumps({"wale_chart": 1, "name": "two", "rows": ["k2 p2", ["k", "k", "p2"]]}))
    write("chart_json", "yarns", json.dumps({"wale_chart": 1, "yarns": {"a": "#102030", "b": None}, "rows": [
        {"stitches": "k4", "yarns": "abab"}, {"stitches": ["k", "k2tog", "yo", "k"], "yarns": ["a4"]}, "k4 | b"]}))
    head = ";!knitout-2\n;;Carriers: 1 2\ninhook 1\n"

    def swatch(rows, needles, work, before=lambda row: ""):
        text = head
        for row in range(rows):
            text += before(row)
            order = range(1, needles + 1) if row % 2 == 0 else range(needles, 0, -1)
            text += "".join(work(row, n, "+-"[row % 2]) for n in order)
        return text

    plain = lambda row, n, way: f"knit {way} f{n} 1\n"
    write("knitout", "jersey", swatch(8, 8, plain) + "outhook 1\n")
    write("knitout", "beds", swatch(9, 8, lambda row, n, way: f"{'tuck' if row % 2 and n % 2 else 'knit'} {way} {'fb'[n % 2]}{n} 1\n"))
    write("knitout", "lace", swatch(10, 12, plain, lambda row: "" if row % 2 else "".join(
        f"xfer f{n} b{n}\nrack 1\nxfer b{n} f{n + 1}\nrack 0\n" for n in range(3, 12, 3))))


def meshes():
    write("obj", "quad", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 .5\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0\nf 1/1 2/2 3/3 4/4\n")
    write("obj", "relative", "# from the end\no x\nv 0 0 0\nv 1 0 0 1\nv +1 1e0 0\nvn 0 0 1\nf -3//1 -2//1 \\\n -1//1\r\n")
    ply = ("ply\nformat %s 1.0\ncomment seed\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "property float s\nproperty float t\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n")
    corners = [(0, 0, 0, 0, 0), (1, 0, 0, 1, 0), (0, 1, 0, 0, 1)]
    text = ply % "ascii" + "".join("%g %g %g %g %g\n" % c for c in corners) + "3 0 1 2\n"
    write("ply", "text", text)
    write("mesh_text", "ply", text)
    for order, name in (("<", "little"), (">", "big")):
        data = (ply % f"binary_{name}_endian").encode() + b"".join(struct.pack(order + "5f", *c) for c in corners)
        write("ply", name, data + struct.pack(order + "B3i", 3, 0, 1, 2))
        write("mesh_text", name, data + struct.pack(order + "B3i", 3, 0, 1, 2))
    extra = text.replace("element face", "property double quality\nproperty uchar red\nelement face")
    write("ply", "extra", "\n".join(l + " 0.5 255" if l.count(" ") == 4 and l[0] in "01" else l for l in extra.split("\n")))
    off = "OFF\n4 2 0 # counts\n0 0 0\n1 0 0\n1 1 0\n\n0 1 0\n3 0 1 2\n3 0 2 3\n"
    write("off", "two", off)
    write("off", "uv", "STOFF\n3 1 0\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n")
    write("off", "colors", "STCNOFF\n3 2 0\n0 0 0 0 0 1 255 0 0 0 0\n1 0 0 0 0 1 7 1 0\n0 1 0 0 0 1 0 1\n"
          "3 0 1 2 1 0 0\n3 0 2 1 # back\n")
    write("off", "quad", "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n")


def scenes():
    fabric = {"name": "cloth", "mesh": {"generator": "swatch", "width": 20, "height": 20, "nu": 4, "nv": 4},
              "pattern": {"builtin": "stockinette"}, "gauge": {"wales": 30}, "material": "yarn",
              "yarn": {"plies": 3}, "detail": "maps"}
    scene = {"wale": 1, "units": "mm", "camera": {"position": [0, 0, 60], "look_at": [0, 0, 0]},
             "film": {"size": [16, 16]}, "integrator": {"spp": 4, "seed": 7},
             "materials": {"yarn": {"type": "ply", "preset": "wool", "color": "#8040c0"},
                           "floor": {"type": "coated", "color": [0.2, 0.3, 0.4]}},
             "fabrics": [fabric],
             "objects": [{"type": "ground", "material": "floor"}, {"type": "sphere", "center": [0, 0, 0], "radius": 3}],
             "lights": [{"type": "quad", "position": [0, 50, 50], "look_at": [0, 0, 0], "width": 9, "height": 9,
                         "radiance": 5},
                        {"type": "environment", "radiance": [0.3, 0.3, 0.4]}]}
    write("scene", "whole", json.dumps(scene, indent=1))
    write("scene", "least", '{"wale": 1}')
    files = {"wale": 1, "camera": {"type": "orthographic", "position": [0, 0, 1], "height": 0.1},
             "materials": {"m": {"type": "ply", "file": "yarn.json", "gloss": 0.7}},
             "fabrics": [{"mesh": "mesh.obj", "pattern": {"file": "tile.json", "period": [0.01, 0.01]},
                          "repeats": [2, 2], "material": "m", "transform": {"scale": 2, "rotate": [0, 90, 0]}}]}
    write("scene", "files", "// beside it: the files\n" + json.dumps(files))
    fabric = {"mesh": {"file": "mesh.obj"}, "pattern": "tile.json", "uv_metres": True, "material": "m", "detail": "paper",
              "color_image": {"file": "colors.png", "map": "stitches", "origin": [1, 2], "size": [8, 8]}}
    write("scene", "stitches", json.dumps({"wale": 1, "materials": {"m": {"type": "ply"}}, "fabrics": [fabric]}, indent=2))
    write("scene", "shapes", json.dumps(
        {"wale": 1, "objects": [{"type": "mesh", "mesh": "mesh.obj", "transform": {"translate": [0, 0, 1]}}],
         "lights": [{"type": "sphere", "position": [0, 1, 0], "radius": 0.1, "radiance": 2},
                    {"type": "mesh", "mesh": "mesh.obj", "radiance": [1, 1, 1]}]}, indent=2))
    yarn = {"preset": "silk", "fibre_color": [0.9, 0.8, 0.7], "roughness": 5, "ior": 1.5,
            "scattering": {"optical_radius": 2.5, "forward_decay": 0.9, "backward_deflection": -30},
            "fibres": {"count": 90, "twist": -20}}
    write("material", "fitted", '{"type": "ply"}\n' + json.dumps(yarn))
    write("material", "joined", '{"type": "ply", "color": "#102030", "translucency": 0.7}\n' + json.dumps(yarn))
    write("material", "striped", '{"type": "ply", "heather": {"yarn": 0.1}}\n' + json.dumps(
        {"stripes": [{"color": [1, 0, 0], "length": 0.2}, {"color": "#ffffff", "length": 0.1}], "gloss": 1}))
    write("material", "plies", '{"type": "ply", "fibres": {"count": 40}}\n' + json.dumps(
        {"plies": ["#808080", [1, 0.5, 0]], "optical_radius": 3, "fibres": {"twist": 10}}))
    write("material", "direct", '{"type": "ply"}\n{"reflect": [0.1, 0.2, 0.3], "transmit": [0.3, 0.2, 0.1]}')
    write("overrides", "numbers", "film.size=[32, 16]\nintegrator.spp=2\nfabrics.0.yarn.plies=2\n")
    write("overrides", "names", "fabrics.cloth.detail=fibres\nlights.sun.intensity=3\nmaterials.yarn.color=#ff8000\n")


def requests():
    token = "0123456789abcdef0123456789abcdef"
    for name, path, body in [("edit", "/edit", '{"set": ["film.exposure=1"], "gesture": "a"}'),
                             ("control", "/control", '{"control": "view.lit", "value": "both"}'),
                             ("camera", "/camera", '{"orbit": [0.1, -0.2], "pan": [0, 1], "zoom": 1.5}'),
                             ("save", "/save", '{"file": "edited.json", "replace": true}'), ("undo", "/undo", "{}")]:
        write("request", name, f"POST {path} HTTP/1.1\r\nHost: localhost:8737\r\nX-Wale-Token: {token}\r\n"
              f"Content-Type: application/json\r\nContent-Length: {len(body)}\r\nOrigin: http://localhost:8737\r\n\r\n{body}")
    write("request", "page", f"GET /?token={token} HTTP/1.1\r\nHost: [::1]:8737\r\nSec-Fetch-Site: none\r\n\r\n")


def images():
    picture = ["--pattern", "constant:color=.2,.5,.8", "6x5", "3"]
    for name, how in {"a.exr": ["-d", "half"], "b.exr": ["-d", "float", "--compression", "rle"], "c.hdr": [],
                      "d.png": ["-d", "uint8"], "e.png": ["-d", "uint16"], "f.jpg": [], "g.tif": ["-d", "uint8"],
                      "h.tif": ["-d", "float", "--compression", "zip"], "i.bmp": [], "j.tga": [], "k.ppm": ["-d", "uint8"]}.items():
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / name
            subprocess.run(["oiiotool", *picture, *how, "-o", str(file)], check=True)
            write("image", name, file.read_bytes())


def weights():
    def npy(shape, data, kind="<f4", fortran=False):
        header = f"{{'descr': '{kind}', 'fortran_order': {fortran}, 'shape': {shape}, }}\n".encode()
        return b"\x93NUMPY\1\0" + struct.pack("<H", len(header)) + header + data

    write("npy", "matrix", npy("(2, 3)", struct.pack("<6f", *range(6))))
    write("npy", "fortran", npy("(1, 2, 2)", struct.pack("<4d", *range(4)), "<f8", True))
    write("npy", "scalar", npy("()", struct.pack("<f", 1)))
    write("npy", "version2", b"\x93NUMPY\2\0" + struct.pack("<I", 58) +
          b"{\"shape\": (0,), \"fortran_order\": False, \"descr\": \"<f4\"}".ljust(57) + b"\n")

    def npz(name, keras, methods):
        stem, shape = ("block1_conv1_{}", (3, 3, 3, 64)) if keras else ("features.0.{}", (64, 3, 3, 3))
        data = io.BytesIO()
        with zipfile.ZipFile(data, "w") as archive:
            for method, part, extent in zip(methods, *zip((stem.format("kernel") if keras else stem.format("weight"), shape), (stem.format("bias"), (64,)))):
                entry = zipfile.ZipInfo(part + ".npy")  # of 1980, so that the bytes stay
                archive.writestr(entry, npy(extent, bytes(4 * math.prod(extent))), method)
        write("npz", name, data.getvalue())

    packed, stored = zipfile.ZIP_DEFLATED, zipfile.ZIP_STORED
    npz("keras", True, (packed, packed))
    npz("torch", False, (packed, stored))

    def field(number, value):
        if isinstance(value, int):
            return bytes([number << 3, value])
        return bytes([number << 3 | 2, len(value)]) + value

    def node(kind, *names):
        return field(1, b"".join(field(1, n) for n in names) + field(2, b"y") + field(4, kind))

    # The target has the first layer's weights "w" and "b" (tests/fuzz/weights.cpp).
    write("onnx", "layer", field(1, 8) + field(7, node(b"Conv", b"x", b"w", b"b")))
    tensor = field(1, 2) + field(1, 1) + field(2, 1) + field(8, b"t") + field(9, struct.pack("<2f", 1, 2))
    write("onnx", "chain", field(2, b"some exporter") + field(7, field(2, b"vgg") + field(5, tensor) + node(b"Sub", b"p", b"t") +
          node(b"Conv", b"x", b"w", b"b") + node(b"Relu", b"y") + node(b"MaxPool", b"y")))
    packed_axes = field(1, bytes([2, 1])) + field(2, 1) + field(8, b"t") + field(4, struct.pack("<2f", 1, 2))
    write("onnx", "packed", field(7, field(5, packed_axes) + node(b"Conv", b"x", b"w", b"b")))


patterns()
charts()
meshes()
sequences()
scenes()
requests()
weights()
images()
