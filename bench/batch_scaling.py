"""How much faster is posevote batch with more workers?

    PYTHONPATH=build/release/python /usr/bin/python3 bench/batch_scaling.py DB PICTURES [WORKERS...]

PICTURES is a folder; WORKERS: numbers of processes, default 1 2. Prints pictures per second between
the first result and the last, so that starting Dask does not count, and the processors' time for
each picture. Numbers mean something on a machine that does nothing else.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path


def lines_in(path):
    return path.read_bytes().count(b"\n") if path.exists() else 0


def cpu_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def measure(database, pictures, workers, total, scratch):
    out = Path(scratch) / f"{workers}.jsonl"
    before = cpu_s()
    command = [sys.executable, "-m", "posevote.batch", pictures, "--db", database]
    process = subprocess.Popen([*command, "--out", str(out), "--workers", str(workers)])
    first = last = None
    while process.poll() is None:
        count, now = lines_in(out), time.perf_counter()
        if count and not first:
            first = count, now
        if count and (not last or count > last[0]):
            last = count, now
        time.sleep(0.01)
    if not first or last[0] == first[0]:
        raise SystemExit(f"too few pictures to measure with: {total}")
    rate = (last[0] - first[0]) / (last[1] - first[1])
    return rate, 1000 * (cpu_s() - before) / total


def main(database, pictures, *workers):
    total = len(os.listdir(pictures))
    base = None
    print("workers  pictures/s  times one  processor ms/picture, start included")
    with tempfile.TemporaryDirectory() as scratch:
        for count in map(int, workers or ("1", "2")):
            rate, cpu_ms = measure(database, pictures, count, total, scratch)
            base = base or rate / count
            print(f"{count:7}  {rate:10.2f}  {rate / base:9.2f}  {cpu_ms:.0f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
