"""The environment for agents, checked by gymnasium's checker."""

import insonify
import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium", reason="gymnasium is not installed; scripts/setup installs it")
from gymnasium.utils.env_checker import check_env  # noqa: E402

import insonify.gym  # noqa: E402

START = insonify.Pose([0, 0, 0])
QUICK = {"sonar.beam_count": 32, "sonar.bin_count": 100, "sonar.quality": {"rows": 32, "columns_per_beam": 1}}


def made(deploy, **more):
    return insonify.gym.SonarEnv(deploy / "minimal.yml", START, overrides=QUICK, **more)


def many(deploy, count, **more):
    return insonify.gym.SonarVectorEnv(deploy / "minimal.yml", START, count, overrides=QUICK, **more)


CHANNELS = [{}, {"channel_axis": True}, {"stack": 3}, {"channel_axis": True, "stack": 4}]
SHAPES = [(32, 100), (1, 32, 100), (3, 32, 100), (4, 32, 100)]


def is_picture(space):
    """What stable_baselines3.common.preprocessing.is_image_space asks of pictures whose channels are first."""
    return (
        isinstance(space, gymnasium.spaces.Box)
        and len(space.shape) == 3
        and space.dtype == np.uint8
        and np.all(space.low == 0)
        and np.all(space.high == 255)
        and np.argmin(space.shape) == 0
    )


@pytest.mark.parametrize("channels", CHANNELS)
def test_gymnasiums_checker_passes(deploy, channels):
    check_env(made(deploy, scatter=1.0, **channels), skip_render_check=True)


@pytest.mark.parametrize("channels", CHANNELS[1:])
def test_a_policy_with_convolutions_of_stable_baselines3_learns_from_it(deploy, channels):
    baselines = pytest.importorskip("stable_baselines3", reason="stable-baselines3 is not installed")
    from stable_baselines3.common.env_checker import check_env as check

    pictures = {"sonar.beam_count": 48, "sonar.bin_count": 64}
    env = insonify.gym.SonarEnv(deploy / "minimal.yml", START, overrides=QUICK | pictures, max_steps=10, **channels)
    check(env)
    assert baselines.PPO("CnnPolicy", env, n_steps=16, batch_size=8, n_epochs=1).learn(16).num_timesteps == 16


@pytest.mark.parametrize("channels, shape", list(zip(CHANNELS, SHAPES)))
def test_observations_have_an_axis_of_channels_on_request(deploy, channels, shape):
    env, envs = made(deploy, **channels), many(deploy, 2, **channels)
    assert env.observation_space.shape == envs.single_observation_space.shape == shape
    assert envs.observation_space.shape == (2, *shape)
    assert is_picture(env.observation_space) == (len(shape) == 3)
    env.reset(seed=1), envs.reset(seed=1)
    assert env.step(np.zeros(4))[0] in env.observation_space
    assert envs.step(np.zeros((2, 4)))[0] in envs.observation_space


def test_stacked_frames_are_those_of_gymnasiums_wrapper(deploy):
    rng, stack = np.random.default_rng(4), 3
    own = made(deploy, scatter=2.0, stack=stack)
    theirs = gymnasium.wrappers.FrameStackObservation(made(deploy, scatter=2.0), stack, padding_type="reset")
    for seed in (5, 6):
        first = own.reset(seed=seed)[0]
        np.testing.assert_array_equal(first, theirs.reset(seed=seed)[0])
        for frame in first[1:]:
            np.testing.assert_array_equal(frame, first[0])
        for _ in range(5):
            action = rng.uniform(-1, 1, 4)
            np.testing.assert_array_equal(own.step(action)[0], theirs.step(action)[0])


def test_stacked_frames_of_many_environments_begin_anew_with_each_episode(deploy):
    rng, count, options = np.random.default_rng(8), 4, dict(scatter=3.0, max_steps=3, collision_range=11.0, max_speed=4.0)
    plain, stacked = many(deploy, count, **options), many(deploy, count, stack=3, **options)
    frames = [plain.reset(seed=2)[0]]
    seen, ages, ended, episodes = stacked.reset(seed=2)[0], np.zeros(count, int), np.zeros(count, bool), 0
    for _ in range(12):
        for i, age in enumerate(ages):  # the frames of this episode, the first of them in place of those before it
            expected = [frames[max(len(frames) - 1 - back, len(frames) - 1 - age)][i] for back in (2, 1, 0)]
            np.testing.assert_array_equal(seen[i], expected)
        actions = rng.uniform(-1, 1, (count, 4))
        frames.append(plain.step(actions)[0])
        ages = np.where(ended, 0, ages + 1)
        seen, _, terminated, truncated, _ = stacked.step(actions)
        ended = terminated | truncated
        episodes += ended.sum()
    assert episodes > count


def test_a_changed_observation_does_not_change_the_next(deploy):
    env, other = made(deploy, stack=2), made(deploy, stack=2)
    env.reset(seed=1)[0][:] = 7
    other.reset(seed=1)
    np.testing.assert_array_equal(env.step(np.zeros(4))[0], other.step(np.zeros(4))[0])


@pytest.mark.parametrize("stack", [0, -1, 1.5, True, "4", None])
def test_a_stack_is_a_whole_number_from_1(deploy, stack):
    for make in (lambda: made(deploy, stack=stack), lambda: many(deploy, 2, stack=stack)):
        with pytest.raises(ValueError, match="^stack: is .*; must be a whole number from 1$"):
            make()


@pytest.mark.parametrize(
    "name, value, error, bound",
    [
        ("max_steps", 0, ValueError, "must be a whole number from 1"),
        ("max_steps", 2.5, ValueError, "must be a whole number from 1"),
        ("floor_db", 60, ValueError, "must be a number below 0"),
        ("max_speed", -1, ValueError, "must be a number from 0"),
        ("scatter", np.nan, ValueError, "must be a number from 0"),
        ("reward", "x", TypeError, "must be a function"),
        ("start", np.eye(4), TypeError, "must be an insonify.Pose"),
    ],
)
def test_an_environment_is_not_made_with_a_wrong_number_or_start(deploy, name, value, error, bound):
    arguments = {"start": START, name: value}
    for make in (insonify.gym.SonarEnv, lambda path, **more: insonify.gym.SonarVectorEnv(path, num_envs=2, **more)):
        with pytest.raises(error, match=f"^{name}: is .*; {bound}$"):
            make(deploy / "minimal.yml", **arguments)


@pytest.mark.parametrize("name", ["hil_ping360.yml", "crosstalk.yml"])
def test_an_environment_has_one_sonar_and_one_vehicle(deploy, name):
    for make in (insonify.gym.SonarEnv, lambda path, start: insonify.gym.SonarVectorEnv(path, start, 2)):
        with pytest.raises(ValueError, match=f"{name}: has several vehicles or sonars; .* one of each$"):
            make(deploy / name, START)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_an_action_that_is_not_finite_is_refused_and_the_episode_goes_on(deploy, bad):
    rng = np.random.default_rng(11)
    env, other = made(deploy, stack=2), made(deploy, stack=2)
    env.reset(seed=3), other.reset(seed=3)
    for _ in range(4):
        action, place = rng.uniform(-1, 1, 4), int(rng.integers(4))
        wrong = action.copy()
        wrong[place] = bad
        with pytest.raises(ValueError, match=rf"^action\[{place}\]: is {bad}; must be finite, from -1 to 1"):
            env.step(wrong)
        one, two = env.step(action), other.step(action)
        np.testing.assert_array_equal(one[0], two[0])
        assert one[1:4] == two[1:4] and one[4]["pose"] == two[4]["pose"] and one[4]["time"] == two[4]["time"]


def test_actions_of_many_environments_that_are_not_finite_are_refused_and_all_go_on(deploy):
    rng = np.random.default_rng(12)
    envs, others = many(deploy, 3, max_steps=2), many(deploy, 3, max_steps=2)
    envs.reset(seed=3), others.reset(seed=3)
    for _ in range(6):
        actions, (row, column) = rng.uniform(-1, 1, (3, 4)), rng.integers([3, 4])
        wrong = actions.copy()
        wrong[row, column] = np.nan
        with pytest.raises(ValueError, match=rf"^actions\[{row}, {column}\]: is nan; must be finite, from -1 to 1"):
            envs.step(wrong)
        for one, two in zip(envs.step(actions)[:4], others.step(actions)[:4]):
            np.testing.assert_array_equal(one, two)


@pytest.mark.parametrize("action", [np.zeros(3), np.zeros((1, 4)), 0.5, []])
def test_an_action_of_another_shape_is_refused(deploy, action):
    env = made(deploy)
    env.reset(seed=1)
    with pytest.raises(ValueError, match=r"^action: has the shape .*; must be \(4,\): ahead, port, up, turn to port"):
        env.step(action)
    env.step(np.zeros(4))


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
