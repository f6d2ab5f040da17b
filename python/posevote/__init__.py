"""Teach a computer particular objects and find them again in pictures.

    import posevote

    with posevote.ObjectStore("objects.db") as store:
        store.teach("mug", "mug.jpg", background="table.jpg", yaw_deg=0)
        recognizer = posevote.Recognizer(store)
    for found in recognizer.recognize(posevote.read_image("desk.jpg")):
        print(found.object, found.box, found.confidence)

Pictures are numpy arrays as OpenCV gives them: uint8, H x W (grey) or H x W x 3 in the order BGR,
read in place. Pixel (0, 0) is the centre of the top-left pixel, x to the right, y down; lengths are
pixels, angles degrees unless something else is said. OpenCV's own module cv2 is not needed.

Options are keywords: those of the command line with _ for the dots, e.g. match_max_ratio=0.8. An
unknown one raises OptionError, which names the nearest. All errors are subclasses of Error.

Arrays in results are read-only and belong to the result. Long calls let other threads run.
"""

import inspect as _inspect

from . import _core, errors
from ._core import (
    AddResult,
    Detection,
    Evaluation,
    Features,
    Frame,
    ModelSet,
    ObjectStore,
    ObjectSummary,
    Recognition,
    Recognizer,
    Sift,
    StageCounts,
    StageTimes,
    Summary,
    Surf,
    TransferResult,
    Video,
    View,
    ViewSummary,
    __version__,
    annotate,
    decode_image,
    evaluate,
    find_object,
    preset_names,
    read_image,
    reads_in_place,
    teach_view,
)
from .errors import (
    AlreadyExistsError,
    DatabaseError,
    Error,
    FeatureMismatchError,
    InvalidArgumentError,
    IoError,
    NotFoundError,
    OptionError,
    UnreadableImageError,
    UnsupportedError,
    UnusableViewError,
)

__all__ = [name for name in dir() if not name.startswith("_")] + ["__version__"]


def _signature(parameters, options):
    """What inspect and editors show of a class whose keywords are the library's options."""
    kinds = _inspect.Parameter
    known = [kinds(name, kind, **default) for name, kind, default in parameters]
    for option in options:
        known.append(kinds(option["name"], kinds.KEYWORD_ONLY, default=option["default"]))
    return _inspect.Signature(known)


Surf.__signature__ = _signature([], _core._extractor_options("surf"))
Sift.__signature__ = _signature([], _core._extractor_options("sift"))
Recognizer.__signature__ = _signature(
    [
        ("models", _inspect.Parameter.POSITIONAL_OR_KEYWORD, {}),
        ("preset", _inspect.Parameter.KEYWORD_ONLY, {"default": "default"}),
    ],
    _core._recognize_options("default"),
)

# The classes are this package's, wherever their code lies.
for _name in __all__:
    if isinstance(globals()[_name], type) and globals()[_name].__module__ == _core.__name__:
        globals()[_name].__module__ = __name__
