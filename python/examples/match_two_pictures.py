"""SURF alone: how many features of one picture are in another?

    python3 match_two_pictures.py OBJECT.jpg SCENE.jpg
"""

import sys

import numpy as np

import posevote


def match(first, second, max_ratio=0.8):
    """Pairs of indices whose best match is clearly better than the second best."""
    similarity = first @ second.T  # rows have length 1
    best = np.argsort(-similarity, axis=1)[:, :2]
    distance = np.sqrt(2 - 2 * np.minimum(np.take_along_axis(similarity, best, axis=1), 1))
    good = distance[:, 0] < max_ratio * distance[:, 1]
    return np.c_[np.flatnonzero(good), best[good, 0]]


def main(object_file, scene_file):
    surf = posevote.Surf(hessian_threshold=300, max_features=1000)
    known = surf.detect_and_compute(posevote.read_image(object_file))
    scene = surf.detect_and_compute(posevote.read_image(scene_file))
    pairs = match(known.descriptors, scene.descriptors)
    print(f"{len(known)} and {len(scene)} features, {len(pairs)} matches")
    if len(pairs) == 0:
        return 1
    x, y = np.median(scene.points[pairs[:, 1]], axis=0)
    print(f"the matches' middle in the scene: ({x:.0f}, {y:.0f})")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
