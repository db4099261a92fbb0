"""The report of scripts/research/sim_to_real: tables, a picture of confusions, and of crops side by side."""
import numpy as np
from PIL import Image, ImageDraw

import sim_real_learn as learn

CELL = 66  # side of a confusion or crop [px]
INK = (30, 30, 30)


def spread(values):
    return f"{np.mean(values):.2f} +- {np.std(values):.2f}"


def table(rows):
    lines = ["| trained on | pictures | accuracy | macro-F1 |", "| --- | --- | --- | --- |"]
    for row in rows:
        lines.append(f"| {row['name']} | {row['pictures']} | {spread([run['accuracy'] for run in row['runs']])} | "
                     f"{spread([run['macro_f1'] for run in row['runs']])} |")
    return lines


def paired(rows):
    """Returns the gain of the whole model over the model without an effect, seed by seed."""
    lines = ["| effect | accuracy gained by it | macro-F1 gained by it |", "| --- | --- | --- |"]
    for row in rows[1:]:
        gains = [[a[key] - b[key] for a, b in zip(rows[0]["runs"], row["runs"])] for key in ("accuracy", "macro_f1")]
        lines.append(f"| {row['name'].removeprefix('without ')} | " + " | ".join(f"{np.mean(each):+.2f} +- {np.std(each):.2f}" for each in gains) + " |")
    return lines


def recall(labels, rows):
    lines = ["| recall of | " + " | ".join(row["name"] for row in rows) + " |", "| --- |" + " --- |" * len(rows)]
    for i, label in enumerate(labels):
        shares = [np.mean([run["confusion"][i][i] / max(1, sum(run["confusion"][i])) for run in row["runs"]]) for row in rows]
        lines.append(f"| {label} | " + " | ".join(f"{each:.2f}" for each in shares) + " |")
    return lines


def distances(train, test, simulated):
    pairs = {"first half, to another of it": (train, train), "second half, to another of it": (test, test),
             "second half, to the first": (test, train), "second half, to the simulated": (test, simulated)}
    return {name: [float(each) for each in np.percentile(learn.nearest(*pair), [10, 50, 90])] for name, pair in pairs.items()}


def confusion_picture(file, labels, rows):
    size, left, top = len(labels), 130, 40
    picture = Image.new("RGB", (len(rows) * (size * CELL + left) + 20, top + (size + 1) * CELL), "white")
    draw = ImageDraw.Draw(picture)
    for k, row in enumerate(rows):
        x0 = left + k * (size * CELL + left)
        draw.text((x0, 12), f"{row['name']}: true class (rows), found class (columns) [%]", fill=INK)
        total = np.sum([run["confusion"] for run in row["runs"]], axis=0)
        for i in range(size):
            draw.text((x0 - 110, top + i * CELL + CELL // 2), labels[i][:18], fill=INK)
            draw.text((x0 + i * CELL + 2, top + size * CELL + 4 + 14 * (i % 2)), labels[i][:18], fill=INK)
            for j in range(size):
                share = total[i, j] / max(1, total[i].sum())
                shade = round(255 * (1 - share))
                box = (x0 + j * CELL, top + i * CELL, x0 + (j + 1) * CELL - 2, top + (i + 1) * CELL - 2)
                draw.rectangle(box, fill=(shade, shade, 255))
                draw.text((box[0] + 24, box[1] + 26), f"{100 * share:.0f}", fill="white" if share > 0.6 else INK)
    picture.save(file)


def tile(pixels):
    low, high = np.percentile(pixels, [1, 99.5])
    image = Image.fromarray((255 * np.clip((pixels - low) / max(high - low, 1e-6), 0, 1)).astype(np.uint8))
    scale = (CELL - 4) / max(image.size)
    return image.resize((max(1, round(image.width * scale)), max(1, round(image.height * scale))), Image.Resampling.NEAREST)


def strip(picture, draw, y, title, crops):
    draw.text((4, y + 24), title, fill=INK)
    for i, crop in enumerate(crops):
        picture.paste(tile(crop.pixels), (190 + i * CELL, y))


def evenly(items, count):
    return [items[int(i)] for i in np.linspace(0, len(items) - 1, min(count, len(items)))] if items else []


def examples_picture(file, labels, simulated, test, found, count=16):
    """Draws for each class simulated crops, recognised and missed real crops, by the classifier that was trained on simulated crops."""
    picture = Image.new("RGB", (200 + count * CELL, 3 * len(labels) * CELL), "white")
    draw = ImageDraw.Draw(picture)
    for k, label in enumerate(labels):
        pairs = [(crop, labels[each] == label) for crop, each in zip(test, found) if crop.label == label]
        for i, (what, crops) in enumerate([("simulated", [crop for crop in simulated if crop.label == label]),
                                           ("real, recognised", [crop for crop, right in pairs if right]),
                                           ("real, missed", [crop for crop, right in pairs if not right])]):
            strip(picture, draw, (3 * k + i) * CELL, f"{label}\n{what}", evenly(crops, count))
    picture.save(file)


def write(folder, result, simulated, test):
    labels, rows, effects = result["labels"], result["rows"], result["effects"]
    confusion_picture(folder / "confusion.png", labels, [rows[0], rows[1]])
    examples_picture(folder / "examples.png", labels, simulated, test, rows[0]["found"])
    ratio = np.mean([run["accuracy"] for run in rows[0]["runs"]]) / max(1e-6, np.mean([run["accuracy"] for run in rows[1]["runs"]]))
    chance = max(result["counts"]["second half"]) / sum(result["counts"]["second half"])
    lines = ["# From simulated to real pictures", "",
             f"{result['classifier']}, {len(rows[0]['runs'])} seeds; mean and deviation over them. "
             + ("Validation: both halves are of the first half of the real pictures." if result["validation"] else
                "Tested on the second half of the real pictures, which were not used for training."), "",
             "| pictures | " + " | ".join(labels) + " |", "| --- |" + " --- |" * len(labels)]
    lines += [f"| {what} | " + " | ".join(map(str, counts)) + " |" for what, counts in result["counts"].items()] + [""]
    lines += table(rows) + ["", f"Simulated only is {ratio:.2f} of real only. The largest class alone would be {chance:.2f}.", ""]
    lines += recall(labels, rows) + ["", "![Confusions](confusion.png)", "", "![Simulated and real](examples.png)", ""]
    if effects:
        lines += ["## Effects", "", "The same windows and places, with and without.", ""] + table(effects) + [""] + paired(effects) + [""]
    lines += ["## Likeness of the halves", "",
              "Distance to the nearest neighbour, 16 x 16 pixels without mean and contrast: 0 the same, 1.41 unrelated.", "",
              "| from | 10 % | median | 90 % |", "| --- | --- | --- | --- |"]
    lines += [f"| {name} | " + " | ".join(f"{each:.2f}" for each in values) + " |" for name, values in result["distances"].items()]
    (folder / "report.md").write_text("\n".join(lines) + "\n")
