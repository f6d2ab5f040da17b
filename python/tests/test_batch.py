"""Many pictures on many workers: order, resumption, workers that die."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time

import pytest

import posevote
from conftest import DEMO

distributed = pytest.importorskip("distributed")

from posevote import batch_work  # noqa: E402
from posevote.batch_results import Results  # noqa: E402

# Dask loads it into each worker, twice.
KILLER = """
import os, signal
from posevote import batch_work
def deadly(job, path, plain=getattr(batch_work, "plain", batch_work.picture_line)):
    if "poison" in path and not os.path.exists({antidote!r}):
        if {once}:
            open({antidote!r}, "w").close()
        os.kill(os.getpid(), signal.SIGKILL)
    return plain(job, path)
batch_work.plain = getattr(batch_work, "plain", batch_work.picture_line)
batch_work.picture_line = deadly
"""


@pytest.fixture(scope="module")
def database(tmp_path_factory):
    path = tmp_path_factory.mktemp("database") / "objects.db"
    with posevote.ObjectStore(path) as store:
        store.teach("poster", DEMO / "train/poster/cover.jpg")
    return path


@pytest.fixture
def pictures(tmp_path):
    """Ten small pictures, one of them damaged."""
    folder = tmp_path / "pictures"
    folder.mkdir()
    cv2 = pytest.importorskip("cv2")
    scenes = sorted((DEMO / "test").glob("*.jpg"))
    for i in range(10):
        image = cv2.imread(str(scenes[i % len(scenes)]))
        cv2.imwrite(str(folder / f"{i}.jpg"), cv2.resize(image, (640 + i, 480)))
    (folder / "4.jpg").write_bytes(b"no picture")
    return folder


def run(*arguments, killer=None, **options):
    environment = dict(os.environ)
    if killer:
        environment["DASK_DISTRIBUTED__WORKER__PRELOAD"] = str(killer)
    return subprocess.run(
        [sys.executable, "-m", "posevote.batch", *map(str, arguments)],
        env=environment,
        capture_output=True,
        text=True,
        **options,
    )


def lines_of(path):
    return [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]


def without_times(line):
    return {key: value for key, value in line.items() if key != "time_ms"}


def expected(folder, database):
    with posevote.ObjectStore(database, "read_only") as store:
        recognizer = posevote.Recognizer(store)
    for path in sorted(folder.glob("*.jpg")):
        try:
            yield without_times(recognizer.recognize(posevote.read_image(path)).to_dict(str(path)))
        except posevote.UnreadableImageError as error:
            yield {"image": str(path), "error": str(error)}


def test_lines_are_those_of_one_machine_in_the_order_given(database, pictures, tmp_path):
    out = tmp_path / "out.jsonl"
    done = run(pictures, "--db", database, "--out", out, "--workers", 2)
    assert done.returncode == 1, done.stderr  # one picture is damaged
    assert done.stderr.splitlines()[-1] == f"posevote: 1 lines of '{out}' are errors"
    found = [without_times(line) for line in lines_of(out)]
    assert found == list(expected(pictures, database))
    assert sum(len(line.get("detections", [])) for line in found) >= 1


@pytest.mark.parametrize(
    "damage", [lambda line: line[:40], lambda line: b"\0" * 20 + line[20:] + line], ids=["cut", "zeros"]
)
def test_what_was_stopped_goes_on_where_it_was(damage, database, pictures, tmp_path):
    out = tmp_path / "out.jsonl"
    (pictures / "4.jpg").unlink()
    assert run(pictures, "--db", database, "--out", out, "--workers", 2).returncode == 0
    whole = out.read_bytes().splitlines(keepends=True)
    out.write_bytes(b"".join(whole[:5]) + damage(whole[5]))
    assert run(pictures, "--db", database, "--out", out, "--workers", 1).returncode == 0
    again = out.read_bytes().splitlines(keepends=True)
    assert again[:5] == whole[:5]  # not made again: even the times are those of before
    assert [without_times(json.loads(a)) for a in again] == [
        without_times(json.loads(w)) for w in whole
    ]


def test_killed_at_any_moment_each_picture_has_one_line(database, pictures, tmp_path):
    out = tmp_path / "out.jsonl"
    command = [sys.executable, "-m", "posevote.batch", str(pictures), "--workers", "2"]
    command += ["--db", str(database), "--out", str(out)]
    for lines in (1, 5):
        process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
        while process.poll() is None and (
            not out.exists() or out.read_bytes().count(b"\n") < lines
        ):
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
        process.wait()
    run(pictures, "--db", database, "--out", out, "--workers", 2)
    assert [without_times(line) for line in lines_of(out)] == list(expected(pictures, database))


def test_a_worker_that_dies_is_replaced(database, pictures, tmp_path):
    shutil.move(pictures / "4.jpg", tmp_path / "damaged.jpg")
    shutil.copy(pictures / "5.jpg", pictures / "4 poison.jpg")
    killer = tmp_path / "killer.py"
    killer.write_text(KILLER.format(antidote=str(tmp_path / "antidote"), once=True))
    out = tmp_path / "out.jsonl"
    done = run(pictures, "--db", database, "--out", out, "--workers", 2, killer=killer)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "antidote").exists()
    assert [without_times(line) for line in lines_of(out)] == list(expected(pictures, database))


TEACHER = """
import posevote
with posevote.ObjectStore({database!r}) as store:
    store.teach("mug", {picture!r})
"""


def test_a_worker_that_would_look_for_other_objects_ends_the_run(database, pictures, tmp_path):
    own = shutil.copy(database, tmp_path / "own.db")
    shutil.move(pictures / "4.jpg", pictures / "4 poison.jpg")
    script = KILLER.format(antidote=str(tmp_path / "antidote"), once=True)
    teacher = TEACHER.format(database=str(own), picture=str(DEMO / "train/mug/y000.jpg"))
    before_killing = "        os.kill("
    assert before_killing in script
    indented = "".join(f"        {line}\n" for line in teacher.strip().splitlines())
    killer = tmp_path / "killer.py"
    killer.write_text(script.replace(before_killing, indented + before_killing))
    out = tmp_path / "out.jsonl"
    arguments = (pictures, "--db", own, "--out", out, "--workers", 1)
    done = run(*arguments, killer=killer)
    assert done.returncode == 1
    said = [line for line in done.stderr.splitlines() if " - INFO - " not in line]  # Dask's
    assert len(said) == 1 and "no longer those" in said[0], done.stderr
    assert len(lines_of(out)) == 4  # those before
    again = run(*arguments)
    assert again.returncode == 1 and "--restart" in again.stderr
    assert len(lines_of(out)) == 4
    assert len(run(*arguments, "--restart").stderr.splitlines()) == 1  # a picture is damaged
    assert len(lines_of(out)) == 10


def test_a_picture_that_kills_workers_is_set_aside(database, pictures, tmp_path):
    shutil.move(pictures / "4.jpg", pictures / "4 poison.jpg")
    killer = tmp_path / "killer.py"
    killer.write_text(KILLER.format(antidote=str(tmp_path / "antidote"), once=False))
    out = tmp_path / "out.jsonl"
    done = run(pictures, "--db", database, "--out", out, "--workers", 2, killer=killer)
    assert done.returncode == 1
    assert "4 poison.jpg is set aside" in done.stderr
    found = [without_times(line) for line in lines_of(out)]
    wanted = list(expected(pictures, database))
    assert "set aside" in found[4]["error"]
    assert found[:4] + found[5:] == wanted[:4] + wanted[5:]
    before = out.read_bytes()
    assert run(pictures, "--db", database, "--out", out, killer=killer).returncode == 0
    assert out.read_bytes() == before  # and it is not tried again


@pytest.fixture
def cluster(tmp_path):
    """A scheduler and two workers, as they would run on other machines: (address, scheduler)."""
    note = tmp_path / "scheduler.json"
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    scheduler = subprocess.Popen(
        [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1"]
        + ["--port", "0", "--no-dashboard", "--scheduler-file", str(note)],
        **quiet,
    )
    workers = [
        subprocess.Popen(
            [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", str(note)]
            + ["--nthreads", "2", "--no-dashboard", "--local-directory", str(tmp_path)],
            **quiet,
        )
        for _ in range(2)
    ]
    try:
        while not note.exists():
            time.sleep(0.05)
        yield json.loads(note.read_text())["address"], scheduler
    finally:
        for process in (*workers, scheduler):
            process.terminate()
            process.wait()


def test_a_cluster_that_is_there_is_used(cluster, database, pictures, tmp_path):
    address, _ = cluster
    out = tmp_path / "out.jsonl"
    done = run(pictures, "--db", database, "--out", out, "--scheduler", address)
    assert done.returncode == 1, done.stderr  # one picture is damaged
    assert [without_times(line) for line in lines_of(out)] == list(expected(pictures, database))


def test_a_scheduler_that_goes_is_said_and_the_work_goes_on_later(
    cluster, database, pictures, tmp_path
):
    address, scheduler = cluster
    (pictures / "4.jpg").unlink()
    names = sorted(map(str, pictures.glob("*.jpg"))) * 20
    listed, out = tmp_path / "pictures.txt", tmp_path / "out.jsonl"
    listed.write_text("".join(name + "\n" for name in names))
    arguments = ["--list", str(listed), "--db", str(database), "--out", str(out)]
    process = subprocess.Popen(
        [sys.executable, "-m", "posevote.batch", *arguments, "--scheduler", address],
        stderr=subprocess.PIPE,
        text=True,
    )
    while process.poll() is None and (not out.exists() or not out.stat().st_size):
        time.sleep(0.01)
    scheduler.kill()
    errors = process.communicate()[1]
    assert process.returncode == 1
    assert errors.splitlines()[-1].startswith("posevote: ") and "run it again" in errors
    assert "Traceback" not in errors
    assert len(lines_of(out)) < len(names)
    assert run(*arguments, "--workers", 2).returncode == 0
    assert [line["image"] for line in lines_of(out)] == names


def test_other_pictures_or_objects_are_not_mixed(database, pictures, tmp_path):
    out = tmp_path / "out.jsonl"
    (pictures / "4.jpg").unlink()
    first, second = pictures / "0.jpg", pictures / "1.jpg"
    assert run(first, "--db", database, "--out", out, "--workers", 1).returncode == 0
    before = out.read_bytes()
    for arguments, words in (
        ((second, "--db", database), "--restart"),
        ((first, "--db", database, "--set", "match.max_ratio=0.7"), "--restart"),
    ):
        done = run(*arguments, "--out", out, "--workers", 1)
        assert done.returncode == 1 and words in done.stderr and done.stderr.count("\n") == 1
        assert out.read_bytes() == before
    other = tmp_path / "mine.txt"
    other.write_text("something of mine\n")
    assert run(first, "--db", database, "--out", other).returncode == 1
    assert other.read_text() == "something of mine\n"


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["--db", "{folder}/nothing.db"], ["nothing.db"]),
        (["--db", "{database}", "--set", "match.max_ration=1"], ["max_ratio'?"]),
        (["--db", "{database}", "--set", "match.max_ratio=much"], ["match.max_ratio", "much"]),
        (["--db", "{database}", "--set", "unknown"], ["NAME=VALUE"]),
        (["--db", "{database}", "--scheduler", "nonsense"], ["nonsense"]),
    ],
)
def test_what_is_wrong_is_said_in_one_sentence(arguments, words, database, pictures, tmp_path):
    given = [a.format(folder=tmp_path, database=database) for a in arguments]
    done = run(pictures, *given, "--out", tmp_path / "out.jsonl")
    assert done.returncode == 1
    assert done.stderr.startswith("posevote: ") and done.stderr.count("\n") == 1
    assert all(word in done.stderr for word in words)


def test_no_password_is_said_or_taken_as_an_argument(pictures, tmp_path, monkeypatch):
    address = "postgresql://robot:secret@127.0.0.1:1/db"
    done = run(pictures, "--db", address, "--out", tmp_path / "out.jsonl")
    assert done.returncode == 2 and "POSEVOTE_DB" in done.stderr and "secret" not in done.stderr
    monkeypatch.setenv("POSEVOTE_DB", address)
    done = run(pictures, "--out", tmp_path / "out.jsonl")
    assert done.returncode == 1 and done.stderr.count("\n") == 1
    assert "robot:***@" in done.stderr and "secret" not in done.stderr


def test_videos_are_cut_in_parts_and_resumed_within(database, pictures, tmp_path, monkeypatch):
    cv2 = pytest.importorskip("cv2")
    film = tmp_path / "film.avi"
    writer = cv2.VideoWriter(str(film), cv2.VideoWriter_fourcc(*"MJPG"), 10, (320, 240))
    image = cv2.resize(cv2.imread(str(DEMO / "test/reading.jpg")), (320, 240))
    for _ in range(23):
        writer.write(image)
    writer.release()
    monkeypatch.setattr(batch_work, "FRAMES_PER_TASK", 10)
    tasks = [task for task, error in batch_work.tasks_of([str(film)])]
    assert [(task.begin, task.end) for task in tasks] == [(0, 10), (10, 20), (20, sys.maxsize)]
    job = batch_work.Job(str(database), every=4)
    lines = [line for task in tasks for line in batch_work.run_task(job, task)]
    assert [json.loads(line)["frame"] for line in lines] == [0, 4, 8, 12, 16, 20]

    out = tmp_path / "out.jsonl"
    results = Results(out, {}, restart=False)
    results.write(lines[:4])
    results.close()
    results = Results(out, {}, restart=False)
    assert [results.take_up(task) for task in tasks] == [(3, False), (1, False), (0, False)]
    results.close()


def test_a_job_shows_no_password():
    assert "secret" not in repr(batch_work.Job("postgresql://robot:secret@host/db"))
