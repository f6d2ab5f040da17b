"""Recognition in many pictures on many processors and machines, with Dask.

    posevote batch pictures/ --db objects.db --out results.jsonl
    python3 -m posevote.batch pictures/ --db objects.db --out results.jsonl

The results are lines of JSON as of `posevote recognize --json`, in the order of the pictures. What
was stopped goes on where it was; each picture has exactly one line.
"""

import argparse
import hashlib
import importlib.util
import json
import os
import re
import sys
import threading
from collections import deque
from dataclasses import dataclass, field
from pathlib import Path

import posevote
from posevote import _core

FRAMES_PER_TASK = 300  # a worker decodes a video from its beginning to its part
ATTEMPTS_ALONE = 2  # a picture that kills this many workers while nothing else runs is poisonous


# --- What a worker does --------------------------------------------------------------------------


@dataclass(frozen=True)
class Job:
    """What is looked for, and how. Its text, which Dask writes into logs, holds no password."""

    database: str = field(repr=False)
    folder: str = ""  # what relative names of pictures are relative to
    preset: str = "default"
    settings: tuple = ()
    every: int = 1


_recognizers = {}
_loading = threading.Lock()


def recognizer_of(job):
    """The job's recogniser: loaded once in each worker, whatever the number of its threads."""
    with _loading:
        if job not in _recognizers:
            with posevote.ObjectStore(job.database, "read_only") as store:
                options = keywords(job.preset, job.settings)
                made = posevote.Recognizer(store, preset=job.preset, **options)
            _recognizers.clear()  # of an earlier job
            _recognizers[job] = made
        return _recognizers[job]


def error_line(path, error):
    return json.dumps({"image": path, "error": str(error)}, ensure_ascii=False)


def picture_line(job, path):
    """The line of a picture. Whatever is wrong with it concerns no other."""
    recognizer = recognizer_of(job)
    try:
        return recognizer.recognize(posevote.read_image(Path(job.folder, path))).to_json(path)
    except Exception as error:
        return error_line(path, error)


def video_lines(job, path, begin, end):
    """Lines of the frames in [begin, end), the last one an error if it cannot be read so far."""
    recognizer = recognizer_of(job)
    lines = []
    try:
        for frame in posevote.Video(Path(job.folder, path)):
            if frame.number >= end:
                break
            if frame.number >= begin and frame.number % job.every == 0:
                line = recognizer.recognize(frame.image).to_dict(path)
                line.update(frame=frame.number, time_s=frame.time_s)
                lines.append(json.dumps(line, ensure_ascii=False))
    except Exception as error:
        lines.append(error_line(path, error))
    return lines


def run_task(job, task):
    """The lines of one task: a picture, or a part of a video."""
    if task.end:
        return video_lines(job, task.path, task.begin, task.end)
    return [picture_line(job, task.path)]


# --- What there is to do -------------------------------------------------------------------------


@dataclass(frozen=True)
class Task:
    path: str
    begin: int = 0  # frames of a video; end 0: a picture
    end: int = 0

    def name(self):
        return f"{self.path}, frames {self.begin} to {self.end - 1}" if self.end else self.path


def tasks_of(arguments):
    """Tasks of folders, pictures and videos, in the order given; for others an error line."""
    for argument in arguments:
        try:
            inputs = _core._expand_input(argument)
        except posevote.Error as error:
            yield Task(argument), error_line(argument, error)
            continue
        for kind, path in inputs:
            if kind == "camera":
                raise posevote.InvalidArgumentError("a camera has no end: it is no work for batch")
            if kind == "image":
                yield Task(path), None
                continue
            try:
                length = posevote.Video(path).length
            except posevote.Error as error:
                yield Task(path), error_line(path, error)
                continue
            # A file that does not say how long it is is one task.
            parts = range(0, length, FRAMES_PER_TASK) if length else [0]
            for begin in parts:
                last = begin + FRAMES_PER_TASK >= length
                end = sys.maxsize if last or not length else begin + FRAMES_PER_TASK
                yield Task(path, begin, end), None


def keywords(preset, settings):
    """NAME=VALUE texts as keywords of the right types."""
    known = {option["name"]: option["default"] for option in _core._recognize_options(preset)}
    found = {}
    for setting in settings:
        name, equals, text = setting.partition("=")
        if not equals:
            raise posevote.InvalidArgumentError(f"--set needs NAME=VALUE, not '{setting}'")
        name = name.replace(".", "_")
        default = known.get(name, "")
        try:
            if isinstance(default, bool):
                found[name] = {"true": True, "on": True, "false": False, "off": False}[text]
            else:
                found[name] = type(default)(text)
        except (KeyError, ValueError):
            message = f"option {name} needs a value like {default}, not '{text}'"
            raise posevote.InvalidArgumentError(message) from None
    return found


# --- The file of results -------------------------------------------------------------------------


class Results:
    """Lines in a fixed order, beside a file that says what they belong to."""

    def __init__(self, path, belongs_to, restart):
        self.path = Path(path)
        self.note = self.path.with_name(self.path.name + ".batch")
        if restart:
            self.path.unlink(missing_ok=True)
            self.note.unlink(missing_ok=True)
        self.check(belongs_to)
        self.written = self.cut_off()
        self.file = open(self.path, "ab")

    def check(self, belongs_to):
        text = json.dumps(belongs_to, sort_keys=True, ensure_ascii=False)
        if self.note.exists():
            if self.note.read_text(encoding="utf-8") != text:
                raise posevote.AlreadyExistsError(
                    f"'{self.path}' was begun with other objects or options; "
                    "name another file, or begin it again with --restart"
                )
        elif self.path.exists() and self.path.stat().st_size:
            raise posevote.AlreadyExistsError(
                f"'{self.path}' exists and was not made by posevote batch; name another file"
            )
        else:
            made = self.note.with_name(self.note.name + ".part")
            made.write_text(text, encoding="utf-8")
            os.replace(made, self.note)

    def cut_off(self):
        """Removes a line that was not finished; returns (image, frame, is error) of the others."""
        if not self.path.exists():
            return []
        data = self.path.read_bytes()
        whole = data[: data.rfind(b"\n") + 1]
        if len(whole) < len(data):
            os.truncate(self.path, len(whole))
        lines = (json.loads(line) for line in whole.splitlines())
        return deque((line["image"], line.get("frame"), "error" in line) for line in lines)

    def take_up(self, task):
        """How many of the lines that are there already belong to `task`, and whether those are all
        of them; takes them off."""
        count = 0
        while self.written:
            image, frame, is_error = self.written[0]
            if image != task.path or frame is not None and not task.begin <= frame < task.end:
                if not task.end:
                    raise posevote.AlreadyExistsError(
                        f"'{self.path}' holds a line of '{image}' where one of '{task.path}' belongs:"
                        " it was made from other pictures; name another file, or use --restart"
                    )
                break
            self.written.popleft()
            count += 1
            if not task.end or is_error:
                return count, True
        return count, False

    def write(self, lines):
        if lines:
            self.file.write("".join(line + "\n" for line in lines).encode("utf-8", "replace"))
            self.file.flush()

    def close(self):
        os.fsync(self.file.fileno())
        self.file.close()


# --- The work ------------------------------------------------------------------------------------


class Progress:
    """A bar on standard error, on terminals only."""

    def __init__(self, total):
        self.total, self.done, self.shown = total, 0, sys.stderr.isatty()

    def advance(self):
        self.done += 1
        if self.shown:
            filled = 30 * self.done // max(self.total, 1)
            bar = "=" * filled + ">" + " " * (30 - filled)
            print(f"\rrecognising [{bar}] {self.done}/{self.total}", end="", file=sys.stderr)

    def close(self):
        if self.shown:
            print("\r\033[K", end="", file=sys.stderr)


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
            progress.advance()

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
    if scheduler:
        try:
            return Client(scheduler, timeout="30s"), None
        except (OSError, TimeoutError, ValueError) as error:
            raise posevote.IoError(f"no scheduler answers at '{scheduler}': {error}") from None
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
    with posevote.ObjectStore(job.database, "read_only") as store:
        objects = {o.name: [view.hash for view in store.views(o.name)] for o in store.objects()}
    known = hashlib.sha256(json.dumps(objects, sort_keys=True).encode()).hexdigest()
    return {
        "objects": known,
        "preset": job.preset,
        "settings": list(job.settings),
        "every": job.every,
        "posevote": posevote.__version__,
    }


def say(sentence):
    print("posevote: " + without_passwords(str(sentence)), file=sys.stderr)


def without_passwords(text):
    return re.sub(r"(postgres(?:ql)?://[^:/@\s]*:)[^\s]*@", r"\1***@", text)


def parse(arguments):
    parser = argparse.ArgumentParser(
        prog="posevote batch", description="Recognise in many pictures on many processors."
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
    found = parser.parse_args(arguments)
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
    job = Job(database, os.getcwd(), found.preset, tuple(found.set), found.every)
    recognizer_of(job)  # whatever is wrong with database or options is said before anything is made
    _recognizers.clear()
    tasks = list(tasks_of(found.inputs))
    results = Results(found.out, belonging(job), found.restart)
    client, cluster = open_client(found.scheduler, found.workers)
    progress = Progress(len(tasks))
    batch = Batch(client, job, results, say)
    try:
        if progress.shown and importlib.util.find_spec("bokeh"):
            print(f"dashboard: {client.dashboard_link}", file=sys.stderr)
        batch.run(tasks, progress)
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
    except KeyboardInterrupt:
        say("stopped; run it again to go on")
        return 1


if __name__ == "__main__":
    # What workers are to run must have a module that they can import.
    from posevote.batch import main as main_of_module

    sys.exit(main_of_module())
