"""What a test warns of, as the command does: stresses that may be in another unit, and much drag."""
from __future__ import annotations

import sys
import warnings
from collections.abc import Mapping

from .arrays import Array

MUCH_DRAG = 0.1   # unbalanced, above which drag carries part of the load [-]
FAR = 100   # times the pressure of the packing, or a hundredth: 100 for 100 kPa


def ask(pressure: float, stresses: Mapping[str, float | None]) -> None:
    """Warns of what goes far from the mean pressure at the start [Pa]."""
    for name, value in stresses.items():
        if not value or pressure <= 0 or pressure / FAR < abs(value) < pressure * FAR:
            continue
        warnings.warn(f"{name} of {value:.3g} Pa for a packing under {pressure:.3g} Pa: is it in Pa?",
                      stacklevel=_outside())


def tell_drag(unbalanced: Array) -> None:
    """Warns where drag carried part of the load: largest drag on a particle / mean contact force [-]."""
    above = int((unbalanced > MUCH_DRAG).sum())
    if above:
        warnings.warn(f"unbalanced up to {unbalanced.max():.2g} [-], above {MUCH_DRAG:g} in {above} "
                      "steps: drag carries part of the load; a smaller solver.viscous_number lowers "
                      "it", stacklevel=_outside())


def _outside() -> int:
    """Where the call into this package is, for a warning that tells its line."""
    level, frame = 1, sys._getframe(1)   # pylint: disable=protected-access
    while frame.f_back and frame.f_globals.get("__package__") == __package__:
        level, frame = level + 1, frame.f_back
    return level
