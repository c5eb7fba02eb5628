"""What a test comes to, step by step, in numpy arrays."""
from __future__ import annotations

from typing import Any

import numpy as np

from . import plots
from .arrays import Array, Reached
from .control import cauchy
from .names import Measure
from .points import State

_MEASURES = {"void_ratio": Measure.VOID_RATIO, "coordination": Measure.COORDINATION,
             "coordination_no_rattlers": Measure.COORDINATION_NO_RATTLERS,
             "fabric": Measure.FABRIC, "anisotropy": Measure.ANISOTROPY,
             "mean_overlap": Measure.MEAN_OVERLAP, "elastic_energy": Measure.ELASTIC_ENERGY,
             "dissipated_energy": Measure.DISSIPATED_ENERGY, "contacts": Measure.CONTACTS,
             "broken_bonds": Measure.BROKEN_BONDS}


class Result:
    """Rows of a test, n of them: the start, and every step. Axis d, the last, is the axial one.

    F                         (n, d, d) deformation gradient dx_i/dX_J [-]
    P                         (n, d, d) first Piola-Kirchhoff stress [Pa], tension positive
    A                         (n, d, d, d, d) tangent dP/dF [Pa], of a test with tangents=True
    sigma                     (n, d, d) Cauchy stress [Pa], tension positive
    axial_strain              (n,) 1 - F22, of spheres 1 - F33 [-], shortening positive
    volumetric_strain         (n,) det F - 1 [-], dilation positive
    shear_strain              (n,) F12 / F22, of spheres F13 / F33 [-]
    shear_stress              (n,) sigma12, of spheres sigma13 [Pa]
    axial_stress              (n,) [Pa], compression positive
    lateral_stress            (n,) [Pa], compression positive; of spheres the mean of two
    mean_pressure             (n,) -tr sigma / d [Pa]
    deviatoric_stress         (n,) q, axial less lateral stress [Pa]: below 0 in extension
    void_ratio                (n,) volume of voids / volume of particles [-]
    coordination              (n,) 2 C / N over all particles [-]
    coordination_no_rattlers  (n,) [-]
    fabric                    (n, d, d) (1/C) sum n n [-]
    anisotropy                (n,) largest / smallest eigenvalue of the fabric - 1 [-]
    mean_overlap              (n,) of touching contacts [m]
    elastic_energy            (n,) stored in the contacts [J]
    dissipated_energy         (n,) by friction, rolling, broken bonds since F = I [J]
    external_work             (n,) of P on dF since the start of the test [J]
    contacts, sliding         (n,) number of touching contacts; of those at the limit of friction [-]
    broken_bonds              (n,) since F = I [-]
    unbalanced                (n,) with solver.viscous_number: largest drag on a particle / mean contact
                              force [-]; else 0
    """

    state: State             #: where the test ended; may be led on
    ended: str               #: what ended it before its end, with the number, or ""
    liquefied: bool          #: whether that was a lack of pressure
    loose_parts: int         #: parts of steps that ended out of balance, beside a jump of the stress
    before: Result | None    #: of the consolidation

    def __init__(self, state: State, before: Result | None = None, tangents: bool = False) -> None:
        self.state, self.before, self._tangents = state, before, tangents
        self.ended, self.liquefied, self.loose_parts = "", False, 0
        self._rows: list[dict[str, Any]] = []

    def add(self, reached: Reached) -> None:
        """A row of where the state is."""
        row: dict[str, Any] = {name: self.state.measure(what) for name, what in _MEASURES.items()}
        row.update(F=reached.F, P=reached.P, sigma=cauchy(reached.P, reached.F),
                   external_work=reached.work, sliding=float(reached.report["sliding"]),
                   unbalanced=float(reached.report["unbalanced"]))
        if self._tangents:
            row["A"] = reached.A
        self._rows.append(row)
        self.loose_parts = reached.loose_parts

    def __len__(self) -> int:
        return len(self._rows)

    def __repr__(self) -> str:
        return (f"<Result of {len(self) - 1} steps, {self.ended or 'done'}: axial strain "
                f"{self.axial_strain[-1]:.4g} [-], mean pressure {self.mean_pressure[-1]:.4g} Pa, "
                f"void ratio {self.void_ratio[-1]:.4g} [-]>")

    def __getattr__(self, name: str) -> Array:
        rows = self.__dict__.get("_rows")
        if not rows or name not in rows[0]:
            raise AttributeError(f"a Result has no {name}; help(grainlaw.laboratory.Result) lists "
                                 "what")
        return np.array([row[name] for row in rows])

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *(self._rows[0] if self._rows else [])]

    @property
    def axial_strain(self) -> Array:
        """(n,) shortening positive [-]"""
        return 1 - self.F[:, -1, -1]

    @property
    def volumetric_strain(self) -> Array:
        """(n,) dilation positive [-]"""
        strain: Array = np.linalg.det(self.F) - 1
        return strain

    @property
    def shear_strain(self) -> Array:
        """(n,) [-]"""
        strain: Array = self.F[:, 0, -1] / self.F[:, -1, -1]
        return strain

    @property
    def shear_stress(self) -> Array:
        """(n,) [Pa]"""
        return self.sigma[:, 0, -1]

    @property
    def axial_stress(self) -> Array:
        """(n,) compression positive [Pa]"""
        return -self.sigma[:, -1, -1]

    @property
    def lateral_stress(self) -> Array:
        """(n,) compression positive [Pa]"""
        stress: Array = -np.diagonal(self.sigma, axis1=1, axis2=2)[:, :-1].mean(axis=1)
        return stress

    @property
    def mean_pressure(self) -> Array:
        """(n,) compression positive [Pa]"""
        pressure: Array = -np.trace(self.sigma, axis1=1, axis2=2) / self.sigma.shape[1]
        return pressure

    @property
    def deviatoric_stress(self) -> Array:
        """(n,) q, axial less lateral stress, below 0 in extension [Pa]"""
        return self.axial_stress - self.lateral_stress

    def columns(self) -> dict[str, Array]:
        """All of it by name, tensors component by component ("sigma12"), each (n,): for
        numpy.savetxt or a data frame of pandas."""
        names = [*(name for name, value in vars(Result).items() if isinstance(value, property)),
                 *self._rows[0]]
        result: dict[str, Array] = {}
        for name in names:
            values = np.asarray(getattr(self, name))
            flat = values.reshape(len(values), -1)
            for k, index in enumerate(np.ndindex(values.shape[1:])):
                result[name + "".join(str(axis + 1) for axis in index)] = flat[:, k]
        return result

    def plot(self, shear: bool | None = None, kind: str = "history") -> Any:
        """A figure of matplotlib, shown by its .show() or kept by its .savefig("sand.png"). Raises
        ImportError where matplotlib is not installed.

        history      stress, void ratio and coordination number over the axial strain
        p-q          deviatoric stress q over the mean pressure p
        e-log-p      void ratio over the mean pressure, logarithmic
        stress-path  axial over lateral stress

        Of a simple shear (shear=True; None: whichever strain is larger) over the shear strain, shear
        stress for q, and shear stress over the normal stress on its planes."""
        return plots.draw(kind, self.columns(), shear)
