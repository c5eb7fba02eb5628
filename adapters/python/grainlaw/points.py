"""States of a material: alone and by the set, and what their evaluation comes to."""
from __future__ import annotations

import ctypes
import functools
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from . import plots
from .abi import (REDUCE, Error, Handle, StepError, as_bytes, bad_argument, c_text, callback, check,
                  library, load_by, saved_by, status_text)
from .arrays import Array, Records
from .arguments import LARGEST_INT, masked, number, whole
from .material import AnyPath, Material
from .names import Consolidation, Contact, Particle, Report, Status, Summary
from .particles import records

# grainlaw_report for numpy, its text as one string.
_layout: Any = np.dtype(Report)
_report: np.dtype[np.void] = np.dtype({
    "names": list(_layout.names),
    "formats": [kind.str if kind.subdtype is None else f"S{kind.itemsize}"
                for kind, _ in _layout.fields.values()],
    "offsets": [offset for _, offset in _layout.fields.values()],
    "itemsize": ctypes.sizeof(Report)})

ROUTES = ("proportional", "isotropic", "k0")   # grainlaw_route


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
        return not np.any(self.status) and self.summary.failed == 0

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
    where = [f"rank {summary.rank}"] if summary.rank >= 0 else []
    where += [f"point {summary.first_failed}"] if summary.failed else []
    return f"{', '.join(where)}: {text}" if where else text


class States:
    """Integration points of one material, evaluated together. F, P, A and measures have the number
    of the point as their first axis. A set may have none, as of a process without cells.

    Pickled with their material and their committed states; a trial is not kept."""

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
        points = "point" if len(self) == 1 else "points"
        return f"<{type(self).__name__} of {len(self)} {points}, {self.material!r}>"

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
        return self._evaluate(None, len(self), F, tangent, threads)

    def evaluate_some(self, which: npt.ArrayLike, F: npt.ArrayLike, tangent: int | None = None,
                      threads: int = 0) -> Evaluation:
        """Evaluation of the points of these numbers (m,) at F (m, d, d) [-]; P, A, status and
        reports are in their order. Other points keep their trials. Raises as evaluate() does, and
        for numbers outside the set or twice."""
        numbers = _points(which)
        return self._evaluate(numbers, len(numbers), F, tangent, threads)

    def answer(self, tangent: int | None = None, threads: int = 0) -> Evaluation:
        """P and A of the committed states, without an increment and with the bits that were
        committed, A where the same tangent was asked for then: what a host goes on from after a
        restart. status and reports are those of no evaluation."""
        out = _Outcome(len(self), self.dimension, tangent)
        result = library.grainlaw_points_answer(
            self._handle, out.want, out.P.ctypes.data, None if out.A is None else out.A.ctypes.data,
            _threads(threads), ctypes.byref(out.summary))
        return out.evaluation(result)

    def _evaluate(self, which: npt.NDArray[np.uintp] | None, n: int, F: npt.ArrayLike,
                  tangent: int | None, threads: int) -> Evaluation:
        deformation = _numbers(F, (n, self.dimension, self.dimension))
        out = _Outcome(n, self.dimension, tangent)
        result = library.grainlaw_points_evaluate_some(
            self._handle, n, None if which is None else which.ctypes.data, deformation.ctypes.data,
            0, out.want, out.P.ctypes.data, 0, None if out.A is None else out.A.ctypes.data, 0,
            out.status.ctypes.data, out.reports.ctypes.data, _threads(threads),
            ctypes.byref(out.summary))
        return out.evaluation(result)

    def consolidate(self, sigma: npt.ArrayLike, which: npt.ArrayLike | None = None, *,
                    route: str = "proportional", axis: npt.ArrayLike | None = None,
                    first_pressure: float = 0.0, overconsolidation: float = 1.0,
                    largest_step: float = 0.05, threads: int = 0) -> Array:
        """Lead these points, or all, to the Cauchy stress sigma (n, d, d) [Pa], tension positive, and
        make that the state at F = I: all points or none. Returns the stress there (n, d, d) [Pa].
        Raises StepError where a packing carries less; its text names the point and what it carries.

        route              "proportional": all components together, from the present stress
                           "isotropic": to the mean pressure with equal principal stresses, then on
                           "k0": the traction on the plane across `axis` is led, without strain
                           within the plane, whose stress is found
        axis               (d,) across that plane, of any length; None: the last axis
        first_pressure     isotropic pressure to lead to before all else [Pa]; 0: none
        overconsolidation  stress of the past over sigma, at least 1 [-]
        largest_step       change of the stress in one increment over its norm [-]
        """
        d = self.dimension
        numbers = np.arange(len(self), dtype=np.uintp) if which is None else _points(which)
        stress = _numbers(sigma, (len(numbers), d, d), "sigma")
        if route not in ROUTES:
            raise bad_argument(f"route {route!r}: expected one of {', '.join(ROUTES)}")
        normal = np.zeros(3)
        if axis is not None:
            normal[:d] = _numbers(axis, (d,), "axis")
        how = Consolidation(ctypes.sizeof(Consolidation), ROUTES.index(route), tuple(normal),
                            number("first_pressure", first_pressure, bad_argument),
                            number("overconsolidation", overconsolidation, bad_argument),
                            number("largest_step", largest_step, bad_argument))
        reached, summary = np.zeros_like(stress), Summary(size=ctypes.sizeof(Summary))
        status = library.grainlaw_points_consolidate(
            self._handle, len(numbers), numbers.ctypes.data, stress.ctypes.data, ctypes.byref(how),
            reached.ctypes.data, None, _threads(threads), ctypes.byref(summary))
        if status < 0:
            raise Error(status, _message(summary), summary.first_failed if summary.failed else None)
        if status > 0:
            raise StepError(status, _message(summary))
        return reached

    def cost(self) -> Array:
        """Processor time of the last evaluation of each point (n,) [s]; 0 before any."""
        seconds = np.zeros(len(self))
        check(library.grainlaw_points_cost(self._handle, seconds.ctypes.data))
        return seconds

    def resize(self, count: int, material: Material | None = None) -> None:
        """Another number of points: those from `count` on are released, new ones begin at F = I, of
        the set's material or of this one."""
        count = whole("number of points", count, 0, sys.maxsize, bad_argument)
        check(library.grainlaw_points_resize(self._handle, count,
                                             None if material is None else material._handle))

    def clone_some(self, which: npt.ArrayLike, source: States, which_of_source: npt.ArrayLike
                   ) -> None:
        """Make the points `which` copies of those of another set, or of this one, committed and
        trial."""
        to, of = _points(which), _points(which_of_source)
        if len(to) != len(of):
            raise bad_argument(f"{len(of)} points to copy to {len(to)}: expected as many")
        check(library.grainlaw_points_clone_some(self._handle, len(to), to.ctypes.data,
                                                 source._handle, of.ctypes.data))

    def save_some(self, which: npt.ArrayLike) -> list[bytes]:
        """The committed states of these points, each as bytes that State.load() takes too."""
        numbers = _points(which)
        offsets = np.zeros(len(numbers) + 1, np.uintp)
        call = functools.partial(library.grainlaw_points_save_some, self._handle, len(numbers),
                                 numbers.ctypes.data)
        check(call(None, offsets.ctypes.data))
        data = ctypes.create_string_buffer(max(1, int(offsets[-1])))
        check(call(data, offsets.ctypes.data))
        ends = offsets.tolist()
        return [data.raw[start:end] for start, end in zip(ends, ends[1:])]

    def load_some(self, which: npt.ArrayLike, saved: Sequence[bytes]) -> None:
        """Replace the committed states of these points by saved ones, each as bytes: all or, on an
        Error, none."""
        numbers = _points(which)
        parts = [as_bytes(one, "a saved point") for one in saved]
        if len(parts) != len(numbers):
            raise bad_argument(f"{len(parts)} saved points for {len(numbers)}: expected as many")
        offsets = np.zeros(len(parts) + 1, np.uintp)
        np.cumsum([len(part) for part in parts], out=offsets[1:])
        load_by(library.grainlaw_points_load_some, self._handle, len(numbers), numbers.ctypes.data,
                b"".join(parts), offsets.ctypes.data)

    def share(self, rank: int, reduce: Callable[[Array, str], npt.ArrayLike] | None) -> None:
        """Share failures with other ranks: evaluations and commits are then calls of all of them, and
        agree on status, message and step ratio. reduce(values, "min" or "sum") returns what the
        ranks' values come to, e.g. by mpi4py's allreduce; None: not shared any more. What it raises is
        raised by the evaluation or commit, on this rank alone: a commit is then not made."""
        def call(_: Any, values: Any, n: int, op: int) -> None:
            own = np.ctypeslib.as_array(values, (n,))
            assert reduce is not None
            native = np.empty(n)   # mpi4py takes no array whose type ctypes has named
            native[:] = own
            own[:] = 0   # not agreed, should it raise
            own[:] = reduce(native, "sum" if op else "min")

        called = REDUCE(callback(call)) if reduce else REDUCE(0)
        rank = whole("rank", rank, 0, LARGEST_INT, bad_argument)
        check(library.grainlaw_points_share(self._handle, rank, called, None))
        self._reduce = called   # as long as the set may call it

    def agree(self, error: Exception | None = None) -> None:
        """Tell the ranks of a shared set how something else went, a call of all of them: raises Error
        with the first text on all where one has an error."""
        text = "" if error is None else str(error)
        status = Status.OK if error is None else getattr(error, "status", Status.FILE_ERROR)
        message = ctypes.create_string_buffer(text.encode()[:255], 256)
        check(library.grainlaw_points_agree(self._handle, status, message, len(message)),
              message.value.decode(errors="replace"))

    def set_time_step(self, step: float) -> None:
        """How long increments take from now on, in the unit of solver.viscous_rate, with
        solver.inertia in s: a material with either asks for it before it deforms; a March tells it.
        0: they take no time, and F has to stay."""
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
        return saved_by(library.grainlaw_points_save, self._handle)

    def load(self, saved: bytes | bytearray | memoryview) -> None:
        """Replace the committed states by saved ones: all of them or, on an Error, none."""
        data = as_bytes(saved, "saved states")
        load_by(library.grainlaw_points_load, self._handle, data, len(data))

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
        return _of_one(super().evaluate(_numbers(F, (d, d))[None], tangent, threads))

    def answer(self, tangent: int | None = None, threads: int = 1) -> Evaluation:
        """P and A of the committed state, without an increment and with the bits that were
        committed."""
        return _of_one(super().answer(tangent, threads))

    def consolidate(self, sigma: npt.ArrayLike, which: npt.ArrayLike | None = None, *,
                    route: str = "proportional", axis: npt.ArrayLike | None = None,
                    first_pressure: float = 0.0, overconsolidation: float = 1.0,
                    largest_step: float = 0.05, threads: int = 0) -> Array:
        """As States.consolidate, of one stress (d, d) [Pa]."""
        d = self.dimension
        reached = super().consolidate(
            _numbers(sigma, (d, d), "sigma")[None], which, route=route, axis=axis,
            first_pressure=first_pressure, overconsolidation=overconsolidation,
            largest_step=largest_step, threads=threads)
        return reached.reshape(d, d)

    def save(self) -> bytes:
        """The committed state as bytes, those of grainlaw_state_save. What C saves can be loaded, and
        C's grainlaw_state_load reads them."""
        return saved_by(library.grainlaw_state_save, self._state(0))

    def measure(self, what: int) -> Any:
        """A Measure of the trial, or of the committed state where there is no trial: a number,
        (d, d) or (components,), in the unit that help(grainlaw.Measure) gives."""
        return super().measure(what)[0]


def _of_one(answer: Evaluation) -> Evaluation:
    A = None if answer.A is None else answer.A[0]
    return Evaluation(answer.P[0], A, answer.status[0], answer.reports[0], answer.summary)


def _restore(kind: type[States], material: Material, count: int, saved: bytes) -> States:
    states = kind(material, count)
    states.load(saved)
    return states


class _Outcome:
    """Arrays for the library to fill, of n points."""

    def __init__(self, n: int, d: int, tangent: int | None) -> None:
        self.want = 0 if tangent is None else whole(
            "tangent", tangent, 0, LARGEST_INT, bad_argument, ", as grainlaw.Tangent.EXACT, or None")
        self.P = np.full((n, d, d), np.nan)
        self.A = np.full((n, d, d, d, d), np.nan) if self.want else None
        self.status = np.zeros(n, np.intc)
        self.reports = np.zeros(n, _report)
        self.reports["size"] = _report.itemsize
        self.summary = Summary(size=ctypes.sizeof(Summary))

    def evaluation(self, result: int) -> Evaluation:
        if result < 0:
            point = self.summary.first_failed if self.summary.failed else None
            raise Error(result, _message(self.summary), point)
        return Evaluation(self.P, self.A, self.status, self.reports, self.summary)


def _threads(threads: int) -> int:
    return whole("threads", threads, -LARGEST_INT, LARGEST_INT, bad_argument, ", 0 for all")


def _points(which: npt.ArrayLike) -> npt.NDArray[np.uintp]:
    numbers = np.asarray(which)
    if numbers.size == 0 and numbers.ndim == 1:
        return np.zeros(0, np.uintp)
    if numbers.ndim != 1 or numbers.dtype.kind not in "iu" or int(numbers.min()) < 0:
        raise bad_argument(f"numbers of points {which!r}: expected whole numbers from 0 on, one axis")
    return np.ascontiguousarray(numbers, np.uintp)


def _numbers(F: npt.ArrayLike, shape: tuple[int, ...], name: str = "F") -> Array:
    if masked(F):
        raise bad_argument(f"{name} has masked entries, expected a number in each")
    try:
        array = np.asarray(F)
    except ValueError as error:
        raise bad_argument(f"{name} is no array: {error}") from None
    if array.dtype.kind not in "iuf":
        raise bad_argument(f"{name} holds {array.dtype}, expected real numbers")
    if array.shape != shape:
        raise bad_argument(f"{name} has the shape {array.shape}, expected {shape}")
    return np.ascontiguousarray(array, dtype=float)
