"""grainlaw for Python: a material law made of grains, over numpy arrays.

Conventions are those of grainlaw.h: F[i, J] = dx_i/dX_J [-], P in Pa with tension positive,
A[i, J, k, L] = dP_iJ/dF_kL [Pa], SI units. d is the dimension of the material, 2 or 3.

    material = grainlaw.Material("sand.toml")
    points = grainlaw.States(material, 240)
    answer = points.evaluate(F, grainlaw.Tangent.EXACT)     # F: (240, d, d)
    if answer.ok:
        points.commit()                                     # answer.P, answer.A
    else:
        points.revert()                 # and retry with answer.step_ratio of the step

    result = grainlaw.laboratory.drained(material, strain=0.05)
    result.plot()

A status < 0 raises Error and leaves what is committed as it was; a recoverable one (> 0) is an
answer. The library is $GRAINLAW_LIBRARY, or the one this package was installed with, or the one
the dynamic loader finds.

    grainlaw.laboratory  the tests of a soil laboratory, one call each, and any mixed path
    grainlaw.March       load steps that are cut, for hosts whose loop is written in Python
    grainlaw.files       files that are the old one or the whole new one
"""
from . import files, laboratory, tests
from .abi import Error, StepError, status_text, version
from .march import March
from .material import Material
from .names import Action, Measure, Status, Tangent
from .points import Evaluation, State, States
from .table import Table

__all__ = ["Action", "Error", "Evaluation", "March", "Material", "Measure", "State", "States",
           "Status", "StepError", "Table", "Tangent", "files", "laboratory", "status_text", "tests",
           "version"]
__version__ = version()
