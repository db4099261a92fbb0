#!/usr/bin/env python3
"""Makes the shards of a run, or of a data set, on workers of Ray. What stands after -- is the command without its --shard:

    scripts/dataset_ray.py --shards 16 --workers 2 -- insonify run deploy/x.yml --pings 1600 --out DIR
    scripts/dataset_ray.py --shards 16 --address auto -- insonify dataset ...

All workers see the same DIR. A shard whose worker dies goes to another one; called again, it makes what is missing. A line
is printed for each shard that is done; the exit code is 1 where one has failed. Needs PyPI's ray."""
import argparse
import os
import subprocess
import sys

import ray


def make(command, index, shards):
    """Makes one shard, on a worker."""
    done = subprocess.run([*command, "--shard", f"{index}/{shards}"], capture_output=True, text=True)
    return index, done.returncode, done.stderr.strip()


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shards", type=int, required=True, help="parts that the work is cut into")
    parser.add_argument("--workers", type=int, default=1, help="processes on this machine")
    parser.add_argument("--address", help="of a cluster that runs, in place of processes here")
    parser.add_argument("--gpus", type=float, default=0, help="of a worker, where visibility: gl is to draw on them")
    parser.add_argument("command", nargs="+", help="after --: insonify run or dataset, with --out")
    return parser.parse_args()


def main():
    args = parse()
    if args.address:
        ray.init(address=args.address, log_to_driver=False)
    else:
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")  # it tells its makers of its use otherwise
        # Nothing but exit codes and texts is kept in memory.
        ray.init(num_cpus=args.workers, include_dashboard=False, log_to_driver=False, object_store_memory=100_000_000)
    # One shard a processor at a time; a shard whose worker dies goes to another, at most four times.
    task = ray.remote(num_cpus=1, num_gpus=args.gpus, max_retries=4)(make)
    waiting = [task.remote(args.command, index, args.shards) for index in range(args.shards)]
    failed = 0
    while waiting:
        done, waiting = ray.wait(waiting)
        try:
            index, code, told = ray.get(done[0])
        except ray.exceptions.RayError as error:
            failed += 1
            print(f"a shard was given up: {error}", file=sys.stderr)
            continue
        failed += code != 0
        print(f"shard {index}/{args.shards}: {'done' if code == 0 else f'exit code {code}: {told}'}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
