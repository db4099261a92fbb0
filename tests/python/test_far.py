"""The same scene and trajectory at the world's origin and in UTM coordinates give the same results about the vehicle."""

import csv
import json
import subprocess

import insonify
import numpy as np
import pytest
from conftest import INSONIFY

FAR = np.array([500_000.0, 6_500_000.0, 0.0])
STEPS = [np.array([0.37 * step, 0.11 * step, -0.02 * step]) for step in range(3)]
FLOOR = np.array([[-40, -9, -40], [-40, -12, 40], [40, -11, -40], [40, -8, 40]], "<f4")  # y up


def scene(folder):
    """A sloping floor of two triangles and a box of a node of its own; returns the path."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], "<f4")
    faces = [0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7, 1, 7, 3]
    arrays = [FLOOR, np.array([0, 1, 2, 2, 1, 3], "<u4"), corners, np.array(faces, "<u4")]
    views, accessors, offset = [], [], 0
    for i, array in enumerate(arrays):
        views.append({"buffer": 0, "byteOffset": offset, "byteLength": array.nbytes})
        kind = {"componentType": 5126, "type": "VEC3"} if array.ndim == 2 else {"componentType": 5125, "type": "SCALAR"}
        accessors.append({"bufferView": i, "count": len(array), **kind})
        if array.ndim == 2:
            accessors[-1].update(min=array.min(0).tolist(), max=array.max(0).tolist())
        offset += array.nbytes
    (folder / "s.bin").write_bytes(b"".join(array.tobytes() for array in arrays))
    mesh = lambda at: {"primitives": [{"attributes": {"POSITION": at}, "indices": at + 1}]}
    made = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "name": "floor"}, {"mesh": 1, "name": "box", "translation": [3, -8, -2]}],
        "meshes": [mesh(0), mesh(2)],
        "buffers": [{"uri": "s.bin", "byteLength": offset}],
        "bufferViews": views,
        "accessors": accessors,
    }
    (folder / "s.gltf").write_text(json.dumps(made))


def deployment(folder, origin):
    """A profiler that looks down from a vehicle on its way over the scene at `origin`; returns the path."""
    scene(folder)
    waypoints = [{"time": 0.1 * i, "position": (origin + step).tolist()} for i, step in enumerate(STEPS)]
    quality = {"rows": 32, "columns_per_beam": 2}
    tasks = {
        "vehicle": {"type": "pose::TrajectoryTask", "activity": {"period": 0.1}, "properties": {"waypoints": waypoints}},
        "scene": {
            "type": "scene::SceneTask",
            "properties": {
                "file": "s.gltf",
                "mount": {"pitch_deg": 90},
                "placement": {"position": origin.tolist()},
                "targets": [{"name": "ball", "position": (origin + [1, 2, -6]).tolist(), "strength_db": -10}],
            },
        },
        "sonar": {
            "type": "sonar::ProfilerTask",
            "properties": {
                "beam_count": 32, "field_of_view_deg": 90, "range": 30, "bin_count": 600, "beam_width_deg": 3,
                "beam_height_deg": 3, "quality": quality, "visibility": "cpu",
            },
        },
        "mcap": {"type": "logger::LoggerTask", "properties": {"file": "m.0.mcap"}},
        "rock": {"type": "logger::LoggerTask", "properties": {"file": "r.0.log"}},
    }  # fmt: skip
    pairs = [("vehicle.pose", "scene.pose"), ("scene.snapshot", "sonar.snapshot")]
    for log in ("mcap", "rock"):
        pairs += [("sonar.soundings", f"{log}.soundings"), ("vehicle.pose", f"{log}.pose"), ("sonar.ping", f"{log}.ping")]
    connections = [{"from": a, "to": b, "policy": {"type": "buffer", "size": 64}} for a, b in pairs]
    path = folder / "d.yml"
    path.write_text(json.dumps({"schedule": "lockstep", "tasks": tasks, "connections": connections}))
    return path


def exported(folder, log, stream):
    """Columns of a stream as CSV, by name."""
    to = folder / f"{log}.{stream}.csv"
    subprocess.run([INSONIFY, "log", "export", folder / "out" / log, "--stream", stream, "--to", to], check=True, timeout=100)
    with open(to) as lines:
        rows = list(csv.DictReader(lines))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Folders of the run at the origin, and of the one far from it."""
    folders = []
    for origin in (np.zeros(3), FAR):
        folder = tmp_path_factory.mktemp("run")
        command = [INSONIFY, "run", deployment(folder, origin), "--pings", "3", "--quiet", "--out", folder / "out"]
        subprocess.run(command, check=True, timeout=300)
        folders.append(folder)
    return folders


def streams(folder, log):
    return {name.rsplit(".", 1)[-1]: name for name in insonify.read_log(folder / "out" / log)}


@pytest.mark.parametrize("log", ["m.0.mcap", "r.0.log"])
def test_soundings_and_poses_are_the_same_about_the_vehicle(runs, log):
    near, far = runs
    for stream, columns in (("soundings", "xyz"), ("pose", "xyz")):
        here = exported(near, log, streams(near, log)[stream])
        there = exported(far, log, streams(far, log)[stream])
        shift = dict(zip("xyz", FAR))
        for axis in columns:
            assert len(here[axis]) == len(there[axis]) > 0
            np.testing.assert_allclose(there[axis] - shift[axis], here[axis], rtol=0, atol=1e-3)


def test_pings_are_the_same(runs):
    near, far = (insonify.read_log(folder / "out/r.0.log") for folder in runs)
    name = streams(runs[0], "r.0.log")["ping"]
    for here, there in zip(near[name], far[name]):
        scale = np.linalg.norm(here.bins)
        assert scale > 0 and np.linalg.norm(here.bins - there.bins) < 1e-3 * scale


def test_scenes_are_reported_to_the_millimetre(runs):
    made = json.loads((runs[1] / "s.gltf").read_text())
    made["scenes"], east_up_south = [{"nodes": [1]}], [FAR[0] + 0.123, FAR[2] + 0.123, -FAR[1] - 0.123]
    made["nodes"][1]["translation"] = east_up_south
    path = runs[1] / "moved.gltf"
    path.write_text(json.dumps(made))
    shown = subprocess.run([INSONIFY, "scene", path], check=True, capture_output=True, text=True, timeout=100).stdout
    assert "from [499999.123, 6499999.123, -0.877] to [500001.123, 6500001.123, 1.123]" in shown


def pipe(facet=0.002, radius=0.15):
    """Vertices and triangles of an upright pipe of facets of that width [m]."""
    count = int(2 * np.pi * radius / facet)
    angle = 2 * np.pi * np.arange(count) / count
    vertices = np.concatenate([np.c_[radius * np.cos(angle), radius * np.sin(angle), np.full(count, z)] for z in (-0.25, 0.25)])
    a = np.arange(count)
    b = (a + 1) % count
    return vertices, np.concatenate([np.c_[a, b, b + count], np.c_[a, b + count, a + count]])


def write_gltf(folder, place, baked):
    """A pipe by the pose of its node, or, baked, by its vertices."""
    vertices, triangles = pipe()
    y_up = lambda v: np.stack([v[..., 0], v[..., 2], -v[..., 1]], -1)
    points, at = y_up(vertices + (place if baked else 0)).astype("<f4"), y_up(np.asarray(place))
    (folder / "p.bin").write_bytes(points.tobytes() + triangles.astype("<u4").tobytes())
    views = [
        {"buffer": 0, "byteOffset": 0, "byteLength": points.nbytes},
        {"buffer": 0, "byteOffset": points.nbytes, "byteLength": 4 * triangles.size},
    ]
    accessors = [
        {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": len(points), "min": points.min(0).tolist(), "max": points.max(0).tolist()},
        {"bufferView": 1, "componentType": 5125, "type": "SCALAR", "count": triangles.size},
    ]  # fmt: skip
    node = {"mesh": 0, "name": "pipe"} | ({} if baked else {"translation": at.tolist()})
    made = {
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [node], "materials": [{"name": "steel"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "buffers": [{"uri": "p.bin", "byteLength": points.nbytes + 4 * triangles.size}], "bufferViews": views, "accessors": accessors,
    }  # fmt: skip
    (folder / "s.gltf").write_text(json.dumps(made))
    return "s.gltf"


def write_obj(folder, place, baked):
    vertices, triangles = pipe()
    lines = ["v {:.9f} {:.9f} {:.9f}".format(*v) for v in vertices + (place if baked else 0)]
    (folder / "p.obj").write_text("\n".join(lines + ["f {} {} {}".format(*(t + 1)) for t in triangles]))
    return "{:.9f} {:.9f} {:.9f}".format(*(np.zeros(3) if baked else place))


def write_sdf(folder, place, baked):
    at = write_obj(folder, place, baked)
    visual = "<geometry><mesh><uri>p.obj</uri></mesh></geometry><material><script><name>steel</name></script></material>"
    link = f"<link name='l'><visual name='pipe'>{visual}</visual></link>"
    model = f"<model name='m'><static>true</static><pose>{at} 0 0 0</pose>{link}</model>"
    (folder / "s.sdf").write_text(f"<sdf version='1.9'><world name='w'>{model}</world></sdf>")
    return "s.sdf"


def write_urdf(folder, place, baked):
    at = write_obj(folder, place, baked)
    visual = "<visual><geometry><mesh filename='p.obj'/></geometry><material name='steel'/></visual>"
    joint = f"<joint name='j' type='fixed'><parent link='base'/><child link='l'/><origin xyz='{at}'/></joint>"
    (folder / "s.urdf").write_text(f"<robot name='r'><link name='base'/><link name='l'>{visual}</link>{joint}</robot>")
    return "s.urdf"


def pipe_simulation(folder, write, place, baked=False):
    """A sonar 5 m from a pipe at `place`; returns the simulation and the sonar's pose."""
    at = np.asarray(place) + [-5, 0.03, 0.02]
    waypoints = [{"position": at.tolist()}]
    tasks = {
        "vehicle": {"type": "pose::TrajectoryTask", "activity": {"period": 0.1}, "properties": {"waypoints": waypoints}},
        "scene": {"type": "scene::SceneTask", "properties": {"file": write(folder, np.asarray(place), baked)}},
        "sonar": {
            "type": "sonar::SonarTask",
            "properties": {
                "beam_count": 8, "field_of_view_deg": 20, "beam_height_deg": 8, "range": 8, "bin_count": 200, "speed_of_sound": 1500,
                "frequency_khz": 400, "visibility": "cpu", "quality": {"rows": 48, "columns_per_beam": 64},
            },
        },
    }  # fmt: skip
    connections = [{"from": "vehicle.pose", "to": "scene.pose"}, {"from": "scene.snapshot", "to": "sonar.snapshot"}]
    (folder / "d.yml").write_text(json.dumps({"tasks": tasks, "connections": connections}))
    return folder / "d.yml", insonify.Pose(at)


@pytest.mark.parametrize("write", [write_gltf, write_sdf, write_urdf])
def test_a_pipe_of_small_facets_echoes_the_same_wherever_its_pose_is(tmp_path, write):
    levels = []
    for i, place in enumerate([(0, 0, 0), (230, -240, 11), (1000, 300, -40), (100_000, 20_000, -300)]):
        (tmp_path / str(i)).mkdir()
        try:
            file, pose = pipe_simulation(tmp_path / str(i), write, place)
            levels.append(10 * np.log10(insonify.Simulation(file).step(pose).bins.sum(dtype=float)))
        except insonify.ConfigError as error:
            if "libsdformat" not in str(error) and "sdf.so" not in str(error):
                raise
            pytest.skip(str(error))
    assert np.ptp(levels) < 0.05 and np.isfinite(levels).all(), levels


@pytest.mark.parametrize(
    "write, place, steps", [(write_gltf, 1000, "0.061 mm"), (write_gltf, 100_000, "7.8 mm"), (write_sdf, 1000, "0.061 mm")]
)
def test_vertices_far_from_their_origin_are_named(tmp_path, write, place, steps):
    file, _ = pipe_simulation(tmp_path, write, (place, 0, 0), baked=True)
    scene = next(tmp_path.glob("s.*"))
    shown = subprocess.run([INSONIFY, "scene", scene], capture_output=True, text=True, timeout=100)
    run = subprocess.run([INSONIFY, "run", file, "--pings", "1", "--out", tmp_path / "out"], capture_output=True, text=True, timeout=100)
    assert f"in steps of {steps}" in shown.stdout + shown.stderr and "pipe" in shown.stdout, shown.stdout + shown.stderr
    assert f"in steps of {steps}" in run.stdout + run.stderr, run.stdout + run.stderr
