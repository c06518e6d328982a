"""Docstrings are numpydoc: one summary line, then a description of each parameter, field and property."""

import ast
import importlib
import inspect
import re
import textwrap

import mozzi
import pytest

MODULES = [
    "mozzi",
    "mozzi.models",
    "mozzi.conventions",
    "mozzi.controllers",
    "mozzi.trajectories",
    "mozzi.modern_robotics",
    "mozzi.jax",
    "mozzi.torch",
]
WIDE = 120


def public(module):
    """The public classes and functions of a module, by their names."""
    own = [name for name, member in vars(module).items() if getattr(member, "__module__", None) == module.__name__]
    for name in getattr(module, "__all__", own):
        if callable(getattr(module, name)) and not name.startswith("_"):
            yield name, getattr(module, name)


def members(name, class_):
    """The methods, properties and descriptors that a class defines itself."""
    for member, value in vars(class_).items():
        value = value.__func__ if isinstance(value, (staticmethod, classmethod)) else value
        described = callable(value) or isinstance(value, property) or inspect.isgetsetdescriptor(value)
        if described and not member.startswith("_"):
            yield f"{name}.{member}", value


def documented():
    for module_name in MODULES:
        try:
            module = importlib.import_module(module_name)
        except ImportError:  # JAX or PyTorch is not installed
            continue
        for name, member in public(module):
            full = f"{module_name}.{name}"
            yield full, member, module
            if inspect.isclass(member) and not issubclass(member, Exception):
                yield from ((path, value, module) for path, value in members(full, member))


# sorted: a class made in Rust lists its members in another order in each process
EVERYTHING = {path: (member, module) for path, member, module in sorted(documented(), key=lambda found: found[0])}


@pytest.mark.parametrize("path", EVERYTHING)
def test_summary_line(path):
    text = inspect.getdoc(EVERYTHING[path][0])
    assert text, f"{path} has no docstring"
    summary, *rest = text.splitlines()
    assert len(summary) <= WIDE, f"{path}: a summary of {len(summary)} characters, expected at most {WIDE}"
    assert not rest or rest[0] == "", f"{path}: a summary of more than one line: {summary} {rest[0]}"
    assert summary.endswith("."), f"{path}: a summary that is no sentence: {summary}"
    assert not re.match(r"(?:What|Of|The same) ", summary), f"{path}: {summary}"


def described(text):
    """The names that the section `Parameters` of a docstring describes: `a, b : type`."""
    found = set()
    for section in re.findall(r"^Parameters\n-+\n(.*?)(?=^\S[^\n]*\n-+\n|\Z)", text, re.M | re.S):
        for line in re.findall(r"^([^\s:][^:\n]*)(?: : |$)", section, re.M):
            found |= {name.strip().lstrip("*") for name in line.split(",")}
    return found


def fields(class_):
    """The fields of a named tuple that have a docstring of their own."""
    body = ast.parse(textwrap.dedent(inspect.getsource(class_))).body[0].body
    pairs = zip(body, body[1:], strict=False)
    is_text = lambda node: isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)  # noqa: E731
    return {field.target.id for field, after in pairs if isinstance(field, ast.AnnAssign) and is_text(after)}


@pytest.mark.parametrize("path", EVERYTHING)
def test_every_parameter_is_described(path):
    member, module = EVERYTHING[path]
    text = inspect.getdoc(member)
    if inspect.isclass(member) and (issubclass(member, Exception) or "\nAttributes\n---" in text):
        return  # nobody constructs an error or a result of the package
    try:
        given = set(inspect.signature(member).parameters) - {"self"}
    except (TypeError, ValueError):  # a property, or a class without a constructor
        return
    known = described(text)
    if inspect.isclass(member) and issubclass(member, tuple):
        known |= fields(member)
    if module.__name__ == "mozzi.modern_robotics":  # the lists of all functions are described once
        known |= described(inspect.getdoc(module))
    assert not given - known, f"{path} does not describe {', '.join(sorted(given - known))}"


def test_the_package_is_found():
    assert len(EVERYTHING) > 250 and "mozzi.Model.mass_matrix" in EVERYTHING and mozzi.Model.__doc__
