"""FEMxDEM's module of this name, over grainlaw."""
from grainlaw.femxdem import MultiScale2D as MultiScale

__all__ = ["MultiScale"]
