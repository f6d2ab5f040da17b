"""Objects that do not fit into one machine's memory: split over several, their results joined.

Each part of the objects - about as many views in each - has a recogniser of its own with the options
of the whole, which sees every picture. The dial of false alarms is not divided: it stands for a
least probability of each single claim, and a part of the objects makes a part of the false claims
only, so their sum is that of the whole. Where detections of different parts claim the same place,
the one that is the least likely to be an accident is right: `join`.
"""

from __future__ import annotations

from collections.abc import Iterable

from posevote import Detection, Recognition, _core


def _overlap(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    """Intersection over union of two boxes (x, y, width, height)."""
    width = min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0])
    height = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    if width <= 0 or height <= 0:
        return 0.0
    shared = width * height
    return shared / (a[2] * a[3] + b[2] * b[3] - shared)


def join(
    results: Iterable[Recognition], max_overlap: float | None = None
) -> list[Detection]:
    """The detections of all parts' results for one picture, best first, as a list of Detection.

    `max_overlap`: intersection over union from which two detections claim the same place; default:
    the recogniser's own.
    """
    if max_overlap is None:
        options = _core._recognize_options("default")
        max_overlap = next(o["default"] for o in options if o["name"] == "max_overlap")
    found = sorted(
        (detection for result in results for detection in result),
        key=lambda detection: detection.log10_false_alarms,
    )
    kept = []
    for detection in found:
        if all(_overlap(detection.box, other.box) < max_overlap for other in kept):
            kept.append(detection)
    return kept
