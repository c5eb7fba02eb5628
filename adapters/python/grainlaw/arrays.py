"""Types that several modules share."""
from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Records = npt.NDArray[np.void]   # a structured array


class Reached(Protocol):
    """Where a test is after a step: what a row of its result is made of."""

    F: Array            #: (d, d) deformation gradient [-]
    P: Array            #: (d, d) first Piola-Kirchhoff stress [Pa]
    A: Array | None     #: (d, d, d, d) dP/dF [Pa], where it was asked for
    work: float         #: of P on dF since the start of the test [J]
    report: Any         #: fields of grainlaw_report
    loose_parts: int    #: parts of steps that ended out of balance, so far
