"""Materials of things: their `extras.acoustics` in a glTF file (components/scene/README.md)."""

import math
from dataclasses import dataclass

# Pressure reflection coefficients of matter, as `insonify describe materials` lists them.
REFLECTION = {
    "steel": 0.936,
    "carbon_steel": 0.936,
    "aluminium": 0.835,
    "cast_iron": 0.91,
    "bronze": 0.93,
    "granite": 0.81,
    "concrete": 0.69,
    "limestone": 0.65,
    "pvc": 0.37,
    "acrylic": 0.35,
    "hdpe": 0.21,
    "neoprene": 0.15,
    "waterlogged_wood": -0.07,
    "closed_cell_foam": -0.94,
    "glass": 0.80,
    "fibreglass": 0.57,
    "rubber": 0.28,
    "wood": 0.15,
    "rock": 0.72,
    "rope": 0.31,
    "net": 0.31,
    "fouling": 0.14,
    "human_body": 0.08,
    "pet": 0.39,
    "polypropylene": 0.22,
    "paper": 0.17,
    "painted_metal": 0.936,
}
COLOURS = {
    "steel": (0.55, 0.57, 0.6),
    "carbon_steel": (0.42, 0.24, 0.15),
    "aluminium": (0.75, 0.76, 0.78),
    "cast_iron": (0.25, 0.24, 0.24),
    "bronze": (0.6, 0.45, 0.2),
    "granite": (0.5, 0.48, 0.46),
    "concrete": (0.6, 0.6, 0.58),
    "limestone": (0.72, 0.68, 0.58),
    "pvc": (0.85, 0.85, 0.8),
    "hdpe": (0.1, 0.25, 0.5),
    "waterlogged_wood": (0.3, 0.22, 0.15),
    "glass": (0.35, 0.55, 0.4),
    "fibreglass": (0.9, 0.75, 0.15),
    "rubber": (0.08, 0.08, 0.08),
    "neoprene": (0.1, 0.1, 0.1),
    "wood": (0.5, 0.36, 0.2),
    "rock": (0.45, 0.43, 0.4),
    "rope": (0.6, 0.52, 0.35),
    "net": (0.2, 0.45, 0.35),
    "closed_cell_foam": (0.85, 0.4, 0.1),
    "human_body": (0.12, 0.12, 0.14),
    "pet": (0.7, 0.82, 0.9),
    "polypropylene": (0.9, 0.9, 0.88),
    "paper": (0.66, 0.5, 0.33),
    "painted_metal": (0.7, 0.1, 0.08),
}
SEDIMENTS = (
    "rough_rock",
    "rock",
    "cobble",
    "sandy_gravel",
    "coarse_sand",
    "medium_sand",
    "fine_sand",
    "muddy_sand",
    "very_fine_sand",
    "coarse_silt",
    "sandy_silt",
    "medium_silt",
    "fine_silt",
    "very_fine_silt",
    "clay",
)
COMMON_NAMES = {"sand": "medium_sand", "gravel": "sandy_gravel", "mud": "clay", "silt": "medium_silt"}
SEDIMENT_COLOUR = (0.76, 0.7, 0.5)
STATES = ("clean", "weathered", "fouled")
SLOPES = {"clean": 0.05, "weathered": 0.2, "fouled": 0.4}  # rms slopes of the faces of walls


@dataclass(frozen=True)
class Material:
    """A material. Values are a tuple of pairs, so that equal materials compare equal."""

    name: str
    colour: tuple
    values: tuple

    def acoustics(self):
        return {key: dict(value) if isinstance(value, tuple) else value for key, value in self.values}


def solid(matter, state="weathered"):
    """A body of one matter. A weathered surface follows Lambert's law at every frequency (ACOUSTICS.md 3.3)."""
    if state == "fouled":
        return Material(f"fouled {matter}", COLOURS[matter], (("material", "fouling"),))
    if state == "clean" or matter in ("rope", "net", "rock", "human_body"):
        return Material(matter, COLOURS[matter], (("material", matter),))
    lambert = round(-9.23 + 20 * math.log10(abs(REFLECTION[matter])), 2)
    return Material(f"weathered {matter}", COLOURS[matter], (("material", matter), ("lambert_db", lambert)))


def wall(matter, thickness_mm, fill="water", state="weathered"):
    """A hollow body: its surface is the outer face of a thin wall that sound passes (components/scene/README.md)."""
    thickness = round(float(thickness_mm), 3)
    shell = (("thickness_mm", thickness), ("material", matter), ("fill", fill))
    return Material(
        f"{matter} wall {thickness:g} mm with {fill}, {state}",
        COLOURS[matter],
        (("shell", shell), ("roughness_slope", SLOPES[state])),
    )


def sediment(name):
    return Material(name, SEDIMENT_COLOUR, (("sediment", COMMON_NAMES.get(name, name)),))
