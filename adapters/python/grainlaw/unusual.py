"""Stresses that somebody may have given in another unit: asked about, as the command does."""
from __future__ import annotations

import sys
import warnings
from collections.abc import Mapping

FAR = 100   # times the pressure of the packing, or a hundredth: 100 for 100 kPa


def ask(pressure: float, stresses: Mapping[str, float | None]) -> None:
    """Warns of what goes far from the mean pressure at the start [Pa]."""
    for name, value in stresses.items():
        if not value or pressure <= 0 or pressure / FAR < abs(value) < pressure * FAR:
            continue
        warnings.warn(f"{name} of {value:.3g} Pa for a packing under {pressure:.3g} Pa: is it in Pa?",
                      stacklevel=_outside())


def _outside() -> int:
    """Where the call into this package is, for a warning that tells its line."""
    level, frame = 1, sys._getframe(1)   # pylint: disable=protected-access
    while frame.f_back and frame.f_globals.get("__package__") == __package__:
        level, frame = level + 1, frame.f_back
    return level
