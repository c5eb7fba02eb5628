"""FEMxDEM's module of this name, over grainlaw."""
import builtins

from grainlaw.femxdem import saveGauss2D, saveGauss3D

__all__ = ["saveGauss2D", "saveGauss3D"]

if not hasattr(builtins, "file"):
    builtins.file = open   # which scripts written for Python 2 call
