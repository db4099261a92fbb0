"""A deployment as an environment of gymnasium: an agent that steers a vehicle by what its sonar hears.

    env = insonify.gym.SonarEnv("deploy/harbour_fls.yml", start=insonify.Pose([0, 0, -5]))
    observation, info = env.reset(seed=1)
    observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

Several go side by side by gymnasium.vector.AsyncVectorEnv or SyncVectorEnv.
"""

from __future__ import annotations

from collections.abc import Callable

import gymnasium
import numpy as np

from . import Ping, Pose, Simulation


def distance_ahead(ping: Ping, half_sector: float = np.radians(15), below_loudest_db: float = 20) -> float:
    """Slant range of the nearest echo within a sector ahead that is so far below the loudest there at most [m]; infinite
    where there is none."""
    ahead = np.abs(ping.bearings) <= half_sector
    loudest = np.nan_to_num(ping.bins[ahead]).max(axis=0, initial=0)
    heard = np.nonzero(loudest > max(loudest.max(initial=0) * 10 ** (-below_loudest_db / 10), 0))[0]
    return float(ping.ranges[heard[0]]) if heard.size else float("inf")


def _progress(ping: Ping, before: Pose, now: Pose) -> float:
    """Metres made good along the x axis of the world."""
    return float(now.position[0] - before.position[0])


class SonarEnv(gymnasium.Env):
    """One vehicle with one sonar.

    An action is the velocity of the vehicle in its own axes and its rate of turn, (ahead, port, up, turn to port), each
    from -1 to 1 of `max_speed` [m/s] and `max_turn` [rad/s]; it stays level. An observation is the ping as levels,
    uint8 [beams, bins]: 0 at `floor_db`, 255 at 0 dB of the loudest bin a first ping had. The episode ends where
    something is nearer ahead than `collision_range` [m], and is cut off after `max_steps`.

    :param start: where episodes begin; `scatter` [m] moves it at random in x and y.
    :param reward: of a ping, the pose before and the pose now; None: metres made good along x.
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

    def _levels(self, ping: Ping) -> np.ndarray:
        floor = 10 ** (self._floor_db / 10)
        db = 10 * np.log10(np.maximum(np.nan_to_num(ping.bins) / self._reference, floor))
        return np.clip(255 * (1 - db / self._floor_db), 0, 255).astype(np.uint8)

    def reset(self, *, seed: int | None = None, options: dict | None = None):
        super().reset(seed=seed)
        aside = self.np_random.uniform(-self._scatter, self._scatter, 2)
        self._pose = Pose(self._start.position + [*aside, 0], self._start.orientation_wxyz)
        self._simulation.reset(int(self.np_random.integers(1, 2**31)))
        self._begin(self._simulation.step(self._pose))
        return self._levels(self._ping), self._info()

    def step(self, action):
        before, self._pose = self._pose, self._moved(np.clip(np.asarray(action, float), -1, 1) * self._speeds)
        self._ping = self._simulation.step(self._pose)
        self._steps += 1
        terminated = distance_ahead(self._ping) < self._collision_range
        reward = float(self._reward(self._ping, before, self._pose))
        return self._levels(self._ping), reward, terminated, self._steps >= self._max_steps, self._info()

    def _moved(self, velocity: np.ndarray) -> Pose:
        matrix = self._pose.matrix()
        turn = velocity[3] * self._period
        half = turn / 2
        w, x, y, z = self._pose.orientation_wxyz
        c, s = np.cos(half), np.sin(half)  # about the world's vertical
        turned = [c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w]
        return Pose(self._pose.position + matrix[:3, :3] @ velocity[:3] * self._period, turned)

    def _info(self) -> dict:
        return {"pose": self._pose, "time": self._ping.time, "distance_ahead": distance_ahead(self._ping)}

    def render(self) -> np.ndarray | None:
        return self._ping.fan() if self.render_mode == "rgb_array" else None
