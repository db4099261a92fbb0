"""The program behind `insonify scene make`: python3 -m insonify_worlds, with the options that the command
has parsed."""

import argparse
import json
import os
import sys
from pathlib import Path

LACKING = 97  # a Python without the packages; the command tries the next one

try:
    import manifold3d  # noqa: F401
    import numpy  # noqa: F401
    import yaml  # noqa: F401
except ImportError:
    sys.exit(LACKING)

from .parameters import Item, RecipeError, read_yaml  # noqa: E402
from .recipe import make_thing, make_world  # noqa: E402
from .things import THINGS  # noqa: E402
from .things.catalogue import ENTRY, may_be_thing  # noqa: E402


def default_of(parameter):
    if parameter.default is None:
        return None
    return list(parameter.default) if isinstance(parameter.default, tuple) else parameter.default


def described(parameter):
    return {
        "name": parameter.name,
        "unit": parameter.unit(),
        "default": default_of(parameter),
        "may_be": parameter.may_be(),
        "about": parameter.about,
    }


def listing(names):
    return [
        {
            "thing": name,
            "about": THINGS[name].about,
            "placed_as": THINGS[name].kind,
            "parameters": [described(each) for each in THINGS[name].all_parameters()],
        }
        for name in names
    ]


def print_listing(names):
    for thing in listing(names):
        print(f"{thing['thing']}: {thing['about']}")
        for each in thing["parameters"]:
            unit = f" {each['unit']}" if each["unit"] else ""
            default = "" if each["default"] is None else f"{each['default']}{unit}"
            about = f"; {each['about']}" if each["about"] else ""
            print(f"  {each['name']:18} {default:12} {each['may_be']}{unit}{about}")
    if len(names) > 1:
        print("of each in a recipe:")
        for each in map(described, ENTRY):
            print(
                f"  {each['name']:18} {'' if each['default'] is None else each['default']!s:12} {each['may_be']}; {each['about']}"
            )


def assignments(texts):
    items = {}
    for text in texts:
        name, equals, value = text.partition("=")
        if not equals:
            raise RecipeError("", f"--set {text}", "must be NAME=VALUE: --set diameter_m=0.7")
        if name in items:
            raise RecipeError("", f"--set {name}", "is given twice")
        item = read_yaml(value, f"--set {name}") if value else Item("", "", name)
        items[name] = with_place(item, "", name)
    return items


def with_place(item, place, path):
    if isinstance(item.value, list):
        item.value = [with_place(each, place, f"{path}[{i}]") for i, each in enumerate(item.value)]
    if isinstance(item.value, dict):
        item.value = {key: with_place(each, place, f"{path}.{key}") for key, each in item.value.items()}
    return Item(item.value, place, path)


def summary(world, out):
    kinds = {}
    for placed in world.placed:
        kinds.setdefault(placed.name.rstrip("0123456789").rstrip("_"), []).append(placed)
    counts = ", ".join(f"{len(all_)} {name}" if len(all_) > 1 else name for name, all_ in kinds.items())
    return f"{out}: {world.triangles} triangles, {len(world.placed)} nodes, {Path(out).stat().st_size / 1e6:.2f} MB, seed {world.seed}: {counts}"


def report(world, out):
    return {
        "file": out,
        "seed": world.seed,
        "triangles": world.triangles,
        "bytes": Path(out).stat().st_size,
        "nodes": [
            {
                "name": each.name,
                "position": [round(float(x), 6) for x in each.at],
                "triangles": sum(len(surface.faces) for surface, _ in each.surfaces),
                "materials": sorted({material.name for _, material in each.surfaces}),
            }
            for each in world.placed
        ],
    }


def made(options):
    if options.thing:
        return make_thing(options.thing, assignments(options.set), options.seed)
    try:
        text = Path(options.recipe).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "is no text in UTF-8"
        raise RecipeError(options.recipe, "", f"cannot be read: {reason}") from None
    return make_world(read_yaml(text, options.recipe), options.seed)


def run(options):
    if options.list:
        if options.thing and options.thing not in THINGS:
            raise RecipeError("", "--thing", f"is {options.thing}; {may_be_thing(options.thing)}")
        names = [options.thing] if options.thing else list(THINGS)
        print(json.dumps(listing(names), indent=1)) if options.json else print_listing(names)
        return
    world = made(options)
    if not world.placed:
        raise RecipeError(options.recipe, "", "makes nothing: it has no floor, and no thing whose count is above 0")
    try:
        world.write(Path(options.out))
    except OSError as error:
        raise RecipeError(options.out, "", f"cannot be written: {error.strerror}") from None
    if options.json:
        print(json.dumps(report(world, options.out), indent=1))
    elif not options.quiet:
        print(summary(world, options.out))


def main():
    parser = argparse.ArgumentParser("insonify_worlds")
    parser.add_argument("--recipe", default="")
    parser.add_argument("--thing", default="")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", default="")
    for flag in ("--list", "--json", "--quiet"):
        parser.add_argument(flag, action="store_true")
    try:
        run(parser.parse_args())
        sys.stdout.flush()
    except RecipeError as error:
        print(error.text(), file=sys.stderr)
        sys.exit(2)
    except BrokenPipeError:  # the reader has stopped: `| head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


if __name__ == "__main__":
    main()
