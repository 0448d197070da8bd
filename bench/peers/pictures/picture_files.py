"""Pictures as height x width x 3 floats, linear, from the .npy of the peers' scripts and from Wale's EXR."""
import numpy as np


def load(path):
    if path.endswith(".npy"):
        return np.load(path).astype(np.float64)
    import mitsuba as mi  # reads EXR
    if mi.variant() is None:
        mi.set_variant("scalar_rgb")
    bitmap = mi.Bitmap(path)
    channels = {field.name: i for i, field in enumerate(bitmap.struct_())}
    return np.array(bitmap)[:, :, [channels[c] for c in "RGB"]].astype(np.float64)
