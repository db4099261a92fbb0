"""The library of things. A thing is a function of random numbers and drawn parameters that returns a Model."""

from . import gear, litter, ordnance, structures, vehicles  # noqa: F401: each adds its things
from .catalogue import THINGS, Model, Thing  # noqa: F401
