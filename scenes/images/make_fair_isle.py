"""Writes fair_isle.png: one pixel a stitch, 24 stitches wide, 32 courses high, to be repeated.

    make_fair_isle.py [FILE]
"""
import struct
import sys
import zlib

# From the top; n navy, c cream, r red, t teal.
CHART = """
ccnncccnncccccnncccnnccc
nnccnnnccnnnnnccnnnccnnn
nnnnnnnnnnnnnnnnnnnnnnnn
crrrrrcrrrrrcrrrrrcrrrrr
rcrrrcrcrrrcrcrrrcrcrrrc
rrcrcrrrcrcrrrcrcrrrcrcr
rrrcrrrrrcrrrrrcrrrrrcrr
rrcrcrrrcrcrrrcrcrrrcrcr
rcrrrcrcrrrcrcrrrcrcrrrc
crrrrrcrrrrrcrrrrrcrrrrr
nnnnnnnnnnnnnnnnnnnnnnnn
cncncncncncncncncncncncn
cccccccccccccccccccccccc
ccccccccccctcccccccccccc
ccctccccccttccccctcccccc
cccttccccttttcccttcccccc
cccttttcctttttcttttccccc
cccctttttcttctttttcccccc
ccccctttttcctttttccccccc
tttttttcctttttcctttttttt
ccccctttttcctttttccccccc
cccctttttcttctttttcccccc
cccttttcctttttcttttccccc
cccttccccttttcccttcccccc
ccctccccccttccccctcccccc
ccccccccccctcccccccccccc
cccccccccccccccccccccccc
cncncncncncncncncncncncn
nnnnnnnnnnnnnnnnnnnnnnnn
rnnrrnnrrnnrrnnrrnnrrnnr
rrnnrrnnrrnnrrnnrrnnrrnn
nnnnnnnnnnnnnnnnnnnnnnnn
""".split()
COLORS = {"n": (30, 42, 84), "c": (238, 228, 206), "r": (168, 42, 40), "t": (38, 116, 118)}


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def main():
    width, height = len(CHART[0]), len(CHART)
    rows = b"".join(b"\0" + bytes(v for stitch in row for v in COLORS[stitch]) for row in CHART)
    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    with open(sys.argv[1] if len(sys.argv) > 1 else "fair_isle.png", "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) +
                  chunk(b"IEND", b""))


if __name__ == "__main__":
    main()
