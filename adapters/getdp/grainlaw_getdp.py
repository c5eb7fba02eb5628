"""grainlaw inside GetDP: what the Python[]{} expressions of grainlaw.pro call.

One pass over the integration points hands over their displacement gradients (collect), one call of
the library evaluates all of them (evaluate), and the terms of the formulation then only read
(tangent, traction, stress). A point is known by (ElementNum[], QuadraturePointIndex[]).

GetDP does not see a Python exception: the expression keeps its last value. So nothing is raised
here; what goes wrong is printed, counted, and answered by FAILED, which the Resolution tests.
"""
import __main__
import functools
import os
import sys

import numpy as np

import grainlaw
from grainlaw import Action
from grainlaw.files import write_whole
from grainlaw.march import load_steps

FAILED, GO_ON, CUT, CONVERGED = 0, 1, 2, 3

failures = 0
_run = None
# GetDP prints the arguments of an expression into its text; one that is no number has to get here.
__main__.nan, __main__.inf = float("nan"), float("inf")


def _guarded(answer_on_failure):
    """No exception leaves the function; the first message of a row is enough."""
    def decorate(function):
        @functools.wraps(function)
        def guarded(*arguments, **options):
            global failures
            try:
                return function(*arguments, **options)
            except Exception as error:  # pylint: disable=broad-except
                failures += 1
                if failures == 1:
                    kind = "" if isinstance(error, grainlaw.Error) else f"{type(error).__name__}: "
                    print(f"grainlaw: {function.__name__}: {kind}{error}", file=sys.stderr,
                          flush=True)
                return answer_on_failure
        return guarded
    return decorate


def _threads():
    text = os.environ.get("GRAINLAW_THREADS")
    if text is None:
        return len(os.sched_getaffinity(0))
    if not text.isdecimal() or int(text) < 1:
        raise ValueError(f"GRAINLAW_THREADS is '{text}', expected a number of threads >= 1")
    return int(text)


class _Run:
    def __init__(self, material, loads, history, dimension, **options):
        self.material = grainlaw.Material(material)
        self.dimension = self.material.dimension
        if dimension not in (None, self.dimension):
            raise ValueError(f"the problem has SpaceDimension = {dimension}, expected {self.dimension}, as of "
                             f"the material {material}")
        self.goals = load_steps(loads)
        self.number = self.cuts = 0
        self.march = grainlaw.March(**options)
        self.march.begin(self.goals[0])
        self.march.next()
        self.history = os.path.abspath(history) if history else None
        axes, unit = ("xy", "N/m") if self.dimension == 2 else ("xyz", "N")
        forces = ",".join(f"top_{axis}_force[{unit}]" for axis in axes)
        self.lines = {"_force.csv": [f"step[-],fraction[-],top_{axes[-1]}_displacement[m],{forces}"],
                      "_newton.csv": ["step[-],iteration[-],relative_residual[-]"]}
        self.threads = _threads()
        self.rows = {}        # (element, point) -> number of the point
        self.states = None    # made when the first pass has told how many there are
        self.gradients = {}   # of this pass, by number of the point
        self.tables = None    # what the terms read: committed, or of the last evaluation
        self.committed = None
        self.residuals = []   # relative, of this attempt
        self.answer = None


def _tables(F, P, A):
    """Lists of what GetDP reads: vectors of 3 and row-major tensors of 9 numbers by component."""
    n, d = F.shape[:2]
    traction = P - np.einsum("niJkL,nkL->niJ", A, F - np.eye(d))

    def vectors(rows):
        padded = np.zeros((n, d, 3))
        padded[:, :, :d] = rows
        return padded.tolist()

    tensors = np.zeros((n, d, d, 3, 3))
    tensors[:, :, :, :d, :d] = A.transpose(0, 1, 3, 2, 4)
    return vectors(P), vectors(traction), tensors.reshape(n, d, d, 9).tolist()


def _current():
    if _run is None:
        raise RuntimeError("grainlaw.start has not been called, or it failed")
    return _run


@_guarded(FAILED)
def start(material, loads, tolerance, history=None, dimension=None, **options):
    """Read the material, which has to be of the dimension where that is given; loads as for load_steps;
    tolerance of |force on the unknowns| relative to |nodal forces of the stresses|; options of
    grainlaw.March; history: prefix of HISTORY_force.csv and HISTORY_newton.csv, which are written anew
    after every step, so that they always are whole."""
    global _run, failures
    _run, failures = None, 0
    run = _Run(material, loads, history, dimension, tolerance=tolerance, **options)
    for ending in run.lines:
        _record(run, ending, [])
    _run = run
    return GO_ON


def states():
    """The points as grainlaw.States, in the order of the first pass, e.g. to write one as VTK."""
    return _current().states


@_guarded([0.0])
def collect(arguments):
    """Of one point: element, point, and a gradient of 3 numbers for each displacement component."""
    run = _current()
    element, point, *gradients = arguments
    d = run.dimension
    if len(gradients) != d or any(not isinstance(g, list) or len(g) != 3 for g in gradients):
        raise ValueError(f"expected element, point and {d} gradients of 3 numbers, got {arguments}")
    key = (int(element), int(point))
    if run.states is None:
        row = run.rows.setdefault(key, len(run.rows))
    elif (row := run.rows.get(key)) is None:
        raise LookupError(f"element {key[0]}, point {key[1]} was not there in the first pass")
    if row in run.gradients:
        raise ValueError(f"element {key[0]}, point {key[1]} was handed over twice in one pass: the regions "
                         "of Body share an element")
    run.gradients[row] = [gradient[:d] for gradient in gradients]
    return [0.0]


@_guarded(FAILED)
def evaluate():
    """All points that a pass collected, in one call: GO_ON, or CUT where one has no equilibrium."""
    run = _current()
    collected, run.gradients = run.gradients, {}
    if failures:
        return FAILED
    if not collected:
        raise RuntimeError("no point was collected: the mesh has no elements in the regions of Body")
    if len(collected) != len(run.rows):
        raise RuntimeError(f"{len(collected)} of {len(run.rows)} points were collected")
    F = np.eye(run.dimension) + np.array([collected[row] for row in range(len(collected))])
    if run.states is None:
        run.states = grainlaw.States(run.material, len(run.rows))
    run.states.set_time_step(run.march.time)
    try:
        run.answer = run.states.evaluate(F, grainlaw.Tangent.EXACT, run.threads)
    except grainlaw.Error as error:
        if error.point is None:
            raise
        message = f"{error.message}; {_where(run, error.point)}"
        raise grainlaw.Error(error.status, message) from None
    if not run.answer.ok:
        reason = f"{run.answer.message}; {_where(run, run.answer.failed[0])}"
        if run.committed is None:
            raise RuntimeError(f"no equilibrium without displacement: {reason}")
        run.march.tell(run.answer, reason=reason)
        return _go_on(run)
    run.tables = _tables(F, run.answer.P, run.answer.A)
    if run.committed is None:  # the first pass, at no displacement
        _commit(run)
    return GO_ON


def _where(run, point):
    return "point {} is element {}, quadrature point {}".format(point, *list(run.rows)[point])


def _commit(run):
    run.states.commit()
    run.committed = run.tables


def _go_on(run):
    """What the march says after it was told."""
    now = run.march.next()
    if now == Action.SOLVE:
        return GO_ON
    if now == Action.ACCEPT:
        return _accept(run)
    run.states.revert()
    run.tables = run.committed
    if now == Action.GIVE_UP:
        raise RuntimeError(f"load {run.march.load:.6g}: {run.march.message}")
    print(f"grainlaw: load {run.march.load:.6g}: {run.march.message}; the step is cut", flush=True)
    run.residuals = []
    run.march.next()  # the next attempt
    return CUT


@_guarded(-1.0)
def load():
    """The fraction of the load to try next."""
    return _current().march.load


@_guarded(FAILED)
def judge(arguments):
    """After the system was generated: its |residual| and |nodal forces of the stresses|. The first
    call of an attempt tells the out-of-balance of the load increment, the others follow a solve."""
    run = _current()
    if failures:
        return FAILED
    residual, scale = arguments
    run.residuals.append(residual / scale)
    if len(run.residuals) == 1:
        return GO_ON
    run.march.tell(grainlaw.Status.OK, residual, scale)
    return _go_on(run)


def _shown(residuals):
    return ", ".join(f"{residual:.1e}" for residual in residuals)


def _accept(run):
    _commit(run)
    print(f"grainlaw: load {run.march.load:.6g}: {_shown(run.residuals)}", flush=True)
    _record(run, "_newton.csv", [f"{run.number},{iteration},{residual:.17g}"
                                 for iteration, residual in enumerate(run.residuals)])
    return CONVERGED


@_guarded(FAILED)
def finish(arguments):
    """After an attempt: its outcome, and of a converged one displacement and force of the platen.
    GO_ON while there is load left, CONVERGED at the end."""
    run = _current()
    outcome, displacement, *forces = arguments
    run.residuals = []
    if int(outcome) == CONVERGED:
        row = [run.march.load, displacement, *forces[:run.dimension]]
        _record(run, "_force.csv", [",".join([str(run.number), *(f"{number:.17g}" for number in row)])])
        _next_part(run)
    if failures:
        return FAILED
    if run.number < len(run.goals):
        return GO_ON
    print(f"grainlaw: the whole load is applied; {run.cuts} cuts", flush=True)
    return CONVERGED


def _next_part(run):
    if run.march.next() != Action.DONE:
        return
    run.cuts += run.march.cuts
    run.number += 1
    if run.number < len(run.goals):
        run.march.begin(run.goals[run.number])
        run.march.next()


def _record(run, ending, lines):
    run.lines[ending] += lines
    if run.history:
        write_whole(run.history + ending, "\n".join(run.lines[ending]) + "\n")


def _read(table, arguments, *components):
    run = _current()
    if run.tables is None:
        raise RuntimeError("a term was read before the points were evaluated")
    row = run.rows.get((int(arguments[0]), int(arguments[1])))
    if row is None:
        raise LookupError(f"element {arguments[0]:.0f}, point {arguments[1]:.0f} was not collected")
    values = run.tables[table][row]
    for component in components:
        values = values[component - 1]
    return values


@_guarded([0.0] * 3)
def stress(i, arguments):
    """Row i of P [Pa]."""
    return _read(0, arguments, i)


@_guarded([0.0] * 3)
def traction(i, arguments):
    """Row i of P - A : (F - I) [Pa]: the constant of Newton's step in the total displacement."""
    return _read(1, arguments, i)


@_guarded([0.0] * 9)
def tangent(i, k, arguments):
    """A_iJkL [Pa], a row for J and a column for L."""
    return _read(2, arguments, i, k)
