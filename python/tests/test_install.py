"""pip installs the package into an empty folder, without a network."""

import os
import subprocess
import sys

import pytest

from conftest import DEMO, SOURCE


def test_pip_installs_what_can_be_used(tmp_path):
    pytest.importorskip("pip")
    target = tmp_path / "installed"
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
    subprocess.run(
        [
            *(sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-index"),
            *("--config-settings", "build-dir=" + os.environ["POSEVOTE_BINARY_DIR"]),
            *("--target", target, SOURCE / "python"),
        ],
        check=True,
        env=environment,
    )
    installed = {path.name for path in (target / "posevote").iterdir()}
    assert {"__init__.py", "__init__.pyi", "py.typed", "errors.py"} <= installed
    metadata = next(target.glob("posevote-*.dist-info"))
    assert "Requires-Dist: numpy" in (metadata / "METADATA").read_text()
    done = subprocess.run(
        [
            *(sys.executable, SOURCE / "python/examples/match_two_pictures.py"),
            *(DEMO / "train/poster/cover.jpg", DEMO / "test/reading.jpg"),
        ],
        env={**environment, "PYTHONPATH": str(target)},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
