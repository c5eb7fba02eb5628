"""Load steps that are cut where a point or Newton fails, for hosts whose loop is written in Python.

    steps = LoadSteps(20)
    while steps:
        points.set_time_step(steps.part)        # for a material with drag
        if attempt(steps.load):                 # tries to reach this fraction of the load
            steps.accept()                      # after commit
        else:
            steps.cut(answer.step_ratio)        # after revert
"""
from __future__ import annotations

import math
from collections.abc import Iterable

from .arguments import MOST_STEPS, number, whole

SMALLEST_CUT, USUAL_CUT = 0.1, 0.5   # of a part that failed, in one go
GROWTH = 2.0                         # of the part after one that went well
MOST_CUTS = 1000                     # 2^-1000 of a step is a number yet


class StepTooSmall(Exception):
    """A step was cut as often as allowed and still fails."""


class LoadSteps:
    """Fractions of the load to reach one after the other. `loads` is their number, for equal steps
    from 0 to 1, or the ascending fractions themselves; a first one of 0 is a step of its own, for
    loads that act from the start. No part gets smaller than its step / 2**max_cuts."""

    def __init__(self, loads: int | Iterable[float], max_cuts: int = 10) -> None:
        if isinstance(loads, Iterable) and not isinstance(loads, (str, bytes)):
            self._goals = [number("load", load) for load in loads]
        else:
            count = whole("number of load steps", loads, 1, MOST_STEPS)
            self._goals = [(k + 1) / count for k in range(count)]
        if (not self._goals or not all(a < b for a, b in zip(self._goals, self._goals[1:]))
                or not 0 <= self._goals[0] <= self._goals[-1] <= 1):
            raise ValueError("expected a number of load steps >= 1, or ascending fractions of the "
                             f"load from 0 to 1, got {loads!r}")
        self._max_cuts = whole("max_cuts", max_cuts, 0, MOST_CUTS)
        self._start = self.done = 0.0
        self.number = 0          #: of the load step, from 0
        self.cuts = 0            #: so far
        self.accepted: list[float] = []   #: fractions that were committed
        self.load = self._goals[0]

    def __bool__(self) -> bool:
        return self.number < len(self._goals)

    @property
    def complete(self) -> bool:
        """Whether `load` ends its load step."""
        return self.load == self._goals[self.number]

    @property
    def part(self) -> float:
        """Share of the load step that leads to `load`: how long that takes, where a step takes 1."""
        step = self._goals[self.number] - self._start
        return (self.load - self.done) / step if step > 0 else 1.0

    def accept(self) -> None:
        """`load` was reached and is committed; `load` becomes the next one."""
        part = self.load - self.done
        complete = self.complete
        self.done = self.load
        self.accepted.append(self.load)
        if complete:
            self.number += 1
            self._start = self.done
            if self:
                self.load = self._goals[self.number]
        else:
            self._aim(GROWTH * part)

    def cut(self, ratio: float) -> None:
        """`load` was not reached: it comes nearer, by the ratio of the way that seems feasible.
        Raises StepTooSmall."""
        ratio = number("ratio", ratio, finite=False)
        step = self._goals[self.number] - self._start
        ratio = max(SMALLEST_CUT, min(USUAL_CUT, ratio)) if math.isfinite(ratio) else USUAL_CUT
        part = (self.load - self.done) * ratio
        if part <= step / 2**(self._max_cuts + 1) or step == 0:
            raise StepTooSmall(f"load step {self.number} fails at fraction {self.load:.6g} of the "
                               f"load even in parts of {self.load - self.done:.1e}")
        self.cuts += 1
        self._aim(part)

    def _aim(self, part: float) -> None:
        goal = self._goals[self.number]
        # A rest that is nothing but round-off is not a part.
        near = self.done + part >= goal - 1e-9 * (goal - self._start)
        self.load = goal if near else self.done + part
