"""Load steps in parts, for hosts whose loop is written in Python: March says what comes next.

    march = March(points, tolerance=1e-10)
    for load in loads:
        for now in march.to(load):
            if march.keep:
                farthest = u.copy()
            if now == Action.SOLVE:
                u += solve(u, march.load)              # once, with the conditions of this load
                answer = points.evaluate(F(u))
                march.tell(answer, residual(u), scale(u))
            elif now == Action.CROSS:
                u[:] = farthest
                march.tell(points.evaluate(F(u)))
            elif now == Action.ACCEPT:
                points.commit()
                committed = u.copy()
            else:                                      # Action.BACK
                points.revert()
                u[:] = committed
"""
from __future__ import annotations

import ctypes
from collections.abc import Iterable, Iterator

import numpy as np

from .abi import Error, Handle, StepError, check, library
from .arguments import MOST_STEPS, number, whole
from .names import Action, MarchOptions, Part, Status, Summary
from .points import Evaluation, States

_WHOLE = ("max_iterations", "max_cuts", "patience", "max_crossings")
_MOST_CUTS = 1000


class March:
    """A way through load steps that are cut where they fail, and whose parts grow again after it.
    Options are those of grainlaw_march_options, with their defaults. A set of points is told the time
    of each part, for a material with solver.viscous_rate or solver.inertia; where it is shared by ranks they
    decide alike."""

    load: float       #: to be reached now
    time: float       #: that it takes, over the time of the load step [-]
    keep: bool        #: whether this iterate is the one to return to in a CROSS: store its unknowns
    complete: bool    #: whether an ACCEPT now ends the load step
    solves: int       #: of this load step so far, those of failed attempts included
    cuts: int         #: of this load step so far
    crossed: int      #: jumps of the stress, crossed in this load step so far
    loose: int        #: parts of this load step accepted out of balance, across jumps
    residuals: list[float]   #: of this attempt, over their scales, of all ranks; NaN: refused [-]
    message: str      #: why an attempt failed, or ""

    def __init__(self, points: States | None = None, **options: float) -> None:
        chosen = default_options()
        for name, value in options.items():
            if name == "size" or not hasattr(chosen, name):
                known = ", ".join(field for field, _ in MarchOptions._fields_[1:])
                raise TypeError(f"{name} is no option of a march, expected one of {known}")
            setattr(chosen, name, _option(name, value))
        self._points = points   # alive as long as the march
        try:
            self._handle = Handle(library.grainlaw_march_create, library.grainlaw_march_destroy,
                                  ctypes.byref(chosen),
                                  None if points is None else points._handle)
        except Error as error:
            if error.status != Status.BAD_ARGUMENT:
                raise
            raise ValueError(f"options of a march {options!r}: one is out of its range") from None
        self.reached = 0.0      #: load that is committed, by whole load steps
        self._part = Part(size=ctypes.sizeof(Part))
        self._status: int = Status.OK
        self.residuals, self._told, self._renewed = [], False, False
        self._read()

    def to(self, load: float, start: float | None = None) -> Iterator[Action]:
        """What to do, one Action after the other, until a load is reached: SOLVE, ACCEPT, BACK or
        CROSS. It begins at `start`, or where the load step before ended. A load step without change
        of load cannot be cut. Raises StepError after the last BACK."""
        self.begin(load, start)
        while (now := self.next()) != Action.DONE:
            if now != Action.GIVE_UP:
                yield now
                continue
            yield Action.BACK
            raise StepError(self._status, f"load {self.load:.6g}: {self.message}")

    def begin(self, load: float, start: float | None = None) -> None:
        """Begin a load step, for a host that calls next itself."""
        start = self.reached if start is None else number("start", start)
        self._goal = number("load", load)
        self._renewed = True
        check(library.grainlaw_march_begin(self._handle, start, self._goal))

    def next(self) -> Action:
        """What to do now; the next call means that it is done. GIVE_UP: the load step failed, go BACK;
        DONE: it is over."""
        now = Action(library.grainlaw_march_next(self._handle, ctypes.byref(self._part)))
        self._read()
        if self._renewed:
            self.residuals = []
        if self._told:
            self.residuals.append(self._part.residual)
        self._told, self._renewed = False, now in (Action.ACCEPT, Action.BACK)
        if now == Action.DONE:
            self.reached = self._goal
        return now

    def share(self, largest_change: float) -> float:
        """The share of a correction to apply, for its largest change of F (Frobenius norm) [-]. 0: that
        is not finite; nothing is to be told then."""
        return float(library.grainlaw_march_share(self._handle, largest_change))

    def tell(self, answer: Evaluation | int, residual: float = 0.0, scale: float = 1.0,
             unforeseen: float = -1.0, reason: str | None = None) -> None:
        """The outcome of a SOLVE or CROSS: an Evaluation, or the Status of a host's own failure;
        norms of the residual and of its scale, on ranks of the unknowns that each owns; how far forces
        are from those foreseen by the committed stiffness, by default as the points find it."""
        summary = answer.summary if isinstance(answer, Evaluation) else None
        self._status = _status_of(answer)
        if reason is not None and self._status != Status.OK:
            ratio = 0.5 if summary is None else summary.step_ratio
            summary = Summary(size=ctypes.sizeof(Summary), step_ratio=ratio, rank=-1,
                              message=reason.encode()[:255])
        check(library.grainlaw_march_tell(
            self._handle, self._status, None if summary is None else ctypes.byref(summary),
            residual, scale, unforeseen))
        self._told = True

    def _read(self) -> None:
        part = self._part
        self.load, self.time = part.load, part.time
        self.keep, self.complete = bool(part.keep), bool(part.complete)
        self.solves, self.cuts = part.solves, part.cuts
        self.crossed, self.loose = part.crossed, part.loose
        self.message = part.message.decode(errors="replace")


def load_steps(loads: int | Iterable[float]) -> list[float]:
    """Loads to reach one after the other, from 0 to 1: a number of equal steps, or the ascending loads
    themselves."""
    if isinstance(loads, Iterable) and not isinstance(loads, (str, bytes)):
        goals = [number("load", load) for load in loads]
    else:
        count = whole("number of load steps", loads, 1, MOST_STEPS)
        goals = [(k + 1) / count for k in range(count)]
    if (not goals or not all(a < b for a, b in zip(goals, goals[1:]))
            or not 0 <= goals[0] <= goals[-1] <= 1):
        raise ValueError("expected a number of load steps >= 1, or ascending fractions of the "
                         f"load from 0 to 1, got {loads!r}")
    return goals


def default_options() -> MarchOptions:
    default = library.grainlaw_march_options_default()
    options = MarchOptions()
    ctypes.memmove(ctypes.byref(options), ctypes.byref(default), ctypes.sizeof(options))
    options.size = ctypes.sizeof(options)
    return options


def _option(name: str, value: float) -> float:
    if name in _WHOLE:
        return whole(name, value, 0, _MOST_CUTS if name == "max_cuts" else 2**31 - 1)
    return number(name, value)


def _status_of(answer: Evaluation | int) -> int:
    if not isinstance(answer, Evaluation):
        return int(answer)
    if answer.ok:
        return Status.OK
    own = np.atleast_1d(answer.status)
    return int(own[own != 0][0]) if own.any() else Status.NOT_CONVERGED  # of another rank
