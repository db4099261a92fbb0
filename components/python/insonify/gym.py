"""A deployment as an environment of gymnasium: an agent steers a vehicle by its sonar's pings.

    env = insonify.gym.SonarEnv("deploy/harbour_fls.yml", start=insonify.Pose([0, 0, -5]))
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

SonarVectorEnv runs many in one process, on one scene.
"""

from __future__ import annotations

from collections.abc import Callable

import gymnasium
import numpy as np

from . import Ping, Pings, Pose, Simulation, SimulationBatch


def distance_ahead(ping: Ping, half_sector: float = np.radians(15), below_loudest_db: float = 20) -> float:
    """Slant range of the nearest echo in a sector ahead that is at most this far below the loudest echo there [m];
    infinite if there is none."""
    return float(_distances_ahead(ping.bins[None], ping.bearings, ping.ranges, half_sector, below_loudest_db)[0])


def _distances_ahead(bins, bearings, ranges, half_sector: float = np.radians(15), below_loudest_db: float = 20) -> np.ndarray:
    """The same for pings [pings, beams, bins]."""
    loudest = np.nan_to_num(bins[:, np.abs(bearings) <= half_sector]).max(axis=1, initial=0)
    threshold = np.maximum(loudest.max(axis=1, keepdims=True, initial=0) * 10 ** (-below_loudest_db / 10), 0)
    is_echo = loudest > threshold
    return np.where(is_echo.any(axis=1), np.append(ranges, np.inf)[np.where(is_echo.any(axis=1), is_echo.argmax(axis=1), -1)], np.inf)


def _whole(name: str, number) -> None:
    if isinstance(number, bool) or not isinstance(number, (int, np.integer)) or number < 1:
        raise ValueError(f"{name}: is {number!r}; must be a whole number from 1")


def _check(start, max_steps: int, floor_db: float, reward, **from_0: float) -> None:
    if not isinstance(start, Pose):
        raise TypeError(f"start: is a {type(start).__name__}; must be an insonify.Pose")
    _whole("max_steps", max_steps)
    if not -np.inf < floor_db < 0:
        raise ValueError(f"floor_db: is {floor_db!r}; must be a number below 0")
    if reward is not None and not callable(reward):
        raise TypeError(f"reward: is {reward!r}; must be a function")
    for name, number in from_0.items():
        if not 0 <= number < np.inf:
            raise ValueError(f"{name}: is {number!r}; must be a number from 0")


class _Frames:
    """Observations of several vehicles: pings as levels, uint8, or the newest `stack` of each along an axis of channels.

    :param bins: first pings [vehicles, beams, bins]; the loudest bin of the first vehicle is 0 dB.
    """

    def __init__(self, bins: np.ndarray, floor_db: float, channel_axis: bool, stack: int) -> None:
        _whole("stack", stack)
        loudest = float(np.nanmax(bins[0], initial=0))
        self._reference, self._floor_db = loudest if loudest > 0 else 1.0, floor_db
        self._stacked = np.zeros((len(bins), stack, *bins.shape[1:]), np.uint8)
        self._has_channels = channel_axis or stack > 1
        shape = self._stacked.shape[1:] if self._has_channels else bins.shape[1:]
        self.space = gymnasium.spaces.Box(0, 255, shape, np.uint8)

    def add(self, bins: np.ndarray, begins: np.ndarray) -> np.ndarray:
        """The observations [vehicles, ...] with a ping each; where an episode `begins` [vehicles], all frames are its first."""
        floor = 10 ** (self._floor_db / 10)
        db = 10 * np.log10(np.fmax(bins / self._reference, floor))  # of NaN and a number, the number
        levels = np.clip(255 * (1 - db / self._floor_db), 0, 255).astype(np.uint8)
        self._stacked = np.concatenate([self._stacked[:, 1:], levels[:, None]], axis=1)
        self._stacked[begins] = levels[begins, None]
        return self._stacked.copy() if self._has_channels else levels


def _velocities(name: str, actions, shape: tuple[int, ...], speeds: np.ndarray) -> np.ndarray:
    """Velocities of actions, which are cut to -1 to 1. ValueError for another shape and for a number that is not finite."""
    given = np.asarray(actions, float)
    if given.shape != shape:
        raise ValueError(f"{name}: has the shape {given.shape}; must be {shape}: ahead, port, up, turn to port")
    if not np.isfinite(given).all():
        place = np.argwhere(~np.isfinite(given))[0]
        raise ValueError(
            f"{name}[{', '.join(map(str, place))}]: is {given[tuple(place)]}; must be finite, from -1 to 1; nothing has moved"
        )
    return np.clip(given, -1, 1) * speeds


def _turned(quaternions: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Quaternions [..., 4] w, x, y, z turned about the world's vertical [rad]."""
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    c, s = np.cos(angles / 2), np.sin(angles / 2)
    return np.stack([c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w], axis=-1)


def _rotated(quaternions: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Vectors [..., 3] of the body, in the world's axes."""
    w, u = quaternions[..., :1], quaternions[..., 1:]
    return vectors + 2 * np.cross(u, np.cross(u, vectors) + w * vectors)


def _progress(ping: Ping, before: Pose, now: Pose) -> float:
    """Metres made good along the x axis of the world."""
    return float(now.position[0] - before.position[0])


class SonarEnv(gymnasium.Env):
    """One vehicle with one sonar.

    An action is the velocity of the vehicle in its own axes and its rate of turn, (ahead, port, up, turn to port), each
    from -1 to 1 of `max_speed` [m/s] and `max_turn` [rad/s]; it stays level. An action that is not finite is a
    ValueError, after which the episode goes on from where it was. An observation is the ping as levels,
    uint8 [beams, bins]: 0 at `floor_db`, 255 at 0 dB of the loudest bin a first ping had. The episode ends when
    something ahead is nearer than `collision_range` [m], and is cut off after `max_steps`.

    :param start: where episodes begin; `scatter` [m] moves it at random in x and y.
    :param channel_axis: observations are [1, beams, bins], as policies with convolutions take them.
    :param stack: the newest pings of the episode that an observation has, [stack, beams, bins], the newest last; above 1
        there is an axis of channels always. After a reset all of them are the first ping.
    :param reward: function of a ping, the pose before and the pose now; None: metres made good along x.
    """

    metadata = {"render_modes": ["rgb_array"]}

    def __init__(
        self,
        deployment: str,
        start: Pose,
        *,
        overrides: dict | None = None,
        period: float = 0.5,
        max_speed: float = 1.0,
        max_turn: float = 0.3,
        scatter: float = 0.0,
        floor_db: float = -60.0,
        collision_range: float = 1.0,
        max_steps: int = 200,
        channel_axis: bool = False,
        stack: int = 1,
        reward: Callable[[Ping, Pose, Pose], float] | None = None,
        render_mode: str | None = None,
    ) -> None:
        _check(start, max_steps, floor_db, reward, max_speed=max_speed, max_turn=max_turn, scatter=scatter, collision_range=collision_range)
        self.render_mode = render_mode
        self._made_of = (str(deployment), dict(overrides or {}))
        self._start, self._scatter, self._period = start, scatter, period
        self._speeds = np.array([max_speed, max_speed, max_speed, max_turn])
        self._collision_range, self._max_steps = collision_range, max_steps
        self._reward = reward or _progress
        self._simulation = self._simulate(0)
        if (len(self._simulation.poses), len(self._simulation.pings)) != (1, 1):
            raise ValueError(f"{deployment}: has several vehicles or sonars; an environment steps a deployment of one of each")
        self._pose, self._steps, self._ping = start, 0, self._simulation.step(start)
        self._frames = _Frames(self._ping.bins[None], floor_db, channel_axis, stack)
        self.action_space = gymnasium.spaces.Box(-1, 1, (4,), np.float32)
        self.observation_space = self._frames.space

    def _simulate(self, seed: int) -> Simulation:
        deployment, overrides = self._made_of
        return Simulation(deployment, seed, overrides, period=self._period)

    def _observe(self, begins: bool) -> np.ndarray:
        return self._frames.add(self._ping.bins[None], np.array([begins]))[0]

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        super().reset(seed=seed)
        aside = self.np_random.uniform(-self._scatter, self._scatter, 2)
        self._pose = Pose(self._start.position + [*aside, 0], self._start.orientation_wxyz)
        self._simulation.reset(int(self.np_random.integers(1, 2**31)))
        self._ping, self._steps = self._simulation.step(self._pose), 0
        return self._observe(True), self._info()

    def step(self, action):
        before, now = self._pose, self._moved(_velocities("action", action, (4,), self._speeds))
        self._ping = self._simulation.step(now)
        self._pose = now
        self._steps += 1
        terminated = distance_ahead(self._ping) < self._collision_range
        observation = self._observe(False)
        return observation, float(self._reward(self._ping, before, now)), terminated, self._steps >= self._max_steps, self._info()

    def _moved(self, velocity: np.ndarray) -> Pose:
        way = _rotated(self._pose.orientation_wxyz, velocity[:3]) * self._period
        return Pose(self._pose.position + way, _turned(self._pose.orientation_wxyz, velocity[3] * self._period))

    def _info(self) -> dict:
        return {"pose": self._pose, "time": self._ping.time, "distance_ahead": distance_ahead(self._ping)}

    def render(self) -> np.ndarray | None:
        return self._ping.fan() if self.render_mode == "rgb_array" else None


class SonarVectorEnv(gymnasium.vector.VectorEnv):
    """`num_envs` of SonarEnv in one process: vehicles that do not see each other, on one scene, each rendered on one
    core, one per core at a time. An environment whose episode has ended is reset at its next step, whose action is not
    used (gymnasium.vector.AutoresetMode.NEXT_STEP).

    :param reward: function of the pings, the positions [num_envs, 3] before and now, returns [num_envs]; None: metres
        made good along x. Other parameters as for SonarEnv.
    """

    metadata = {"autoreset_mode": gymnasium.vector.AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        deployment: str,
        start: Pose,
        num_envs: int,
        *,
        overrides: dict | None = None,
        period: float = 0.5,
        max_speed: float = 1.0,
        max_turn: float = 0.3,
        scatter: float = 0.0,
        floor_db: float = -60.0,
        collision_range: float = 1.0,
        max_steps: int = 200,
        channel_axis: bool = False,
        stack: int = 1,
        reward: Callable[[Pings, np.ndarray, np.ndarray], np.ndarray] | None = None,
    ) -> None:
        _check(start, max_steps, floor_db, reward, max_speed=max_speed, max_turn=max_turn, scatter=scatter, collision_range=collision_range)
        self.num_envs = num_envs
        self._start, self._scatter, self._period = start, scatter, period
        self._speeds = np.array([max_speed, max_speed, max_speed, max_turn])
        self._collision_range, self._max_steps = collision_range, max_steps
        self._reward = reward or (lambda pings, before, now: now[:, 0] - before[:, 0])
        self._batch = SimulationBatch(deployment, num_envs, overrides=overrides, period=period)
        self._poses = np.tile(np.concatenate([start.position, start.orientation_wxyz]), (num_envs, 1))
        self._steps, self._ended = np.zeros(num_envs, int), np.zeros(num_envs, bool)
        self._frames = _Frames(self._batch.step(self._poses).bins, floor_db, channel_axis, stack)
        self.single_action_space = gymnasium.spaces.Box(-1, 1, (4,), np.float32)
        self.single_observation_space = self._frames.space
        self.action_space = gymnasium.vector.utils.batch_space(self.single_action_space, num_envs)
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, num_envs)

    def _begin(self, which: np.ndarray) -> None:
        numbers = np.flatnonzero(which)
        self._batch.reset(numbers, self.np_random.integers(1, 2**31, len(numbers)))
        aside = self.np_random.uniform(-self._scatter, self._scatter, (len(numbers), 2))
        self._poses[numbers, :2] = self._start.position[:2] + aside
        self._poses[numbers, 2:] = [self._start.position[2], *self._start.orientation_wxyz]
        self._steps[numbers] = 0

    def _observe(self, begins: np.ndarray) -> tuple[np.ndarray, dict]:
        self._pings = self._batch.step(self._poses)
        distances = _distances_ahead(self._pings.bins, self._pings.bearings, self._pings.ranges)
        info = {"position": self._poses[:, :3].copy(), "distance_ahead": distances, "time": self._pings.times}
        return self._frames.add(self._pings.bins, begins), info

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        super().reset(seed=seed)
        self._begin(np.ones(self.num_envs, bool))
        self._ended[:] = False
        return self._observe(np.ones(self.num_envs, bool))

    def step(self, actions):
        velocities = _velocities("actions", actions, (self.num_envs, 4), self._speeds)
        before, begins = self._poses[:, :3].copy(), self._ended.copy()
        self._poses[:, :3] += _rotated(self._poses[:, 3:], velocities[:, :3]) * self._period
        self._poses[:, 3:] = _turned(self._poses[:, 3:], velocities[:, 3] * self._period)
        self._steps += 1
        if begins.any():
            self._begin(begins)
        observations, info = self._observe(begins)
        rewards = np.where(begins, 0.0, self._reward(self._pings, before, self._poses[:, :3]))
        terminated = (info["distance_ahead"] < self._collision_range) & ~begins
        truncated = (self._steps >= self._max_steps) & ~begins
        self._ended = terminated | truncated
        return observations, rewards, terminated, truncated, info
