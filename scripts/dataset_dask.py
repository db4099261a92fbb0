#!/usr/bin/env python3
"""Makes the shards of a run, or of a data set, on workers of Dask. What stands after -- is the command without its --shard:

    scripts/dataset_dask.py --shards 16 --workers 2 -- insonify run deploy/x.yml --pings 1600 --out DIR
    scripts/dataset_dask.py --shards 16 --scheduler tcp://HOST:8786 -- insonify dataset ...

All workers see the same DIR. A shard whose worker dies goes to another one; called again, it makes what is missing. A line
is printed for each shard that is done; the exit code is 1 where one has failed. Needs PyPI's distributed."""
import argparse
import subprocess
import sys

from distributed import Client, KilledWorker, LocalCluster, as_completed


def make(command, index, shards):
    """Makes one shard, on a worker."""
    done = subprocess.run([*command, "--shard", f"{index}/{shards}"], capture_output=True, text=True)
    return index, done.returncode, done.stderr.strip()


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--shards", type=int, required=True, help="parts that the work is cut into")
    parser.add_argument("--workers", type=int, default=1, help="processes on this machine")
    parser.add_argument("--scheduler", help="address of a cluster that runs, in place of processes here")
    parser.add_argument("command", nargs="+", help="after --: insonify run or dataset, with --out")
    return parser.parse_args()


def main():
    args = parse()
    # One shard a worker at a time; a shard whose worker dies goes to another, at most three times.
    cluster = args.scheduler or LocalCluster(n_workers=args.workers, threads_per_worker=1, dashboard_address=None)
    failed = 0
    with Client(cluster) as client:
        shards = [client.submit(make, args.command, index, args.shards, pure=False) for index in range(args.shards)]
        for shard in as_completed(shards):
            try:
                index, code, told = shard.result()
            except (KilledWorker, OSError) as error:    # no worker outlived it, or none has the command
                failed += 1
                print(f"a shard was given up: {error}", file=sys.stderr)
                continue
            failed += code != 0
            print(f"shard {index}/{args.shards}: {'done' if code == 0 else f'exit code {code}: {told}'}", flush=True)
    if not args.scheduler:
        cluster.close()
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
