"""FEMxDEM's module of this name, over grainlaw."""
from grainlaw.femxdem import MultiScaleUP as MultiScale

__all__ = ["MultiScale"]
