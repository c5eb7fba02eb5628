"""Particles and contacts of a state as structured arrays of numpy."""
from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from .abi import check
from .arrays import Records
from .names import Contact, Particle

_ABOUT_AXIS_3 = ("rotation", "moment")
_YES_OR_NO = ("sliding", "bonded")


def records(function: Callable[..., int], state: ctypes.c_void_p,
            struct: type[Particle] | type[Contact], dimension: int) -> Records:
    """All records of a state, by a function of the library, vectors in `dimension` components."""
    size = ctypes.sizeof(struct)
    count = ctypes.c_size_t()
    check(function(state, None, size, ctypes.byref(count)))
    raw: Records = np.zeros(count.value, np.dtype(struct))
    check(function(state, raw.ctypes.data, size, ctypes.byref(count)))
    names = raw.dtype.names or ()
    columns = {name: _column(raw[name], name, dimension) for name in names}
    kind = np.dtype([(name, column.dtype, column.shape[1:]) for name, column in columns.items()])
    result = np.empty(len(raw), kind)
    for name, column in columns.items():
        result[name] = column
    return result


def _column(column: npt.NDArray[Any], name: str, dimension: int) -> npt.NDArray[Any]:
    if name in _YES_OR_NO:
        return column.astype(bool)
    if column.ndim == 1 or dimension == 3:
        return column
    return column[:, 2] if name in _ABOUT_AXIS_3 else column[:, :2]
