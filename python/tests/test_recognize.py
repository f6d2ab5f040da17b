"""Teaching, recognising, and what comes back."""

import pickle
import sys
import threading
import time

import numpy as np
import pytest

import posevote


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


LONG_CALLS = {
    "recognize": lambda poster, scene, store: posevote.Recognizer({"it": [poster]}).recognize(scene),
    "teach_view": lambda poster, scene, store: posevote.teach_view(scene),
    "detect": lambda poster, scene, store: posevote.Surf().detect_and_compute(scene),
    "add_view": lambda poster, scene, store: store.add_view("poster", poster),
    "load": lambda poster, scene, store: store.load(pictures=True),
    "wait": lambda poster, scene, store: store.wait_for_change(store.version, 0.01),
}


@pytest.mark.parametrize("name", LONG_CALLS)
def test_other_threads_run_during_long_calls(name, poster, scene, store):
    # Without time slices a thread runs on until it lets others run of its own accord.
    slice_s = sys.getswitchinterval()
    store.add_view("other", poster)
    span, moments = [], []

    def work():
        span.append(time.perf_counter())
        LONG_CALLS[name](poster, scene, store)
        span.append(time.perf_counter())

    thread = threading.Thread(target=work)
    sys.setswitchinterval(1000)
    try:
        thread.start()
        while thread.is_alive():
            moments.append(time.perf_counter())
            time.sleep(0)  # lets the other begin
        thread.join()
    finally:
        sys.setswitchinterval(slice_s)
    assert any(span[0] < moment < span[1] for moment in moments)


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
