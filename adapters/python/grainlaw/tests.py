"""The old name of grainlaw.laboratory."""
from .laboratory import *  # pylint: disable=wildcard-import,unused-wildcard-import
from .laboratory import __all__ as __all__
