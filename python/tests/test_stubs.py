"""Stubs and docstrings say what is there."""

import ast
import inspect
from pathlib import Path

import posevote
from posevote import split

PACKAGE = Path(posevote.__file__).parent
STUBS = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"))
CLASSES = {node.name: node for node in STUBS.body if isinstance(node, ast.ClassDef)}
FUNCTIONS = {node.name: node for node in STUBS.body if isinstance(node, ast.FunctionDef)}


def own(cls):
    """Public names that the class itself defines."""
    return {name for name in vars(cls) if not name.startswith("_")}


def test_the_package_says_that_it_is_typed():
    assert (PACKAGE / "py.typed").exists()


def test_stubs_and_package_have_the_same_names():
    public = {name for name in posevote.__all__ if not inspect.ismodule(getattr(posevote, name))}
    errors = {n for n in public if inspect.isclass(getattr(posevote, n)) and n.endswith("Error")}
    stubbed = {name for name in CLASSES if not name.startswith("_")} | set(FUNCTIONS)
    assert stubbed == public - errors - {"__version__"}
    for name, node in CLASSES.items():
        if name.startswith("_"):
            continue
        members = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
        assert {m for m in members if not m.startswith("_")} == own(getattr(posevote, name)), name


def documented_arguments(doc):
    """Argument names of a docstring's first line, NAME(a, *, b=1, **options) -> TYPE."""
    first = doc.splitlines()[0]
    arguments = ast.parse(f"def f{first[first.index('('):]}: ...").body[0].args
    return [a.arg for a in arguments.args + arguments.kwonlyargs], arguments.kwarg


def test_docstrings_begin_with_the_signature_of_the_stub():
    wanted = [(node, getattr(posevote, name)) for name, node in FUNCTIONS.items()]
    for name, node in CLASSES.items():
        if name.startswith("_"):
            continue
        for method in node.body:
            if not isinstance(method, ast.FunctionDef) or method.name.startswith("_"):
                continue
            if any(getattr(d, "id", "") == "property" for d in method.decorator_list):
                continue
            wanted.append((method, getattr(getattr(posevote, name), method.name)))
    for node, function in wanted:
        stub = [a.arg for a in node.args.args + node.args.kwonlyargs if a.arg != "self"]
        if not stub:
            continue
        assert function.__doc__.startswith(node.name + "("), node.name
        names, options = documented_arguments(function.__doc__)
        assert names == stub[: len(names)], node.name
        assert options is not None or len(names) == len(stub), node.name


def test_everything_public_is_documented():
    for name in posevote.__all__:
        thing = getattr(posevote, name)
        if inspect.isclass(thing) or inspect.isbuiltin(thing):
            assert thing.__doc__ and len(thing.__doc__.strip()) > 10, name
            if inspect.isclass(thing):
                assert thing.__module__.startswith("posevote") and "_core" not in thing.__module__


def test_properties_are_documented():
    for name in CLASSES:
        for member in own(getattr(posevote, name, object)):
            thing = vars(getattr(posevote, name))[member]
            if isinstance(thing, property):
                assert thing.__doc__, f"{name}.{member}"


def test_what_has_no_stub_says_its_types():
    signature = inspect.signature(split.join)
    assert all(p.annotation is not p.empty for p in signature.parameters.values())
    assert signature.return_annotation == "list[Detection]"
