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


def _levels(bins: np.ndarray, reference: float, floor_db: float) -> np.ndarray:
    floor = 10 ** (floor_db / 10)
    db = 10 * np.log10(np.maximum(np.nan_to_num(bins) / reference, floor))
    return np.clip(255 * (1 - db / floor_db), 0, 255).astype(np.uint8)


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
    from -1 to 1 of `max_speed` [m/s] and `max_turn` [rad/s]; it stays level. An observation is the ping as levels,
    uint8 [beams, bins]: 0 at `floor_db`, 255 at 0 dB of the loudest bin a first ping had. The episode ends when
    something ahead is nearer than `collision_range` [m], and is cut off after `max_steps`.

    :param start: where episodes begin; `scatter` [m] moves it at random in x and y.
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
        reward: Callable[[Ping, Pose, Pose], float] | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.render_mode = render_mode
        self._made_of = (str(deployment), dict(overrides or {}))
        self._start, self._scatter, self._period = start, scatter, period
        self._speeds = np.array([max_speed, max_speed, max_speed, max_turn])
        self._floor_db, self._collision_range, self._max_steps = floor_db, collision_range, max_steps
        self._reward = reward or _progress
        self._simulation = self._simulate(0)
        self._reference = None
        first = self._simulation.step(start)
        self._begin(first)
        self.action_space = gymnasium.spaces.Box(-1, 1, (4,), np.float32)
        self.observation_space = gymnasium.spaces.Box(0, 255, first.bins.shape, np.uint8)

    def _simulate(self, seed: int) -> Simulation:
        deployment, overrides = self._made_of
        return Simulation(deployment, seed, overrides, period=self._period)

    def _begin(self, ping: Ping) -> None:
        loudest = float(np.nanmax(ping.bins, initial=0))
        self._reference = self._reference or (loudest if loudest > 0 else 1.0)
        self._ping, self._steps = ping, 0

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        super().reset(seed=seed)
        aside = self.np_random.uniform(-self._scatter, self._scatter, 2)
        self._pose = Pose(self._start.position + [*aside, 0], self._start.orientation_wxyz)
        self._simulation.reset(int(self.np_random.integers(1, 2**31)))
        self._begin(self._simulation.step(self._pose))
        return _levels(self._ping.bins, self._reference, self._floor_db), self._info()

    def step(self, action):
        before, self._pose = self._pose, self._moved(np.clip(np.asarray(action, float), -1, 1) * self._speeds)
        self._ping = self._simulation.step(self._pose)
        self._steps += 1
        terminated = distance_ahead(self._ping) < self._collision_range
        reward = float(self._reward(self._ping, before, self._pose))
        return _levels(self._ping.bins, self._reference, self._floor_db), reward, terminated, self._steps >= self._max_steps, self._info()

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
        reward: Callable[[Pings, np.ndarray, np.ndarray], np.ndarray] | None = None,
    ) -> None:
        self.num_envs = num_envs
        self._start, self._scatter, self._period = start, scatter, period
        self._speeds = np.array([max_speed, max_speed, max_speed, max_turn])
        self._floor_db, self._collision_range, self._max_steps = floor_db, collision_range, max_steps
        self._reward = reward or (lambda pings, before, now: now[:, 0] - before[:, 0])
        self._batch = SimulationBatch(deployment, num_envs, overrides=overrides, period=period)
        self._poses = np.tile(np.concatenate([start.position, start.orientation_wxyz]), (num_envs, 1))
        self._steps, self._ended = np.zeros(num_envs, int), np.zeros(num_envs, bool)
        first = self._batch.step(self._poses)
        loudest = float(np.nanmax(first.bins[0], initial=0))
        self._reference = loudest if loudest > 0 else 1.0
        self.single_action_space = gymnasium.spaces.Box(-1, 1, (4,), np.float32)
        self.single_observation_space = gymnasium.spaces.Box(0, 255, first.bins.shape[1:], np.uint8)
        self.action_space = gymnasium.vector.utils.batch_space(self.single_action_space, num_envs)
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, num_envs)

    def _begin(self, which: np.ndarray) -> None:
        numbers = np.flatnonzero(which)
        self._batch.reset(numbers, self.np_random.integers(1, 2**31, len(numbers)))
        aside = self.np_random.uniform(-self._scatter, self._scatter, (len(numbers), 2))
        self._poses[numbers, :2] = self._start.position[:2] + aside
        self._poses[numbers, 2:] = [self._start.position[2], *self._start.orientation_wxyz]
        self._steps[numbers] = 0

    def _observe(self) -> tuple[Pings, np.ndarray]:
        self._pings = self._batch.step(self._poses)
        return self._pings, _distances_ahead(self._pings.bins, self._pings.bearings, self._pings.ranges)

    def _observation(self, distances: np.ndarray) -> tuple[np.ndarray, dict]:
        info = {"position": self._poses[:, :3].copy(), "distance_ahead": distances, "time": self._pings.times}
        return _levels(self._pings.bins, self._reference, self._floor_db), info

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        super().reset(seed=seed)
        self._begin(np.ones(self.num_envs, bool))
        self._ended[:] = False
        return self._observation(self._observe()[1])

    def step(self, actions):
        velocities = np.clip(np.asarray(actions, float), -1, 1) * self._speeds
        before, begins = self._poses[:, :3].copy(), self._ended.copy()
        self._poses[:, :3] += _rotated(self._poses[:, 3:], velocities[:, :3]) * self._period
        self._poses[:, 3:] = _turned(self._poses[:, 3:], velocities[:, 3] * self._period)
        self._steps += 1
        if begins.any():
            self._begin(begins)
        pings, distances = self._observe()
        rewards = np.where(begins, 0.0, self._reward(pings, before, self._poses[:, :3]))
        terminated = (distances < self._collision_range) & ~begins
        truncated = (self._steps >= self._max_steps) & ~begins
        self._ended = terminated | truncated
        observations, info = self._observation(distances)
        return observations, rewards, terminated, truncated, info
