#!/usr/bin/env python3
"""Makes the shards of a run, or of a data set, on workers of Dask. What stands after -- is the command without its --shard:

    scripts/dataset_dask.py --shards 16 --workers 2 -- insonify run deploy/x.yml --pings 1600 --out DIR
    scripts/dataset_dask.py --shards 16 --scheduler tcp://HOST:8786 -- insonify dataset ...

All workers see the same DIR. A shard whose worker dies goes to another one; called again, it makes what is missing. A line
is printed for each shard that is done; the exit code is 1 where one has failed. Needs PyPI's distributed."""
import subprocess
import sys

import shard_workers
from distributed import Client, KilledWorker, LocalCluster, as_completed


def make(command, index, shards):
    """Makes one shard, on a worker, which has this function alone."""
    done = subprocess.run([*command, "--shard", f"{index}/{shards}"], capture_output=True, text=True)
    return index, done.returncode, done.stderr.strip()


def main():
    parser = shard_workers.parser(__doc__)
    parser.add_argument("--scheduler", help="address of a cluster that runs, in place of processes here")
    args = parser.parse_args()
    # One shard a worker at a time; a shard whose worker dies goes to another, at most three times.
    cluster = args.scheduler or LocalCluster(n_workers=args.workers, threads_per_worker=1, dashboard_address=None)
    given_up = (KilledWorker, OSError)    # no worker outlived it, or none has the command
    with Client(cluster) as client:
        shards = [client.submit(make, args.command, index, args.shards, pure=False) for index in range(args.shards)]
        done = [shard_workers.tell(shard.result, given_up, args.shards) for shard in as_completed(shards)]
    if not args.scheduler:
        cluster.close()
    return 0 if all(done) else 1


if __name__ == "__main__":
    sys.exit(main())
