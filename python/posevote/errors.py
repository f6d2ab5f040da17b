"""The exceptions of posevote: one tree, one class for each of the library's codes.

Each is also the built-in exception that Python programs expect, e.g. NotFoundError is a
LookupError.
"""


class Error(Exception):
    """Base of all. `code` is the library's name for the reason; str() is one sentence."""

    code = "error"


class InvalidArgumentError(Error, ValueError):
    """An option, a name or an array's shape is out of range."""

    code = "invalid_argument"


class OptionError(InvalidArgumentError, TypeError):
    """There is no option of that name; the message names the nearest."""


class UnreadableImageError(Error, OSError):
    """The file is missing, not an image, or larger than the limit."""

    code = "unreadable_image"


class UnusableViewError(Error, ValueError):
    """The picture was read, but no object can be taught from it; the message has advice."""

    code = "unusable_view"


class NotFoundError(Error, LookupError):
    """No such object, view, file or database."""

    code = "not_found"


class AlreadyExistsError(Error, ValueError):
    """The new name is taken."""

    code = "already_exists"


class FeatureMismatchError(Error, ValueError):
    """Features of another kind or with other parameters may not be mixed."""

    code = "feature_mismatch"


class DatabaseError(Error):
    """Not a posevote database, damaged, or of a newer version."""

    code = "database_unusable"


class IoError(Error, OSError):
    """Disk full, no permission, connection lost."""

    code = "io"


class UnsupportedError(Error, NotImplementedError):
    """This build lacks the part that was asked for."""

    code = "unsupported"


CLASSES = {
    error.code: error
    for error in (
        InvalidArgumentError,
        UnreadableImageError,
        UnusableViewError,
        NotFoundError,
        AlreadyExistsError,
        FeatureMismatchError,
        DatabaseError,
        IoError,
        UnsupportedError,
    )
}
