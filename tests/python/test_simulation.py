"""Stepping a deployment from Python, compared with the command at the same poses."""

import collections.abc
import copy
import pickle
import subprocess
import sys
import threading
import time
import warnings

import insonify
import numpy as np
import pytest
from conftest import INSONIFY

HERE = insonify.Pose([0, 0, 0])


@pytest.fixture
def minimal(deploy):
    return insonify.Simulation(deploy / "minimal.yml", seed=1)


def test_a_step_gives_a_ping_with_its_grid(minimal):
    ping = minimal.step(HERE)
    assert ping.bins.shape == (256, 500) and ping.bins.dtype == np.float32
    assert ping.bearings.shape == (256,) and ping.bearings[0] == pytest.approx(-ping.bearings[-1]) and ping.bearings[0] < 0
    np.testing.assert_allclose(np.diff(ping.ranges), ping.bin_length)
    assert ping.ranges[0] == pytest.approx(ping.bin_length / 2)
    assert ping.bins.max() > 0 and ping.truth is None


def test_bins_share_the_pings_memory_and_outlive_the_ping(minimal):
    ping = minimal.step(HERE)
    bins, again = ping.bins, ping.bins
    assert np.shares_memory(bins, again) and not bins.flags.owndata
    with pytest.raises(ValueError):
        bins[0, 0] = 1
    kept = bins.copy()
    del ping, again
    for step in range(20):
        minimal.step(insonify.Pose([0.1 * step, 0, 0]))
    np.testing.assert_array_equal(bins, kept)


def test_the_command_makes_the_same_pings_of_the_same_poses(deploy, tmp_path):
    command = [INSONIFY, "run", deploy / "harbour_fls.yml", "--pings", "3", "--seed", "5", "--quiet"]
    subprocess.run([*command, "--out", tmp_path], check=True, timeout=600)
    log = insonify.read_log(next(tmp_path.glob("harbour*.log")))
    with pytest.raises(KeyError, match="sonar.pnig: is no stream of the log; there are receiver.ping, vehicle.pose"):
        log["sonar.pnig"]
    with pytest.raises(insonify.ConfigError, match="line.xtf: is a recording of a side-scan; `insonify log import`"):
        insonify.read_log("line.xtf")
    simulation = insonify.Simulation(deploy / "harbour_fls.yml", seed=5)
    pings = [stream for name, stream in log.items() if name == simulation.pings[0]][0]
    assert len(pings) == 3
    for ping, pose in zip(pings, log["vehicle.pose"]):
        stepped = simulation.step(pose, time=pose.time)
        assert stepped.time == ping.time
        np.testing.assert_array_equal(stepped.bins, ping.bins)


def test_a_reset_equals_a_new_simulation(deploy):
    file = deploy / "harbour_fls.yml"
    poses = [insonify.Pose([0.3 * step, 0, -5.5]) for step in range(3)]
    simulation = insonify.Simulation(file, seed=3)
    first = [simulation.step(pose).bins.copy() for pose in poses]
    simulation.reset()
    for bins, pose in zip(first, poses):
        np.testing.assert_array_equal(simulation.step(pose).bins, bins)
    simulation.reset(4)
    other = insonify.Simulation(file, seed=4)
    for bins, pose in zip(first, poses):
        again = simulation.step(pose).bins
        np.testing.assert_array_equal(again, other.step(pose).bins)
        assert not np.array_equal(again, bins)


@pytest.mark.parametrize("pose", [[1, 2, 3], None, np.eye(3), np.ones((4, 4)), "here"])
def test_what_is_not_a_pose_is_refused(minimal, pose):
    with pytest.raises(ValueError, match="transform|convert"):
        minimal.step(pose)


def test_a_pose_states_what_is_wrong_with_its_numbers():
    with pytest.raises(ValueError, match="position: must be x, y, z; has 2 numbers"):
        insonify.Pose.from_euler([2, 0])
    with pytest.raises(ValueError, match="orientation_wxyz: must be w, x, y, z; has 3 numbers"):
        insonify.Pose([0, 0, 0], [1, 0, 0])


def test_a_ping_prints_its_size_and_range(minimal):
    assert repr(minimal.step(HERE)).startswith("Ping(256 beams x 500 bins, ")


def test_a_transform_is_a_pose():
    pose = insonify.Pose.from_euler([1, 2, 3], roll=0.3, pitch=-0.7, yaw=2.5)
    again = insonify.Pose.from_matrix(pose.matrix())
    assert abs(np.dot(pose.orientation_wxyz, again.orientation_wxyz)) == pytest.approx(1)
    np.testing.assert_allclose(again.position, [1, 2, 3])
    down = insonify.Pose.from_euler([0, 0, 0], pitch=np.pi / 2).matrix() @ [1, 0, 0, 1]
    np.testing.assert_allclose(down, [0, 0, -1, 1], atol=1e-12)
    for wrong in (np.eye(3), np.diag([1, 1, -1, 1]), np.diag([2, 2, 2, 1])):
        with pytest.raises(ValueError):
            insonify.Pose.from_matrix(wrong)


def test_a_transform_and_a_pose_step_alike(minimal):
    matrix = np.eye(4)
    matrix[:3, 3] = [0.5, 2, 0.25]
    bins = minimal.step(insonify.Pose([0.5, 2, 0.25])).bins.copy()
    for same in (matrix, np.asfortranarray(matrix), matrix.astype(np.float32)):
        minimal.reset()
        np.testing.assert_array_equal(minimal.step(same).bins, bins)
    assert not np.array_equal(minimal.step(np.eye(4)).bins, bins)
    strided = np.zeros((3, 2))
    strided[:, 0] = [0.5, 2, 0.25]
    minimal.reset()
    np.testing.assert_array_equal(minimal.step(insonify.Pose(strided[:, 0])).bins, bins)


def test_seven_numbers_are_a_pose_as_for_a_batch(minimal, deploy):
    pose = insonify.Pose.from_euler([0.5, 2, 0.25], yaw=0.2)
    numbers = [*pose.position, *pose.orientation_wxyz]
    bins = minimal.step(pose).bins.copy()
    for same in (numbers, tuple(numbers), np.array(numbers), {minimal.poses[0]: numbers}):
        minimal.reset()
        np.testing.assert_array_equal(minimal.step(same).bins, bins)
    batch = insonify.SimulationBatch(deploy / "minimal.yml", 4, seed=1)
    for made in batch.step([pose, numbers, np.array(numbers), pose.matrix()]).bins[:1]:
        np.testing.assert_array_equal(made, bins)
    for wrong in (numbers[:6], [numbers], "here"):
        with pytest.raises(ValueError):
            minimal.step(wrong)
    with pytest.raises(ValueError, match="seven numbers x, y, z and a quaternion w, x, y, z"):
        minimal.step(numbers[:6])


def test_warnings_follow_changes_and_pings(deploy):
    def warned(call):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            call()
        return [(str(each.message), each.filename) for each in caught]

    for made in (insonify.Simulation(deploy / "minimal.yml"), insonify.SimulationBatch(deploy / "minimal.yml", 2)):
        poses = HERE if isinstance(made, insonify.Simulation) else [HERE] * 2
        assert warned(lambda: made.step(poses)) == []
        texts = warned(lambda: (made.set({"sonar.range": 31}), made.step(poses)))
        assert len(texts) == 1 and "more than 31 m" in texts[0][0] and texts[0][1] == __file__, texts
        assert warned(lambda: made.step(poses)) == []
        assert warned(lambda: (made.set({"sonar.range": 50}), made.step(poses))) == []
        assert len(warned(lambda: (made.set({"sonar.range": 31}), made.step(poses)))) == 1

    overrides = {"scene.water_surface": -1}  # and the sonar is above it
    for made in (
        insonify.Simulation(deploy / "minimal.yml", overrides=overrides),
        insonify.SimulationBatch(deploy / "minimal.yml", 2, overrides=overrides),
    ):
        poses = HERE if isinstance(made, insonify.Simulation) else [HERE] * 2
        texts = warned(lambda: made.step(poses))
        assert [text for text, _ in texts if "the sonar is 1 m above the water surface" in text], texts
        assert not [text for text, _ in warned(lambda: made.step(poses)) if "above the water" in text]


def test_the_version_is_that_of_the_command():
    printed = subprocess.run([INSONIFY, "--version"], check=True, capture_output=True, text=True).stdout
    assert insonify.__version__ == printed.split("\n")[0]


def test_the_truth_names_objects_and_has_the_shape_of_the_bins(deploy):
    simulation = insonify.Simulation(deploy / "harbour_fls.yml", truth=True)
    ping = simulation.step(insonify.Pose([2, 0, -5.5]))
    truth = ping.truth
    for name in ("elevation", "object", "share", "hits", "grazing", "path", "shadow"):
        assert getattr(truth, name).shape == ping.bins.shape
    assert "sea_floor" in truth.objects
    shown = truth.object[truth.object >= 0]
    assert shown.size > 1000 and shown.max() < len(truth.objects)
    assert repr(truth).startswith("Truth(") and "grazing" in repr(truth)


def test_a_fan_is_a_picture(deploy):
    ping = insonify.Simulation(deploy / "harbour_fls.yml").step(insonify.Pose([2, 0, -5.5]))
    picture = ping.fan(width=400)
    assert picture.dtype == np.uint8 and picture.shape[1:] == (400, 3)
    assert picture.std() > 10, "neither black nor uniform"
    with pytest.raises(insonify.ConfigError, match="amber, copper"):
        ping.fan(colour_map="rainbow")


def test_overrides_reach_the_tasks(deploy):
    simulation = insonify.Simulation(
        deploy / "minimal.yml", overrides={"sonar.range": 30, "sonar.quality": {"rows": 64, "columns_per_beam": 1}}
    )
    ping = simulation.step(HERE)
    assert ping.ranges[-1] == pytest.approx(30, rel=0.02)


def test_warnings_of_the_tasks_are_python_warnings(deploy):
    with pytest.warns(UserWarning, match="^sonar: range reached is .* more than 31 m"):
        insonify.Simulation(deploy / "minimal.yml", overrides={"sonar.range": 31, "sonar.bin_count": 1000}).step(HERE)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        insonify.Simulation(deploy / "minimal.yml").step(HERE)


def test_errors_have_file_line_and_column(tmp_path, deploy):
    file = tmp_path / "wrong.yml"
    text = (deploy / "minimal.yml").read_text().replace("scenes/wall.glb", str(deploy / "scenes/wall.glb"))
    file.write_text(text.replace("sonar::SonarTask}", "sonar::SonarTask, properties: {rnge: 20}}"))
    with pytest.raises(insonify.ConfigError, match="did you mean range") as caught:
        insonify.Simulation(file)
    line = 1 + next(i for i, text in enumerate(file.read_text().splitlines()) if "rnge" in text)
    assert caught.value.file == str(file) and caught.value.line == line and caught.value.column > 0
    assert caught.value.diagnostics[0]["path"].endswith(".rnge")
    with pytest.raises(insonify.ConfigError, match="nowhere.yml"):
        insonify.Simulation(tmp_path / "nowhere.yml")


def test_errors_of_overrides_name_them(deploy):
    with pytest.raises(insonify.ConfigError, match="overrides: .*did you mean sonar"):
        insonify.Simulation(deploy / "minimal.yml", overrides={"sonr.range": 3})
    with pytest.raises(insonify.ConfigError, match="overrides: tasks.sonar.properties.range: "):
        insonify.Simulation(deploy / "minimal.yml", overrides={"sonar.range": -3})


def test_after_an_invalid_pose_the_next_pose_works(minimal):
    with pytest.raises(RuntimeError, match="finite"):
        minimal.step(insonify.Pose([np.nan, 0, 0]))
    assert minimal.step(HERE).bins.max() > 0
    with pytest.raises(RuntimeError, match="the one before"):
        minimal.step(HERE, time=0.5)
    with pytest.raises(ValueError):
        insonify.Pose([1, 2])


def test_several_simulations_are_independent(deploy):
    """Each runs on its own thread, interleaved with the poses of the others."""
    poses = [insonify.Pose([0.2 * step, 0, 0]) for step in range(10)]
    alone = insonify.Simulation(deploy / "minimal.yml", seed=2)
    wanted = [alone.step(pose).bins.copy() for pose in poses]
    differ = []

    def run():
        simulation = insonify.Simulation(deploy / "minimal.yml", seed=2)
        differ.append(sum(not np.array_equal(simulation.step(pose).bins, bins) for pose, bins in zip(poses, wanted)))

    threads = [threading.Thread(target=run) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert differ == [0, 0, 0]


def test_others_run_while_a_step_renders(deploy):
    """Another Python thread runs during a step: the lock of the interpreter is free for most of it."""
    simulation = insonify.Simulation(
        deploy / "minimal.yml", overrides={"sonar.quality": {"rows": 2048, "columns_per_beam": 16}}
    )
    simulation.step(HERE)
    seen, ended = [], threading.Event()

    def watch():
        while not ended.is_set():
            seen.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=watch)
    thread.start()
    gaps = []
    for step in range(1, 6):  # only one, because the machine may be busy
        begin = time.perf_counter()
        simulation.step(insonify.Pose([step, 0, 0]))
        end = time.perf_counter()
        during = [begin, *(at for at in seen if begin < at < end), end]
        gaps.append(max(np.diff(during)) / (end - begin))
    ended.set()
    thread.join()
    assert min(gaps) < 0.8, "it stood still all the while"


def test_two_threads_in_one_simulation_are_an_error(deploy):
    simulation = insonify.Simulation(
        deploy / "minimal.yml", overrides={"sonar.quality": {"rows": 2048, "columns_per_beam": 16}}
    )
    errors = []

    def run(ahead):
        for step in range(3):
            try:
                simulation.step(insonify.Pose([0.1 * step, 0, 0]))
            except RuntimeError as error:
                errors.append(str(error))

    threads = [threading.Thread(target=run, args=(index,)) for index in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert errors and set(errors) == {"another thread uses this simulation"}
    assert simulation.step(HERE).bins.max() > 0


def test_two_vehicles_take_a_dictionary(deploy):
    try:
        simulation = insonify.Simulation(deploy / "two_vehicles.yml")
    except insonify.ConfigError as error:
        if "needs the component library sdf" in str(error):
            pytest.skip("there is no libsdformat")
        raise
    assert len(simulation.poses) == 2
    with pytest.raises(ValueError, match="dictionary"):
        simulation.step(HERE)
    with pytest.raises(RuntimeError, match="no pose is given"):
        simulation.step({simulation.poses[0]: HERE})
    pings = simulation.step({port: HERE for port in simulation.poses})
    assert len(pings) == len(simulation.pings) == 2


def test_objects_of_the_library_are_not_copied_to_other_processes(minimal):
    ping = minimal.step(HERE)
    for wrong in (ping, minimal):
        for refused in (pickle.dumps, copy.deepcopy):
            with pytest.raises(TypeError, match="cannot be copied or sent to another process"):
                refused(wrong)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(ping.bins)), ping.bins)
    np.testing.assert_array_equal(copy.copy(ping).bins, ping.bins)
    with pytest.raises(TypeError, match="cannot be copied"):
        copy.copy(minimal)


def test_arguments_that_are_not_numbers_are_named(minimal):
    with pytest.raises(TypeError, match="time: is 'x'; must be a number"):
        minimal.step(HERE, time="x")
    for wrong in ("abc", [1, "a"]):
        with pytest.raises(ValueError, match="pose: is .*; must be a Pose, seven numbers or a 4 x 4 transform"):
            minimal.step(wrong)
    with pytest.raises(insonify.ConfigError, match="values: tasks.sonar.properties.range: is -1"):
        minimal.set({"sonar.range": -1})


def test_impossible_times_are_errors(deploy, minimal):
    with pytest.raises(ValueError, match="finite"):
        minimal.step(HERE, time=float("nan"))
    with pytest.raises(ValueError, match="deployment's own"):
        minimal.reset(0)
    with pytest.raises(ValueError, match="the time of a step is 1e\\+18 s; may be -9e"):
        minimal.step(HERE, time=1e18)
    assert minimal.step(HERE, time=1.7e9).time == 1.7e9, "of a log"
    with pytest.raises(RuntimeError, match="the step is at 5 s; it must be after the one before, at 1.7e"):
        minimal.step(HERE, time=5)


def test_numbers_of_numpy_and_paths_are_overrides(deploy):
    simulation = insonify.Simulation(
        deploy / "minimal.yml",
        overrides={"sonar.range": np.float32(30), "sonar.beam_count": np.int64(16), "scene.file": deploy / "scenes/wall.glb"},
    )
    assert simulation.step(HERE).bins.shape[0] == 16


@pytest.mark.parametrize("seed", [1.5, "a", [1]])
def test_a_seed_that_is_no_whole_number_is_named(deploy, seed):
    sim = insonify.Simulation(deploy / "minimal.yml", seed=1)
    for make in (lambda: insonify.Simulation(deploy / "minimal.yml", seed=seed), lambda: sim.reset(seed=seed)):
        with pytest.raises(TypeError, match="^seed: is .*; must be a whole number$"):
            make()


def test_numbers_of_numpy_are_arguments(deploy):
    simulation = insonify.Simulation(deploy / "minimal.yml", np.uint64(3), period=np.float32(0.5))
    assert simulation.period == 0.5
    ping = simulation.step(HERE, time=np.float32(2))
    assert ping.time == 2
    assert ping.fan(width=np.int64(300), dynamic_range_db=np.float32(30), reference_db=np.int32(3)).shape[1] == 300
    simulation.reset(np.int64(3))
    np.testing.assert_array_equal(simulation.step(HERE).bins, ping.bins)
    for wrong in (-1, 2**64):
        with pytest.raises(ValueError, match=f"seed: is {wrong}"):
            simulation.reset(wrong)
    with pytest.raises(ValueError, match="reference_db: is nan"):
        ping.fan(reference_db=float("nan"))
    for wrong in (0, 100_000):
        with pytest.raises(insonify.ConfigError, match=f"width: is {wrong}; may be 256 to 8192"):
            ping.fan(width=wrong)
    with pytest.raises(ValueError, match="period: is nan"):
        insonify.Simulation(deploy / "minimal.yml", period=float("nan"))
    for wrong in (0, -1):
        with pytest.raises(insonify.ConfigError, match=f"period: is {wrong}; must be above 0 s"):
            insonify.Simulation(deploy / "minimal.yml", period=wrong)
    for wrong in (["sonar.range=3"], "sonar.range=3"):
        with pytest.raises(TypeError, match="overrides: is a .*; must be a mapping from task.property to values"):
            insonify.Simulation(deploy / "minimal.yml", overrides=wrong)


def test_threads_read_one_log(deploy, tmp_path):
    """The lock of the interpreter is free while a sample is read."""
    command = [INSONIFY, "run", deploy / "harbour_fls.yml", "--pings", "4", "--quiet", "--out", tmp_path]
    subprocess.run(command, check=True, timeout=600)
    log = insonify.read_log(next(tmp_path.glob("harbour*.log")))
    pings, poses = log["receiver.ping"], log["vehicle.pose"]
    assert "receiver.ping (4)" in repr(log)
    wanted = [ping.bins for ping in pings]
    differ = []

    def read(first):
        for index in range(first, first + 40):
            at = np.int64(index % 4)
            differ.append(not np.array_equal(pings[at].bins, wanted[at]) or poses[at].time != poses.times[at])

    threads = [threading.Thread(target=read, args=(first,)) for first in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(differ) == 160 and not any(differ)
    for none in (4, -5):
        with pytest.raises(IndexError, match=f"{none}: receiver.ping has 4 samples"):
            pings[none]
    assert isinstance(pings, collections.abc.Sequence)
    assert [each.time for each in pings[1:3]] == [pings[1].time, pings[2].time] and pings[9:] == []


def test_a_log_in_several_files_is_one(deploy, tmp_path):
    command = [INSONIFY, "run", deploy / "harbour_fls.yml", "--pings", "8", "--quiet", "--out"]
    subprocess.run([*command, tmp_path / "one"], check=True, timeout=600)
    subprocess.run([*command, tmp_path / "many", "--set", "log.max_file_size=1e6"], check=True, timeout=600)
    one, many = (insonify.read_log(tmp_path / run / "harbour.0.log") for run in ("one", "many"))
    assert one.files == [str(tmp_path / "one" / "harbour.0.log")] and one.notice == ""
    names = [f"harbour.{i}.log" for i in range(len(many.files))]
    assert many.files == [str(tmp_path / "many" / name) for name in names] and len(names) >= 3
    assert f"is continued in {len(names) - 1} files up to {names[-1]}" in many.notice
    assert len(many["receiver.ping"]) == 8
    for name in one:
        np.testing.assert_array_equal(many[name].times, one[name].times)
    for index in range(-8, 8):
        np.testing.assert_array_equal(many["receiver.ping"][index].bins, one["receiver.ping"][index].bins)
    alone = insonify.Log(tmp_path / "many" / names[1])
    assert alone.files == [str(alone.path)] and 0 < len(alone["receiver.ping"]) < 8
    subprocess.run([*command, tmp_path / "other", "--seed", "9"], check=True, timeout=600)
    (tmp_path / "other" / "harbour.0.log").rename(tmp_path / "many" / "harbour.1.log")
    mixed = insonify.Log(tmp_path / "many" / names[0])
    assert mixed.files == many.files[:1] and "harbour.1.log is of another run" in mixed.notice


def test_a_file_that_is_not_a_log_is_an_error(tmp_path):
    (tmp_path / "x.log").write_bytes(b"not a log")
    with pytest.raises(insonify.ConfigError):
        insonify.read_log(tmp_path / "x.log")


def test_the_time_can_be_read_while_another_thread_steps(minimal):
    """Notices cannot: they are those of tasks at work."""
    times, refused, ended = set(), [], threading.Event()

    def watch():
        while not ended.is_set():
            times.add(minimal.time)
            try:
                minimal._simulation.facts()
            except RuntimeError as error:
                refused.append(str(error))
            time.sleep(1e-3)  # or it leaves no room for a step on a busy machine

    thread = threading.Thread(target=watch)
    thread.start()
    before = minimal.time
    made = 0
    deadline = time.monotonic() + 60
    while made < 100 and time.monotonic() < deadline:
        try:
            minimal.step(HERE)
            made += 1
        except RuntimeError as error:
            assert "another thread uses this simulation" in str(error)
    ended.set()
    thread.join()
    assert minimal.time == pytest.approx(before + made * minimal.period) and len(times) > 1
    assert all("another thread uses this simulation" in text for text in refused)


def test_the_interpreter_ends_while_a_daemon_thread_steps(deploy):
    program = f"""
import threading, time, insonify
simulation = insonify.Simulation({str(deploy / "minimal.yml")!r})
started = threading.Event()
def run():
    while True:
        simulation.step(insonify.Pose([0, 0, 0]))
        started.set()
threading.Thread(target=run, daemon=True).start()
started.wait()
time.sleep(0.01)
"""
    for _ in range(5):
        ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=100, check=False)
        assert ended.returncode == 0 and ended.stderr == ""


def test_settings_between_steps_give_the_pings_of_overrides(deploy):
    fixed = {"sonar.quality": {"rows": 64, "columns_per_beam": 2}, "sonar.visibility": "cpu"}
    changed = insonify.Simulation(deploy / "minimal.yml", overrides=fixed)
    first = changed.step(HERE)
    draw = np.random.default_rng(5)
    for _ in range(6):
        values = {"sonar.range": float(draw.uniform(5, 30)), "sonar.bin_count": int(draw.integers(50, 300)),
                  "sonar.beam_count": int(draw.integers(1, 64)), "sonar.speed_of_sound": float(draw.uniform(1400, 1560)),
                  "sonar.absorption": {"db_per_m": float(draw.uniform(0, 0.3))},
                  "sonar.quality.rows": int(draw.integers(16, 128))}
        changed.set(values)
        ping = changed.step(HERE)
        made = insonify.Simulation(deploy / "minimal.yml", overrides=fixed | values).step(HERE)
        assert np.array_equal(ping.bins, made.bins) and np.array_equal(ping.ranges, made.ranges)
    changed.reset()
    assert np.array_equal(changed.step(HERE).bins, made.bins), "they stay after a reset"
    del values["sonar.quality.rows"]
    changed.set(dict.fromkeys(values) | {"sonar.quality": {"rows": 9}, "sonar.quality.rows": 64})  # the inner name prevails
    assert np.array_equal(changed.step(HERE).bins, first.bins), "None: the default again"


def test_settings_of_noise_and_receiver_too(deploy):
    fixed = {"sonar.quality": {"rows": 64, "columns_per_beam": 2}, "sonar.beam_count": 64, "sonar.bin_count": 200}
    values = {"sonar.range": 17, "noise.speckle": {"law": "rayleigh"}, "noise.seed": 99, "receiver.gain_db": 6}
    changed = insonify.Simulation(deploy / "harbour_fls.yml", overrides=fixed)
    made = insonify.Simulation(deploy / "harbour_fls.yml", overrides=fixed | values)
    changed.step(HERE), made.step(HERE)
    changed.set(values)
    for _ in range(3):
        ping, other = changed.step(HERE), made.step(HERE)
        assert np.array_equal(ping.bins, other.bins) and ping.bins.max() > 0
    for simulation in (changed, made):
        simulation.reset(seed=7)
    assert np.array_equal(changed.step(HERE).bins, made.step(HERE).bins), "a seed that is given stays"


def test_wrong_settings_change_nothing_and_are_reported_as_overrides(deploy):
    sim = insonify.Simulation(deploy / "minimal.yml", overrides={"sonar.quality": {"rows": 64, "columns_per_beam": 2}})
    before = sim.step(HERE).bins
    for values in ({"sonar.range": -3}, {"sonar.rang": 3}, {"sona.range": 3}, {"sonar": 3}, {"sonar.activity.period": 1},
                   {"sonar.range": 9, "sonar.beam_count": 0}, {"sonar.range": 9, "sonar.quality": {"rws": 3}},
                   {"sonar.range": "far"}, {"sonar.bin_count": 2.5}, {"sonar.range": [1, 2]}):
        with pytest.raises(insonify.ConfigError) as live:
            sim.set(values)
        assert np.array_equal(sim.step(HERE).bins, before), values
        with pytest.raises(insonify.ConfigError) as given:
            insonify.Simulation(deploy / "minimal.yml", overrides=values)
        if len(values) == 1 and "sonar" not in values:  # which also says that it could be a namespace
            told = [d["message"].split(";")[0] for d in live.value.diagnostics]
            assert told == [d["message"].split(";")[0] for d in given.value.diagnostics], values
    with pytest.raises(RuntimeError, match="scene is Running"):
        sim.set({"scene.file": "other.glb"})
    with pytest.raises(TypeError, match="values: is a list"):
        sim.set([1])
    assert np.array_equal(sim.step(HERE).bins, before)


def test_settings_of_a_batch_are_those_of_each(deploy):
    fixed = {"sonar.quality": {"rows": 64, "columns_per_beam": 2}}
    batch = insonify.SimulationBatch(deploy / "minimal.yml", 3, overrides=fixed)
    single = insonify.Simulation(deploy / "minimal.yml", overrides=fixed)
    for stepped in (batch, single):
        stepped.set({"sonar.range": 7.5})
    bins = batch.step([HERE] * 3).bins
    assert all(np.array_equal(each, single.step(HERE).bins) for each in bins[:1])
    with pytest.raises(insonify.ConfigError):
        batch.set({"sonar.range": -1})
