"""grainlaw as the micro simulation of preCICE's Micro Manager: "micro_file_name": "grainlaw_micro".

Macro data: F1, F2[, F3], the rows of F [-]. Micro data: P1, ..., the rows of P [Pa]; A111, ..., with A{i}{J}{k}
the row k of dP_iJ/dF [Pa]; void_ratio [-]. The material file is $GRAINLAW_MATERIAL, or material.toml.
"""
import os

import numpy as np

import grainlaw


class MicroSimulation:
    material = None   # of the process: the packing is read once

    def __init__(self, sim_id):
        kind = type(self)
        kind.material = kind.material or grainlaw.Material(
            os.environ.get("GRAINLAW_MATERIAL", "material.toml"))
        self._id, self._state = sim_id, grainlaw.State(kind.material)
        self._solved = False

    def initialize(self, *_):
        return self._output(self._state.answer(grainlaw.Tangent.EXACT))

    def solve(self, macro_data, dt):
        rows = [f"F{i + 1}" for i in range(self._state.dimension)]
        if not all(row in macro_data for row in rows):
            raise ValueError(f"micro simulation {self._id}: found {', '.join(macro_data)}, expected "
                             f"{', '.join(rows)} in read_data_names")
        F = np.array([macro_data[row] for row in rows])
        self._state.set_time_step(dt)
        answer = self._state.evaluate(F, grainlaw.Tangent.EXACT)   # from the start of the window
        self._solved = bool(answer.ok)
        if not answer.ok:
            raise RuntimeError(f"micro simulation {self._id}: {answer.message}; a time window of "
                               f"{answer.step_ratio} times this one may do")
        return self._output(answer)

    def get_state(self):
        """Asked for at the start of a window: what was solved before has been accepted."""
        if self._solved:
            self._state.commit()
        self._solved = False
        return {"bytes": self._state.save()}

    def set_state(self, state):
        """The start of a window that is repeated, or of one that came from elsewhere."""
        self._state.load(state["bytes"])
        self._solved = False

    def get_global_id(self):
        return self._id

    def set_global_id(self, global_id):
        self._id = global_id

    def _output(self, answer):
        axes = range(self._state.dimension)
        data = {f"P{i + 1}": answer.P[i] for i in axes}
        data |= {f"A{i + 1}{J + 1}{k + 1}": answer.A[i, J, k] for i in axes for J in axes for k in axes}
        return data | {"void_ratio": float(self._state.measure(grainlaw.Measure.VOID_RATIO))}
