"""States of a material: alone and by the set, and what their evaluation comes to."""
from __future__ import annotations

import ctypes
import os
import sys
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from . import plots
from .abi import Error, Handle, bad_argument, c_text, check, library, status_text
from .arrays import Array, Records
from .arguments import LARGEST_INT, masked, number, whole
from .material import AnyPath, Material
from .names import Contact, Particle, Report, Status, Summary
from .particles import records

# grainlaw_report for numpy, its text as one string.
_layout: Any = np.dtype(Report)
_report: np.dtype[np.void] = np.dtype({
    "names": list(_layout.names),
    "formats": [kind.str if kind.subdtype is None else f"S{kind.itemsize}"
                for kind, _ in _layout.fields.values()],
    "offsets": [offset for _, offset in _layout.fields.values()],
    "itemsize": ctypes.sizeof(Report)})


@dataclass
class Evaluation:
    """What an evaluation of n points came to; of a State without the first axis. Rows of points
    that failed are NaN.

    P        (n, d, d) first Piola-Kirchhoff stress [Pa], tension positive
    A        (n, d, d, d, d) tangent dP_iJ/dF_kL [Pa], or None
    status   (n,) Status as numbers
    reports  (n,) fields of grainlaw_report by name, e.g. reports["sliding"] [-]
    """

    P: Array                     #: (n, d, d) first Piola-Kirchhoff stress [Pa]
    A: Array | None              #: (n, d, d, d, d) tangent dP/dF [Pa], None when not asked for
    status: npt.NDArray[np.intc]  #: (n,) Status as numbers
    reports: Records             #: (n,) fields of grainlaw_report by name, e.g. reports["sliding"]
    summary: Summary             #: fields of grainlaw_summary

    @property
    def ok(self) -> bool:
        """Whether all points are well and may be committed."""
        return not np.any(self.status)

    @property
    def failed(self) -> npt.NDArray[np.intp]:
        """Numbers of the points that failed."""
        return np.flatnonzero(self.status)

    @property
    def step_ratio(self) -> float:
        """Smallest factor on the step that a failed point suggests [-]; 1 when all are well."""
        return float(self.summary.step_ratio)

    @property
    def message(self) -> str:
        """The first failed point and why, or "" """
        return _message(self.summary)


def _message(summary: Summary) -> str:
    text: str = summary.message.decode(errors="replace")
    return f"point {summary.first_failed}: {text}" if summary.failed else text


class States:
    """Integration points of one material, evaluated together. F, P, A and measures have the number
    of the point as their first axis. A set may have none, as of a process without cells.

    Pickled with their material and their committed states; a trial is not kept, and the packing
    has to be where it was."""

    material: Material
    dimension: int   #: d, 2 or 3

    def __init__(self, material: Material, count: int) -> None:
        if not isinstance(material, Material):
            raise Error(Status.BAD_HANDLE, f"expected a Material, got {type(material).__name__}")
        count = whole("number of points", count, 0, sys.maxsize, bad_argument)
        self.material = material
        self.dimension = material.dimension
        self._handle = Handle(library.grainlaw_points_create, library.grainlaw_points_destroy,
                              material._handle, count)

    def __len__(self) -> int:
        return int(library.grainlaw_points_size(self._handle))

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {len(self)} points, {self.material!r}>"

    def clone(self) -> Self:
        """An independent copy, committed and trial."""
        copy = self.__class__.__new__(self.__class__)
        copy.material, copy.dimension = self.material, self.dimension
        copy._handle = Handle(library.grainlaw_points_clone, library.grainlaw_points_destroy,
                              self._handle)
        return copy

    def __copy__(self) -> Self:
        return self.clone()

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self.clone()

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (type(self), self.material, len(self), self.save())

    def evaluate(self, F: npt.ArrayLike, tangent: int | None = None, threads: int = 0) -> Evaluation:
        """Evaluation of all points at the total deformation gradients F (n, d, d) [-], with a
        Tangent or without, on so many threads (0: OMP_NUM_THREADS or all processors). Raises Error
        for arrays of another shape or type and where a point's status is < 0."""
        n, d = len(self), self.dimension
        deformation = _numbers(F, (n, d, d))
        want = 0 if tangent is None else whole("tangent", tangent, 0, LARGEST_INT, bad_argument,
                                               ", as grainlaw.Tangent.EXACT, or None")
        threads = whole("threads", threads, -LARGEST_INT, LARGEST_INT, bad_argument, ", 0 for all")
        P = np.full((n, d, d), np.nan)
        A = np.full((n, d, d, d, d), np.nan) if want else None
        status = np.zeros(n, np.intc)
        reports = np.zeros(n, _report)
        reports["size"] = _report.itemsize
        summary = Summary(size=ctypes.sizeof(Summary))
        result = library.grainlaw_points_evaluate(
            self._handle, deformation.ctypes.data, want, P.ctypes.data, None if A is None else A.ctypes.data,
            status.ctypes.data, reports.ctypes.data, threads, ctypes.byref(summary))
        if result < 0:
            raise Error(result, _message(summary), summary.first_failed if summary.failed else None)
        return Evaluation(P, A, status, reports, summary)

    def set_time_step(self, step: float) -> None:
        """How long increments take from now on, in the host's unit, e.g. `LoadSteps.part`: a
        material with solver.viscous_rate asks for it before it deforms. 0: they take no time,
        and F has to stay."""
        step = number("time step", step, bad_argument)
        if step < 0:
            raise bad_argument(f"time step {step!r}: expected a number of at least 0")
        check(library.grainlaw_points_set_time_step(self._handle, step))

    def commit(self) -> None:
        """Make the trial the committed state: of all points or, when one has none, of none."""
        check(library.grainlaw_points_commit(self._handle))

    def revert(self) -> None:
        """Drop the trial, if any."""
        check(library.grainlaw_points_revert(self._handle))

    def save(self) -> bytes:
        """The committed states as bytes, those of grainlaw_points_save."""
        return _saved(library.grainlaw_points_save, self._handle)

    def load(self, saved: bytes | bytearray | memoryview) -> None:
        """Replace the committed states by saved ones: all of them or, on an Error, none."""
        try:
            saved = bytes(memoryview(saved))
        except TypeError:
            raise bad_argument(f"expected saved states as bytes, got {type(saved).__name__}") from None
        message = ctypes.create_string_buffer(256)
        status = library.grainlaw_points_load(self._handle, saved, len(saved), message,
                                              len(message))
        check(status, message.value.decode(errors="replace"))

    def measure(self, what: int) -> Array:
        """A Measure of the trial, or of the committed state where there is no trial: (n,),
        (n, d, d) or (n, components), in the unit that help(grainlaw.Measure) gives."""
        what = whole("measure", what, 0, LARGEST_INT, bad_argument, ", as grainlaw.Measure.VOID_RATIO")
        count = ctypes.c_size_t()
        check(library.grainlaw_points_measure(self._handle, what, None, ctypes.byref(count)))
        values = np.empty(count.value)
        check(library.grainlaw_points_measure(self._handle, what, values.ctypes.data,
                                              ctypes.byref(count)))
        if not len(self):   # the components are those of any point
            return np.empty((0, *States(self.material, 1).measure(what).shape[1:]))
        components, square = count.value // len(self), (self.dimension, self.dimension)
        shape: tuple[int, ...] = (components,)
        if components == 1:
            shape = ()
        elif components == self.dimension**2:
            shape = square
        return values.reshape(len(self), *shape)

    def particles(self, point: int = 0) -> Records:
        """Particles of a point as a structured array, of its trial or, without one, of its
        committed state; copies on a frame included. Fields, d the dimension:

        position  (d,) of the centre, not wrapped into a periodic cell [m]
        rotation  since F = I [rad]: of discs anticlockwise, of spheres a vector (3,)
        radius    [m]
        source    which particle it is, from 0: copies on a frame have one number [-]
        contacts  of it that touch [-]
        """
        return records(library.grainlaw_state_particles, self._state(point), Particle,
                       self.dimension)

    def contacts(self, point: int = 0) -> Records:
        """Touching contacts with their forces, of the same state, ordered by i and j. Fields:

        branch            (d,) from the centre of i to that of j or its periodic image [m]
        normal            (d,) the branch of length 1 [-]
        overlap           [m]
        normal_force      on j along the normal; negative in the tension of a bond [N]
        tangential_force  (d,) on j [N]
        moment            on j [N m]: of discs anticlockwise, of spheres a vector (3,)
        weight            1, or 1 / copies of the contact on a frame [-]
        i, j              numbers of the particles, from 0 [-]
        shift             (d,) periods of the cell between j and its image [-]
        sliding           whether it is at the limit of friction
        bonded            whether by a bond that holds
        """
        return records(library.grainlaw_state_contacts, self._state(point), Contact,
                       self.dimension)

    def plot(self, point: int = 0) -> Any:
        """Particles and force chains of a point, a figure of matplotlib: a bar joins two centres, its
        width goes with the normal force; spheres are seen along axis 2, with the contacts that carry
        more than the mean. Raises ImportError where matplotlib is not installed."""
        return plots.packing(self.particles(point), self.contacts(point))

    def write_vtk(self, path: AnyPath, point: int = 0) -> None:
        """Particles and force chains of a point as a .vtp file for ParaView."""
        self._write(library.grainlaw_state_write_vtk, path, point)

    def write_packing(self, prefix: AnyPath, point: int = 0) -> None:
        """A point as a packing that a material file can read: PREFIX_particles.csv, _contacts.csv
        and _cell.csv."""
        self._write(library.grainlaw_state_write_packing, prefix, point)

    def _state(self, point: int) -> Any:
        point = whole("point", point, 0, len(self) - 1, bad_argument)
        return library.grainlaw_points_state(self._handle, point)

    def _write(self, function: Callable[..., int], path: AnyPath, point: int) -> None:
        name = os.fsdecode(path)
        if not name:
            raise bad_argument("the name of a file '': expected one that is not empty")
        ctypes.set_errno(0)
        status = function(self._state(point), c_text(name))
        cause = ctypes.get_errno() if status == Status.FILE_ERROR else 0
        check(status, f"{name}: {status_text(status)}{f': {os.strerror(cause)}' if cause else ''}")


class State(States):
    """One integration point: the same without the first axis."""

    def __init__(self, material: Material, count: int = 1) -> None:
        if count != 1:
            raise bad_argument(f"a State is one point, got {count!r}: States")
        super().__init__(material, 1)

    def evaluate(self, F: npt.ArrayLike, tangent: int | None = None, threads: int = 1) -> Evaluation:
        """Evaluation at the total deformation gradient F (d, d) [-], with a Tangent or without.
        Raises Error for an array of another shape or type and for a status < 0."""
        d = self.dimension
        answer = super().evaluate(_numbers(F, (d, d))[None], tangent, threads)
        A = None if answer.A is None else answer.A[0]
        return Evaluation(answer.P[0], A, answer.status[0], answer.reports[0], answer.summary)

    def save(self) -> bytes:
        """The committed state as bytes, those of grainlaw_state_save. What C saves can be loaded, and
        C's grainlaw_state_load reads them."""
        return _saved(library.grainlaw_state_save, self._state(0))

    def measure(self, what: int) -> Any:
        """A Measure of the trial, or of the committed state where there is no trial: a number,
        (d, d) or (components,), in the unit that help(grainlaw.Measure) gives."""
        return super().measure(what)[0]


def _saved(function: Callable[..., int], handle: Any) -> bytes:
    size = ctypes.c_size_t()
    check(function(handle, None, ctypes.byref(size)))
    data = ctypes.create_string_buffer(size.value)
    check(function(handle, data, ctypes.byref(size)))
    return data.raw


def _restore(kind: type[States], material: Material, count: int, saved: bytes) -> States:
    states = kind(material, count)
    states.load(saved)
    return states


def _numbers(F: npt.ArrayLike, shape: tuple[int, ...]) -> Array:
    if masked(F):
        raise bad_argument("F has masked entries, expected a number in each")
    try:
        array = np.asarray(F)
    except ValueError as error:
        raise bad_argument(f"F is no array: {error}") from None
    if array.dtype.kind not in "iuf":
        raise bad_argument(f"F holds {array.dtype}, expected real numbers")
    if array.shape != shape:
        raise bad_argument(f"F has the shape {array.shape}, expected {shape}")
    return np.ascontiguousarray(array, dtype=float)
