"""Processes that fork with a simulation in memory, as pools and data loaders do. A hang fails by its timeout."""

import concurrent.futures
import gc
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import time

import insonify
import numpy as np
import pytest
from conftest import ROOT

HERE = insonify.Pose([0, 0, 0])
OVERRIDES = {"sonar.visibility": "cpu", "sonar.beam_count": 16, "sonar.bin_count": 64}
TIMEOUT = 60


def in_fork(work):
    """Returns what `work` returns in a forked child, an exception included; fails if it hangs or crashes."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            result = work()
        except BaseException as error:
            result = error
        os.write(write, pickle.dumps(result))
        os._exit(0)
    os.close(write)
    end = time.monotonic() + TIMEOUT
    while os.waitpid(child, os.WNOHANG) == (0, 0):
        if time.monotonic() > end:
            os.kill(child, signal.SIGKILL)
            os.waitpid(child, 0)
            pytest.fail("the forked child hangs")
        time.sleep(0.01)
    with os.fdopen(read, "rb") as pipe:
        return pickle.loads(pipe.read())


def refused(result) -> bool:
    return isinstance(result, RuntimeError) and "make one in each process" in str(result) and "spawn" in str(result)


@pytest.fixture
def simulation(deploy):
    return insonify.Simulation(deploy / "minimal.yml", seed=1, overrides=OVERRIDES)


@pytest.mark.parametrize("steps", [0, 1])
@pytest.mark.parametrize("work", ["step", "reset"])
def test_a_simulation_of_the_parent_is_refused_in_a_forked_child(simulation, steps, work):
    for _ in range(steps):
        simulation.step(HERE)
    call = {"step": lambda: simulation.step(HERE), "reset": simulation.reset}[work]
    assert refused(in_fork(call))
    simulation.step(HERE)  # the parent continues


def test_a_reset_simulation_is_refused_in_a_forked_child(simulation):
    simulation.step(HERE)
    simulation.reset(2)
    assert refused(in_fork(lambda: simulation.step(HERE)))


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("steps", [0, 1])
def test_a_batch_of_the_parent_is_refused_in_a_forked_child(deploy, count, steps):
    batch = insonify.SimulationBatch(deploy / "minimal.yml", count, overrides=OVERRIDES)
    poses = np.tile([0.0, 0, 0, 1, 0, 0, 0], (count, 1))
    for _ in range(steps):
        batch.step(poses)
    assert refused(in_fork(lambda: batch.step(poses)))
    assert refused(in_fork(batch.reset))
    assert len(batch.step(poses)) == count


def test_a_child_may_drop_what_it_inherited(simulation):
    held = [simulation]
    held[0].step(HERE)

    def drop():
        held[0].__dict__.clear()
        gc.collect()
        return "dropped"

    assert in_fork(drop) == "dropped"
    assert held[0].step(HERE).bins.shape == (16, 64)


def test_a_child_makes_its_own_simulation_with_the_same_pings(deploy, simulation):
    bins = simulation.step(HERE).bins.copy()

    def own():
        made = insonify.Simulation(deploy / "minimal.yml", seed=1, overrides=OVERRIDES)
        return made.step(HERE).bins.copy()

    np.testing.assert_array_equal(in_fork(own), bins)


def test_pings_and_logs_of_the_parent_stay_readable_in_a_child(simulation):
    ping = simulation.step(HERE)
    np.testing.assert_array_equal(in_fork(lambda: ping.bins.copy()), ping.bins)


def _own_bins(deployment):
    return insonify.Simulation(deployment, seed=1, overrides=OVERRIDES).step(HERE).bins.copy()


def _inherited(_):
    try:
        _SHARED.step(HERE)
    except RuntimeError as error:
        return str(error)
    return "stepped"


_SHARED = None


@pytest.mark.parametrize("method", ["fork", "spawn", "forkserver"])
def test_a_pool_makes_simulations_in_its_workers(deploy, simulation, method):
    bins = simulation.step(HERE).bins.copy()
    with multiprocessing.get_context(method).Pool(2) as pool:
        for made in pool.map_async(_own_bins, [deploy / "minimal.yml"] * 3).get(TIMEOUT):
            np.testing.assert_array_equal(made, bins)


def test_a_forked_pool_reports_a_shared_simulation(simulation):
    global _SHARED
    _SHARED = simulation
    _SHARED.step(HERE)
    with multiprocessing.get_context("fork").Pool(2) as pool:
        for text in pool.map_async(_inherited, range(3)).get(TIMEOUT):
            assert "make one in each process" in text
    _SHARED = None


def test_a_simulation_that_is_sent_to_a_process_is_refused_when_it_is_pickled(simulation):
    process = multiprocessing.get_context("spawn").Process(target=print, args=(simulation,))
    with pytest.raises(TypeError, match="cannot be copied or sent to another process; make the simulation"):
        process.start()


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_an_executor_makes_simulations_in_its_workers(deploy, simulation, method):
    bins = simulation.step(HERE).bins.copy()
    with concurrent.futures.ProcessPoolExecutor(2, multiprocessing.get_context(method)) as workers:
        for made in workers.map(_own_bins, [deploy / "minimal.yml"] * 3, timeout=TIMEOUT):
            np.testing.assert_array_equal(made, bins)


@pytest.mark.parametrize("torch", [False, True])
@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_the_loader_of_the_examples_gives_the_items_of_the_parent(deploy, monkeypatch, method, torch):
    if torch:
        pytest.importorskip("torch", reason="torch is not installed; the other half of the test does without")
    else:
        for name in ("torch", "torch.utils.data"):  # may be loaded already
            monkeypatch.setitem(sys.modules, name, None)
    monkeypatch.syspath_prepend(str(ROOT / "components/python/examples"))
    import loader

    data = loader.Pings(deploy / "minimal.yml", 5, seed=3, overrides=OVERRIDES)
    expected = [data[i] for i in range(5)]  # the parent has a simulation when the workers are forked
    assert len(data) == 5 and expected[0][0].shape == (16, 64) and not np.array_equal(expected[0][0], expected[1][0])
    for index in (-1, 5):
        with pytest.raises(IndexError):
            data[index]
    batches = list(loader.batches(data, 2, 2, method))
    assert [len(bins) for bins, _ in batches] == [2, 2, 1]
    for part in (0, 1):
        made = np.concatenate([np.asarray(batch[part]) for batch in batches])
        np.testing.assert_array_equal(made, np.stack([each[part] for each in expected]))
    np.testing.assert_array_equal(data[2][0], expected[2][0])  # the parent goes on


def test_the_loader_runs_as_on_its_page(deploy):
    command = [sys.executable, ROOT / "components/python/examples/loader.py", deploy / "minimal.yml", "--pings", "4", "--batch", "2"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT)
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("the parent looks at the first: (96, 128)\nbatch 0: (2, 96, 128), ")
