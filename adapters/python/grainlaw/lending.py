# mypy: allow-untyped-calls
"""Points lent between ranks of MPI by libgrainlaw_lending, which is built and installed where MPI is found.
Needs mpi4py, of the same MPI.

    lending = Lending(comm, states, [material])      # a call of all ranks, as those below
    answer = lending.evaluate(F, Tangent.EXACT)      # the bits of states.evaluate
"""
from __future__ import annotations

import ctypes
import os
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from mpi4py import MPI

from .abi import library, load_by
from .material import Material
from .names import ABI, Summary
from .points import Evaluation, States, _numbers, _Outcome
from .ranks import together


class Lent(ctypes.Structure):
    """What lending did on this rank since it was switched on: grainlaw_lent."""

    size: int
    offered: int       #: points that others could have taken [-]
    lent: int          #: of these, points that others evaluated [-]
    taken: int         #: points of others that this rank evaluated [-]
    bytes: float       #: that it got and gave back for these [byte]
    packing: float     #: processor time of offering, and of taking answers over [s]
    carrying: float    #: processor time of getting points of others and giving them back [s]
    own: float         #: processor time of evaluating own points [s]
    seconds: float     #: processor time of evaluating points of others [s]
    _fields_ = [("size", ctypes.c_size_t), ("offered", ctypes.c_long), ("lent", ctypes.c_long),
                ("taken", ctypes.c_long), ("bytes", ctypes.c_double), ("packing", ctypes.c_double),
                ("carrying", ctypes.c_double), ("own", ctypes.c_double), ("seconds", ctypes.c_double)]


class Lending:
    """Ranks that are done with their own points evaluate points of others. The states are shared as by
    States.share. What it holds is freed by close(), or when the process ends.

    materials    the same on all ranks, in one order
    material_of  number of the material of each point (n,); None: all are of the first

    Raises Error, the same on all ranks, and one rank alone ImportError without the library."""

    def __init__(self, comm: MPI.Intracomm, states: States, materials: Sequence[Material],
                 material_of: npt.ArrayLike | None = None) -> None:
        with together(comm):
            self._library = _open()
        self._states = states
        self._handle = ctypes.c_void_p()
        handles = (ctypes.c_void_p * len(materials))(
            *(material._handle._as_parameter_.value for material in materials))
        numbers = None if material_of is None else np.ascontiguousarray(material_of, np.intc)
        load_by(self._library.grainlaw_lending_create, comm.py2f(), states._handle, len(materials),
                handles, None if numbers is None else numbers.ctypes.data, ctypes.byref(self._handle))

    def evaluate(self, F: npt.ArrayLike, tangent: int | None = None) -> Evaluation:
        """As States.evaluate, in one thread of each rank."""
        n, d = len(self._states), self._states.dimension
        deformation, out = _numbers(F, (n, d, d)), _Outcome(n, d, tangent)
        return out.evaluation(self._library.grainlaw_lending_evaluate(
            self._handle, deformation.ctypes.data, out.want, out.P.ctypes.data,
            None if out.A is None else out.A.ctypes.data, out.status.ctypes.data,
            out.reports.ctypes.data, ctypes.byref(out.summary)))

    @property
    def count(self) -> Lent:
        """What it did on this rank so far."""
        found: Lent = self._library.grainlaw_lending_count(self._handle)
        return found

    def close(self) -> None:
        """End it; the states are shared no more. A call of all ranks."""
        self._library.grainlaw_lending_destroy(self._handle)
        self._handle = ctypes.c_void_p()


def _open() -> ctypes.CDLL:
    """The library beside that of the law, or the one that the dynamic loader finds."""
    path = os.path.join(os.path.dirname(library._name), f"libgrainlaw_lending.so.{ABI}")
    try:
        opened = ctypes.CDLL(path)
    except OSError as error:
        raise ImportError(f"points cannot be lent: {error}; CMake builds {os.path.basename(path)} where it "
                          "finds MPI (Debian: libopenmpi-dev)") from None
    pointer, size = ctypes.c_void_p, ctypes.c_size_t
    opened.grainlaw_lending_create.argtypes = (ctypes.c_int, pointer, size, pointer, pointer, pointer,
                                               ctypes.c_char_p, size)
    opened.grainlaw_lending_destroy.argtypes = (pointer,)
    opened.grainlaw_lending_destroy.restype = None
    opened.grainlaw_lending_evaluate.argtypes = (pointer, pointer, ctypes.c_uint, pointer, pointer,
                                                 pointer, pointer, ctypes.POINTER(Summary))
    opened.grainlaw_lending_count.argtypes = (pointer,)
    opened.grainlaw_lending_count.restype = Lent
    return opened
