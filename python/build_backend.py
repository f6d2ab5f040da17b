"""How pip builds the package (PEP 517): with CMake, and with nothing that has to be fetched.

`--config-settings build-dir=FOLDER` takes the package from an existing CMake build folder instead of
building everything again.
"""

import base64
import hashlib
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def _version():
    text = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(posevote VERSION ([0-9.]+)", text)[1]


def _metadata():
    return (
        "Metadata-Version: 2.1\n"
        "Name: posevote\n"
        f"Version: {_version()}\n"
        "Summary: Recognises particular objects in pictures by Hough clustering of SURF features\n"
        "License: Apache-2.0\n"
        "Requires-Python: >=3.9\n"
        "Requires-Dist: numpy\n"
        'Provides-Extra: batch\nRequires-Dist: distributed; extra == "batch"\n'
    )


def _tags():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def _run(*command):
    subprocess.run([str(word) for word in command], check=True)


def _build(folder):
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    generator = ["-G", "Ninja"] if shutil.which("ninja") else []
    _run(
        *("cmake", "-S", ROOT, "-B", folder, "-DCMAKE_BUILD_TYPE=Release", *launcher, *generator),
        *("-DPOSEVOTE_BUILD_TESTS=OFF", "-DPOSEVOTE_WITH_APPS=OFF"),
        f"-DPython3_EXECUTABLE={sys.executable}",
    )
    if not any(Path(folder).glob("python/cmake_install.cmake")):
        raise SystemExit("posevote: CMake found no pybind11 or no headers of " + sys.executable)
    _run(
        *("cmake", "--build", folder, "--target", "posevote_python_package"),
        *("--parallel", os.cpu_count() or 1),
    )


def _stage(folder, stage):
    """Installs the package and returns the folder that holds it."""
    _run("cmake", "--install", folder, "--prefix", stage, "--component", "python")
    return next(Path(stage).rglob("posevote/__init__.py")).parent.parent


def _write_wheel(path, files):
    """`files`: name in the wheel -> content."""
    info = f"posevote-{_version()}.dist-info"
    files[f"{info}/METADATA"] = _metadata().encode()
    files[f"{info}/WHEEL"] = (
        f"Wheel-Version: 1.0\nGenerator: posevote\nRoot-Is-Purelib: false\nTag: {_tags()}\n"
    ).encode()
    record = ""
    for name, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(content)}\n"
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for name, content in files.items():
            wheel.writestr(name, content)


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    name = f"posevote-{_version()}-{_tags()}.whl"
    with tempfile.TemporaryDirectory() as scratch:
        folder = (config_settings or {}).get("build-dir")
        if not folder:
            folder = Path(scratch) / "build"
            _build(folder)
        root = _stage(folder, Path(scratch) / "stage")
        files = {
            str(path.relative_to(root)): path.read_bytes()
            for path in sorted(root.rglob("*"))
            if path.is_file()
        }
    _write_wheel(Path(wheel_directory) / name, files)
    return name


def build_sdist(sdist_directory, config_settings=None):
    raise SystemExit("posevote: the sources are those of the whole project, not of this folder")
