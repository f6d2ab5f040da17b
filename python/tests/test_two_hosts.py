"""Two hosts, each a network namespace of its own, and a scheduler on a third."""

import os
import shutil
import subprocess
import sys

import pytest

pytest.importorskip("distributed")

from test_batch import database, expected, lines_of, pictures, run, without_times  # noqa: E402, F401

NAME = f"pv{os.getpid() % 100000}"
NETWORK = "10.203.77"


def ip(*words):
    subprocess.run(["ip", *words], check=True, capture_output=True)


@pytest.fixture
def hosts():
    """Two namespaces that reach this machine and each other over a bridge."""
    if os.geteuid() != 0 or not shutil.which("ip"):
        pytest.skip("only root can make network namespaces, with ip")
    names = [f"{NAME}{letter}" for letter in "ab"]
    try:
        ip("link", "add", NAME, "type", "bridge")
    except subprocess.CalledProcessError:
        pytest.skip("this machine allows no network namespaces")
    try:
        ip("addr", "add", f"{NETWORK}.1/24", "dev", NAME)
        ip("link", "set", NAME, "up")
        for number, name in enumerate(names, start=2):
            ip("netns", "add", name)
            ip("link", "add", name, "type", "veth", "peer", "name", "eth0", "netns", name)
            ip("link", "set", name, "master", NAME, "up")
            ip("-n", name, "addr", "add", f"{NETWORK}.{number}/24", "dev", "eth0")
            ip("-n", name, "link", "set", "eth0", "up")
            ip("-n", name, "link", "set", "lo", "up")
        yield names
    finally:
        for name in names:
            subprocess.run(["ip", "netns", "del", name], capture_output=True)
        subprocess.run(["ip", "link", "del", NAME], capture_output=True)


def test_workers_on_two_hosts_do_the_work(hosts, database, pictures, tmp_path):  # noqa: F811
    (pictures / "4.jpg").unlink()
    python = [sys.executable, "-m"]
    log = open(tmp_path / "log", "w")
    scheduler = subprocess.Popen(
        [*python, "distributed.cli.dask_scheduler", "--host", NETWORK + ".1", "--port", "8786"]
        + ["--no-dashboard"],
        stdout=log,
        stderr=log,
    )
    address = f"tcp://{NETWORK}.1:8786"
    workers = [
        subprocess.Popen(
            ["ip", "netns", "exec", host, *python, "distributed.cli.dask_worker", address]
            + ["--nthreads", "1", "--no-dashboard", "--name", host]
            + ["--local-directory", str(tmp_path)],
            stdout=log,
            stderr=log,
        )
        for host in hosts
    ]
    try:
        from distributed import Client

        with Client(address, timeout="120s") as client:
            client.wait_for_workers(2)
            assert {w["name"] for w in client.scheduler_info()["workers"].values()} == set(hosts)
        out = tmp_path / "out.jsonl"
        done = run(pictures, "--db", database, "--out", out, "--scheduler", address)
        assert done.returncode == 0, done.stderr
        assert [without_times(line) for line in lines_of(out)] == list(
            expected(pictures, database)
        )
    finally:
        for process in (*workers, scheduler):
            process.terminate()
            process.wait()
