"""The syntax of recipes: parameters with units in their names, bounds and defaults, and laws of random values.

A number is one value, [lowest, highest], {uniform: [lowest, highest]}, {normal: [mean, deviation]} or {choice: [...]}.
"""

import difflib
import math
from dataclasses import dataclass, field

import numpy as np
import yaml


class RecipeError(Exception):
    """One error of a recipe: its place, the value, and the allowed values."""

    def __init__(self, place, path, message):
        super().__init__(message)
        self.place, self.path, self.message = place, path, message

    def text(self):
        return ": ".join(part for part in (self.place, self.path, self.message) if part)


@dataclass
class Item:
    """A value of a recipe with its place: `value` is a text, a list of items or a dict of items by name."""

    value: object
    place: str
    path: str
    key_place: str = ""  # file position of its key, where it has one

    def fail(self, message):
        raise RecipeError(self.place, self.path, message)

    def said(self):
        """The value as written in the recipe, for messages."""
        if isinstance(self.value, dict):
            return "a block"
        if isinstance(self.value, list):
            return "a list"
        return self.value if self.value else '""'

    def block(self, known):
        """Items by key; every key must be known."""
        if not isinstance(self.value, dict):
            self.fail(f"is {self.said()}; must be a block of keys: {', '.join(known)}")
        for name, item in self.value.items():
            if name not in known:
                near = difflib.get_close_matches(name, known, 1)
                meant = f"did you mean {near[0]}? " if near else ""
                raise RecipeError(item.key_place, item.path, f"is not a key here; {meant}may be {', '.join(known)}")
        return self.value


class _Composer:
    """Items of a YAML document; aliases are refused, since they could expand a small file without
    end."""

    def __init__(self, name):
        self.name = name

    def place(self, node):
        return f"{self.name}:{node.start_mark.line + 1}:{node.start_mark.column + 1}"

    def item(self, node, path):
        place = self.place(node)
        if isinstance(node, yaml.ScalarNode):
            return Item(node.value, place, path)
        if isinstance(node, yaml.SequenceNode):
            return Item([self.item(each, f"{path}[{i}]") for i, each in enumerate(node.value)], place, path)
        items = {}
        for key, value in node.value:
            if not isinstance(key, yaml.ScalarNode):
                raise RecipeError(self.place(key), path, "has a key that is no text")
            below = f"{path}.{key.value}" if path else key.value
            if key.value in items:
                raise RecipeError(self.place(key), below, "is given twice")
            items[key.value] = self.item(value, below)
            items[key.value].key_place = self.place(key)
        return Item(items, place, path)


def read_yaml(text, name):
    """The only document of a YAML text, as an item."""
    try:
        for token in yaml.scan(text):
            if isinstance(token, (yaml.AliasToken, yaml.AnchorToken)):
                mark = token.start_mark
                raise RecipeError(
                    f"{name}:{mark.line + 1}:{mark.column + 1}", "", "is an anchor or alias; write the value out"
                )
        node = yaml.compose(text, yaml.SafeLoader)
        if node is not None:
            return _Composer(name).item(node, "")
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        place = f"{name}:{mark.line + 1}:{mark.column + 1}" if mark else name
        raise RecipeError(place, "", f"is no YAML: {error.problem or error.context}") from None
    except yaml.YAMLError as error:
        raise RecipeError(name, "", f"is no YAML: {str(error).splitlines()[0]}") from None
    except RecursionError:
        raise RecipeError(name, "", "has blocks that are nested too deep") from None
    raise RecipeError(name, "", "is empty; a recipe has a floor, things or both")


def number_in(item, low, high, whole=False):
    kind = "a whole number" if whole else "a number"
    may = f"must be {kind} from {low:g} to {high:g}"
    if not isinstance(item.value, str):
        item.fail(f"is {item.said()}; {may}")
    try:
        value = math.nan if "_" in item.value else float(item.value)
    except ValueError:
        value = math.nan
    if math.isnan(value) or not low <= value <= high or (whole and value != int(value)):
        item.fail(f"is {item.said()}; {may}")
    return int(value) if whole else value


@dataclass
class Law:
    """The law of a value: uniform, normal within the bounds, or one of a list."""

    kind: str
    values: list
    low: float = -math.inf
    high: float = math.inf
    whole: bool = False

    def is_fixed(self):
        return self.kind == "choice" and len(self.values) == 1 and not self.is_absent()

    def is_absent(self):
        return self.values == [None]

    def draw(self, rng):
        if self.kind == "choice":
            return self.values[rng.integers(len(self.values))]
        if self.whole:
            return int(rng.integers(self.values[0], self.values[1] + 1))
        if self.kind == "uniform":
            return float(rng.uniform(*self.values))
        for _ in range(1000):
            if self.low <= (value := float(rng.normal(*self.values))) <= self.high:
                return value
        return min(max(self.values[0], self.low), self.high)


@dataclass
class Parameter:
    name: str
    default: object
    about: str

    def unit(self):
        for ending, unit in (("_per_m2", "1/m2"), ("_mm", "mm"), ("_m", "m"), ("_deg", "deg")):
            if self.name.endswith(ending):
                return unit
        return ""

    def fallback(self):
        return Law("choice", [self.default])


@dataclass
class Number(Parameter):
    low: float = 0
    high: float = 1
    whole: bool = False

    def may_be(self):
        return f"{self.low:g} to {self.high:g}"

    def read(self, item):
        def one(each):
            return number_in(each, self.low, self.high, self.whole)

        def law(kind, items):
            first, last = (one(each) for each in items.value)
            if kind == "uniform" and first > last:
                items.fail(f"is [{first:g}, {last:g}]; the lowest value is first")
            return Law("uniform", [first, last], self.low, self.high, self.whole)

        if isinstance(item.value, str):
            return Law("choice", [one(item)])
        pair = "must be two numbers"
        if isinstance(item.value, list):
            if len(item.value) != 2:
                item.fail(f"has {len(item.value)} values; {pair}: [lowest, highest]")
            return law("uniform", item)
        kinds = ("uniform", "choice") if self.whole else ("uniform", "normal", "choice")
        block = item.block(kinds)
        if len(block) != 1:
            item.fail(f"must have one of {', '.join(kinds)}")
        ((kind, items),) = block.items()
        if not isinstance(items.value, list) or (kind == "choice" and not items.value):
            items.fail(f"is {items.said()}; must be a list")
        if kind == "choice":
            return Law("choice", [one(each) for each in items.value])
        if len(items.value) != 2:
            items.fail(
                f"has {len(items.value)} values; {pair}: {'[mean, deviation]' if kind == 'normal' else '[lowest, highest]'}"
            )
        if kind == "uniform":
            return law(kind, items)
        deviation = number_in(items.value[1], 0, self.high - self.low)
        return Law("normal", [one(items.value[0]), deviation], self.low, self.high)


@dataclass
class Choice(Parameter):
    options: tuple = ()

    def may_be(self):
        return ", ".join(self.options)

    def read(self, item):
        def one(each):
            if not isinstance(each.value, str) or each.value not in self.options:
                each.fail(f"is {each.said()}; may be {', '.join(self.options)}")
            return each.value

        if isinstance(item.value, dict):
            items = item.block(("choice",)).get("choice")
            if items is None or not isinstance(items.value, list) or not items.value:
                item.fail("must have a list of values: {choice: [...]}")
            return Law("choice", [one(each) for each in items.value])
        if isinstance(item.value, list):
            item.fail(f"is a list; may be {', '.join(self.options)}, or {{choice: [...]}}")
        return Law("choice", [one(item)])


class Switch(Choice):
    def __init__(self, name, default, about):
        super().__init__(name, default, about, ("true", "false"))

    def read(self, item):
        law = super().read(item)
        law.values = [value == "true" for value in law.values]
        return law

    def fallback(self):
        return Law("choice", [self.default == "true"])


@dataclass
class Point(Parameter):
    """A fixed place or size, [x, y]."""

    low: float = -1000
    high: float = 1000

    def may_be(self):
        return f"[x, y], {self.low:g} to {self.high:g}"

    def read(self, item):
        if not isinstance(item.value, list) or len(item.value) != 2:
            item.fail(f"is {item.said()}; must be two numbers: [x, y]")
        return Law("choice", [tuple(number_in(each, self.low, self.high) for each in item.value)])


@dataclass
class Text(Parameter):
    def may_be(self):
        return "letters, digits and _, beginning with a letter"

    def read(self, item):
        text = item.value
        if (
            not isinstance(text, str)
            or not text.isascii()
            or not text.replace("_", "a").isalnum()
            or not text[:1].isalpha()
        ):
            item.fail(f"is {item.said()}; must be {self.may_be()}")
        return Law("choice", [text])


@dataclass
class Drawn:
    """The laws of some parameters, read from a block."""

    laws: dict = field(default_factory=dict)

    def draw(self, rng):
        return {name: law.draw(rng) for name, law in self.laws.items()}


def read_parameters(block, parameters):
    """Reads `block`, items by key."""
    laws = {}
    for each in parameters:
        laws[each.name] = each.read(block[each.name]) if each.name in block else each.fallback()
    return Drawn(laws)


def generator(*words):
    """Random numbers that depend only on these whole numbers."""
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(words)))
