"""A state led by steps of mixed strain and stress control: Newton by the exact tangent on the
components of F that are found, in the parts of a march."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .abi import StepError, status_text
from .arrays import Array
from .control import Condition, Segment, cauchy, controlled, follow_volume, solve, with_volume
from .interrupt import Interrupts
from .march import March, default_options
from .names import Action, Measure, Status, Tangent
from .points import Evaluation, State


@dataclass(frozen=True)
class Options:
    """Of the stress control."""

    # Largest error / norm of sigma at the start of the step [-], and iterations of one attempt.
    tolerance: float = default_options().tolerance
    max_iterations: int = default_options().max_iterations
    max_cuts: int = 12           # the smallest part of a step is 2^-max_cuts of it
    tangents: bool = False       # wanted of steps too that a strain alone leads


class Lead:
    """A state on its way. F (d, d) [-], P (d, d) [Pa] and A [Pa] are of what is committed;
    report is that of the evaluation that led there."""

    def __init__(self, state: State, options: Options, interrupts: Interrupts) -> None:
        self.state = state
        self.loose_parts = 0     #: that ended out of balance, so far
        self.work = 0.0          #: of P on dF over the parts, trapezoid rule [J]
        self._volume = float(state.measure(Measure.REFERENCE_VOLUME))
        self.options, self._interrupts = options, interrupts
        state.revert()
        self.F: Array = state.measure(Measure.DEFORMATION_GRADIENT)
        self.P: Array
        self.A: Array | None
        self.report: Any
        self._renew_tangent()

    def values(self, conditions: Sequence[Condition]) -> Array:
        """Of what is prescribed, as they are (d*d,)."""
        if not any(condition.stress for condition in conditions):
            return self.F.ravel()
        if self.A is None:
            self._renew_tangent()
        return controlled(conditions, self.F, self.P, self.tangent())[0]

    def run(self, segment: Segment, record: Callable[[], None],
            tell_cut: Callable[[float, str], None],
            may_stay: Callable[[], bool] | None = None) -> bool:
        """One step. Calls record() at its end; where Ctrl-C or a failure ends it before, at the end of
        the last part of it that was committed, if any. Calls tell_cut(part, reason) with the part of
        the step that comes next. A step that may not stay is taken back instead: False. Raises
        KeyboardInterrupt and StepError."""
        start = self.values(segment.conditions)
        end = np.array([start[k] + one.value if one.added else one.value
                        for k, one in enumerate(segment.conditions)])
        F = self.F
        before = None if may_stay is None else self._keep()
        try:
            self._march(segment, start, end, tell_cut)
        except (KeyboardInterrupt, StepError):
            self.state.revert()
            if self.F is not F:
                record()
            raise
        if before is not None and may_stay is not None and not may_stay():
            self._go_back(before)
            return False
        record()
        return True

    def _keep(self) -> tuple[Any, ...]:
        return (self.state.save(), self.F, self.P, self.A, self.report, self.work, self.loose_parts)

    def _go_back(self, kept: tuple[Any, ...]) -> None:
        self.state.load(kept[0])
        _, self.F, self.P, self.A, self.report, self.work, self.loose_parts = kept

    def _march(self, segment: Segment, start: Array, end: Array,
               tell_cut: Callable[[float, str], None]) -> None:
        options = self.options
        march = March(self.state, tolerance=options.tolerance, max_cuts=options.max_cuts,
                      max_iterations=options.max_iterations)
        attempt, farthest, reason = None, self.F, ""
        try:
            for now in march.to(1.0):
                if attempt is None:
                    if reason:
                        tell_cut(march.time, reason)
                    attempt = _Attempt(self, segment, start + march.load * (end - start))
                if march.keep:
                    farthest = attempt.F
                if now == Action.SOLVE:
                    attempt.solve()
                    attempt.tell(march)
                elif now == Action.CROSS:
                    attempt.evaluate(farthest, Tangent.EXACT)
                    attempt.tell(march)
                elif now == Action.ACCEPT:
                    self._accept(attempt)
                    attempt, reason = None, ""
                else:
                    self.state.revert()
                    attempt, reason = None, march.message
        except StepError as error:
            raise StepError(error.status, f"a step failed {march.message}") from None
        finally:
            self.loose_parts += march.loose

    def evaluate(self, F: Array, tangent: Tangent | None) -> Evaluation:
        """Of the state; KeyboardInterrupt comes between evaluations."""
        self._interrupts.check()
        return self.state.evaluate(F, tangent)

    def _accept(self, attempt: _Attempt) -> None:
        assert attempt.answer is not None
        self.state.commit()
        self.work += 0.5 * self._volume * float(
            np.sum((self.P + attempt.answer.P) * (attempt.F - self.F)))
        self.F, self.P, self.A = attempt.F, attempt.answer.P, attempt.answer.A
        self.report = attempt.answer.reports

    def _renew_tangent(self) -> None:
        answer = self.state.evaluate(self.F, Tangent.EXACT)
        if not answer.ok:
            raise StepError(int(answer.status), f"where the path starts: {_why(answer)}")
        self.P, self.A, self.report = answer.P, answer.A, answer.reports
        self.state.revert()

    def tangent(self) -> Array:
        """A, which stress control has renewed."""
        assert self.A is not None
        return self.A


class _Attempt:
    """Newton on the components of F whose stress is prescribed, from what is committed. The first
    iterate carries what is prescribed over to the unknowns by the committed tangent. Where the tangent
    is not exact, Broyden's updates go on from the last one."""

    def __init__(self, lead: Lead, segment: Segment, goal: Array) -> None:
        self.F = lead.F
        self.answer: Evaluation | None = None
        self._lead, self._segment, self._goal = lead, segment, goal
        self._error, self._unforeseen = 0.0, -1.0
        if not segment.mixed:
            return
        self._stresses = [k for k, one in enumerate(segment.conditions) if one.stress]
        self._scale = max(float(np.linalg.norm(cauchy(lead.P, lead.F))), 1.0)
        self._value, self._matrix = controlled(segment.conditions, lead.F, lead.P, lead.tangent())
        self._before, self._foreseen = self._value, self._matrix.copy()

    def solve(self) -> None:
        """One iteration; where a strain alone leads, the only one."""
        d, follows, volume = len(self.F), self._segment.follows, self._segment.volume
        if not self._segment.mixed:
            F = self._goal.reshape(d, d)
            self.evaluate(with_volume(F, follows, volume) if follows else F,
                          Tangent.EXACT if self._lead.options.tangents else None)
            return
        if self.answer is not None:
            self._renew_matrix(self.answer)
        self._correction = _correction(self._matrix, self._goal - self._value, self.F, follows)
        F = self.F + self._correction.reshape(d, d)
        self._first = self.answer is None
        self.evaluate(with_volume(F, follows, volume) if follows else F, Tangent.EXACT)
        answer = self.answer
        if answer is None or not answer.ok:
            return
        assert answer.A is not None
        self._last = self._value
        self._value, self._derivative = controlled(self._segment.conditions, self.F, answer.P,
                                                   answer.A)
        self._error = float(np.abs((self._goal - self._value)[self._stresses]).max()) / self._scale
        change = (self.F - self._lead.F).ravel()
        self._unforeseen = float(np.linalg.norm(self._value - self._before
                                                - self._foreseen @ change))

    def evaluate(self, F: Array, tangent: Tangent | None) -> None:
        """The state at F; components that are found may differ."""
        self.F, self.answer = F, self._lead.evaluate(F, tangent)
        if self.answer.ok:
            self.F = self._lead.state.measure(Measure.DEFORMATION_GRADIENT)

    def tell(self, march: March) -> None:
        """The outcome of the last evaluation."""
        assert self.answer is not None
        march.tell(self.answer, self._error, 1.0, self._unforeseen, _why(self.answer))

    def _renew_matrix(self, answer: Evaluation) -> None:
        if answer.reports["tangent_exact"] or self._first:
            self._matrix = self._derivative
            return
        mismatch = self._value - self._last - self._matrix @ self._correction
        self._matrix = self._matrix + (np.outer(mismatch, self._correction)
                                       / (self._correction @ self._correction))


def _correction(matrix: Array, residual: Array, F: Array, follows: Sequence[int]) -> Array:
    if follows:
        matrix, residual = matrix.copy(), residual.copy()
        follow_volume(matrix, F, follows)
        residual[[(len(F) + 1) * i for i in follows]] = 0
    return solve(matrix, residual)


def _why(answer: Evaluation) -> str:
    message: bytes = answer.summary.message
    return message.decode(errors="replace") or status_text(int(answer.status))
