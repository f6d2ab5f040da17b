"""With OpenCV's own module in the same process, and without it."""

import subprocess
import sys

import pytest

SCRIPT = """
import sys
{imports}
import numpy as np
picture = np.kron(np.random.default_rng(1).integers(0, 256, (30, 40), dtype=np.uint8),
                  np.ones((8, 8), dtype=np.uint8))
features = posevote.Surf().detect_and_compute(picture)
try:
    posevote.read_image("there is none.jpg")
except posevote.UnreadableImageError:
    print(len(features), float(features.descriptors.sum(dtype=float)))
if "cv2" in sys.modules:
    edges = cv2.Canny(picture, 50, 150)
    assert edges.any()
    matcher = cv2.BFMatcher(cv2.NORM_L2, True)
    matches = matcher.match(features.descriptors, features.descriptors)
    assert len(matches) == len(features)
    try:
        cv2.resize(None, (3, 3))
    except cv2.error:
        pass
    found = posevote.Recognizer({{"it": [posevote.teach_view(cv2.merge([picture] * 3))]}}).recognize(picture)
    assert [d.object for d in found] == ["it"]
    assert cv2.perspectiveTransform(found[0].outline[None], found[0].homography).shape[1] > 2
else:
    assert not any(name == "cv2" or name.startswith("cv2.") for name in sys.modules)
"""


def run(imports):
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT.format(imports=imports)], capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_it_works_without_cv2():
    assert int(run("import posevote").split()[0]) > 100


def test_it_works_beside_cv2_whichever_comes_first():
    pytest.importorskip("cv2")
    alone = run("import posevote")
    assert run("import cv2, posevote") == alone
    assert run("import posevote, cv2") == alone
