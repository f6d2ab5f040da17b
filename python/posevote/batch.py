"""Recognition in many pictures on many processors and machines, with Dask.

    posevote batch pictures/ --db objects.db --out results.jsonl

The results are lines of JSON as of `posevote recognize --json`, in the order of the pictures. What
was stopped goes on where it was; each picture has exactly one line.
"""

import argparse
import importlib.util
import json
import logging
import os
import sys
import time
from collections import deque
from concurrent.futures import CancelledError

import posevote
from posevote import _core
from posevote.batch_results import Results
from posevote.batch_work import Job, error_line, objects_hash, run_task, tasks_of

ATTEMPTS_ALONE = 2  # a picture that kills this many workers while nothing else runs is poisonous


class Progress:
    """A bar on standard error, on terminals only."""

    def __init__(self, total):
        self.total, self.done, self.shown = total, 0, sys.stderr.isatty()
        self.begin, self.before = time.monotonic(), 0

    def advance(self, worked):
        """`worked`: False for what an earlier run has done."""
        self.done += 1
        self.before += not worked
        if self.shown:
            filled = 30 * self.done // max(self.total, 1)
            bar = "=" * filled + ">" + " " * (30 - filled)
            text = f"recognising [{bar}] {self.done}/{self.total}{self.pace()}"
            print(f"\r{text}\033[K", end="", file=sys.stderr, flush=True)

    def pace(self):
        done, seconds = self.done - self.before, time.monotonic() - self.begin
        if done < 10 or seconds < 1:
            return ""
        left = round((self.total - self.done) * seconds / done)
        hours, minutes = left // 3600, left % 3600 // 60
        return f", {done / seconds:.1f}/s, {hours}:{minutes:02}:{left % 60:02} left"

    def close(self):
        if self.shown:
            print("\r\033[K", end="", file=sys.stderr, flush=True)


class Batch:
    """Hands tasks to workers, a window at a time, and writes their lines in order."""

    def __init__(self, client, job, results, say):
        self.client, self.job, self.results, self.say = client, job, results, say
        self.window = max(8, 4 * sum(client.nthreads().values()))
        self.failed = 0
        self.number = 0  # makes keys unique, so that nothing is taken for something done before

    def submit(self, task):
        self.number += 1
        key = f"recognize-{os.getpid()}-{id(self)}-{self.number}"
        return self.client.submit(run_task, self.job, task, key=key, pure=False)

    def alone(self, task):
        """The lines of a task that was in hand when a worker died; nothing else runs meanwhile."""
        from distributed.scheduler import KilledWorker

        for _ in range(ATTEMPTS_ALONE):
            try:
                return self.submit(task).result()
            except KilledWorker:
                continue
        self.say(f"{task.name()} is set aside: workers die of it")
        return [error_line(task.path, "set aside: workers that read this picture die")]

    def run(self, tasks, progress):
        from distributed.scheduler import KilledWorker

        waiting = deque(tasks)  # (task, error line or None)
        flying = deque()  # (task, future or lines), in order
        while waiting or flying:
            while waiting and len(flying) < self.window:
                task, error = waiting.popleft()
                known, done = self.results.take_up(task)
                if done:
                    flying.append((task, 0, []))
                else:
                    flying.append((task, known, [error] if error else self.submit(task)))
            task, known, future = flying.popleft()
            if isinstance(future, list):
                lines = future
            else:
                try:
                    lines = future.result()
                except KilledWorker:
                    # Whose fault it was is not known yet. The others come to their end first.
                    flying = deque(self.settle(entry) for entry in flying)
                    lines = self.alone(task)
            self.finish(lines, known)
            progress.advance(worked=bool(lines))

    def settle(self, entry):
        """A task in flight with its lines, or as it was when a worker died of it, too."""
        from distributed.scheduler import KilledWorker

        task, known, future = entry
        if isinstance(future, list):
            return entry
        try:
            return task, known, future.result()
        except KilledWorker:
            return entry

    def finish(self, lines, known):
        lines = lines[known:]  # without those of a video's part that are there already
        self.failed += sum('"error":' in line and "error" in json.loads(line) for line in lines)
        self.results.write(lines)


def open_client(scheduler, workers):
    """A client of the scheduler, or of a cluster of this machine's own."""
    try:
        import dask
        from distributed import Client, LocalCluster
    except ImportError:
        raise posevote.UnsupportedError(
            "posevote batch needs Dask; install it: apt install python3-distributed"
        ) from None
    # What goes wrong is said in a sentence; Dask would show where in its own code it noticed.
    for name in ("distributed", "distributed.client", "tornado.application", "asyncio"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    if scheduler:
        try:
            return Client(scheduler, timeout="30s"), None
        except (OSError, TimeoutError, ValueError) as error:
            raise posevote.IoError(f"no scheduler answers at '{scheduler}': {error}") from None
    # OpenCV's own threads would work on the cores of the other workers.
    os.environ.setdefault("OPENCV_FOR_THREADS_NUM", "1")
    # A process for each core: a picture that kills its worker kills nobody else's work. Of a worker
    # that dies twice nothing would be learned; a busy machine may take long to start one.
    dask.config.set(
        {
            "distributed.scheduler.allowed-failures": 0,
            "distributed.comm.timeouts.connect": "120s",
            "distributed.comm.timeouts.tcp": "120s",
        }
    )
    cluster = LocalCluster(
        n_workers=workers or len(os.sched_getaffinity(0)),
        threads_per_worker=1,
        processes=True,
        silence_logs=50,
        dashboard_address="127.0.0.1:0",
    )
    return Client(cluster), cluster


def belonging(job):
    """What lines in one file have in common."""
    return {
        "objects": job.objects,
        "preset": job.preset,
        "settings": list(job.settings),
        "every": job.every,
        "posevote": posevote.__version__,
    }


def dashboard(client):
    """Address of Dask's own pages: its plots, or its plain pages when bokeh is not there."""
    if importlib.util.find_spec("bokeh"):
        return client.dashboard_link
    return client.dashboard_link.removesuffix("/status") + "/info/main/workers.html"


def say(sentence):
    print("posevote: " + _core._without_passwords(str(sentence)), file=sys.stderr)


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="posevote batch",
        description="Recognise in many pictures on many processors.",
        epilog="On a terminal the address of Dask's pages is shown: its dashboard where bokeh is "
        "installed (Debian 12 has no package of it), else its plain pages on workers and tasks.",
    )
    parser.add_argument("inputs", nargs="*", metavar="INPUT", help="pictures, folders, videos")
    parser.add_argument("--list", help="file with an INPUT a line; -: standard input")
    parser.add_argument("--db", default=os.environ.get("POSEVOTE_DB"), help="database of objects")
    parser.add_argument("--out", required=True, help="file of results, a line of JSON each")
    parser.add_argument("--scheduler", help="address of a Dask scheduler; default: this machine")
    parser.add_argument("--workers", type=int, default=0, help="processes here; 0: one per core")
    parser.add_argument("--every", type=int, default=1, help="of videos, only every N-th frame")
    parser.add_argument("--preset", default="default")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE")
    parser.add_argument("--restart", action="store_true", help="begin the file of results again")
    given = sys.argv[1:] if arguments is None else arguments
    found = parser.parse_args(given)
    if any(_core._without_passwords(word) != word for word in given):
        parser.error(
            "everybody sees a password in the list of processes: put it into ~/.pgpass, "
            "or the address into $POSEVOTE_DB"
        )
    if found.list:
        lines = sys.stdin if found.list == "-" else open(found.list, encoding="utf-8")
        found.inputs += [line.rstrip("\n") for line in lines if line.strip()]
    if not found.inputs:
        parser.error("name pictures, folders or videos")
    if not found.db:
        parser.error("name a database with --db")
    if found.every < 1 or found.workers < 0:
        parser.error("--every must be at least 1, --workers at least 0")
    return found


def run(found):
    database = found.db if "://" in found.db else os.path.abspath(found.db)
    # Whatever is wrong with options or database is said before anything is made.
    posevote.Recognizer({}, preset=found.preset, **_core._settings(found.preset, found.set))
    with posevote.ObjectStore(database, "read_only") as store:
        objects = objects_hash(store)
    job = Job(database, os.getcwd(), found.preset, tuple(found.set), found.every, objects)
    tied_to = belonging(job)
    tasks = list(tasks_of(found.inputs))
    results = Results(found.out, tied_to, found.restart)
    client, cluster = open_client(found.scheduler, found.workers)
    from distributed.comm import CommClosedError

    progress = Progress(len(tasks))
    batch = Batch(client, job, results, say)
    try:
        if progress.shown:
            print(f"dashboard: {dashboard(client)}", file=sys.stderr)
        batch.run(tasks, progress)
    except CommClosedError as error:
        raise CancelledError from error
    finally:
        progress.close()
        results.close()
        client.close()
        if cluster:
            cluster.close()
    if batch.failed:
        say(f"{batch.failed} lines of '{found.out}' are errors")
    return 1 if batch.failed else 0


def main(arguments=None):
    found = parse(arguments)
    try:
        return run(found)
    except (posevote.Error, OSError) as error:
        say(error)
        return 1
    except CancelledError:
        say("the scheduler is gone; run it again to go on")
        return 1
    except KeyboardInterrupt:
        say("stopped; run it again to go on")
        return 1


if __name__ == "__main__":
    sys.exit(main())
