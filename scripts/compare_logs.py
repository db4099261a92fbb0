"""Prints how the pings of two runs differ, stream by stream: scripts/compare_logs.py FOLDER OTHER, with the module `insonify`."""
import pathlib
import sys

import insonify
import numpy as np

folder, other = map(pathlib.Path, sys.argv[1:])
for file in sorted(folder.glob("*.log")):
    ours, theirs = insonify.read_log(file), insonify.read_log(other / file.name)
    for name, stream in ours.items():
        pings = [(ping.bins, again.bins) for ping, again in zip(stream, theirs[name]) if isinstance(ping, insonify.Ping)]
        if not pings:
            continue
        a, b = (np.concatenate([each.ravel() for each in side]).astype(float) for side in zip(*pings))
        differ = np.count_nonzero(a != b)
        print(
            f"{file.stem} {name}: {len(pings)} pings, {differ} of {a.size} bins differ; relative L2 "
            f"{np.linalg.norm(a - b) / np.linalg.norm(a):.1e}, at most {np.abs(a - b).max() / a.max():.1e} of the loudest"
        )
