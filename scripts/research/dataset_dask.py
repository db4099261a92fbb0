#!/usr/bin/env python3
"""Makes the shards of a run, or of a data set, on workers of Dask. After -- follows the command without its --shard:

    scripts/research/dataset_dask.py --shards 16 --workers 2 -- insonify run deploy/x.yml --pings 1600 --out DIR
    scripts/research/dataset_dask.py --shards 16 --scheduler tcp://HOST:8786 -- insonify dataset ...

All workers must see the same DIR. If a worker dies, another worker makes its shard. Called again, the script makes the missing shards.
It prints a line for each finished shard; the exit code is 1 if a shard has failed. Needs PyPI's distributed."""
import subprocess
import sys

import shard_workers
from distributed import Client, KilledWorker, LocalCluster, as_completed


def make(command, index, shards):
    """Makes one shard. Only this function is sent to the worker."""
    done = subprocess.run([*command, "--shard", f"{index}/{shards}"], capture_output=True, text=True)
    return index, done.returncode, done.stderr.strip()


def main():
    parser = shard_workers.parser(__doc__)
    parser.add_argument("--scheduler", help="address of a running cluster, instead of processes on this machine")
    args = parser.parse_args()
    # One shard per worker at a time; a shard whose worker dies is given to another, at most three times.
    cluster = args.scheduler or LocalCluster(n_workers=args.workers, threads_per_worker=1, dashboard_address=None)
    given_up = (KilledWorker, OSError)    # no worker survived it, or none has the command
    with Client(cluster) as client:
        shards = [client.submit(make, args.command, index, args.shards, pure=False) for index in range(args.shards)]
        done = [shard_workers.report(shard.result, given_up, args.shards) for shard in as_completed(shards)]
    if not args.scheduler:
        cluster.close()
    return 0 if all(done) else 1


if __name__ == "__main__":
    sys.exit(main())
