"""Teaching, recognising, and what comes back."""

import json
import pickle
import sys
import threading
import time
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import posevote
from conftest import DEMO


def test_a_taught_picture_is_found(poster, scene):
    found = posevote.Recognizer({"poster": [poster]}).recognize(scene)
    assert [detection.object for detection in found] == ["poster"]
    detection = found[0]
    assert np.allclose(detection.box, (270, 150, 285, 388), atol=6)
    assert detection.homography.shape == (3, 3) and detection.homography[2, 2] == 1
    # The homography maps the view's outline to the outline in the scene.
    corners = np.c_[poster.outline, np.ones(len(poster.outline))] @ detection.homography.T
    assert np.allclose(corners[:, :2] / corners[:, 2:], detection.outline, atol=0.01)
    assert detection.matches.shape == (detection.inliers, 2, 2)
    assert (found.width, found.height) == (1280, 960)
    assert found.counts.features > found.counts.verified >= detection.inliers
    assert found.time_ms.total >= found.time_ms.detect > 0


def test_nothing_found_is_a_result(poster):
    found = posevote.Recognizer({"poster": [poster]}).recognize(np.zeros((90, 120, 3), np.uint8))
    assert len(found) == 0 and list(found) == [] and found.detections == []
    assert len(posevote.Recognizer({}).recognize(np.zeros((0, 0), np.uint8))) == 0


def test_results_can_be_shown_pickled_and_made_plain(poster, scene):
    found = posevote.Recognizer({"poster": [poster]}).recognize(scene)
    plain = found.to_dict("scene.jpg")
    assert plain["image"] == "scene.jpg" and plain["width"] == 1280
    assert plain["detections"] == [found[0].to_dict()]
    assert plain["detections"][0]["homography"] == found[0].homography.tolist()
    again = pickle.loads(pickle.dumps(found))
    assert again.to_dict("scene.jpg") == plain
    assert np.array_equal(again[0].matches, found[0].matches)
    assert repr(found[0]).startswith("Detection(object='poster', view='', confidence=0.")
    assert "Detection(object='poster'" in repr(found)
    assert found[-1].object == "poster" and found[:1][0].object == "poster"
    with pytest.raises(IndexError):
        found[1]


def test_teaching_by_background_mask_and_rectangle(demo):
    picture = posevote.read_image(demo / "train/muesli/y000.jpg")
    background = posevote.read_image(demo / "train/muesli/background.jpg")
    by_background = posevote.teach_view(picture, background=background, yaw_deg=30)
    assert by_background.method == "background" and by_background.yaw_deg == 30
    assert by_background.image_size == (picture.shape[1], picture.shape[0])
    assert np.array_equal(by_background.mask, posevote.find_object(picture, background))
    by_mask = posevote.teach_view(picture, mask=by_background.mask > 0)
    assert by_mask.method == "mask" and by_mask.yaw_deg is None
    assert np.array_equal(by_mask.features.descriptors, by_background.features.descriptors)
    by_roi = posevote.teach_view(picture, roi=(200, 120, 260, 280))
    assert by_roi.method == "roi" and by_roi.coverage == pytest.approx(260 * 280 / picture[..., 0].size)
    assert "features" in repr(by_roi) and by_roi.to_dict()["method"] == "roi"


def test_files_and_arrays_teach_the_same(demo, poster):
    from_file = posevote.teach_view(demo / "train/poster/cover.jpg")
    assert np.array_equal(from_file.features.descriptors, poster.features.descriptors)
    assert from_file.source.endswith("cover.jpg") and poster.source == ""
    assert from_file.version == posevote.__version__


def test_what_cannot_be_taught_is_said_with_advice(cover):
    with pytest.raises(posevote.UnusableViewError):
        posevote.teach_view(np.zeros((50, 50), np.uint8))
    with pytest.raises(posevote.UnusableViewError):
        posevote.teach_view(cover, mask=np.zeros(cover.shape[:2], np.uint8))
    with pytest.raises(posevote.InvalidArgumentError):
        posevote.teach_view(cover, mask=np.zeros((3, 3), np.uint8))
    with pytest.raises(posevote.InvalidArgumentError):
        posevote.teach_view(cover, roi=(1, 2, 3))


def test_sets_of_objects(poster):
    models = posevote.ModelSet({"poster": [poster]})
    assert models.names == ["poster"] and len(models) == 1
    assert models.feature_count == len(poster.features)
    assert np.array_equal(models.views("poster")[0].outline, poster.outline)
    assert "1 objects" in repr(models)
    with pytest.raises(posevote.NotFoundError):
        models.views("cup")
    with pytest.raises(posevote.InvalidArgumentError):
        posevote.Recognizer(7)


def test_features_of_two_kinds_do_not_mix(cover, poster):
    sift = posevote.teach_view(cover, feature_kind="sift")
    with pytest.raises(posevote.FeatureMismatchError):
        posevote.ModelSet({"a": [poster], "b": [sift]})
    recognizer = posevote.Recognizer({"poster": [sift]})
    assert recognizer.options["feature_kind"] == "sift"
    with pytest.raises(posevote.FeatureMismatchError):
        recognizer.set_models({"poster": [poster]})


def test_objects_can_be_swapped(poster, scene):
    recognizer = posevote.Recognizer({})
    assert len(recognizer.recognize(scene)) == 0
    recognizer.set_models({"poster": [poster]})
    assert len(recognizer.recognize(scene)) == 1
    assert recognizer.models.names == ["poster"]


def copying(store):
    other = posevote.ObjectStore(store.location + ".copy")
    return lambda: other.copy_from(store, on_conflict="merge")


def evaluating(folder):
    """One object and one picture of the demonstration."""
    data = json.loads((DEMO / "dataset.json").read_text(encoding="utf-8"))
    data["objects"] = [entry for entry in data["objects"] if entry["name"] == "poster"]
    data["tests"] = [test for test in data["tests"] if test["image"] == "test/reading.jpg"]
    data["twins"] = []
    for test in data["tests"]:
        test["objects"] = [truth for truth in test["objects"] if truth["name"] == "poster"]
    (folder / "dataset.json").write_text(json.dumps(data), encoding="utf-8")
    for name in ("train", "test"):
        (folder / name).symlink_to(DEMO / name)
    return partial(posevote.evaluate, folder, jobs=1)


def swapping(poster):
    recognizer = posevote.Recognizer({})
    none, some = posevote.ModelSet({}), posevote.ModelSet({name: [poster] for name in "abcdef"})

    def swap():
        recognizer.set_models(none)
        recognizer.set_models(some)

    return swap


# Each gives the call itself; what it needs is there before.
LONG_CALLS = {
    "recognizer": lambda poster, scene, store: partial(posevote.Recognizer, {"it": [poster]}),
    "recognize": lambda poster, scene, store: partial(
        posevote.Recognizer({"it": [poster]}).recognize, scene
    ),
    "set_models": lambda poster, scene, store: swapping(poster),
    "teach_view": lambda poster, scene, store: partial(posevote.teach_view, scene),
    "find_object": lambda poster, scene, store: partial(
        posevote.find_object,
        posevote.read_image(DEMO / "train/muesli/y000.jpg"),
        posevote.read_image(DEMO / "train/muesli/background.jpg"),
    ),
    "read_image": lambda poster, scene, store: partial(
        posevote.read_image, DEMO / "test/reading.jpg"
    ),
    "evaluate": lambda poster, scene, store: evaluating(Path(store.location).parent),
    "detect": lambda poster, scene, store: partial(posevote.Surf().detect_and_compute, scene),
    "add_view": lambda poster, scene, store: partial(store.add_view, "poster", poster),
    "load": lambda poster, scene, store: partial(store.load, pictures=True),
    "copy_from": lambda poster, scene, store: copying(store),
    "wait": lambda poster, scene, store: partial(store.wait_for_change, store.version, 0.01),
}


@pytest.mark.parametrize("name", LONG_CALLS)
def test_other_threads_run_during_long_calls(name, poster, scene, store):
    # Without time slices a thread runs on until it lets others run of its own accord.
    slice_s = sys.getswitchinterval()
    store.add_view("other", poster)
    call = LONG_CALLS[name](poster, scene, store)
    moments, seen = [], []

    def work():
        for _ in range(50):  # a short one may be over before the other thread gets a processor
            begin = time.perf_counter()
            call()
            end = time.perf_counter()
            seen.extend(moment for moment in moments if begin < moment < end)
            if seen:
                return

    thread = threading.Thread(target=work)
    sys.setswitchinterval(1000)
    try:
        thread.start()
        while thread.is_alive():
            moments.append(time.perf_counter())
            time.sleep(0.001)  # lets the other go on
        thread.join()
    finally:
        sys.setswitchinterval(slice_s)
    assert seen


def test_many_threads_share_a_recognizer(poster, scene):
    recognizer = posevote.Recognizer({"poster": [poster]})
    expected = [detection.to_dict() for detection in recognizer.recognize(scene)]
    results = []

    def work():
        results.append([detection.to_dict() for detection in recognizer.recognize(scene)])

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results == [expected] * 4


def test_results_are_drawn_on_a_copy(poster, scene):
    found = posevote.Recognizer({"poster": [poster]}).recognize(scene)
    drawn = posevote.annotate(scene, found)
    assert drawn.shape == scene.shape and drawn.dtype == np.uint8
    assert not np.array_equal(drawn, scene)
