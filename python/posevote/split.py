"""Objects that do not fit into one machine's memory: split over several, their results joined.

Each part of the objects has a recogniser of its own, which sees every picture. The expected number
of false alarms in a picture is the sum over the parts, so each part may have its share of it only:
`share_of` says how. Where detections of different parts claim the same place, the one that is the
least likely to be an accident is right: `join`.
"""

from posevote import _core


def share_of(parts, preset="default"):
    """Keywords for the Recognizer of one of so many equal parts: its share of the false alarms."""
    known = {option["name"]: option["default"] for option in _core._recognize_options(preset)}
    name = "verify_false_alarms_per_1000_images"
    return {name: known[name] / parts}


def _overlap(a, b):
    """Intersection over union of two boxes (x, y, width, height)."""
    width = min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0])
    height = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    if width <= 0 or height <= 0:
        return 0.0
    shared = width * height
    return shared / (a[2] * a[3] + b[2] * b[3] - shared)


def join(results, max_overlap=0.4):
    """The detections of all parts' results for one picture, best first, as a list of Detection.

    `max_overlap`: intersection over union from which two detections claim the same place.
    """
    found = sorted(
        (detection for result in results for detection in result),
        key=lambda detection: detection.log10_false_alarms,
    )
    kept = []
    for detection in found:
        if all(_overlap(detection.box, other.box) < max_overlap for other in kept):
            kept.append(detection)
    return kept
