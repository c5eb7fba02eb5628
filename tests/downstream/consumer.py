"""A host in Python: load a material, compress it by 0.1 %, commit, print the stress."""
import sys

import grainlaw

try:
    state = grainlaw.State(grainlaw.Material(sys.argv[1]))
    answer = state.evaluate([[1, 0], [0, 0.999]], grainlaw.Tangent.EXACT)
    if not answer.ok:
        sys.exit(f"{answer.message}: retry with {answer.step_ratio} of the step")
    state.commit()
    void_ratio = state.measure(grainlaw.Measure.VOID_RATIO)
    print(f"grainlaw {grainlaw.version()}: P11 = {answer.P[0, 0]:.6g} Pa, P22 = {answer.P[1, 1]:.6g} "
          f"Pa, dP22/dF22 = {answer.A[1, 1, 1, 1]:.6g} Pa, e = {void_ratio:.4f} [-]")
except grainlaw.Error as error:
    sys.exit(str(error))
