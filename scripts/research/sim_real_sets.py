"""Pictures for scripts/research/sim_to_real: crops of real folders, their halves, and simulated sets, which `insonify dataset` makes."""
import hashlib
import io
import json
import os
import re
import subprocess
import zipfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml
from PIL import Image, UnidentifiedImageError

PICTURES = {".jpg", ".jpeg", ".png", ".bmp", ".tif", ".tiff"}
KEYS = {"deployment", "sweeps", "ablated", "decibels", "range_down", "margin", "sizes", "turn_deg", "visible_db", "white_share", "effects"}
FEWEST = 30  # visible pixels of a window


class Wrong(Exception):
    """Input that cannot be used, in one sentence."""


@dataclass
class Crop:
    pixels: np.ndarray  # grey levels 0 to 1
    label: str
    group: str  # film or object: crops of a group are in one half. Empty: unknown
    name: str


def number(name):
    """Sorts names by the numbers in them."""
    return [int(part) if part.isdigit() else part for part in re.split(r"(\d+)", name)]


def grey(source, name):
    try:
        with Image.open(source) as image:
            pixels = np.asarray(image.convert("L"), np.float32) / 255
    except (UnidentifiedImageError, OSError) as error:
        raise Wrong(f"{name}: cannot be read as a picture ({error})") from None
    if min(pixels.shape) < 4:
        raise Wrong(f"{name}: is {pixels.shape[1]} x {pixels.shape[0]} pixels; a crop has at least 4 x 4")
    return pixels


def class_files(entry):
    """(name within the class, readable) of each picture of a folder or a zip file."""
    if entry.is_dir():
        files = [file for file in entry.rglob("*") if file.suffix.lower() in PICTURES]
        return [(str(file.relative_to(entry)), file) for file in files]
    try:
        with zipfile.ZipFile(entry) as archive:
            names = [name for name in archive.namelist() if Path(name).suffix.lower() in PICTURES]
            strip = f"{entry.stem}/" if all(name.startswith(f"{entry.stem}/") for name in names) else ""
            return [(name[len(strip):], io.BytesIO(archive.read(name))) for name in names]
    except zipfile.BadZipFile:
        raise Wrong(f"{entry}: is no zip file") from None


def real_classes(folder):
    crops = []
    entries = sorted(each for each in folder.iterdir() if each.is_dir() or each.suffix == ".zip")
    for entry in entries:
        files = sorted(class_files(entry), key=lambda each: number(each[0]))
        if len(files) < 4:
            raise Wrong(f"{entry}: holds {len(files)} pictures; a class has at least 4, so that each half has two")
        for name, source in files:
            group = str(Path(name).parent) if len(Path(name).parts) > 1 else ""
            crops.append(Crop(grey(source, f"{entry}/{name}"), entry.stem, group, f"{entry.stem}/{name}"))
    return crops


def boxes(file):
    """(picture, class, box) of a COCO file."""
    try:
        content = json.loads(file.read_text())
        names = {each["id"]: each["name"] for each in content["categories"]}
        pictures = {each["id"]: each["file_name"] for each in content["images"]}
        return [(pictures[each["image_id"]], names[each["category_id"]], each["bbox"]) for each in content["annotations"]]
    except (ValueError, KeyError, TypeError) as error:
        raise Wrong(f"{file}: is no COCO file of images, annotations and categories ({error!r})") from None


def cut(pixels, box, margin):
    """The box and a margin of its sides; pixels outside the picture are omitted."""
    left, top, width, height = box
    grow_x, grow_y = margin * width, margin * height
    rows = slice(max(0, round(top - grow_y)), max(0, round(top + height + grow_y)))
    columns = slice(max(0, round(left - grow_x)), max(0, round(left + width + grow_x)))
    return pixels[rows, columns]


def real_frames(file):
    crops, loaded = [], {}
    for name, label, box in sorted(boxes(file), key=lambda each: number(each[0])):
        if name not in loaded:
            loaded = {name: grey(file.parent / name, file.parent / name)}
        pixels = cut(loaded[name], box, 0.1)
        if min(pixels.shape) < 4:
            raise Wrong(f"{file}: box {box} of {name} is smaller than 4 x 4 pixels or outside of the picture")
        folder = str(Path(name).parent)
        crops.append(Crop(pixels, label, "" if folder == "." else folder, f"{name} {box}"))
    return crops


def real(folder):
    """Crops in folders or zip files that have the names of their classes, or frames with COCO files."""
    if not folder.is_dir():
        raise Wrong(f"{folder}: is no folder")
    files = sorted(folder.glob("*.json"))
    crops = [crop for file in files for crop in real_frames(file)] if files else real_classes(folder)
    labels = sorted({crop.label for crop in crops})
    if len(labels) < 2:
        raise Wrong(f"{folder}: has {len(labels)} classes; there must be at least two, each a folder or a zip file of "
                    "pictures, or a COCO file with frames")
    return crops, labels


def halves(crops):
    """(train, test): halves of each class, by film or object where they are known, else by numbering. Films are never cut."""
    train, test, where = [], [], {}
    for label in sorted({crop.label for crop in crops}):
        mine = [crop for crop in crops if crop.label == label]
        groups = sorted({crop.group for crop in mine}, key=number)
        if len(groups) == 1 and groups[0] == "":
            middle = (len(mine) + 1) // 2
            train += mine[:middle]
            test += mine[middle:]
            continue
        for group in groups:  # a film with several classes stays in the half of its first class
            if group not in where:
                sizes = [sum(each.label == label for each in part) for part in (train, test)]
                where[group] = int(sizes[1] < sizes[0])
            (train, test)[where[group]].extend(crop for crop in mine if crop.group == group)
    for name, part in [("first", train), ("second", test)]:
        missing = {crop.label for crop in crops} - {crop.label for crop in part}
        if missing:
            raise Wrong(f"{sorted(missing)[0]}: the {name} half has none of it, because a film or object is in one half alone")
    return train, test


def read_set(path):
    """set.yml, or a folder with it."""
    file = path / "set.yml" if path.is_dir() else path
    if not file.exists():
        raise Wrong(f"{file}: there is no such file, which names a deployment and its sweeps")
    try:
        content = yaml.safe_load(file.read_text())
    except yaml.YAMLError as error:
        raise Wrong(f"{file}: is no YAML ({error})".replace("\n", " ")) from None
    if not isinstance(content, dict) or not {"deployment", "sweeps"} <= set(content) or not set(content) <= KEYS:
        raise Wrong(f"{file}: must have deployment and sweeps, and may have {', '.join(sorted(KEYS - {'deployment', 'sweeps'}))}")
    if not isinstance(content.get("sizes", False), bool):
        raise Wrong(f"{file}: sizes is {content['sizes']}; it is true or false")
    sweeps, ablated = ([sweep for pattern in content.get(key, content["sweeps"]) for sweep in sorted(file.parent.glob(pattern))]
                       for key in ("sweeps", "ablated"))
    if not sweeps or not ablated:
        raise Wrong(f"{file}: no file is named as its sweeps are, {', '.join(content['sweeps'])}")
    return content | {"sweeps": sweeps, "ablated": ablated, "deployment": file.parent / content["deployment"], "file": file,
                      "effects": content.get("effects") or {}}


def inputs_hash(files, values):
    total = hashlib.sha256(json.dumps(values, sort_keys=True).encode())
    for file in files:
        total.update(file.read_bytes())
    return total.hexdigest()[:12]


def without_settings(sweep, content, properties, file):
    """Writes the sweep without settings of these properties and what is in them, which would replace those of --set; returns its file."""
    kept = {name: law for name, law in (content.get("settings") or {}).items()
            if not any(name == each or name.startswith(f"{each}.") for each in properties)}
    if kept == (content.get("settings") or {}):
        return sweep
    scenes = [each | {"file": str((sweep.parent / each["file"]).resolve())} if isinstance(each, dict) else str((sweep.parent / each).resolve())
              for each in content.get("scenes", [])]
    file.write_text(json.dumps(content | {"settings": kept} | ({"scenes": scenes} if scenes else {})))
    return file


def made(insonify, plan, sweep, effect, cache):
    """Returns the folder of a sweep's set, without the effect if one is named. An existing set is reused."""
    values = plan["effects"][effect] if effect else {}
    content = yaml.safe_load(sweep.read_text()) or {}
    scenes = [sweep.parent / each["file"] if isinstance(each, dict) else sweep.parent / each for each in content.get("scenes", [])]
    missing = [file for file in [plan["deployment"], *scenes] if not file.exists()]
    if missing:
        raise Wrong(f"{missing[0]}: there is no such file, which {sweep} needs")
    folder = cache / f"{effect or 'whole'}_{sweep.stem}_{inputs_hash([plan['deployment'], sweep, *scenes], values)}"
    if (folder / "manifest.json").exists():
        return folder
    folder.parent.mkdir(parents=True, exist_ok=True)
    sweep = without_settings(sweep, content, values, folder.with_suffix(".yml"))
    command = [insonify, "dataset", plan["deployment"], "--sweep", sweep, "--out", folder, "--format", "coco"]
    for name, value in values.items():
        command += ["--set", f"{name}={json.dumps(value)}"]
    try:
        done = subprocess.run([str(each) for each in command], capture_output=True, text=True)
    except OSError as error:
        raise Wrong(f"{insonify}: cannot be run ({error.strerror})") from None
    if done.returncode != 0:
        raise Wrong(f"{sweep}: insonify dataset failed: {done.stderr.strip() or done.stdout.strip()}")
    return folder


def generate(insonify, plan, effect, cache):
    """Folders of the sets, one per sweep, made in parallel on all processors."""
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(lambda sweep: made(insonify, plan, sweep, effect, cache), plan["ablated" if effect else "sweeps"]))


def amplitudes(pixels, decibels):
    return 10 ** ((pixels - 1) * decibels / 20) * (pixels > 0) if decibels else pixels


def instances(file):
    """(picture, class, box, mask) of each annotation of a simulated set; a mask is rows and columns of its pixels, or None."""
    content = json.loads(file.read_text())
    for (picture, label, box), each in zip(boxes(file), content["annotations"]):
        runs = each.get("segmentation")
        if not runs:
            yield picture, label, box, None
            continue
        inside = np.repeat(np.arange(len(runs["counts"])) % 2 == 1, runs["counts"])
        columns, rows = np.divmod(np.flatnonzero(inside), runs["size"][0])
        yield picture, label, box, (rows, columns)


def turned(rows, columns, centre, degrees):
    """Points after a turn about a centre. A fan looks the same in each direction, so a turned object is off the sonar's axis."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    y, x = rows - centre[0], columns - centre[1]
    return centre[0] + c * y - s * x, centre[1] + s * y + c * x


def cut_turned(pixels, window, margin):
    """A window and a margin of its sides out of a picture that is turned about the window's centre of turn; black outside."""
    left, top, width, height = window.box
    rows, columns = np.mgrid[round(top - margin * height):round(top + (1 + margin) * height) + 1,
                             round(left - margin * width):round(left + (1 + margin) * width) + 1]
    y, x = (np.rint(each).astype(int) for each in turned(rows, columns, window.centre, -window.turn))
    known = (y >= 0) & (y < pixels.shape[0]) & (x >= 0) & (x < pixels.shape[1])
    return np.where(known, pixels[y.clip(0, pixels.shape[0] - 1), x.clip(0, pixels.shape[1] - 1)], 0)


def visible(levels, mask, decibels):
    """The pixels of a mask that exceed the median of their surroundings, in the mean of 3 x 3 pixels, as people see
    an object in noise."""
    rows, columns = mask
    margin = 6
    part = levels[max(0, rows.min() - margin):rows.max() + margin, max(0, columns.min() - margin):columns.max() + margin]
    ground = np.median(part[part > 0]) if (part > 0).any() else 0
    padded = np.pad(levels, 1, mode="edge")
    mean = sum(padded[rows + i, columns + j] for i in range(3) for j in range(3)) / 9
    seen = mean > ground * 10 ** (decibels / 20)
    return rows[seen], columns[seen]


@dataclass
class Window:
    box: list  # left, top, width, height in the turned picture [px]
    turn: float = 0.0  # of the picture [deg]
    centre: tuple = (0, 0)  # of the turn: row, column


def window(levels, box, mask, turn, decibels):
    """Returns the window of an annotation, or None where too little of it is visible."""
    if mask is None:
        return Window(box)
    if decibels is not None:
        mask = visible(levels, mask, decibels)
    if len(mask[0]) < FEWEST:
        return None
    left, top, width, height = box
    centre = (top + height / 2, left + width / 2)
    rows, columns = turned(*mask, centre, turn)
    (top, bottom), (left, right) = np.percentile(rows, [1, 99]), np.percentile(columns, [1, 99])
    return Window([left - 1, top - 1, right - left + 2, bottom - top + 2], turn, centre)


def windows(folders, sweeps, plan):
    """Windows of a set by (sweep, sample, class)."""
    found, (low, high) = {}, plan.get("turn_deg", [0, 0])
    for folder, sweep in zip(folders, sweeps):
        for file in sorted(folder.glob("instances_*.json")):
            for name, label, box, mask in instances(file):
                index = int(name.split("_")[0])
                turn = low + (high - low) * np.random.default_rng([index, 1]).random()
                levels = amplitudes(grey(folder / name, folder / name), plan.get("decibels"))
                found[(sweep.stem, index, label)] = window(levels, box, mask, turn, plan.get("visible_db"))
    return {key: each for key, each in found.items() if each}


def displayed(pixels, share):
    """Amplitudes as 8 bits of a display with a gain that makes a share of the pixels white [%]."""
    white = max(np.percentile(pixels, 100 - share), 1e-12)
    return np.round(255 * np.minimum(pixels / white, 1)) / 255


def simulated(folders, sweeps, plan, shown):
    """Crops of a set at `shown` windows, which may come from another set, to compare two sets in pairs."""
    crops = {}
    low, high = plan.get("margin", [0.1, 0.1])
    names = {sweep.stem: {int(file.name.split("_")[0]): file for file in folder.glob("[0-9]*_*.png")}
             for folder, sweep in zip(folders, sweeps)}
    for (sweep, index, label), where in shown.items():
        if sweep not in names:
            continue
        file = names[sweep][index]
        margin = low + (high - low) * np.random.default_rng(index).random()
        pixels = amplitudes(cut_turned(grey(file, file), where, margin), plan.get("decibels"))
        if plan.get("white_share"):
            pixels = displayed(pixels, np.random.default_rng([index, 2]).uniform(*plan["white_share"]))
        if plan.get("range_down"):
            pixels = pixels[::-1]
        if min(pixels.shape) >= 4:
            crops[(sweep, index, label)] = Crop(pixels.astype(np.float32), label, "", str(file))
    return crops
