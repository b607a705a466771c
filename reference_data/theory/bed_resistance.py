"""Pressure drop of a bed of grains by a drag law, as a locally averaged flow has it: what to expect of the mud cake's pressure."""

import math

from drag_laws.drag_laws import LAWS

from theory.clean_channel import DEPTH, FLUID
from theory.packed_beds import pressure_gradient


def bed_drop(law, count, d, lower, height, array, flow):
    """Pa, of `count` grains of diameter d that fill the room between the cylinders from `lower` over `height`; the grains' part alone.

    The superficial velocity is the flow, m3/s, over the cross section that the cylinders leave on average; the void fraction of the
    bed is what the grains leave of that room. A bed without fluid has no pressure drop: NaN.
    """
    if count == 0 or height <= 0.0:
        return 0.0
    room = array.open_area(lower, lower + height) * DEPTH
    eps = 1.0 - count * math.pi * d**3 / 6.0 / room
    if eps <= 0.0:
        return math.nan
    return float(pressure_gradient(LAWS[law], eps, flow * height / room, d, FLUID["rho"], FLUID["mu"])) * height
