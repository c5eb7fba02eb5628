"""Points by element, for a host that calls for one at a time and never says commit."""
from __future__ import annotations

import ctypes
from typing import Any

import numpy as np
import numpy.typing as npt

from .abi import Error, Handle, as_bytes, bad_argument, check, library, load_by, saved_by
from .arguments import number, whole
from .arrays import Array
from .material import Material
from .names import Report, Status
from .points import Evaluation, _numbers, _of_one, _Outcome

_LARGEST = 2**63 - 1


class Table:
    """Points of one material, found by element and point; each is made at its first call."""

    material: Material
    dimension: int   #: d, 2 or 3

    def __init__(self, material: Material) -> None:
        if not isinstance(material, Material):
            raise Error(Status.BAD_HANDLE, f"expected a Material, got {type(material).__name__}")
        self.material, self.dimension = material, material.dimension
        self._handle = Handle(library.grainlaw_table_create, library.grainlaw_table_destroy,
                              material._handle)

    def __len__(self) -> int:
        return int(library.grainlaw_table_size(self._handle))

    def evaluate(self, element: int, point: int, token: float, F: npt.ArrayLike | None,
                 F0: npt.ArrayLike | None = None, tangent: int | None = None,
                 time_step: float = 0.0) -> tuple[Evaluation, float]:
        """Evaluation of a point at F (d, d) [-], and the token of its answer. `token` is what the
        host keeps of the increment that it starts from, 0 at first: the point's own number means to
        try again, one more that the last answer was accepted. F0 (d, d) is F at the start, F None:
        P and A there. Raises Error for a token or F0 of no known state."""
        d = self.dimension
        out = _Outcome(1, d, tangent)
        kept = ctypes.c_double(number("token", token, bad_argument))
        start = None if F0 is None else _numbers(F0, (d, d))
        target = None if F is None else _numbers(F, (d, d))
        status = library.grainlaw_table_evaluate(
            self._handle, *_key(element, point), ctypes.byref(kept),
            None if start is None else start.ctypes.data,
            None if target is None else target.ctypes.data,
            number("time step", time_step, bad_argument), out.want, out.P.ctypes.data,
            None if out.A is None else out.A.ctypes.data, out.reports.ctypes.data)
        report: Any = Report.from_buffer_copy(out.reports.tobytes())
        check(min(status, 0), report.message.decode(errors="replace"))
        out.status[0] = status
        out.summary.step_ratio, out.summary.message = report.step_ratio, report.message
        out.summary.rank, out.summary.failed = -1, int(status != 0)
        return _of_one(out.evaluation(0)), kept.value

    def measure(self, element: int, point: int, what: int) -> Array:
        """All components of a Measure of a point, of its trial or else of its committed state."""
        count = ctypes.c_size_t()
        arguments = (self._handle, *_key(element, point), int(what))
        check(library.grainlaw_table_measure(*arguments, None, ctypes.byref(count)))
        values = np.empty(count.value)
        check(library.grainlaw_table_measure(*arguments, values.ctypes.data, ctypes.byref(count)))
        return values

    def forget(self, element: int, point: int) -> None:
        """Release a point; its next call begins at F = I."""
        check(library.grainlaw_table_forget(self._handle, *_key(element, point)))

    def save(self) -> bytes:
        """All points with their tokens as bytes."""
        return saved_by(library.grainlaw_table_save, self._handle)

    def load(self, saved: bytes | bytearray | memoryview) -> None:
        """Replace all points by saved ones: all or, on an Error, none."""
        data = as_bytes(saved, "a saved table")
        load_by(library.grainlaw_table_load, self._handle, data, len(data))


def _key(element: int, point: int) -> tuple[int, int]:
    return (whole("element", element, -_LARGEST, _LARGEST, bad_argument),
            whole("point", point, -_LARGEST, _LARGEST, bad_argument))
