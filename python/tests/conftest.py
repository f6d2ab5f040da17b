"""What the tests share: the demo's pictures, and numbers that are the same in every run."""

import os
from pathlib import Path

import numpy as np
import pytest

import posevote

SOURCE = Path(os.environ["POSEVOTE_SOURCE_DIR"])
DEMO = SOURCE / "data" / "demo"


@pytest.fixture
def demo():
    return DEMO


@pytest.fixture(scope="session")
def cover():
    return posevote.read_image(DEMO / "train/poster/cover.jpg")


@pytest.fixture(scope="session")
def scene():
    return posevote.read_image(DEMO / "test/reading.jpg")


@pytest.fixture(scope="session")
def poster(cover):
    return posevote.teach_view(cover)


@pytest.fixture
def blobs():
    """A grey picture with something in it, 120 x 160."""
    random = np.random.default_rng(1)
    small = random.integers(0, 256, (15, 20), dtype=np.uint8)
    return np.kron(small, np.ones((8, 8), dtype=np.uint8))


@pytest.fixture
def store(tmp_path):
    with posevote.ObjectStore(tmp_path / "objects.db") as store:
        yield store
