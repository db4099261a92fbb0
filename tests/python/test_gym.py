"""The environment for agents, checked by gymnasium's checker."""

import insonify
import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium", reason="gymnasium is not installed; scripts/setup installs it")
from gymnasium.utils.env_checker import check_env  # noqa: E402

import insonify.gym  # noqa: E402

QUICK = {"sonar.beam_count": 32, "sonar.bin_count": 100, "sonar.quality": {"rows": 32, "columns_per_beam": 1}}


def made(deploy, **more):
    return insonify.gym.SonarEnv(deploy / "minimal.yml", insonify.Pose([0, 0, 0]), overrides=QUICK, **more)


def test_gymnasiums_checker_passes(deploy):
    check_env(made(deploy, scatter=1.0), skip_render_check=True)


def test_the_same_seed_is_the_same_episode(deploy):
    def episode(seed):
        env = made(deploy, scatter=2.0)
        observations = [env.reset(seed=seed)[0]]
        for _ in range(3):
            observations.append(env.step(np.array([1, 0.2, 0, 0.5]))[0])
        return np.stack(observations)

    np.testing.assert_array_equal(episode(7), episode(7))
    assert not np.array_equal(episode(7), episode(8))


def test_actions_move_the_vehicle_in_its_own_axes(deploy):
    env = made(deploy, period=0.5, max_speed=2.0, max_turn=np.pi)
    env.reset(seed=1)
    *_, info = env.step(np.array([0, 0, 0, 1]))
    np.testing.assert_allclose(info["pose"].position, [0, 0, 0], atol=1e-12)
    *_, info = env.step(np.array([1, 0, 0, 0]))
    np.testing.assert_allclose(info["pose"].position, [0, 1, 0], atol=1e-12)  # turned to port by 90 degrees


def test_an_episode_is_truncated_in_time_and_ends_at_a_wall(deploy):
    env = made(deploy, max_steps=2)
    env.reset(seed=1)
    assert env.step(np.zeros(4))[3] is False and env.step(np.zeros(4))[3] is True
    near = made(deploy, collision_range=1000.0)
    near.reset(seed=1)
    assert near.step(np.zeros(4))[2] is True


def test_several_environments_step_together(deploy):
    envs = gymnasium.vector.SyncVectorEnv([lambda: made(deploy), lambda: made(deploy)])
    observations, _ = envs.reset(seed=[1, 2])
    assert observations.shape == (2, 32, 100)
    observations, rewards, *_ = envs.step(np.array([[1, 0, 0, 0], [0, 0, 0, 0]], np.float32))
    assert rewards[0] > rewards[1] == 0
    envs.close()
