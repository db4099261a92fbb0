"""A mission of hours in lockstep: a side-scan's lines over a survey of a hundred files, by time and memory."""
import sys
import tempfile
from pathlib import Path

import yaml

from benchmarks.common import ROOT
from benchmarks.memory import SETTLED, watch

ALONG = 10             # tiles on each side of the mosaic
SPEED, LINE_GAP = 1.5, 110.0    # [m/s], [m]
SOURCE = """    <SimpleSource>
      <SourceFilename relativeToVRT="1">{name}</SourceFilename><SourceBand>1</SourceBand>
      <SrcRect xOff="0" yOff="0" xSize="{posts}" ySize="{posts}"/>
      <DstRect xOff="{column}" yOff="{row}" xSize="{posts}" ySize="{posts}"/>
    </SimpleSource>
"""


def elevations(file):
    """The elevations of a survey's posts, rows from north to south [m], and their spacing [m]."""
    try:
        import numpy as np
    except ImportError:
        sys.exit("bench: mission needs numpy; PATH=$PWD/build/venv/bin:$PATH scripts/bench finds it after scripts/setup")
    if file.suffix == ".npz":
        held = np.load(file)
        return held[held.files[0]].astype("<f4"), 2.0
    head = dict(line.split() for line in file.with_suffix(".hdr").read_text().splitlines())
    shape = int(head["nrows"]), int(head["ncols"])
    return np.fromfile(file, "<f4").reshape(shape), float(head["cellsize"])


def write_mosaic(floor, spacing, folder):
    """The survey and its mirror images next to each other, each in its own file, so that there
    are no steps at the edges; the mosaic, and its side [m]."""
    posts, sources = min(floor.shape) - 1, ""
    for row in range(ALONG):
        for column in range(ALONG):
            tile = floor[:posts, :posts][:: -1 if row % 2 else 1, :: -1 if column % 2 else 1]
            name = f"tile_{row}_{column}.flt"
            tile.tofile(folder / name)
            (folder / name).with_suffix(".hdr").write_text(
                f"ncols {posts}\nnrows {posts}\ncellsize {spacing}\nnbits 32\npixeltype FLOAT\nbyteorder LSBFIRST\n")
            sources += SOURCE.format(name=name, posts=posts, column=column * posts, row=row * posts)
    mosaic = folder / "survey.vrt"
    side = ALONG * posts
    mosaic.write_text(f'<VRTDataset rasterXSize="{side}" rasterYSize="{side}">\n'
                      f"  <GeoTransform>0, {spacing}, 0, 0, 0, -{spacing}</GeoTransform>\n"
                      f'  <VRTRasterBand dataType="Float32" band="1">\n{sources}  </VRTRasterBand>\n</VRTDataset>\n')
    return mosaic, side * spacing


def lines(seconds, side, depth):
    """Waypoints of lines to and fro; when the survey is done, from the first line again."""
    half, way = side / 2 - 150, []
    time, line, north = 0.0, 0, -1
    while time < seconds:
        y = half - (line * LINE_GAP) % (2 * half)
        for end in (north, -north):
            way.append({"time": round(time, 1), "position": [end * half, y, depth], "yaw_deg": 0 if north < 0 else 180})
            time += (2 * half if end == north else LINE_GAP) / SPEED
        line, north = line + 1, -north
    return way


def measure_mission(options):
    seconds = 3600 * options.mission_hours
    floor, spacing = elevations(Path(options.survey))
    deployment = yaml.safe_load((ROOT / "deploy" / "survey_mission.yml").read_text())
    tasks = deployment["tasks"]
    with tempfile.TemporaryDirectory() as folder:
        mosaic, side = write_mosaic(floor, spacing, Path(folder))
        tasks["vehicle"]["properties"] = {"waypoints": lines(seconds, side, float(floor.max()) + 6)}
        tasks["scene"]["properties"]["bathymetry"]["file"] = str(mosaic)
        run = watch(yaml.safe_dump(deployment), ["--duration", str(seconds)])
    return {"hours": options.mission_hours, "survey_km": side / 1e3, "way_km": SPEED * seconds / 1e3, **run}


def show_mission(run):
    print(f"{run['hours']:g} h, {run['way_km']:.1f} km over {run['survey_km']:.2f} x {run['survey_km']:.2f} km in "
          f"{run['seconds']:.0f} s, {3600 * run['hours'] / run['seconds']:.1f} times as fast as real time; "
          f"{run['settled_mb']:.1f} MB after {SETTLED} s, {run['end_mb']:.1f} MB at the end, {run['max_mb']:.1f} MB at most")
