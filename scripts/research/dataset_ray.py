#!/usr/bin/env python3
"""Makes the shards of a run, or of a data set, on workers of Ray. After -- follows the command without its --shard:

    scripts/research/dataset_ray.py --shards 16 --workers 2 -- insonify run deploy/x.yml --pings 1600 --out DIR
    scripts/research/dataset_ray.py --shards 16 --address auto -- insonify dataset ...

All workers must see the same DIR. If a worker dies, another worker makes its shard. Called again, the script makes the missing shards.
It prints a line for each finished shard; the exit code is 1 if a shard has failed. Needs PyPI's ray."""
import os
import subprocess
import sys

import ray
import shard_workers


def make(command, index, shards):
    """Makes one shard. Only this function is sent to the worker."""
    done = subprocess.run([*command, "--shard", f"{index}/{shards}"], capture_output=True, text=True)
    return index, done.returncode, done.stderr.strip()


def main():
    parser = shard_workers.parser(__doc__)
    parser.add_argument("--address", help="of a running cluster, instead of processes on this machine")
    parser.add_argument("--gpus", type=float, default=0, help="of a worker, where visibility: gl is to draw on them")
    args = parser.parse_args()
    if args.address:
        ray.init(address=args.address, log_to_driver=False)
    else:
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # otherwise it reports its use to its makers
        # Only exit codes and texts are kept in memory.
        ray.init(num_cpus=args.workers, include_dashboard=False, log_to_driver=False, object_store_memory=100_000_000)
    # One shard per processor at a time; a shard whose worker dies is given to another, at most four times.
    task = ray.remote(num_cpus=1, num_gpus=args.gpus, max_retries=4)(make)
    waiting = [task.remote(args.command, index, args.shards) for index in range(args.shards)]
    all_done = True
    while waiting:
        (shard,), waiting = ray.wait(waiting)
        all_done &= shard_workers.report(lambda: ray.get(shard), ray.exceptions.RayError, args.shards)
    return 0 if all_done else 1


if __name__ == "__main__":
    sys.exit(main())
