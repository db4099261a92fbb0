"""Many simulations on one scene, compared with single simulations."""

import copy
import re
import subprocess
import sys

import insonify
import numpy as np
import pytest
from conftest import ROOT

pytestmark = pytest.mark.slow

QUICK = {"sonar.beam_count": 48, "sonar.bin_count": 100, "sonar.quality": {"rows": 32, "columns_per_beam": 1}}


def random_poses(rng, count):
    yaws = rng.uniform(-3, 3, count)
    places = np.column_stack([rng.uniform(0, 25, count), rng.uniform(-10, 2, count), rng.uniform(-8, -3, count)])
    return np.column_stack([places, np.cos(yaws / 2), 0 * yaws, 0 * yaws, np.sin(yaws / 2)])


def pose(numbers):
    return insonify.Pose(numbers[:3], numbers[3:])


@pytest.mark.parametrize("seed", [0, 7])
def test_each_ping_equals_that_of_a_single_simulation(deploy, seed):
    file, rng = deploy / "harbour_fls.yml", np.random.default_rng(3)
    batch = insonify.SimulationBatch(file, 5, seed=seed, overrides=QUICK)
    assert len(batch) == 5 and batch.seeds[0] == seed and len(set(batch.seeds)) == 5
    singles = [insonify.Simulation(file, each, QUICK) for each in batch.seeds]
    for step in range(3):
        poses = random_poses(rng, 5)
        pings = batch.step(poses)
        assert pings.bins.shape == (5, 48, 100) and pings.bins.dtype == np.float32 and len(pings) == 5
        for i, single in enumerate(singles):
            expected = single.step(pose(poses[i]))
            np.testing.assert_array_equal(pings.bins[i], expected.bins)
            assert pings.times[i] == expected.time
        np.testing.assert_array_equal(pings.bearings, expected.bearings)
        np.testing.assert_array_equal(pings.ranges, expected.ranges)
    assert not np.array_equal(pings.bins[0], pings.bins[1])


def test_some_simulations_are_reset_and_the_others_continue(deploy):
    file, rng = deploy / "harbour_fls.yml", np.random.default_rng(4)
    batch = insonify.SimulationBatch(file, 3, seed=2, overrides=QUICK)
    first, second = random_poses(rng, 3), random_poses(rng, 3)
    batch.step(first)
    batch.reset([1], [99])
    pings = batch.step(second)
    single = insonify.Simulation(file, 99, QUICK)
    np.testing.assert_array_equal(pings.bins[1], single.step(pose(second[1])).bins)
    assert pings.times[1] < pings.times[0]
    batch.reset(range(3), batch.seeds)
    np.testing.assert_array_equal(batch.step(first).bins, insonify.SimulationBatch(file, 3, 2, QUICK).step(first).bins)


def test_pings_have_their_truth(deploy):
    batch = insonify.SimulationBatch(deploy / "harbour_fls.yml", 2, overrides=QUICK, truth=True)
    poses = random_poses(np.random.default_rng(5), 2)
    truth = batch.step(poses).truth
    single = insonify.Simulation(deploy / "harbour_fls.yml", overrides=QUICK, truth=True).step(pose(poses[0])).truth
    assert truth.object.shape == (2, 48, 100)
    np.testing.assert_array_equal(truth.object[0], single.object)
    np.testing.assert_array_equal(truth.elevation[0], single.elevation)
    assert truth.objects == single.objects


def test_poses_may_be_numbers_matrices_or_poses(deploy):
    batch = insonify.SimulationBatch(deploy / "minimal.yml", 2, overrides=QUICK)
    numbers = random_poses(np.random.default_rng(6), 2) * [0.1, 0.1, 0.1, 1, 1, 1, 1]
    poses = [pose(each) for each in numbers]
    by_numbers = batch.step(numbers).bins
    for given in (poses, np.array(poses), np.stack([each.matrix() for each in poses])):
        batch.reset()
        np.testing.assert_allclose(batch.step(given).bins, by_numbers, rtol=1e-4, atol=1e-12)


def test_arrays_keep_their_values_during_later_steps(deploy):
    batch = insonify.SimulationBatch(deploy / "minimal.yml", 2, overrides=QUICK)
    here = np.tile([0, 0, 0, 1.0, 0, 0, 0], (2, 1))
    bins = batch.step(here).bins
    kept = bins.copy()
    with pytest.raises(ValueError):
        bins[0, 0, 0] = 1
    for _ in range(5):
        batch.step(here + [0.1, 0, 0, 0, 0, 0, 0])
    np.testing.assert_array_equal(bins, kept)


def test_each_wrong_argument_has_one_clear_error(deploy):
    file = deploy / "minimal.yml"
    for wrong in (-1, 0, 2**16):
        with pytest.raises(ValueError, match=f"count: is {wrong}; may be 1 to 65535"):
            insonify.SimulationBatch(file, wrong)
    with pytest.raises(insonify.ConfigError, match="several vehicles or sonars"):
        insonify.SimulationBatch(deploy / "two_vehicles.yml", 2)
    batch = insonify.SimulationBatch(file, 2, overrides=QUICK)
    here = np.tile([0, 0, 0, 1.0, 0, 0, 0], (2, 1))
    with pytest.raises(ValueError, match="poses: are 3; the batch has 2 simulations"):
        batch.step([pose(here[0])] * 3)
    for shape in ((3, 7), (2, 6), (7,), (2, 4, 3), (2, 1, 7)):
        with pytest.raises(ValueError, match=re.escape(f"poses: are an array {list(shape)}; must be [2, 7] or [2, 4, 4]")):
            batch.step(np.zeros(shape))
    with pytest.raises(IndexError, match="there is no simulation 2 of 2"):
        batch.reset([2])
    with pytest.raises(IndexError, match="there is no simulation -1 of 2"):
        batch.reset([-1])
    with pytest.raises(TypeError, match="cannot be copied"):
        copy.copy(batch)
    with pytest.raises(ValueError, match="simulation 0 is given more than once"):
        batch.reset([0, 0])
    with pytest.raises(ValueError, match="deployment's own"):
        batch.reset([1], [0])
    with pytest.raises(ValueError, match="seeds: are 1; there are 2 simulations to reset"):
        batch.reset([0, 1], [5])
    with pytest.raises(RuntimeError, match="simulation 1: .*quaternion"):
        batch.step(np.vstack([here[0], [0, 0, 0, 0, 0, 0, 0]]))
    assert batch.step(here).bins.max() > 0  # the next valid poses give pings


def test_one_scene_is_loaded_for_all(deploy):
    def memory():
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * 4096

    quick = {**QUICK, "sonar.visibility": "cpu"}
    first = insonify.SimulationBatch(deploy / "harbour_fls.yml", 1, overrides=quick)
    here = np.array([[0, 0, -5.5, 1.0, 0, 0, 0]])
    first.step(here)
    before = memory()
    many = insonify.SimulationBatch(deploy / "harbour_fls.yml", 20, overrides=quick)
    many.step(np.tile(here, (20, 1)))
    assert (memory() - before) / 20 < 8e6  # the scene alone takes more


def test_the_vector_environment_equals_single_environments(deploy):
    gymnasium = pytest.importorskip("gymnasium", reason="gymnasium is not installed; scripts/setup installs it")
    import insonify.gym

    start = insonify.Pose([0, 0, 0])
    options = dict(overrides=QUICK, max_steps=4, collision_range=0.5)
    many = insonify.gym.SonarVectorEnv(deploy / "minimal.yml", start, 3, **options)
    one = insonify.gym.SonarEnv(deploy / "minimal.yml", start, **options)
    assert isinstance(many, gymnasium.vector.VectorEnv)
    observations, info = many.reset(seed=1)
    expected, _ = one.reset(seed=1)
    assert many.observation_space.contains(observations) and many.single_observation_space.contains(observations[0])
    actions = np.array([[1, 0, 0, 0.3], [0.2, -0.4, 0, 0], [0, 0, 0, 0]], np.float32)
    ways = np.zeros(3)
    for step in range(4):
        observations, rewards, terminated, truncated, info = many.step(actions)
        alone, reward, *_ = one.step(actions[0])
        assert rewards[0] == pytest.approx(reward) and info["position"][0] == pytest.approx(one._pose.position)
        assert abs(observations[0].astype(int) - alone).mean() < 20  # speckle of another seed
        assert (truncated == (step == 3)).all() and not terminated.any()
        ways += rewards
    assert ways[0] > ways[1] > ways[2] == 0
    observations, rewards, terminated, truncated, info = many.step(actions)  # which resets them
    assert (rewards == 0).all() and not truncated.any() and np.allclose(info["position"], 0)
    again, _ = many.reset(seed=1)
    np.testing.assert_array_equal(again, many.reset(seed=1)[0])


def test_the_example_learns(deploy):
    pytest.importorskip("gymnasium", reason="gymnasium is not installed; scripts/setup installs it")
    example = ROOT / "components/python/examples/avoid.py"
    command = [sys.executable, example, deploy / "harbour_fls.yml", "--vehicles", "16", "--rounds", "5", "--steps", "50"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stderr
    before, after = (float(done.stdout.split(mark)[1].split(" m")[0]) for mark in ("straight ahead: ", "learnt: "))
    assert after > 1.3 * before, done.stdout
