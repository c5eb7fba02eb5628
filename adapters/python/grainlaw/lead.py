"""A state led by steps of mixed strain and stress control: Newton by the exact tangent on the
components of F that are found, steps cut where that or the packing fails."""
from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from .abi import status_text
from .arrays import Array
from .control import Condition, Segment, cauchy, controlled, follow_volume, solve, with_volume
from .interrupt import Interrupts
from .names import Measure, Status, Tangent
from .points import Evaluation, State

# An attempt ends when so many iterations in a row have not halved the error: P(F) jumps where
# contacts collapse, and Newton then goes to and fro. A smaller step usually passes beside it.
PATIENCE = 4
# What a part of no more than this share of a step does not end is such a jump. It is crossed: what
# lies beyond is committed out of balance, and brought to balance from there, so often at most.
CROSSING_PART, CROSSINGS = 1 / 16, 8
SMALLEST_CUT, USUAL_CUT, GROWTH = 0.1, 0.5, 2.0   # of a part that failed; of one that went well


class StepError(Exception):
    """A step that failed in its smallest part too."""

    def __init__(self, status: int, message: str) -> None:
        super().__init__(message)
        self.status = status


@dataclass
class Attempt:
    """How far Newton came: converged, stalled (every evaluation went well, to no end), or why not."""

    F: Array
    answer: Evaluation | None = None
    converged: bool = False
    stalled: bool = False
    ratio: float = USUAL_CUT
    reason: str = ""
    status: int = Status.OK
    far: float = -1.0            # of the iterate furthest from what the last tangent foresaw [Pa]
    far_F: Array | None = None


@dataclass(frozen=True)
class Options:
    """Of the stress control."""

    tolerance: float = 1e-8      # largest error / norm of sigma at the start of the step [-]
    max_iterations: int = 20     # of one attempt
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
        self._options, self._interrupts = options, interrupts
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
        return controlled(conditions, self.F, self.P, self._tangent())[0]

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
            self._solve_in_parts(segment, start, end, tell_cut)
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

    def _solve_in_parts(self, segment: Segment, start: Array, end: Array,
                        tell_cut: Callable[[float, str], None]) -> None:
        done, part = 0.0, 1.0
        while done < 1:
            to = 1.0 if done + part > 1 - 1e-9 else done + part
            self.state.set_time_step(to - done)
            attempt = self._attempt(segment, start + to * (end - start), to - done)
            if attempt.converged:
                self._accept(attempt)
                done, part = to, min(1 - to, GROWTH * (to - done))
                continue
            self.state.revert()
            part = (to - done) * min(max(attempt.ratio, SMALLEST_CUT), USUAL_CUT)
            if part < 2.0**-self._options.max_cuts:
                raise StepError(attempt.status,
                                f"a step failed {100 * done:.3g} % along, in parts of "
                                f"{to - done:.1e} of it too: {attempt.reason}")
            tell_cut(part, attempt.reason)

    def _attempt(self, segment: Segment, goal: Array, part: float) -> Attempt:
        attempt = self._newton(segment, goal)
        if not attempt.stalled or part > CROSSING_PART:
            return attempt
        for _ in range(CROSSINGS):
            if not attempt.stalled or attempt.far_F is None:
                return attempt
            beyond = self._evaluate(attempt.far_F, Tangent.EXACT)
            if not beyond.ok:
                return attempt
            self._accept(Attempt(attempt.far_F, beyond))
            attempt = self._newton(segment, goal)
        if attempt.stalled:
            attempt.converged = True   # the next part goes on from here
            self.loose_parts += 1
        return attempt

    def _newton(self, segment: Segment, goal: Array) -> Attempt:
        """The first iterate carries what is prescribed over to the unknowns by the tangent of the
        last step. Where the tangent is not exact, Broyden's updates go on from the last one."""
        d = len(self.F)
        follows, volume, conditions = segment.follows, segment.volume, segment.conditions
        if not segment.mixed:
            F = goal.reshape(d, d)
            return self._at(with_volume(F, follows, volume) if follows else F,
                            Tangent.EXACT if self._options.tangents else None)
        stresses = [k for k, condition in enumerate(conditions) if condition.stress]
        scale = max(float(np.linalg.norm(cauchy(self.P, self.F))), 1.0)
        value, matrix = controlled(conditions, self.F, self.P, self._tangent())
        before, foreseen = value, matrix.copy()
        F, best, best_iteration = self.F, np.inf, 0
        far, far_F, stalled = -1.0, None, False
        for iteration in range(self._options.max_iterations):
            correction = self._correction(matrix, goal - value, F, follows)
            F = F + correction.reshape(d, d)
            if follows:
                F = with_volume(F, follows, volume)
            attempt = self._at(F, Tangent.EXACT)
            if attempt.answer is None:
                return attempt
            F, A = attempt.F, attempt.answer.A
            assert A is not None
            last, (value, derivative) = value, controlled(conditions, F, attempt.answer.P, A)
            error = float(np.abs((goal - value)[stresses]).max()) / scale
            unforeseen = float(np.linalg.norm(value - before - foreseen @ (F - self.F).ravel()))
            if unforeseen > far:
                far, far_F = unforeseen, F
            if error <= self._options.tolerance:
                return attempt
            if error < 0.5 * best:
                best, best_iteration = error, iteration
            stalled = bool(np.isfinite(error)) and iteration >= best_iteration + PATIENCE
            if stalled or not np.isfinite(error):
                break
            if attempt.answer.reports["tangent_exact"] or iteration == 0:
                matrix = derivative
            else:
                mismatch = value - last - matrix @ correction
                matrix = matrix + np.outer(mismatch, correction) / (correction @ correction)
        attempt.converged, attempt.stalled, attempt.far, attempt.far_F = False, stalled, far, far_F
        attempt.reason = f"the stress control did not converge (best residual {best:.1e} [-])"
        return attempt

    @staticmethod
    def _correction(matrix: Array, residual: Array, F: Array, follows: Sequence[int]) -> Array:
        if follows:
            matrix, residual = matrix.copy(), residual.copy()
            follow_volume(matrix, F, follows)
            residual[[(len(F) + 1) * i for i in follows]] = 0
        return solve(matrix, residual)

    def _at(self, F: Array, tangent: Tangent | None) -> Attempt:
        answer = self._evaluate(F, tangent)
        if answer.ok:
            found: Array = self.state.measure(Measure.DEFORMATION_GRADIENT)
            return Attempt(found, answer, converged=True)
        return Attempt(F, ratio=answer.step_ratio, reason=_why(answer), status=int(answer.status))

    def _evaluate(self, F: Array, tangent: Tangent | None) -> Evaluation:
        self._interrupts.check()
        return self.state.evaluate(F, tangent)

    def _accept(self, attempt: Attempt) -> None:
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

    def _tangent(self) -> Array:
        assert self.A is not None
        return self.A


def _why(answer: Evaluation) -> str:
    message: bytes = answer.summary.message
    return message.decode(errors="replace") or status_text(int(answer.status))
