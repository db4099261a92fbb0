#!/usr/bin/env python3
"""Makes deploy/scenes/wall.glb: a concrete wall, 40 m wide and 6 m high, across the way 10 m north. Needs numpy."""
from pathlib import Path

from glb import Glb, box

glb = Glb()
concrete = glb.material("concrete", {"material": "concrete"}, (0.6, 0.6, 0.58))
glb.node("wall", glb.mesh("wall", [box((1.0, 40.0, 6.0))], concrete), (10.5, 0, 0))
glb.write(Path(__file__).resolve().parents[2] / "deploy" / "scenes" / "wall.glb")
