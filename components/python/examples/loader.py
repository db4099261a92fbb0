"""Batches of pings from several processes, for training: by PyTorch's DataLoader where torch is installed, otherwise by a
pool of multiprocessing, which forks in the same way.

    python components/python/examples/loader.py deploy/harbour_fls.yml --pings 64 --workers 2
"""

import argparse
import multiprocessing
import os

import numpy as np

import insonify


class Pings:
    """Pings at random poses, and the object that each bin shows: a map-style data set of PyTorch.

    Item `i` depends on the seed and on `i` alone, whichever process makes it. A simulation does not follow a fork, so each
    process makes its own at its first item: also after the parent has looked at one.
    """

    def __init__(self, deployment, count, seed=1, overrides=None):
        self._made_of, self._count, self._seed = (str(deployment), seed, overrides), count, seed
        self._process = self._simulation = None

    def __len__(self):
        return self._count

    def __getstate__(self):  # for `spawn`: a simulation cannot be sent to another process
        return self.__dict__ | {"_process": None, "_simulation": None}

    def __getitem__(self, index):
        if not 0 <= index < self._count:
            raise IndexError(index)
        if self._process != os.getpid():
            self._process, self._simulation = os.getpid(), insonify.Simulation(*self._made_of, truth=True)
        rng = np.random.default_rng([self._seed, index])
        self._simulation.reset(int(rng.integers(1, 2**63)))
        pose = insonify.Pose.from_euler([rng.uniform(0, 20), rng.uniform(-8, 0), -5.5], yaw=rng.uniform(-1, 0.5))
        ping = self._simulation.step(pose)
        return ping.bins.copy(), ping.truth.object.astype(np.int64)


_data = None


def _hold(data):
    global _data
    _data = data


def _batch(indices):
    return tuple(np.stack(arrays) for arrays in zip(*(_data[i] for i in indices)))


def batches(data, size, workers, method="fork"):
    """Yields bins [size, beams, bins] and objects of the same shape, in order: tensors with torch, otherwise arrays."""
    try:
        from torch.utils.data import DataLoader
    except ImportError:
        numbers = [range(len(data))[i : i + size] for i in range(0, len(data), size)]
        with multiprocessing.get_context(method).Pool(workers, _hold, (data,)) as pool:
            yield from pool.imap(_batch, numbers)
    else:
        yield from DataLoader(data, batch_size=size, num_workers=workers, multiprocessing_context=method)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("deployment", nargs="?", default="deploy/harbour_fls.yml")
    parser.add_argument("--pings", type=int, default=64)
    parser.add_argument("--batch", type=int, default=8)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--method", choices=multiprocessing.get_all_start_methods(), default="fork")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    pings = Pings(options.deployment, options.pings, options.seed, {"sonar.beam_count": 96, "sonar.bin_count": 128})
    print(f"the parent looks at the first: {pings[0][0].shape}")
    for number, (bins, objects) in enumerate(batches(pings, options.batch, options.workers, options.method)):
        print(f"batch {number}: {tuple(bins.shape)}, {int((objects >= 0).sum())} bins show an object", flush=True)
