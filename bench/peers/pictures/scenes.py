"""The frozen scenes of the comparison: what every renderer is given. Lengths are millimetres, angles degrees, radiance
W/(m^2 sr) in linear Rec. 709; y is up in the picture unless `up` says otherwise; pictures are square."""

# Scattering events of a path, the last of them lit by light sampling and by what its ray meets.
DEPTH = 12

ENVIRONMENT = 0.25  # constant radiance from all sides, seen by the camera

# The artist's colour of Wale's wool; yarn_colours.py has the peers'.
WOOL = [0.70, 0.40, 0.16]


def swatch(side, wales):
    mesh = {"generator": "swatch", "width": side, "height": side, "nu": 16, "nv": 16}
    return {"mesh": mesh, "gauge": {"wales": wales}}


def drape(side, wales):
    mesh = {"generator": "draped_square", "size": side, "sphere_radius": 50, "nu": 96}
    return {"mesh": mesh, "gauge": {"wales": wales}}


SCENES = {
    # A flat swatch, 8 stitches across the picture.
    "close": {
        "fabric": swatch(40, 40),
        "camera": {"position": [6, -18, 57], "look_at": [0, 0, 0], "up": [0, 1, 0], "fov": 19},
        "light": {"position": [-120, 120, 180], "look_at": [0, 0, 0], "up": [0, 1, 0], "side": 120, "radiance": 16},
    },
    # A square of cloth as it hangs over a ball (which is not there), a stitch is 4.6 pixels wide at 256 x 256.
    "drape": {
        "fabric": drape(185, 30),
        "camera": {"position": [110, -345, 185], "look_at": [0, 0, -25], "up": [0, 0, 1], "fov": 26},
        "light": {"position": [-280, -215, 370], "look_at": [0, 0, 0], "up": [0, 0, 1], "side": 215, "radiance": 18},
    },
    # No cloth: two diffuse pages at a right angle. Tells whether light, camera and depth mean the same everywhere.
    "book": {
        "pages": {"albedo": 0.8, "side": 60},
        "camera": {"position": [60, -20, 90], "look_at": [12, 0, 10], "up": [0, 1, 0], "fov": 20},
        "light": {"position": [120, 120, 180], "look_at": [0, 0, 0], "up": [0, 1, 0], "side": 120, "radiance": 16},
    },
}


def pages(scene):
    """Corners and triangles of the book: one page in z = 0, x >= 0, the other rises from its left edge along +z."""
    side = scene["pages"]["side"]
    h = side / 2
    flat = [[0, -h, 0], [side, -h, 0], [side, h, 0], [0, h, 0]]
    rising = [[0, -h, 0], [0, h, 0], [0, h, side], [0, -h, side]]  # its own corners, so that no normal is an average
    return flat + rising, [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]


def light_corners(light):
    """Four corners of the quad light, counter-clockwise seen from where it shines."""
    import numpy as np

    at = np.array(light["position"], float)
    forward = np.array(light["look_at"], float) - at
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, np.array(light["up"], float))
    right /= np.linalg.norm(right)
    up = np.cross(right, forward)
    h = light["side"] / 2
    return [list(at + h * (a * right + b * up)) for a, b in [(1, -1), (-1, -1), (-1, 1), (1, 1)]]


def wale_scene(scene, size, depth, seed, mesh_file=None):
    """The scene file that Wale reads; `mesh_file` holds the pages, where the scene has some."""
    camera, light = scene["camera"], scene["light"]
    out = {
        "wale": 1,
        "units": "mm",
        "camera": camera,
        "film": {"size": [size, size], "filter": "box"},
        "integrator": {"max_depth": depth, "seed": seed},
        "materials": {"yarn": {"type": "ply", "preset": "wool", "color": WOOL}},
        "lights": [
            {"type": "quad", "position": light["position"], "look_at": light["look_at"], "up": light["up"],
             "width": light["side"], "height": light["side"], "radiance": light["radiance"]},
            {"type": "environment", "radiance": ENVIRONMENT},
        ],
    }
    if "fabric" in scene:
        out["fabrics"] = [{"pattern": {"builtin": "stockinette"}, "yarn": {"plies": 3, "twist_pitch": 8},
                           "material": "yarn", **scene["fabric"]}]
    else:
        out["materials"]["page"] = {"type": "diffuse", "color": [scene["pages"]["albedo"]] * 3}
        out["objects"] = [{"type": "mesh", "mesh": mesh_file, "transform": {"scale": 0.001}, "material": "page"}]
    return out
