"""Tests of a soil laboratory, one call each, of discs and spheres by the same words.

    result = drained(material, strain=0.05, consolidation=200e3)
    result.axial_stress, result.void_ratio, result.state        # help(Result) lists all, with units
    result.plot().savefig("drained.png")

Every test starts from a Material, at F = I, or from a State, which it leads on: tests one after the
other on the same State are a history. Pressures [Pa], q [Pa] and strains [-] are positive in
compression. Axis d, the last, is the axial one; a shear moves F12 of discs, F13 of spheres.

All of them take:
    loops          Loops(count, strain=... or q=...): up and down instead of one way
    stop           Stop(strain, q, ratio, p, axial_stress, liquefied): what ends the test first
    consolidation  isotropic pressure [Pa] that is brought on before, in 20 steps; result.before
    tolerance      largest error of a prescribed stress / norm of the stress at the start of a step [-]
    tangents       whether result.A has the exact tangent of every row
    progress       True: a line on stderr that says how far the test is, the time left, and why steps are
                   cut; or a function of the fraction that is done and a text

    ensemble = Ensemble(drained(one, strain=0.05) for one in materials)      # mean and band of several

More than 10^7 steps one way, or loops, are refused: such a test does not end.

Ctrl-C ends a test between two evaluations: Interrupted, a KeyboardInterrupt, has the rows so far as
its `result`, whose state is where the last one left it. A step that fails in its smallest part raises
StepFailed, which has them too.
"""
from __future__ import annotations

import dataclasses
import functools
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from .abi import StepError
from .arguments import MOST_STEPS, number, whole
from .arrays import Array
from .components import read_conditions
from .control import Condition, Segment, cauchy
from .course import Course, Loops, Plan, Stop, keep
from .ensemble import Ensemble
from .interrupt import Interrupts
from .lead import Lead, Options
from .material import Material
from .names import Measure
from .points import State
from .progress import Listener, Progress
from .result import Result
from .series import Batch, Stiffness, loops_of
from .unusual import ask, tell_drag

__all__ = ["Batch", "Ensemble", "Interrupted", "Loops", "Result", "StepFailed", "Stiffness", "Stop",
           "constant_p", "cyclic_undrained", "drained", "hollow_cylinder", "isotropic", "k0", "oedometric",
           "path", "radial", "rotation", "shear_constant_stress", "shear_constant_volume", "stiffness", "torsional", "true_triaxial",
           "undrained"]

STEPS = 20            # where stresses lead
Start = Material | State


@dataclasses.dataclass(frozen=True)
class _How:
    """What all tests take."""

    stop: Stop | None
    consolidation: float | None
    tolerance: float
    tangents: bool
    progress: Listener


class StepFailed(Exception):
    """A step of a test failed in its smallest part too; `result` is what was reached before, `status`
    the Status of the last evaluation."""

    def __init__(self, message: str, status: int, result: Result) -> None:
        super().__init__(message)
        self.status, self.result = status, result

    def __reduce__(self) -> tuple[Any, ...]:
        return StepFailed, (str(self), self.status, self.result)


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a test; `result` is what was reached before."""

    def __init__(self, result: Result) -> None:
        super().__init__(f"after step {len(result) - 1}")
        self.result = result

    def __reduce__(self) -> tuple[Any, ...]:
        return Interrupted, (self.result,)


def isotropic(start: Start, pressure: float | None = None, steps: int = STEPS, *,
              loops: int = 0, stop: Stop | None = None, tolerance: float = 1e-8,
              tangents: bool = False, progress: Listener = False) -> Result:
    """All normal stresses to `pressure` [Pa], twice what it is by default; shears of F stay. `loops`:
    so many times there and back."""
    wanted, count = _pressure("pressure", pressure), _count(steps)

    def plan(lead: Lead) -> Plan:
        F, sigma = lead.F, cauchy(lead.P, lead.F)
        end = -2 * float(sigma.trace()) / len(F) if wanted is None else wanted

        def to(way: float) -> Segment:
            conditions = keep(F.size)
            for i in range(len(F)):
                conditions[_kk(F, i)] = _stress(sigma[i, i] + way * (-end - sigma[i, i]))
            return Segment(conditions)

        return Plan(to, 1.0, 1 / count, by_share=True)

    return _run("isotropic", start, plan, _turns(loops),
                _How(stop, None, tolerance, tangents, progress))


def k0(start: Start, axial_stress: float | None = None, steps: int = STEPS, *, loops: int = 0,
       stop: Stop | None = None, consolidation: float | None = None,
       tolerance: float = 1e-8, tangents: bool = False, progress: Listener = False) -> Result:
    """The axial stress to `axial_stress` [Pa], twice what it is by default; lateral strains stay 0.
    `loops`: so many times there and back."""
    wanted, count = _pressure("axial_stress", axial_stress), _count(steps)

    def plan(lead: Lead) -> Plan:
        F, sigma = lead.F, cauchy(lead.P, lead.F)
        end = -2 * float(sigma[-1, -1]) if wanted is None else wanted

        def to(way: float) -> Segment:
            conditions = keep(F.size)
            conditions[-1] = _stress(sigma[-1, -1] + way * (-end - sigma[-1, -1]))
            return Segment(conditions)

        return Plan(to, 1.0, 1 / count, by_share=True)

    return _run("k0", start, plan, _turns(loops),
                _How(stop, consolidation, tolerance, tangents, progress))


def oedometric(start: Start, strain: float = 0.02, step: float = 5e-4, *,
               loops: Loops | None = None, stop: Stop | None = None,
               consolidation: float | None = None, tolerance: float = 1e-8,
               tangents: bool = False, progress: Listener = False) -> Result:
    """Axial strain [-], in steps of `step` [-]; lateral strains stay 0."""
    return _strained("oedometric", start, strain, step, lambda F, sigma, conditions: (), loops,
                     _How(stop, consolidation, tolerance, tangents, progress))


def drained(start: Start, strain: float = 0.1, step: float = 1e-3, *,
            lateral_stress: float | None = None, loops: Loops | None = None,
            stop: Stop | None = None, consolidation: float | None = None,
            tolerance: float = 1e-8,
            tangents: bool = False, progress: Listener = False) -> Result:
    """Axial strain [-], in steps of `step` [-]; the lateral stresses stay, as they are or
    `lateral_stress` [Pa]."""
    held = _pressure("lateral_stress", lateral_stress)

    def hold(F: Array, sigma: Array, conditions: list[Condition]) -> Sequence[int]:
        for i in range(len(F) - 1):
            conditions[_kk(F, i)] = _stress(sigma[i, i] if held is None else -held)
        return ()

    return _strained("drained", start, strain, step, hold, loops,
                     _How(stop, consolidation, tolerance, tangents, progress))


def undrained(start: Start, strain: float = 0.1, step: float = 1e-3, *,
              loops: Loops | None = None, stop: Stop | None = None,
              consolidation: float | None = None, tolerance: float = 1e-8,
              tangents: bool = False, progress: Listener = False) -> Result:
    """Axial strain [-], in steps of `step` [-]; det F stays, to 1e-15, lateral stretches share one
    factor. Ends where the mean pressure is a hundredth of that at the start (stop.liquefied)."""
    return _strained("undrained", start, strain, step,
                     lambda F, sigma, conditions: range(len(F) - 1), loops,
                     _How(stop, consolidation, tolerance, tangents, progress))


def constant_p(start: Start, strain: float = 0.1, step: float = 1e-3, *,
               loops: Loops | None = None, stop: Stop | None = None,
               consolidation: float | None = None, tolerance: float = 1e-8,
               tangents: bool = False, progress: Listener = False) -> Result:
    """Axial strain [-], in steps of `step` [-]; the mean pressure stays, and of spheres the
    difference of the lateral stresses."""
    def hold(F: Array, sigma: Array, conditions: list[Condition]) -> Sequence[int]:
        conditions[0] = Condition("mean", float(sigma.trace()) / len(F), False)
        for i in range(1, len(F) - 1):
            conditions[_kk(F, i)] = Condition("difference", float(sigma[i, i] - sigma[0, 0]), False)
        return ()

    return _strained("constant_p", start, strain, step, hold, loops,
                     _How(stop, consolidation, tolerance, tangents, progress))


def shear_constant_volume(start: Start, strain: float = 0.1, step: float = 1e-3, *,
                          loops: Loops | None = None, stop: Stop | None = None,
                          consolidation: float | None = None, tolerance: float = 1e-8,
                          tangents: bool = False, progress: Listener = False) -> Result:
    """Shear strain [-], in steps of `step` [-]; all else of F stays. Ends where the mean pressure is
    a hundredth of that at the start (stop.liquefied)."""
    return _strained("shear_constant_volume", start, strain, step,
                     lambda F, sigma, conditions: (), loops,
                     _How(stop, consolidation, tolerance, tangents, progress), shear=True,
                     keeps_volume=True)


def shear_constant_stress(start: Start, strain: float = 0.1, step: float = 1e-3, *,
                          normal_stress: float | None = None, loops: Loops | None = None,
                          stop: Stop | None = None, consolidation: float | None = None,
                          tolerance: float = 1e-8,
                          tangents: bool = False, progress: Listener = False) -> Result:
    """Shear strain [-], in steps of `step` [-]; the normal stress on its planes stays, as it is or
    `normal_stress` [Pa]."""
    held = _pressure("normal_stress", normal_stress)

    def hold(F: Array, sigma: Array, conditions: list[Condition]) -> Sequence[int]:
        conditions[-1] = _stress(sigma[-1, -1] if held is None else -held)
        return ()

    return _strained("shear_constant_stress", start, strain, step, hold, loops,
                     _How(stop, consolidation, tolerance, tangents, progress), shear=True)


def cyclic_undrained(start: Start, stress_ratio: float, cycles: int = 100,
                     double_amplitude: float = 0.05, step: float = 2e-4, *,
                     consolidation: float | None = None, tolerance: float = 1e-8,
                     tangents: bool = False, progress: Listener = False) -> Result:
    """Undrained loops of q between plus and minus 2 `stress_ratio` times the mean pressure at the
    start [-], as in cyclic triaxial tests of sand (ASTM D5311): until the axial strain spans
    `double_amplitude` [-], the packing has liquefied, or after `cycles` loops; result.ended tells
    which, and in which loop."""
    ratio = number("stress_ratio", stress_ratio)
    if not 0 < ratio < 2:
        raise ValueError(f"stress_ratio {ratio!r}: expected q / (2 p), above 0 and below 2")
    state, before = _consolidated(start, consolidation, tolerance, progress)
    sigma = state.measure(Measure.CAUCHY_STRESS)
    pressure = -float(np.trace(sigma)) / len(sigma)
    result = undrained(state, 0.49, step, loops=Loops(cycles, q=2 * ratio * pressure),
                       stop=Stop(double_amplitude=double_amplitude), tolerance=tolerance,
                       tangents=tangents, progress=progress)
    result.before = before
    return result


def stiffness(start: Start, strains: Sequence[float] = (1e-6, 1e-5, 1e-4, 1e-3),
              steps: int = 10, *, consolidation: float | None = None, tolerance: float = 1e-8,
              progress: Listener = False) -> Stiffness:
    """Secant shear modulus [Pa] and damping [-] against the shear strain: two loops of shear at
    constant volume of each amplitude [-], in `steps` from 0 to it, each on a copy of the state; the
    second is measured. At 1e-6 G is what bender elements measure."""
    state, _ = _consolidated(start, consolidation, tolerance, progress)
    return loops_of(state, strains, _count(steps), functools.partial(
        shear_constant_volume, tolerance=tolerance, progress=progress))


def true_triaxial(start: Start, b: float, strain: float = 0.1, step: float = 1e-3, *,
                  lateral_stress: float | None = None, loops: Loops | None = None,
                  stop: Stop | None = None, consolidation: float | None = None,
                  tolerance: float = 1e-8, tangents: bool = False,
                  progress: Listener = False) -> Result:
    """Axial strain [-] of spheres, in steps of `step` [-], at b = (s2 - s3) / (s1 - s3) [-], s1 the
    axial stress, s2 that of axis 2 and s3 that of axis 1 (Habib 1953). The mean pressure stays; with
    `lateral_stress` [Pa] s3 is held there instead. b 0 is triaxial compression, b 1 extension."""
    share, held = number("b", b), _pressure("lateral_stress", lateral_stress)
    if not 0 <= share <= 1:
        raise ValueError(f"b {share!r}: expected a number from 0 to 1")

    def hold(F: Array, sigma: Array, conditions: list[Condition]) -> Sequence[int]:
        if len(F) != 3:
            raise ValueError("true_triaxial of discs: expected spheres, which have three stresses")
        conditions[0] = (Condition("mean", float(sigma.trace()) / 3, False) if held is None
                         else _stress(-held))
        conditions[4] = _stresses({4: 1.0, 0: share - 1, 8: -share})
        return ()

    return _strained("true_triaxial", start, strain, step, hold, loops,
                     _How(stop, consolidation, tolerance, tangents, progress))


def radial(start: Start, strain: float = 0.02, step: float = 5e-4, *,
           stress_ratio: float | None = None, poisson: float | None = None,
           loops: Loops | None = None, stop: Stop | None = None,
           consolidation: float | None = None, tolerance: float = 1e-8,
           tangents: bool = False, progress: Listener = False) -> Result:
    """Axial strain [-], in steps of `step` [-], along a ray: with `stress_ratio` lateral stresses
    change by that much of the axial one's change (K0 where it is that of no lateral strain); with
    `poisson` lateral strains are minus that much of the axial one (0: oedometric) [-]."""
    if (stress_ratio is None) == (poisson is None):
        raise ValueError("expected one of stress_ratio and poisson")
    share = number("stress_ratio" if poisson is None else "poisson",
                   stress_ratio if poisson is None else poisson)

    def hold(F: Array, sigma: Array, conditions: list[Condition]) -> Sequence[int]:
        for i in range(len(F) - 1 if poisson is None else 0):
            conditions[_kk(F, i)] = _stresses({_kk(F, i): 1.0, F.size - 1: -share},
                                              float(sigma[i, i] - share * sigma[-1, -1]))
        return ()

    def spread(F: Array, way: float, conditions: list[Condition]) -> None:
        for i in range(0 if poisson is None else len(F) - 1):
            conditions[_kk(F, i)] = Condition("F", float(F[i, i]) * (1 + share * way), False)

    return _strained("radial", start, strain, step, hold, loops,
                     _How(stop, consolidation, tolerance, tangents, progress), spread=spread)


def torsional(start: Start, strain: float = 0.1, step: float = 1e-3, *, drained: bool = True,
              loops: Loops | None = None, stop: Stop | None = None,
              consolidation: float | None = None, tolerance: float = 1e-8,
              tangents: bool = False, progress: Listener = False) -> Result:
    """Shear strain [-], in steps of `step` [-], as in the wall of a hollow cylinder with one pressure
    inside and outside (Hight, Gens & Symes 1983): all normal stresses stay. Undrained det F stays, and
    the differences of the normal stresses. Ends where the mean pressure is a hundredth of that at the
    start (stop.liquefied) where volume is kept."""
    def hold(F: Array, sigma: Array, conditions: list[Condition]) -> Sequence[int]:
        d = len(F)
        radial_axis = d - 2   # of discs the axis along the shear
        for i in range(d):
            if drained:
                conditions[_kk(F, i)] = _stress(sigma[i, i])
            elif i != radial_axis:
                conditions[_kk(F, i)] = Condition(
                    "difference", float(sigma[i, i] - sigma[radial_axis, radial_axis]), False,
                    other=_kk(F, radial_axis))
        return () if drained else (radial_axis,)

    return _strained("torsional", start, strain, step, hold, loops,
                     _How(stop, consolidation, tolerance, tangents, progress), shear=True)


def hollow_cylinder(start: Start, alpha: float, b: float = 0.5, strain: float = 0.1,
                    step: float = 1e-3, *, drained: bool = True, loops: Loops | None = None,
                    stop: Stop | None = None, consolidation: float | None = None,
                    tolerance: float = 1e-8, tangents: bool = False,
                    progress: Listener = False) -> Result:
    """Strain [-] of spheres, in steps of `step` [-], with the largest principal stress s1 at `alpha`
    [degree] from the axial axis, 0 to 90, turned as a shear above 0 turns it, and
    b = (s2 - s3) / (s1 - s3) [-], s2 along axis 2, the radial one. The mean pressure stays, undrained
    det F. The strain is the axial one up to 22.5 degrees (compression) and from 67.5 (extension), the
    shear strain between; F12 and F23 stay (Hight, Gens & Symes 1983). Raises ValueError for discs and
    for numbers outside of these ranges."""
    share, angle = number("b", b), number("alpha", alpha)
    if not 0 <= share <= 1:
        raise ValueError(f"b {share!r}: expected a number from 0 to 1")
    if not 0 <= angle <= 90:
        raise ValueError(f"alpha {angle!r}: expected degrees from the axial axis, from 0 to 90")
    if number("strain", strain) <= 0:
        raise ValueError(f"strain {strain!r}: expected a number above 0; alpha tells the direction")
    turned, shear = math.radians(2 * angle), 22.5 < angle < 67.5

    def hold(F: Array, sigma: Array, conditions: list[Condition]) -> Sequence[int]:
        if len(F) != 3:
            raise ValueError("hollow_cylinder of discs: expected spheres, which have three stresses")
        if drained:
            conditions[0] = Condition("mean", float(sigma.trace()) / 3, False)
        cos, sin = math.cos(turned) / 2, math.sin(turned)
        half = 2 * share - 1   # times (s1 - s3) / 2: of s2 from the mean of s1 and s3
        conditions[4] = _stresses({4: 1.0, 0: half * cos - 0.5, 8: -half * cos - 0.5, 2: half * sin})
        conditions[8 if shear else 2] = _stresses({0: -sin / 2, 8: sin / 2, 2: 2 * cos})
        return () if drained else (0,)

    return _strained("hollow_cylinder", start, -strain if angle >= 67.5 else strain, step, hold, loops,
                     _How(stop, consolidation, tolerance, tangents, progress), shear=shear)


def rotation(start: Start, angle: float = 180.0, steps: int = 36, *, stop: Stop | None = None,
             consolidation: float | None = None, tolerance: float = 1e-8, tangents: bool = False,
             progress: Listener = False) -> Result:
    """The principal stresses of the plane of axis 1 and the axial one are turned by `angle` [degree],
    all of them staying as they are, as a shear above 0 turns them; a hollow cylinder does that between
    torsion and axial load (Miura, Miura & Toki 1986). 180 degrees are a whole cycle of the stress. The
    start has to have a deviator, by a test before on the same State: else it raises ValueError."""
    whole_angle, count = math.radians(2 * number("angle", angle)), _count(steps)
    if whole_angle == 0:
        raise ValueError("angle 0: expected degrees to turn the principal stresses by, as 180")

    def plan(lead: Lead) -> Plan:
        sigma = cauchy(lead.P, lead.F)
        mean, half = 0.5 * (sigma[0, 0] + sigma[-1, -1]), 0.5 * (sigma[0, 0] - sigma[-1, -1])
        size, first = math.hypot(half, sigma[0, -1]), math.atan2(sigma[0, -1], half)
        if size < 1e-3 * abs(mean):
            raise ValueError(f"principal stresses that differ by {2 * size / abs(mean):.1e} of their mean: "
                             "expected at least 2e-3, by a test before on the same State")

        def to(way: float) -> Segment:
            conditions, now = keep(lead.F.size), first + way * whole_angle
            for i in range(1, len(sigma) - 1):
                conditions[_kk(lead.F, i)] = _stress(sigma[i, i])
            conditions[0] = _stress(mean + size * math.cos(now))
            conditions[-1] = _stress(mean - size * math.cos(now))
            conditions[len(sigma) - 1] = _stress(size * math.sin(now))
            return Segment(conditions)

        return Plan(to, 1.0, 1 / count, by_share=True, shear=True)

    return _run("rotation", start, plan, 0, _How(stop, consolidation, tolerance, tangents, progress))


def path(start: Start, steps: int, *, isochoric: bool = False, mean_pressure: float | None = None,
         stop: Stop | None = None, consolidation: float | None = None, tolerance: float = 1e-8,
         tangents: bool = False, progress: Listener = False, **components: float | str) -> Result:
    """Any mixed path, by the keys of a [[segment]] of a scene, linearly in equal steps from where
    the state is; components of F without a condition stay.

    F11=1.01            component of F at its end [-]
    dF12=0.02           the same, added to F at the start [-]
    P22=-100e3          first Piola-Kirchhoff stress at its end [Pa], tension positive
    sigma11=-100e3      Cauchy stress at its end [Pa], tension positive
    sigma11="sigma22"   two stresses stay equal
    F11="free", mean_pressure=1e5   F11 is found for the mean pressure [Pa], compression positive
    isochoric=True      components of the diagonal of F without a condition follow by one factor, so
                        that det F stays
    """
    count, wanted = _count(steps), _pressure("mean_pressure", mean_pressure)

    def plan(lead: Lead) -> Plan:
        contact = lead.state.material.description.get("contact", {})
        conditions, follows = read_conditions(len(lead.F), components, isochoric, wanted,
                                              tension=contact.get("law") == "bonded")
        first = lead.values(conditions)
        last = [value + one.value if one.added else one.value
                for value, one in zip(first, conditions)]
        volume = float(np.linalg.det(lead.F))

        def to(way: float) -> Segment:
            return Segment([dataclasses.replace(one, value=a + way * (b - a), added=False)
                            for one, a, b in zip(conditions, first, last)], follows, volume)

        return Plan(to, 1.0, 1 / count, by_share=True)

    return _run("path", start, plan, 0, _How(stop, consolidation, tolerance, tangents, progress))


def _strained(name: str, start: Start, strain: float, step: float,
              hold: Callable[[Array, Array, list[Condition]], Sequence[int]],
              loops: Loops | None, how: _How, shear: bool = False, keeps_volume: bool = False,
              spread: Callable[[Array, float, list[Condition]], None] | None = None) -> Result:
    """A test led by a strain. hold(F, sigma, conditions) sets what is held, and returns the axes
    whose stretches keep det F; spread(F, way, conditions) what goes with the strain."""
    strain, step = number("strain", strain), number("step", step)
    if not 0 < abs(strain) < 0.5:
        raise ValueError(f"expected a strain between -0.5 and 0.5, 0.05 for 5 % of compression, "
                         f"got {strain!r}")
    if not 0 < step <= 0.1:
        raise ValueError(f"expected a strain of one step, above 0 and up to 0.1, got {step!r}")
    if loops is not None and not isinstance(loops, Loops):
        raise TypeError(f"expected loops as Loops(2, strain=0.005) or None, got {loops!r}")
    way = abs(strain) if loops is None or loops.strain is None else float(loops.strain)
    if step < way / MOST_STEPS:
        raise ValueError(f"step {step!r} of strain {way!r}: expected a step of at least strain / "
                         f"{MOST_STEPS}, {way / MOST_STEPS:.3g}")

    def plan(lead: Lead) -> Plan:
        F, sigma = lead.F, cauchy(lead.P, lead.F)
        held = keep(F.size)
        follows = hold(F, sigma, held)
        volume = float(np.linalg.det(F))

        def to(way: float) -> Segment:
            conditions = list(held)
            if shear:
                conditions[len(F) - 1] = Condition("F", F[0, -1] + way * F[-1, -1], False)
            else:
                conditions[-1] = Condition("F", F[-1, -1] * (1 - way), False)
            if spread is not None:
                spread(F, way, conditions)
            return Segment(conditions, follows, volume)

        return Plan(to, strain, step, shear, keeps_volume=keeps_volume or bool(follows))

    return _run(name, start, plan, loops or 0, how)


def _run(name: str, start: Start, planner: Callable[[Lead], Plan], loops: Loops | int,
         how: _How) -> Result:
    state = _state_of(start)
    if how.stop is not None and not isinstance(how.stop, Stop):
        raise TypeError(f"expected stop as Stop(q=100e3) or None, got {how.stop!r}")
    tolerance = number("tolerance", how.tolerance)
    if not tolerance > 0:
        raise ValueError(f"tolerance {tolerance!r}: expected a number above 0, as 1e-8")
    consolidation = _pressure("consolidation", how.consolidation)
    # Answers that start from the last trial are as exact as the library's own equilibrium.
    solver = state.material.description.get("solver", {})
    if solver.get("start") == "trial":
        tolerance = max(tolerance, solver.get("tolerance", 1e-6))
    before = None
    if consolidation is not None:
        before = isotropic(state, consolidation, tolerance=tolerance, progress=how.progress)
    result = Result(state, before, how.tangents)
    progress = Progress(name, how.progress)
    try:
        with Interrupts() as interrupts:
            lead = Lead(state, Options(tolerance, tangents=how.tangents), interrupts)
            result.add(lead)
            plan = planner(lead)
            _ask_for_units(result, plan, loops, how.stop)
            Course(lead, plan, loops, how.stop, result, progress).run()
            tell_drag(result.unbalanced)
    except StepError as error:
        where = f"after axial strain {result.axial_strain[-1]:.6g} [-] " if len(result) else ""
        raise StepFailed(f"{where}{error}", error.status, result) from None
    except KeyboardInterrupt:
        result.ended = "interrupted"
        raise Interrupted(result) from None
    finally:
        progress.clear()
    return result


def _state_of(start: Start) -> State:
    state = State(start) if isinstance(start, Material) else start
    if not isinstance(state, State):
        raise TypeError(f"expected a Material or a State, got {type(start).__name__}")
    return state


def _consolidated(start: Start, pressure: float | None, tolerance: float,
                  progress: Listener) -> tuple[State, Result | None]:
    """The state, and the result of what brought it to the pressure."""
    state, wanted = _state_of(start), _pressure("consolidation", pressure)
    if wanted is None:
        return state, None
    return state, isotropic(state, wanted, tolerance=tolerance, progress=progress)


def _ask_for_units(result: Result, plan: Plan, loops: Loops | int, stop: Stop | None) -> None:
    """Of all stresses that a test leads to, is held at, turns at or stops at."""
    d = result.state.dimension
    stresses: dict[str, float | None] = {
        f"a target in direction {1 + k // (d + 1)}": min(one.value, 0.0)
        for k, one in enumerate(plan.to(plan.end).conditions)
        if one.kind in ("P", "sigma", "mean") and k % (d + 1) == 0}
    if isinstance(loops, Loops):
        stresses["loops.q"] = loops.q
    if stop is not None:
        stresses |= {"stop.q": stop.q, "stop.p": stop.p, "stop.axial_stress": stop.axial_stress}
    ask(float(result.mean_pressure[0]), stresses)


def _kk(F: Array, i: int) -> int:
    """Number of the component ii."""
    return (len(F) + 1) * i


def _stress(value: float) -> Condition:
    return Condition("sigma", float(value), False)


def _stresses(weights: Mapping[int, float], value: float = 0.0) -> Condition:
    return Condition("stresses", value, False, weights=tuple(weights.items()))


def _count(steps: int) -> int:
    return whole("number of steps", steps, 1, MOST_STEPS)


def _turns(loops: int) -> int:
    return whole("number of loops", loops, 0, MOST_STEPS)


def _pressure(name: str, value: float | None) -> float | None:
    if value is not None and not number(name, value) > 0:
        raise ValueError(f"expected a {name} above 0 Pa, compression positive, got {value!r}")
    return value
