"""The work of posevote batch: its tasks, and what a worker does for one."""

import hashlib
import json
import sys
import threading
from dataclasses import dataclass, field
from pathlib import Path

import posevote
from posevote import _core

FRAMES_PER_TASK = 300  # a worker decodes a video from its beginning to its part


@dataclass(frozen=True)
class Job:
    """What is looked for, and how. Its text, which Dask writes into logs, holds no password."""

    database: str = field(repr=False)
    folder: str = ""  # what relative names of pictures are relative to
    preset: str = "default"
    settings: tuple = ()
    every: int = 1
    objects: str = ""  # `objects_hash` of those that the run began with; "": whatever there is


def objects_hash(store):
    """Names and content of all objects of a store, in short."""
    objects = {o.name: [view.hash for view in store.views(o.name)] for o in store.objects()}
    return hashlib.sha256(json.dumps(objects, sort_keys=True).encode()).hexdigest()


_recognizers = {}
_loading = threading.Lock()


def recognizer_of(job):
    """The job's recogniser: loaded once in each worker, whatever the number of its threads."""
    with _loading:
        if job not in _recognizers:
            with posevote.ObjectStore(job.database, "read_only") as store:
                options = _core._settings(job.preset, job.settings)
                made = posevote.Recognizer(store, preset=job.preset, **options)
                if job.objects and objects_hash(store) != job.objects:
                    raise posevote.AlreadyExistsError(
                        f"the objects in '{store.location}' are no longer those that this run "
                        "began with; name another file, or begin it again with --restart"
                    )
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
