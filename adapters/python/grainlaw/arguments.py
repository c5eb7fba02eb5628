"""Numbers that callers give: read, or refused in words before anything is done with them."""
from __future__ import annotations

import math
import numbers
import operator
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

LARGEST_INT = 2**31 - 1    # of C
MOST_STEPS = 10**7         # of one way: months of evaluations

Refusal = Callable[[str], Exception]


def whole(what: str, value: Any, least: int, most: int, refuse: Refusal = ValueError,
          hint: str = "") -> int:
    """A whole number from least to most, of Python or numpy."""
    try:
        found = operator.index(value)
    except TypeError:
        found = least - 1
    if not least <= found <= most:
        raise refuse(f"{what} {value!r}: expected a whole number from {least} to {most}{hint}")
    return found


def number(what: str, value: Any, refuse: Refusal = ValueError, finite: bool = True) -> float:
    """A real number, of Python or an array of numpy without axes."""
    real = isinstance(value, numbers.Real) or (
        isinstance(value, np.ndarray) and value.shape == () and value.dtype.kind in "iuf"
        and not masked(value))
    try:
        found = float(value) if real else math.nan
    except OverflowError:
        found = math.inf
    # No comparison with a NaN: a host may trap that.
    if not real or (finite and not math.isfinite(found)):
        raise refuse(f"{what} {value!r}: expected a {'finite ' if finite else ''}number")
    return found


def several(what: str, values: Any, expected: str) -> list[Any]:
    """A list, tuple, array or the like; not a text."""
    if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
        raise TypeError(f"{what} {values!r}: expected {expected}")
    return list(values)


def masked(values: Any) -> bool:
    """Whether entries of an array, or of one in a list of them, are masked."""
    if isinstance(values, np.ma.MaskedArray):
        return bool(np.any(values.mask))
    return isinstance(values, (list, tuple)) and any(masked(one) for one in values)
