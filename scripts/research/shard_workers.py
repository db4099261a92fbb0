"""Shared by dataset_dask.py and dataset_ray.py: options, and the output per shard."""
import argparse
import sys


def parser(text):
    """A parser of the common options."""
    options = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--shards", type=int, required=True, help="parts that the work is cut into")
    options.add_argument("--workers", type=int, default=1, help="processes on this machine")
    options.add_argument("command", nargs="+", help="after --: insonify run or dataset, with --out")
    return options


def report(get, given_up, shards):
    """Prints the result of `get()`, (shard index, exit code, error output), or that it raised `given_up`;
    returns whether the shard is done."""
    try:
        index, code, errors = get()
    except given_up as error:
        print(f"a shard was given up: {error}", file=sys.stderr)
        return False
    print(f"shard {index}/{shards}: {'done' if code == 0 else f'exit code {code}: {errors}'}", flush=True)
    return code == 0
