"""SURF and SIFT alone; which arrays are pictures."""

import pickle

import numpy as np
import pytest

import posevote


def equal(a, b):
    return np.array_equal(a.keypoints, b.keypoints) and np.array_equal(a.descriptors, b.descriptors)


def test_features_are_arrays_of_one_length(blobs):
    features = posevote.Surf().detect_and_compute(blobs)
    assert len(features) > 20
    assert features.keypoints.dtype.names == ("x", "y", "scale", "angle", "response", "laplacian")
    assert features.keypoints.shape == (len(features),)
    assert features.points.shape == (len(features), 2)
    assert features.descriptors.shape == (len(features), 64)
    assert features.descriptors.dtype == np.float32
    assert np.allclose(np.linalg.norm(features.descriptors, axis=1), 1, atol=1e-4)
    assert np.array_equal(features.points[:, 0], features.keypoints["x"])
    response = features.keypoints["response"]
    assert np.all(response[:-1] >= response[1:])


def test_features_unpack_as_opencv_does(blobs):
    features = posevote.Surf().detect_and_compute(blobs)
    keypoints, descriptors = features
    assert np.array_equal(keypoints, features.keypoints)
    assert np.array_equal(descriptors, features.descriptors)


def test_arrays_outlive_the_features_and_cannot_be_written(blobs):
    features = posevote.Surf().detect_and_compute(blobs)
    points, descriptors = features.points, features.descriptors
    before = points.copy(), descriptors.copy()
    del features
    posevote.Surf().detect_and_compute(blobs)
    assert np.array_equal(points, before[0]) and np.array_equal(descriptors, before[1])
    for array in (points, descriptors):
        with pytest.raises(ValueError):
            array[0] = 0


def test_a_picture_without_features_gives_none():
    for image in (np.zeros((40, 40), np.uint8), np.zeros((1, 1, 3), np.uint8), np.zeros((0, 7), np.uint8)):
        features = posevote.Surf().detect_and_compute(image)
        assert len(features) == 0
        assert features.keypoints.shape == (0,)
        assert features.points.shape == (0, 2)
        assert features.descriptors.shape[0] == 0
        assert features.to_dict() == {"keypoints": [], "descriptors": []}


def test_every_layout_of_the_same_pixels_gives_the_same(blobs):
    expected = posevote.Surf().detect_and_compute(blobs)
    wide = np.zeros((blobs.shape[0] + 3, blobs.shape[1] + 5), np.uint8)
    wide[:-3, :-5] = blobs
    layouts = {
        "crop": (wide[:-3, :-5], True),
        "one channel": (blobs[:, :, None], True),
        "column by column": (np.asfortranarray(blobs), False),
        "mirrored twice": (blobs[:, ::-1].copy()[:, ::-1], False),
        "upside down twice": (blobs[::-1].copy()[::-1], False),
        "memoryview": (memoryview(np.ascontiguousarray(blobs)), True),
    }
    for name, (image, in_place) in layouts.items():
        assert posevote.reads_in_place(image) == in_place, name
        assert equal(posevote.Surf().detect_and_compute(image), expected), name


def test_grey_in_three_channels_or_sixteen_bits_is_still_grey(blobs):
    expected = posevote.Surf().detect_and_compute(blobs)
    bgr = np.repeat(blobs[:, :, None], 3, axis=2)
    assert posevote.reads_in_place(bgr)
    assert not posevote.reads_in_place(bgr[..., ::-1])
    assert equal(posevote.Surf().detect_and_compute(bgr), expected)
    assert equal(posevote.Surf().detect_and_compute(blobs.astype(np.uint16) * 256), expected)


def test_key_points_outside_the_mask_are_left_out(blobs):
    mask = np.zeros(blobs.shape, bool)
    mask[:, 80:] = True
    features = posevote.Surf().detect_and_compute(blobs, mask)
    assert len(features) > 5
    assert features.points[:, 0].min() >= 79.5
    assert equal(posevote.Surf().detect_and_compute(blobs, mask.astype(np.uint8)), features)
    with pytest.raises(posevote.InvalidArgumentError):
        posevote.Surf().detect_and_compute(blobs, mask[1:])


@pytest.mark.parametrize(
    "image, words",
    [
        ([[1, 2], [3, 4]], "numpy array"),
        (b"abc", "numpy array"),
        (None, "numpy array"),
        (np.zeros((4, 4)), "float64"),
        (np.zeros((4, 4), ">u2"), ">u2"),
        (np.zeros(9, np.uint8), "(9)"),
        (np.zeros((4, 4, 2), np.uint8), "(4, 4, 2)"),
        (np.zeros((1, 4, 4, 3), np.uint8), "(1, 4, 4, 3)"),
    ],
)
def test_what_is_no_picture_is_refused_with_what_it_is(image, words):
    with pytest.raises(posevote.InvalidArgumentError) as caught:
        posevote.Surf().detect_and_compute(image)
    assert words in str(caught.value)


def test_options_have_their_effect(blobs):
    all_of_them = posevote.Surf(max_features=0).detect_and_compute(blobs)
    few = posevote.Surf(max_features=7).detect_and_compute(blobs)
    assert len(few) == 7 < len(all_of_them)
    upright = posevote.Surf(upright=True)
    assert set(upright.detect_and_compute(blobs).keypoints["angle"]) == {0}
    assert upright.signature != posevote.Surf().signature
    assert repr(posevote.Surf(upright=True, max_features=7)) == "Surf(max_features=7, upright=true)"


def test_sift_gives_sift(blobs):
    features = posevote.Sift().detect_and_compute(blobs)
    assert features.descriptors.shape == (len(features), 128)
    assert "128" in posevote.Sift().signature


def test_features_can_be_pickled_and_shown(blobs):
    features = posevote.Surf(max_features=3).detect_and_compute(blobs)
    again = pickle.loads(pickle.dumps(features))
    assert equal(features, again)
    assert repr(features) == "Features(3 key points, descriptors 3 x 64)"
    plain = features.to_dict()
    assert plain["keypoints"][0][0] == features.keypoints["x"][0]
    assert np.allclose(plain["descriptors"], features.descriptors)
