"""The sheet of scripts/research/peers: the figures of each simulator next to the closed form, as a table in Markdown.
sheet.py OUT FOLDER... writes OUT/sheet.md of the folders of adapters."""
import json
import sys
from pathlib import Path

import case
import metrics
import numpy as np


def _range(a):
    return [f"{1e3 * metrics.range_error(a['range_m'], a['intensity'], a['truth_m']):.2f}"]


def _beam(a):
    return [f"{np.degrees(metrics.beam_width(a['bearing_rad'], a['intensity'])):.2f}", f"{metrics.first_sidelobe(a['intensity']):.1f}"]


def _floor(a):
    slope, error = metrics.floor_slope(a["range_m"], a["intensity"], a["depth_m"], case.FLOOR_RANGES)
    return [f"{slope:.2f} ± {error:.2f}"]


def _sphere(a):
    return [f"{metrics.target_strength(a['intensity'], a['reference']):.1f}"]


def _speckle(a):
    return [f"{metrics.contrast(a['intensity']):.2f}", f"{metrics.distance_to_exponential(a['intensity']):.3f}"]


def _motion(a):
    found, law = metrics.correlations(a["intensity"]), metrics.aperture_correlation(a["shift_m"], case.APERTURE)
    half = int(np.argmin(np.abs(law - 0.5)))
    return [f"{found[half]:.2f}", f"{np.abs(found - law).max():.2f}"]


def _times(a):
    medians = [1e3 * np.median(a[name]) for name in ("processor", "seconds")]
    return [f"{ms:.0f}" if ms > 100 else f"{ms:.1f}" for ms in medians]


# Experiment, function, and for each of its figures what it is and the closed form.
ROWS = [
    ("points", _range, [("largest error in range of a point target at nine parts of a resolution cell [mm]", "0")]),
    ("beam", _beam, [("half-power width of a uniform array's beam [degrees]", f"{np.degrees(0.886 * case.WAVELENGTH / case.APERTURE):.2f}"),
                     ("its first sidelobe [dB]", "-13.3")]),
    ("floor", _floor, [("n of a flat floor's backscatter, sin(grazing angle)^n; Lambert's law", "2")]),
    ("sphere", _sphere, [(f"target strength of a rigid sphere, a²/4 with a = {case.SPHERE_RADIUS} m [dB]", f"{20 * np.log10(case.SPHERE_RADIUS / 2):.1f}")]),
    ("speckle", _speckle, [("speckle: standard deviation over mean of the intensity", "1"),
                           ("speckle: largest distance from the exponential distribution", "0")]),
    ("motion", _motion, [("correlation of the intensities of two pings, 0.146 of the aperture apart", "0.50"),
                         (f"its largest error at {len(case.MOTION_SHIFTS) - 1} distances up to {case.MOTION_SHIFTS[-1] / case.APERTURE:g} of the aperture", "0")]),
    ("times", _times, [("time of a ping of that floor, processor, all threads, median [ms]", ""), ("the same by the clock [ms]", "")]),
]


class Peer:
    """What an adapter has written to a folder."""

    def __init__(self, folder):
        self.about = json.loads((folder / "about.json").read_text())
        self.notes = self.about["notes"]
        self.cells = {}
        for experiment, function, rows in ROWS:
            with np.load(folder / f"{experiment}.npz") as arrays:
                self.cells[experiment] = function(arrays)
                if experiment == "times":
                    self.cores = int(arrays["cores"])
        assert all(len(self.cells[experiment]) == len(rows) for experiment, _, rows in ROWS)

    @property
    def title(self):
        return f"{self.about['name']} {self.about['version']}"


def table(peers):
    """Returns the lines of the table, with notes below it."""
    notes = []
    lines = ["| figure | closed form | " + " | ".join(peer.title for peer in peers) + " |", "| --- " * (len(peers) + 2) + "|"]
    for experiment, _, rows in ROWS:
        marks = []
        for peer in peers:
            if experiment in peer.notes:
                notes.append(f"{peer.about['name']}: {peer.notes[experiment]}")
            marks.append(f" ({len(notes)})" if experiment in peer.notes else "")
        for i, (figure, theory) in enumerate(rows):
            cells = [peer.cells[experiment][i] + mark for peer, mark in zip(peers, marks)]
            lines.append("| " + " | ".join([figure, theory, *cells]) + " |")
    return lines + [""] + [f"- ({i + 1}) {note}." for i, note in enumerate(notes)]


def write(folders, out):
    """Prints the sheet of adapters' folders, and writes it to sheet.md in the folder `out`."""
    file = Path(out) / "sheet.md"
    peers = [Peer(Path(folder)) for folder in folders]
    text = "\n".join(table(peers)) + "\n"
    print(text, end="")
    file.write_text(text)
    ran = [f"{peer.title}, Python {peer.about['python']}, {peer.cores} cores" for peer in peers]
    print(f"{file}: {'; '.join(ran)}")


if __name__ == "__main__":
    write(sys.argv[2:], sys.argv[1])
