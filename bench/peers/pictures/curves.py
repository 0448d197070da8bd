"""The ply curves that `wale export` wrote, as arrays. Millimetres, so that no renderer's absolute offsets matter."""
import numpy as np


def read_mitsuba_text(path):
    """Curves of a text file, "x y z radius" a line, empty lines between curves: (points n x 3, radii n, sizes)."""
    with open(path, encoding="ascii") as file:
        blocks = [block for block in file.read().split("\n\n") if block.strip()]
    values = [np.array(block.split(), dtype=np.float64).reshape(-1, 4) for block in blocks]
    rows = 1000.0 * np.concatenate(values)
    return rows[:, :3].astype(np.float32), rows[:, 3].astype(np.float32), np.array([len(v) for v in values], np.int32)


def write_mitsuba_text(path, points, radii, sizes):
    with open(path, "w", encoding="ascii") as file:
        first = 0
        for size in sizes:
            rows = np.column_stack([points[first:first + size], radii[first:first + size]])
            file.write("\n".join("%.9g %.9g %.9g %.9g" % tuple(row) for row in rows) + "\n\n")
            first += size


def save(path, points, radii, sizes):
    np.savez(path, points=points, radii=radii, sizes=sizes)


def load(path):
    data = np.load(path)
    return data["points"], data["radii"], data["sizes"]
