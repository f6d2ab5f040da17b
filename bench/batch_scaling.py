"""How much faster is posevote batch with more workers, and how much faster could it be?

    PYTHONPATH=build/release/python /usr/bin/python3 bench/batch_scaling.py DB PICTURES [WORKERS...]

PICTURES is a folder; WORKERS: numbers of processes, default 1 2. For each prints pictures per second

- of plain processes that share nothing and have their pictures given beforehand: what the machine
  can do;
- of posevote batch, between the first result and the last, so that starting Dask does not count,
  and the processors' time for each picture, with everything.

Numbers mean something on a machine that does nothing else.
"""

import multiprocessing
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from posevote import batch_work


def lines_in(path):
    return path.read_bytes().count(b"\n") if path.exists() else 0


def cpu_s():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def recognise_all(database, pictures, ready):
    job = batch_work.Job(database)
    batch_work.recognizer_of(job)
    ready.wait()
    for picture in pictures:
        batch_work.picture_line(job, picture)


def plain_rate(database, pictures, processes):
    context = multiprocessing.get_context("spawn")
    ready = context.Barrier(processes + 1)
    running = [
        context.Process(target=recognise_all, args=(database, pictures[i::processes], ready))
        for i in range(processes)
    ]
    for process in running:
        process.start()
    ready.wait()
    begin = time.perf_counter()
    for process in running:
        process.join()
    return len(pictures) / (time.perf_counter() - begin)


def batch_rate(database, pictures, workers, scratch):
    out = Path(scratch) / "found.jsonl"
    names = Path(scratch) / "pictures.txt"
    names.write_text("".join(picture + "\n" for picture in pictures))
    before = cpu_s()
    command = [sys.executable, "-m", "posevote.batch", "--list", str(names), "--db", database]
    process = subprocess.Popen([*command, "--out", str(out), "--workers", str(workers)])
    first = last = None
    while process.poll() is None:
        count, now = lines_in(out), time.perf_counter()
        if count and not first:
            first = count, now
        if count and (not last or count > last[0]):
            last = count, now
        time.sleep(0.02)
    if not first or last[0] == first[0]:
        raise SystemExit(f"too few pictures to measure with: {len(pictures)}")
    rate = (last[0] - first[0]) / (last[1] - first[1])
    return rate, 1000 * (cpu_s() - before) / len(pictures)


def main(database, folder, *workers):
    os.environ["OPENCV_FOR_THREADS_NUM"] = "1"  # a process is one core, as it is in a batch
    pictures = sorted(str(Path(folder, name).absolute()) for name in os.listdir(folder))
    database = str(Path(database).absolute())
    base = None
    print("workers   plain/s  times one   batch/s  times one  processor ms/picture, start included")
    for count in map(int, workers or ("1", "2")):
        plain = plain_rate(database, pictures, count)
        with tempfile.TemporaryDirectory() as scratch:
            rate, cpu_ms = batch_rate(database, pictures, count, scratch)
        base = base or (plain / count, rate / count)
        print(
            f"{count:7}  {plain:8.2f}  {plain / base[0]:9.2f}  {rate:8.2f}  {rate / base[1]:9.2f}"
            f"  {cpu_ms:.0f}",
            flush=True,
        )


if __name__ == "__main__":
    main(*sys.argv[1:])
