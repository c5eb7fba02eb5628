"""grainlaw for Python: numpy arrays over the C ABI.

Conventions are those of grainlaw.h: F[i, J] = dx_i/dX_J, P in Pa with tension positive,
A[i, J, k, L] = dP_iJ/dF_kL, SI units. d is the dimension of the material.

    material = grainlaw.Material("sand.toml")
    points = grainlaw.States(material, 240)
    answer = points.evaluate(F, grainlaw.Tangent.EXACT)     # F: (240, d, d)
    if answer.ok:
        points.commit()                                     # answer.P, answer.A
    else:
        points.revert()                 # and retry with answer.step_ratio of the step

A status < 0 raises Error and leaves what is committed as it was; a recoverable one (> 0) is an
answer. The library is $GRAINLAW_LIBRARY, or the one this file was installed with, or the one the
dynamic loader finds.
"""
import ctypes
import os
from dataclasses import dataclass

import numpy as np

from grainlaw_library import Error, Handle, c_text, check, library, status_text, version
from grainlaw_names import Measure, Report, Status, Summary, Tangent

__all__ = ["Error", "Evaluation", "Material", "Measure", "State", "States", "Status", "Tangent",
           "status_text", "version"]

# grainlaw_report for numpy, its text as one string.
_fields = np.dtype(Report).fields
_report = np.dtype({
    "names": list(_fields),
    "formats": [kind.str if kind.subdtype is None else f"S{kind.itemsize}"
                for kind, _ in _fields.values()],
    "offsets": [offset for _, offset in _fields.values()],
    "itemsize": ctypes.sizeof(Report)})


class Material:
    """A material file and the packing it names, in equilibrium at F = I. Raises Error with the
    library's message, which names file, line, key and what was expected."""

    def __init__(self, path):
        self._create(library.grainlaw_material_load, c_text(path))

    @classmethod
    def parse(cls, text, base_directory="."):
        """The same from TOML text; relative paths in it start at base_directory."""
        material = cls.__new__(cls)
        material._create(library.grainlaw_material_parse, c_text(text), c_text(base_directory))
        return material

    def _create(self, function, *arguments):
        message = ctypes.create_string_buffer(1024)

        def create(out):
            status = function(*arguments, out, message, len(message))
            check(status, message.value.decode(errors="replace"))
            return status

        self._handle = Handle(create, library.grainlaw_material_destroy)
        self.dimension = library.grainlaw_material_dimension(self._handle)


@dataclass
class Evaluation:
    """What an evaluation of n points came to. Rows of points that failed are NaN."""

    P: np.ndarray        #: (n, d, d) first Piola-Kirchhoff stress [Pa]
    A: np.ndarray        #: (n, d, d, d, d) tangent [Pa], or None when none was asked for
    status: np.ndarray   #: (n,) Status as numbers
    reports: np.ndarray  #: (n,) fields of grainlaw_report by name, e.g. reports["sliding"]
    summary: Summary     #: fields of grainlaw_summary

    @property
    def ok(self):
        return not self.status.any()

    @property
    def failed(self):
        """Numbers of the points that failed."""
        return np.flatnonzero(self.status)

    @property
    def step_ratio(self):
        """Smallest factor on the step that a failed point suggests; 1 when all are well."""
        return self.summary.step_ratio

    @property
    def message(self):
        """The first failed point and why, or "" """
        return _message(self.summary)


def _message(summary):
    text = summary.message.decode(errors="replace")
    return f"point {summary.first_failed}: {text}" if summary.failed else text


class States:
    """Integration points of one material, evaluated together. F, P, A and measures have the number
    of the point as their first axis."""

    def __init__(self, material, count):
        if not isinstance(material, Material):
            raise Error(Status.BAD_HANDLE, f"expected a Material, got {type(material).__name__}")
        if not isinstance(count, (int, np.integer)) or count < 1:
            raise Error(Status.BAD_ARGUMENT, f"expected a number of points >= 1, got {count!r}")
        self.dimension = material.dimension
        self._handle = Handle(library.grainlaw_points_create, library.grainlaw_points_destroy,
                              material._handle, count)

    def __len__(self):
        return library.grainlaw_points_size(self._handle)

    def clone(self):
        """An independent copy, committed and trial."""
        copy = self.__class__.__new__(self.__class__)
        copy.dimension = self.dimension
        copy._handle = Handle(library.grainlaw_points_clone, library.grainlaw_points_destroy,
                              self._handle)
        return copy

    def evaluate(self, F, tangent=None, threads=0):
        """Evaluation of all points at F (n, d, d), with a Tangent or without, on so many threads
        (0: OMP_NUM_THREADS or all processors). Raises Error for arrays of another shape or type and where
        a point's status is < 0."""
        n, d = len(self), self.dimension
        F = _numbers(F, (n, d, d))
        want = 0 if tangent is None else int(tangent)
        P = np.full((n, d, d), np.nan)
        A = np.full((n, d, d, d, d), np.nan) if want else None
        status = np.zeros(n, np.intc)
        reports = np.zeros(n, _report)
        reports["size"] = _report.itemsize
        summary = Summary(size=ctypes.sizeof(Summary))
        result = library.grainlaw_points_evaluate(
            self._handle, F.ctypes.data, want, P.ctypes.data, A.ctypes.data if want else None,
            status.ctypes.data, reports.ctypes.data, threads, ctypes.byref(summary))
        if result < 0:
            raise Error(result, _message(summary), summary.first_failed if summary.failed else None)
        return Evaluation(P, A, status, reports, summary)

    def set_time_step(self, step):
        """How long increments take from now on, e.g. `LoadSteps.part`: a material with
        solver.viscous_increment asks for it."""
        check(library.grainlaw_points_set_time_step(self._handle, step))

    def commit(self):
        """Make the trial the committed state: of all points or, when one has none, of none."""
        check(library.grainlaw_points_commit(self._handle))

    def revert(self):
        """Drop the trial, if any."""
        check(library.grainlaw_points_revert(self._handle))

    def save(self):
        """The committed states as bytes."""
        size = ctypes.c_size_t()
        check(library.grainlaw_points_save(self._handle, None, ctypes.byref(size)))
        data = ctypes.create_string_buffer(size.value)
        check(library.grainlaw_points_save(self._handle, data, ctypes.byref(size)))
        return data.raw

    def load(self, saved):
        """Replace the committed states by saved ones: all of them or, on an Error, none."""
        saved = bytes(saved)
        message = ctypes.create_string_buffer(256)
        status = library.grainlaw_points_load(self._handle, saved, len(saved), message,
                                              len(message))
        check(status, message.value.decode(errors="replace"))

    def measure(self, what):
        """A Measure of the trial, or of the committed state where there is no trial:
        (n,), (n, d, d) or (n, components), in the unit that grainlaw.h gives."""
        count = ctypes.c_size_t()
        check(library.grainlaw_points_measure(self._handle, what, None, ctypes.byref(count)))
        values = np.empty(count.value)
        check(library.grainlaw_points_measure(self._handle, what, values.ctypes.data,
                                              ctypes.byref(count)))
        components, square = count.value // len(self), (self.dimension, self.dimension)
        shape = () if components == 1 else square if components == np.prod(square) else (-1,)
        return values.reshape(len(self), *shape)

    def write_vtk(self, path, point=0):
        """Particles and force chains of a point as a .vtp file for ParaView."""
        self._write(library.grainlaw_state_write_vtk, path, point)

    def write_packing(self, prefix, point=0):
        """A point as a packing that a material file can read."""
        self._write(library.grainlaw_state_write_packing, prefix, point)

    def _write(self, function, path, point):
        if not 0 <= point < len(self):
            raise Error(Status.BAD_ARGUMENT, f"point {point} is none of 0 to {len(self) - 1}")
        status = function(library.grainlaw_points_state(self._handle, point), c_text(path))
        check(status, f"{os.fspath(path)}: {status_text(status)}")


class State(States):
    """One integration point: the same without the first axis."""

    def __init__(self, material):
        super().__init__(material, 1)

    def evaluate(self, F, tangent=None):
        d = self.dimension
        answer = super().evaluate(_numbers(F, (d, d))[None], tangent, threads=1)
        A = None if answer.A is None else answer.A[0]
        return Evaluation(answer.P[0], A, answer.status[0], answer.reports[0], answer.summary)

    def measure(self, what):
        return super().measure(what)[0]


def _numbers(F, shape):
    try:
        array = np.asarray(F)
    except ValueError as error:
        raise Error(Status.BAD_ARGUMENT, f"F is no array: {error}") from None
    if array.dtype.kind not in "iuf":
        raise Error(Status.BAD_ARGUMENT, f"F holds {array.dtype}, expected real numbers")
    if array.shape != shape:
        raise Error(Status.BAD_ARGUMENT, f"F has the shape {array.shape}, expected {shape}")
    return np.ascontiguousarray(array, dtype=float)
