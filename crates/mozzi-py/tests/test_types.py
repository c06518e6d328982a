"""The stubs are the compiled part's, and the type checkers pass them, strictly, with the examples."""

import ast
import inspect
import json
import os
import subprocess
import sys
from pathlib import Path

import mozzi
import pytest
from mozzi import _mozzi

PACKAGE = Path(mozzi.__file__).parent
EXAMPLES = sorted((Path(__file__).parents[3] / "examples").glob("*.py"))


def is_documented(member):
    return inspect.isclass(member) and not issubclass(member, Exception)


def stubs():
    tree = ast.parse((PACKAGE / "_mozzi.pyi").read_text())
    return {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}


@pytest.mark.parametrize("name", [name for name, member in vars(_mozzi).items() if is_documented(member)])
def test_stubs_say_what_is_compiled(name):
    class_, stub = getattr(_mozzi, name), stubs()[name]
    said = {node.name: node for node in stub.body if isinstance(node, ast.FunctionDef)}
    assert {member for member in vars(class_) if not member.startswith("_")} == {m for m in said if not m.startswith("_")}
    for member, node in said.items():
        if member == "__init__":
            given = [a.arg for a in [*node.args.args[1:], *node.args.kwonlyargs]]
            real = inspect.signature(class_).parameters
            assert given == list(real), name
            defaults = [ast.literal_eval(d) for d in [*node.args.defaults, *node.args.kw_defaults] if d is not None]
            assert defaults == [p.default for p in real.values() if p.default is not p.empty], name
        if member.startswith("_") or any(getattr(d, "id", "") == "property" for d in node.decorator_list):
            continue
        variadic = [[*filter(None, [a])] for a in (node.args.vararg, node.args.kwarg)]
        given = [a.arg for a in [*node.args.args, *variadic[0], *node.args.kwonlyargs, *variadic[1]]]
        assert given == list(inspect.signature(getattr(class_, member)).parameters), member
        defaults = [ast.literal_eval(d) for d in [*node.args.defaults, *node.args.kw_defaults] if d is not None]
        real = inspect.signature(getattr(class_, member)).parameters.values()
        assert defaults == [p.default for p in real if p.default is not p.empty], member


def definitions():
    """The classes, methods and functions of the stubs, by their paths in the compiled part."""
    for node in ast.parse((PACKAGE / "_mozzi.pyi").read_text()).body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            yield node.name, node
            yield from ((f"{node.name}.{m.name}", m) for m in node.body if isinstance(m, ast.FunctionDef))


@pytest.mark.parametrize(("path", "node"), [pytest.param(*found, id=found[0]) for found in definitions()])
def test_stubs_have_the_summaries_of_what_is_compiled(path, node):
    owner, _, name = path.rpartition(".")
    if name.startswith("__") or path.startswith("SupportsRead"):  # Python's own documentation; a protocol of the stubs
        return
    member = getattr(getattr(_mozzi, owner) if owner else _mozzi, name)
    expected = " ".join((inspect.getdoc(member) or "").partition("\n\n")[0].split())
    assert " ".join((ast.get_docstring(node) or "").split()) == expected


def test_lines_of_the_stubs():
    assert max(map(len, (PACKAGE / "_mozzi.pyi").read_text().splitlines())) <= 120


def run(tmp_path, *command):
    # in a folder of its own: the package is found as installed, not as files to be checked for style
    environment = {**os.environ, "MYPYPATH": str(PACKAGE.parent), "PYTHONPATH": str(PACKAGE.parent)}
    found = subprocess.run(
        [sys.executable, "-m", *command], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=300
    )
    return found


def test_mypy(tmp_path):
    found = run(tmp_path, "mypy", "--strict", "--cache-dir", str(tmp_path), "-p", "mozzi")
    assert found.returncode == 0, found.stdout + found.stderr
    for example in EXAMPLES:
        found = run(tmp_path, "mypy", "--strict", "--cache-dir", str(tmp_path), str(example))
        assert found.returncode == 0, found.stdout + found.stderr


def test_pyright(tmp_path):
    started = run(tmp_path, "pyright", "--version")
    if started.returncode != 0:
        pytest.skip("pyright does not start: it fetches its own program once")
    paths = [str(PACKAGE.parent), str(EXAMPLES[0].parent)]  # examples import what they share
    (tmp_path / "pyrightconfig.json").write_text(json.dumps({"extraPaths": paths}))
    found = run(tmp_path, "pyright", "--pythonpath", sys.executable, str(PACKAGE), *map(str, EXAMPLES))
    assert found.returncode == 0, found.stdout + found.stderr
