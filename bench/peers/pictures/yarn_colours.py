"""The yarn's colour in each peer's own terms, frozen: the mean of the picture "close" then is that of Wale's
(`calibrate.py`).

Mitsuba and Cycles have the hair model of Chiang et al. (2016): a dielectric fibre of refractive index 1.55, scales
tilted by 2 degrees, absorption sigma_a = (ln C / p(beta_n))^2 of an artist's colour C, their eq. 9. A ply is a
bundle and scatters wider than a hair: of the roughnesses 0.3 (both programs' default), 0.5, 0.7 and 0.9 the last
gives pictures whose contrast is nearest to Wale's. LuxCore has no model of hair: `glossytranslucent`, colour kd
reflected, kt transmitted."""
import math

INDEX = 1.55
ROUGHNESS = 0.9  # along and around the ply
TILT = 2.0  # degrees

MITSUBA = [0.451, 0.324, 0.1385]
CYCLES = [0.4455, 0.320, 0.1364]
LUXCORE = [0.778, 0.640, 0.350]  # kd; kt is the same


def absorption(colour, beta):
    p = 5.969 - 0.215 * beta + 2.532 * beta**2 - 10.73 * beta**3 + 5.574 * beta**4 + 0.245 * beta**5
    return [(math.log(c) / p) ** 2 for c in colour]
