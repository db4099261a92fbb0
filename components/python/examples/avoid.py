"""Learns to keep clear of obstacles by sonar: a vehicle in the harbour is steered by the nearest echo in each of
eight sectors, through sixteen weights that the cross-entropy method finds (Rubinstein 1999). Needs gymnasium.

    python components/python/examples/avoid.py            # about a minute on two cores
"""

import argparse

import numpy as np

import insonify
import insonify.gym

SECTORS = 8
FAN = {  # level and so flat that it receives obstacles, and not the floor
    "scene.mount": {"position": [0.4, 0, 0]},
    "sonar.beam_count": 96,
    "sonar.bin_count": 128,
    "sonar.beam_height_deg": 8,
    "sonar.range": 20,
    "sonar.quality": {"rows": 64, "columns_per_beam": 1},
}


def nearest(observations, threshold=130):
    """Proximity of the nearest strong echo in each sector, starboard first [vehicles, sectors]: 1 at the sonar, 0
    for none."""
    vehicles, beams, bins = observations.shape
    strong = (observations.reshape(vehicles, SECTORS, beams // SECTORS, bins) > threshold).any(axis=2)
    return np.where(strong.any(axis=2), 1 - strong.argmax(axis=2) / bins, 0)


def steer(weights, observations):
    """Straight ahead at full speed, turning by a weighted sum of the proximities; slower by another
    weighted sum."""
    seen = nearest(observations)
    turn = np.tanh(np.einsum("ij,ij->i", weights[:, :SECTORS], seen))
    ahead = 1 - np.clip(np.einsum("ij,ij->i", weights[:, SECTORS:], seen), 0, 0.9)
    return np.stack([ahead, 0 * turn, 0 * turn, turn], axis=1)


def travelled(env, weights, steps, seed):
    """Distance that each vehicle covers before it meets something or time is up [m]."""
    observations, _ = env.reset(seed=seed)
    way, alive = np.zeros(env.num_envs), np.ones(env.num_envs, bool)
    for _ in range(steps):
        observations, rewards, terminated, _, _ = env.step(steer(weights, observations))
        way += np.where(alive, rewards, 0)
        alive &= ~terminated
        if not alive.any():
            break
    return way


def learn(deployment, vehicles, rounds, steps, seed):
    rng = np.random.default_rng(seed)
    env = insonify.gym.SonarVectorEnv(
        deployment,
        insonify.Pose.from_euler([4, -6, -5.5], yaw=1.0),  # towards the quay
        vehicles,
        overrides=FAN,
        scatter=3,
        max_steps=steps + 1,
        max_turn=0.5,
        collision_range=2,
        reward=lambda pings, before, now: np.linalg.norm(now - before, axis=1),
    )
    mean, spread = np.zeros(2 * SECTORS), np.ones(2 * SECTORS)
    untrained = travelled(env, np.tile(mean, (vehicles, 1)), steps, seed).mean()
    print(f"straight ahead: {untrained:.1f} m")
    for number in range(rounds):
        weights = rng.normal(mean, spread, (vehicles, 2 * SECTORS))
        way = travelled(env, weights, steps, seed + number + 1)
        best = weights[np.argsort(way)[-vehicles // 4 :]]
        mean, spread = best.mean(axis=0), best.std(axis=0) + 0.1
        print(f"round {number + 1}: {way.mean():.1f} m in the mean, {way.max():.1f} m at most", flush=True)
    trained = travelled(env, np.tile(mean, (vehicles, 1)), steps, seed).mean()
    print(f"with what was learnt: {trained:.1f} m, {trained / untrained:.1f} times as far")
    return untrained, trained


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deployment", nargs="?", default="deploy/harbour_fls.yml")
    parser.add_argument("--vehicles", type=int, default=32)
    parser.add_argument("--rounds", type=int, default=10)
    parser.add_argument("--steps", type=int, default=80, help="of an episode, half a second each")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    learn(options.deployment, options.vehicles, options.rounds, options.steps, options.seed)
