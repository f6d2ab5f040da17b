"""The examples do what they say."""

import json
import subprocess
import sys

from conftest import DEMO, SOURCE


def run(name, *arguments):
    done = subprocess.run(
        [sys.executable, SOURCE / "python/examples" / name, *map(str, arguments)],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()


def test_match_two_pictures():
    lines = run("match_two_pictures.py", DEMO / "train/poster/cover.jpg", DEMO / "test/reading.jpg")
    assert int(lines[0].split(", ")[1].split()[0]) > 50
    x, y = (float(number) for number in lines[1].split("(")[1].rstrip(")").split(", "))
    assert 270 < x < 555 and 150 < y < 538


def test_teach_and_recognize(tmp_path):
    train = DEMO / "train/soup"
    lines = run(
        "teach_and_recognize.py",
        *(tmp_path / "objects.db", "soup", train / "y000.jpg", train / "background.jpg"),
        DEMO / "test/twice.jpg",
    )
    assert lines[0] == "soup: view 1 added"
    assert any(line.startswith("soup: confidence") for line in lines)


def test_recognize_in_threads():
    lines = run("recognize_in_threads.py", DEMO / "train/poster/cover.jpg", DEMO / "test")
    results = [json.loads(line) for line in lines]
    assert [result["image"] for result in results] == sorted(map(str, (DEMO / "test").glob("*.jpg")))
    found = {r["image"].split("/")[-1] for r in results if r["detections"]}
    assert "reading.jpg" in found and "breakfast.jpg" not in found
