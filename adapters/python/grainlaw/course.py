"""One element test on its way: where its steps lead, where it turns and what ends it. Pressures, q and
strains are positive in compression; axis d, the last, is the axial one; a shear moves the last plane
along axis 1: F12 of discs, F13 of spheres."""
from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .abi import StepError
from .arguments import MOST_STEPS, number, whole
from .control import Condition, Segment, cauchy
from .lead import Lead
from .progress import Progress
from .result import Result

MOST_STEPS_OF_A_LEG = 100000
NEAR, LEAST = 1e-6, 1e-10  # of an amplitude of stress that is met; of a step, between two shares of it
WEAK = 0.1                 # of the pressure at the start: what is left then does not carry


@dataclass(frozen=True)
class Loops:
    """Loops of a test: it turns at plus and minus a strain and ends at 0, or at so much above and
    below the q of the start and ends there. q is axial less lateral stress, of a shear the shear
    stress."""

    count: int
    strain: float | None = None   #: [-]
    q: float | None = None        #: [Pa]

    def __post_init__(self) -> None:
        whole("number of loops", self.count, 1, MOST_STEPS)
        if (self.strain is None) == (self.q is None):
            raise ValueError("expected one of strain (0.005 for 0.5 %) and q (Pa) of the loops")
        if not 0 < number("amplitude", self.amplitude) < (0.5 if self.q is None else math.inf):
            raise ValueError(f"expected an amplitude above 0, of strain below 0.5, got "
                             f"{self.amplitude!r}")

    @property
    def amplitude(self) -> float:
        """[-] or [Pa]"""
        value = self.strain if self.q is None else self.q
        assert value is not None
        return value


@dataclass(frozen=True)
class Stop:
    """What ends a test before its strain or stress; what is None never does."""

    strain: float | None = None         #: axial, or shear, since the start, absolute [-]
    q: float | None = None              #: axial less lateral stress, or shear stress, absolute [Pa]
    ratio: float | None = None          #: q over mean pressure, absolute [-]
    p: float | None = None              #: mean pressure, reached from either side [Pa]
    axial_stress: float | None = None   #: reached from either side [Pa]
    double_amplitude: float | None = None   #: largest less smallest strain since the start [-]
    #: Share of the mean pressure at the start below which there is no soil any more [-]; None: 0.01
    #: where volume is kept, else 0, which never ends it.
    liquefied: float | None = None

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if value is None:
                continue
            number(f"stop.{name}", value)
            if not (0 <= value <= 1 if name == "liquefied" else value > 0):
                raise ValueError(f"expected a stop.{name} above 0"
                                 f"{' and at most 1' if name == 'liquefied' else ''}, got {value!r}")


@dataclass(frozen=True)
class Plan:
    """A test: to(way) leads to that much of the leading strain [-], or, by share, to that share of
    the way of what is led."""

    to: Callable[[float], Segment]
    end: float                 # strain [-]; by share 1
    step: float                # strain, or share, of a step [-]
    shear: bool = False
    by_share: bool = False
    keeps_volume: bool = False


class Course:
    """Leads along a plan and keeps what it finds in the result."""

    def __init__(self, lead: Lead, plan: Plan, loops: Loops | int, stop: Stop | None,
                 result: Result, progress: Progress) -> None:
        self._lead, self._plan, self._loops, self._result = lead, plan, loops, result
        self._stop, self._progress = stop or Stop(), progress
        share = 0.01 if plan.keeps_volume else 0.0
        self._liquefied = share if self._stop.liquefied is None else self._stop.liquefied
        self._start_F, self._p, self._q = lead.F, self.pressure, self.deviator
        self._way = self._least = self._most = 0.0
        self._jumps = 0   # of q over an amplitude

    @property
    def pressure(self) -> float:
        """Mean, compression positive [Pa]."""
        return -float(np.trace(cauchy(self._lead.P, self._lead.F))) / len(self._lead.F)

    @property
    def deviator(self) -> float:
        """q [Pa]."""
        sigma = cauchy(self._lead.P, self._lead.F)
        if self._plan.shear:
            return float(sigma[0, -1])
        return float(np.mean(np.diagonal(sigma)[:-1]) - sigma[-1, -1])

    @property
    def axial(self) -> float:
        """Axial stress, compression positive [Pa]."""
        return -float(cauchy(self._lead.P, self._lead.F)[-1, -1])

    def run(self) -> None:
        """To the end, or to what stops it. Raises StepError."""
        try:
            if isinstance(self._loops, Loops):
                self._loop(self._loops)
            elif self._to(self._plan.end):
                self._back_and_forth(self._loops)
        except StepError:
            if not self._liquefied > 0 or self.pressure > WEAK * self._p:
                raise
            self._result.liquefied = True
            self._result.ended = (f"liquefied: no equilibrium after a mean pressure of "
                                  f"{self.pressure:.4g} Pa, {self.pressure / self._p:.2g} of that at "
                                  "the start")

    def _back_and_forth(self, loops: int) -> None:
        """Of a test that stresses lead, from its end."""
        for turn in range(2 * loops - 1):
            if not self._to(self._plan.end if turn % 2 else 0):
                return

    def _loop(self, loops: Loops) -> None:
        for count in range(loops.count):
            for side in (1.0, -1.0):
                on = (self._to(side * loops.amplitude) if loops.q is None
                      else self._to_q(self._q + side * loops.amplitude, side, loops.amplitude))
                if not on:
                    self._result.ended += f", in loop {count + 1} of {loops.count}"
                    return
        if loops.q is None:
            self._to(0)
        else:
            if self._to_q(self._q, 1, loops.amplitude) and self._jumps:
                self._result.ended = (f"q jumped past its amplitude at {self._jumps} of "
                                      f"{2 * loops.count + 1} turns")

    def _make(self, way: float, may_stay: Callable[[], bool] | None = None) -> bool:
        """One step; False when it was taken back."""
        p, axial = self.pressure, self.axial
        if not self._lead.run(self._plan.to(way), lambda: self._result.add(self._lead),
                              self._tell_cut, may_stay):
            return False
        self._tell_step()
        self._way = way
        self._result.ended = self._stopped(p, axial)
        return True

    def _tell_step(self) -> None:
        d, F = len(self._lead.F), self._lead.F
        self._progress.update(self._fraction, f"sigma{d}{d} {-self.axial / 1e3:.1f} kPa, F{d}{d} "
                                              f"{F[-1, -1]:.4f}, F1{d} {F[0, -1]:.4f}")

    def _tell_cut(self, part: float, reason: str) -> None:
        self._progress.update(self._fraction, f"step {len(self._result)} in parts of {part:.1e} of "
                                              f"it: {reason}")

    @property
    def _fraction(self) -> float:
        """Steps that are done over those that it takes where nothing stops it."""
        plan, loops = self._plan, self._loops
        legs, way = 1, abs(plan.end)
        if isinstance(loops, Loops):
            legs, way = 4 * loops.count, 2 * plan.step if loops.strain is None else loops.strain
        elif loops:
            legs = 2 * loops
        return min(1.0, (len(self._result) - 1) / (legs * self._steps(way)))

    def _steps(self, way: float) -> int:
        return max(1, math.ceil(way / self._plan.step - 1e-9))

    def _to(self, to: float) -> bool:
        """In equal steps to a strain."""
        start = self._way
        count = self._steps(abs(to - start))
        return all(self._make(to if k == count else start + (to - start) * k / count)
                   and not self._result.ended for k in range(1, count + 1))

    def _to_q(self, wanted: float, direction: float, amplitude: float) -> bool:
        """Until q is what is wanted, in this direction: whole steps, and a last one as long as it
        takes."""
        def rest() -> float:   # of the amplitude [-]
            return direction * (wanted - self.deviator) / amplitude

        for _ in range(MOST_STEPS_OF_A_LEG):
            if rest() <= NEAR:
                return True
            if not self._step_towards(rest, direction):
                return False
            if abs(self._way) > abs(self._plan.end):
                self._result.ended = f"strain {self._way:.4g} reached before q {wanted:.4g} Pa"
                return False
        return False

    def _step_towards(self, rest: Callable[[], float], direction: float) -> bool:
        """A whole step, or the share of it where nothing is left, by regula falsi (Illinois). Where q
        jumps over the goal, the least share that does. False when the test is over."""
        start, step = self._way, self._plan.step
        share, jump, left = 1.0, False, 0.0
        ends = {True: (0.0, rest()), False: (1.0, 0.0)}   # shares that fall short or not, what is left

        def may_stay() -> bool:
            nonlocal left
            last, left = left, rest()
            if jump or abs(left) <= NEAR or (share == 1 and left > 0):
                return True
            ends[left > 0] = (share, left)
            if last * left > 0:   # twice on a side: the other end is stale
                at, value = ends[left <= 0]
                ends[left <= 0] = (at, value / 2)
            return False

        while not self._make(start + direction * share * step, may_stay):
            (low, short), (high, over) = ends[True], ends[False]
            jump = high - low < LEAST
            share = high if jump else (low * over - high * short) / (over - short)
        self._jumps += jump
        return not self._result.ended

    def _stopped(self, p_before: float, axial_before: float) -> str:
        stop, p, q = self._stop, self.pressure, abs(self.deviator)
        strain = self._way
        if self._plan.by_share:
            strain = 1 - float(self._lead.F[-1, -1] / self._start_F[-1, -1])
        if self._liquefied > 0 and p < self._liquefied * self._p:
            self._result.liquefied = True
            return (f"liquefied: mean pressure {p:.4g} Pa, {p / self._p:.2g} of that at the start")
        if stop.strain is not None and abs(strain) >= stop.strain * (1 - 1e-9):
            return f"strain {strain:.6g} reached"
        self._least, self._most = min(self._least, strain), max(self._most, strain)
        if (stop.double_amplitude is not None
                and self._most - self._least >= stop.double_amplitude * (1 - 1e-9)):
            return f"double amplitude {self._most - self._least:.6g} reached"
        if stop.q is not None and q >= stop.q:
            return f"q {q:.6g} Pa reached"
        if stop.ratio is not None and q >= stop.ratio * p:
            return f"q/p {q / p:.6g} reached"
        if stop.p is not None and (p_before - stop.p) * (p - stop.p) <= 0:
            return f"mean pressure {p:.6g} Pa reached"
        if (stop.axial_stress is not None
                and (axial_before - stop.axial_stress) * (self.axial - stop.axial_stress) <= 0):
            return f"axial stress {self.axial:.6g} Pa reached"
        return ""


def keep(count: int) -> list[Condition]:
    """F of every component stays."""
    return [Condition() for _ in range(count)]
