"""Noise of a renderer from pictures that differ in the seed alone: the variance of a pixel over the square of the
picture around it, averaged over the channels. The plain mean over all pixels counts fireflies in full; the other
one, the median over blocks of 8 x 8 pixels, shows what most of the picture looks like."""
import itertools

import numpy as np

BLOCK = 8
BLUR = 4  # the surroundings are 9 x 9 pixels


def surroundings(picture):
    padded = np.pad(picture, ((BLUR, BLUR), (BLUR, BLUR), (0, 0)), mode="edge")
    for axis in (0, 1):
        sums = np.cumsum(np.insert(padded, 0, 0, axis=axis), axis=axis)
        n = 2 * BLUR + 1
        high, low = [slice(None)] * 3, [slice(None)] * 3
        high[axis], low[axis] = slice(n, None), slice(None, -n)
        padded = (sums[tuple(high)] - sums[tuple(low)]) / n
    return padded


def relative_variance(a, b):
    """(plain mean, median over blocks) of two pictures with equal samples."""
    if not (np.isfinite(a).all() and np.isfinite(b).all()):
        raise ValueError("a picture holds values that are not finite")
    relative = ((a - b) ** 2 / 2 / surroundings((a + b) / 2) ** 2).mean(axis=2)
    h, w = (n // BLOCK * BLOCK for n in relative.shape)
    blocks = relative[:h, :w].reshape(h // BLOCK, BLOCK, w // BLOCK, BLOCK).mean(axis=(1, 3))
    return relative.mean(), np.median(blocks[blocks > 0])  # blocks without cloth have no noise


def of_seeds(pictures):
    """Mean of (plain, blocks) over all pairs of pictures."""
    return tuple(np.mean([relative_variance(a, b) for a, b in itertools.combinations(pictures, 2)], axis=0))
