"""Keywords come from the library's own description; errors are one tree."""

import inspect

import pytest

import posevote
from posevote import _core, errors

DESCRIBED = {
    "surf": _core._extractor_options("surf"),
    "sift": _core._extractor_options("sift"),
    "recognize": _core._recognize_options("default"),
    "teach": _core._teach_options(),
    "segment": _core._segment_options(),
}


@pytest.mark.parametrize("kind", DESCRIBED)
def test_keywords_are_names_and_differ(kind):
    names = [option["name"] for option in DESCRIBED[kind]]
    assert names and all(name.isidentifier() for name in names)
    assert len(set(names)) == len(names)


def test_every_keyword_takes_its_default():
    options = {option["name"]: option["default"] for option in DESCRIBED["recognize"]}
    assert posevote.Recognizer({}, **options).options == options
    for make, kind in ((posevote.Surf, "surf"), (posevote.Sift, "sift")):
        make(**{option["name"]: option["default"] for option in DESCRIBED[kind]})


def test_signature_and_help_list_every_keyword():
    for what, kind in ((posevote.Surf, "surf"), (posevote.Recognizer, "recognize")):
        parameters = inspect.signature(what).parameters
        for option in DESCRIBED[kind]:
            assert parameters[option["name"]].default == option["default"]
            assert option["name"] + "=" in what.__doc__
            assert option["help"] in what.__doc__
    for option in DESCRIBED["teach"]:
        assert option["name"] + "=" in posevote.teach_view.__doc__


def test_a_preset_and_keywords_change_options():
    assert posevote.Recognizer({}, match_max_ratio=0.5).options["match_max_ratio"] == 0.5
    assert posevote.Recognizer({}, preset="paper").options["rule"] == "paper"
    assert posevote.Recognizer({}, **{"match.max_ratio": 0.5}).options["match_max_ratio"] == 0.5
    assert "paper" in posevote.preset_names()


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: posevote.Surf(hesian_threshold=3), ["hesian_threshold", "hessian_threshold"]),
        (lambda: posevote.Recognizer({}, match_max_ration=0.5), ["match_max_ratio'?"]),
        (lambda: posevote.teach_view("x.jpg", min_feature=3), ["min_features"]),
        (lambda: posevote.Surf(zebra=1), ["zebra", "help()"]),
    ],
)
def test_an_unknown_keyword_names_the_nearest(call, words):
    with pytest.raises(posevote.OptionError) as caught:
        call()
    assert all(word in str(caught.value) for word in words)
    assert isinstance(caught.value, TypeError)  # as for any unknown keyword


@pytest.mark.parametrize(
    "call, words",
    [
        (lambda: posevote.Surf(octaves=0), ["octaves", "1", "8"]),
        (lambda: posevote.Surf(octaves=2.5), ["octaves", "2.5"]),
        (lambda: posevote.Surf(octaves="2"), ["octaves", "number"]),
        (lambda: posevote.Surf(upright=1), ["upright", "True or False"]),
        (lambda: posevote.Surf(hessian_threshold=float("nan")), ["hessian_threshold"]),
        (lambda: posevote.Recognizer({}, rule="maybe"), ["rule", "paper"]),
        (lambda: posevote.Recognizer({}, preset="nix"), ["nix"]),
    ],
)
def test_wrong_values_are_refused_by_name(call, words):
    with pytest.raises(posevote.InvalidArgumentError) as caught:
        call()
    assert all(word in str(caught.value) for word in words)


def test_each_code_of_the_library_has_a_class():
    assert sorted(_core._error_codes()) == sorted(errors.CLASSES)
    for code, kind in errors.CLASSES.items():
        assert issubclass(kind, posevote.Error)
        assert kind.code == code
        assert getattr(posevote, kind.__name__) is kind
        assert kind.__doc__


def test_errors_are_what_python_expects(tmp_path):
    with pytest.raises(OSError) as caught:
        posevote.read_image(tmp_path / "nothing.jpg")
    assert isinstance(caught.value, posevote.UnreadableImageError)
    assert "nothing.jpg" in str(caught.value)
    assert caught.value.code == "unreadable_image"
    with pytest.raises(LookupError):
        posevote.ObjectStore(tmp_path / "nothing.db", "existing")
