"""Reads recipes."""

from .parameters import Item, Law, RecipeError, generator, number_in, read_parameters
from .places import FlatGround
from .things import THINGS
from .things.catalogue import may_be_thing
from .world import Spot, World

KEYS = ("floor", "things", "max_triangles")
MAX_TRIANGLES = 8_000_000


def make_world(recipe, seed):
    """Makes a world from a recipe, whose text was read as an item."""
    block = recipe.block(KEYS)
    if "floor" not in block and "things" not in block:
        recipe.fail("is empty; a recipe has a floor, things or both")
    max_triangles = number_in(block["max_triangles"], 1, MAX_TRIANGLES, True) if "max_triangles" in block else 2_000_000

    def refuse(count):
        raise RecipeError(
            recipe.place,
            "max_triangles",
            f"is {max_triangles}; the recipe makes at least {count}: give a larger cell_m, fewer things, or up to {MAX_TRIANGLES}",
        )

    world = World(seed, max_triangles, refuse)
    if "floor" in block:
        world.add_floor(block["floor"])
    things = block.get("things", Item([], recipe.place, "things"))
    if not isinstance(things.value, list):
        things.fail(f"is {things.said()}; must be a list of blocks with the key thing")
    for index, each in enumerate(things.value):
        world.add_entry(each, index)
    if "floor" in block:
        world.add_stones()
    return world


def make_thing(name, assignments, seed):
    """Makes a world of a single thing on a flat floor at z = 0, which is not in the file."""
    if name not in THINGS:
        raise RecipeError("", "--thing", f"is {name}; {may_be_thing(name)}")
    thing = THINGS[name]
    parameters = [each for each in thing.all_parameters() if each.name not in ("buried",)]
    block = Item(assignments, "", "--set").block([each.name for each in parameters])
    rng = generator(seed, 11, 0, 0)
    values = read_parameters(block, parameters).draw(rng)
    world, origin = World(seed), Law("choice", [0.0])
    world.ground = FlatGround(0.0 if thing.kind != "structure" else 10.0)
    values |= {"gap_m": 0.0, "buried": 0.0}
    if values.get("heading_deg", 0) is None:
        values["heading_deg"] = 0.0
    if not world.place(thing, values, rng, name, Spot(origin, origin)):
        raise RecipeError("", "--thing", f"is {name}; it is larger than {world.ground.size[0]:g} m")
    return world
