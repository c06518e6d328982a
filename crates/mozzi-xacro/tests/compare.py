"""Compares mozzi's expansion of xacro with PyPI's xacro, the reference, as canonical XML with numbers to 1e-12.

    python compare.py BATCH [--write] [--fuzz SECONDS] [--seed N]

BATCH is the example `batch` of mozzi-xacro. Needs `pip install xacro==2.1.1`. The cases are in cases/; --write writes
what PyPI's xacro gives to cases/expected.txt, with which the Rust test compares where there is no Python. --fuzz
compares random expressions, too.
"""

import argparse
import io
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree as tree
from contextlib import redirect_stderr, redirect_stdout
from xml.sax.saxutils import quoteattr

import xacro

HERE = pathlib.Path(__file__).parent / "cases"
ROOT = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
PACKAGES = {}


def cases():
    """The cases: name, arguments, and files by name; the first file is expanded."""
    for number, line in enumerate((HERE / "expressions.txt").read_text().splitlines(), 1):
        if line.strip() and not line.startswith("#"):
            yield f"expression {number}: {line}", {}, {"main.xacro": expression(line)}
    name, arguments, files, current = None, {}, {}, None
    for line in (HERE / "documents.txt").read_text().splitlines() + ["=== end"]:
        if line.startswith("=== "):
            if name:
                yield name, arguments, {key: wrapped(key, "\n".join(text)) for key, text in files.items()}
            name, *given = line[4:].split(" | ")
            arguments = dict(word.split(":=", 1) for word in " ".join(given).split())
            current = "main.xacro"
            files = {current: []}
        elif line.startswith("--- "):
            current = line[4:]
            files[current] = []
        elif name:
            files[current].append(line)


def expression(text):
    return ROOT.format(f"<a v={quoteattr('${' + text + '}')}/>")


def wrapped(name, text):
    return text if name.endswith(".yaml") or text.startswith(("<?xml", "<robot", "<!--", "<mujoco")) else ROOT.format(text)


def reference(path, arguments):
    """What PyPI's xacro gives, without its banner; None if it refuses."""
    try:
        signal.setitimer(signal.ITIMER_REAL, 2.0)  # it has no bounds of its own
        with redirect_stderr(io.StringIO()), redirect_stdout(io.StringIO()):
            xacro.init_stacks(path)
            document = xacro.parse(None, path)
            xacro.process_doc(document, mappings=dict(arguments))
            text = document.toprettyxml(indent="  ")
        tree.fromstring(text)
        return text
    except BaseException as error:
        if isinstance(error, KeyboardInterrupt):
            raise
        return None
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def canonical(text):
    """The tree as nested tuples, white space joined."""
    words = lambda text: " ".join((text or "").split())
    node = lambda e: (e.tag, sorted((key, words(value)) for key, value in e.attrib.items()), words(e.text), [(node(c), words(c.tail)) for c in e])
    return node(tree.fromstring(text))


def equal(a, b):
    """Trees that differ in the last digits of numbers at most."""
    if isinstance(a, str):
        return a == b or isinstance(b, str) and all_close(re.split(r"([\s,()\[\]:{}]+)", a), re.split(r"([\s,()\[\]:{}]+)", b))
    return type(a) is type(b) and len(a) == len(b) and all(equal(x, y) for x, y in zip(a, b))


def all_close(a, b):
    def close(x, y):
        try:
            return abs(float(x) - float(y)) <= 1e-12 * max(1.0, abs(float(x)))
        except ValueError:
            return False
    return len(a) == len(b) and all(x == y or close(x, y) for x, y in zip(a, b))


class Batch:
    """mozzi's expansions."""

    def __init__(self, program):
        self.process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def expand(self, path, arguments):
        words = [path] + [f"{name}:={value}" for name, value in arguments.items()] + [f"{name}={folder}" for name, folder in PACKAGES.items()]
        self.process.stdin.write(("\t".join(words) + "\n").encode())
        self.process.stdin.flush()
        verdict, length = self.process.stdout.readline().decode().split()
        return verdict == "ok", self.process.stdout.read(int(length)).decode()


def verdict(name, text, ok, ours):
    """A sentence if the two disagree."""
    if text is None:
        return f"accepted, PyPI's refuses: {name}\n  {ours[:300]}" if ok else None
    if not ok:
        return f"refused, PyPI's accepts: {name}\n  {ours}\n  {text[23:300]}"
    return None if text == ours or equal(canonical(text), canonical(ours)) else f"different: {name}\n  PyPI:  {text[23:400]}\n  mozzi: {ours[23:400]}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("batch")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--fuzz", type=float, default=0.0)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    signal.signal(signal.SIGALRM, lambda *_: (_ for _ in ()).throw(TimeoutError()))
    resource.setrlimit(resource.RLIMIT_AS, (4 << 30, 4 << 30))
    program, wrong, expected, count, refused, same = os.path.abspath(options.batch), [], [], 0, 0, 0
    os.environ["MOZZI_XACRO_CASE"] = "case"
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        batch = Batch(program)
        for name, arguments, files in cases():
            for file, text in files.items():
                os.makedirs(os.path.dirname(file) or ".", exist_ok=True)
                pathlib.Path(file).write_text(text)
            text = reference("main.xacro", arguments)
            ok, ours = batch.expand("main.xacro", arguments)
            count, refused, same = count + 1, refused + (text is None), same + (text == ours)
            found = verdict(name, text, ok, ours)
            wrong += [found] if found else []
            expected.append(f"=== {name}\n{'refused' if text is None else text.replace(folder, 'FOLDER')}\n")
            for file in files:
                os.remove(file)
        print(f"{count} cases, of which {refused} are refused: {count - len(wrong)} agree, {same} of them to the byte")
        if options.fuzz:
            wrong += fuzz(batch, options.fuzz, options.seed)
    if options.write:
        (HERE / "expected.txt").write_text("".join(expected))
    print("\n".join(wrong[:60]))
    return 1 if wrong else 0


def fuzz(batch, seconds, seed):
    """Random expressions."""
    draw, wrong, count, accepted = random.Random(seed), [], 0, 0
    end = time.monotonic() + seconds
    while time.monotonic() < end and len(wrong) < 20:
        line = random_expression(draw, draw.randint(1, 4))
        pathlib.Path("main.xacro").write_text(expression(line))
        text, (ok, ours) = reference("main.xacro", {}), batch.expand("main.xacro", {})
        count, accepted = count + 1, accepted + (text is not None)
        found = None if not ok and bounded(ours) else verdict(line, text, ok, ours)
        wrong += [found] if found else []
    print(f"{count} random expressions, of which PyPI's xacro accepts {accepted}: {count - len(wrong)} agree")
    return wrong


def bounded(message):
    """Refused for a bound, or for what is documented as not supported."""
    return re.search(r"expected at most|steps|complex|not defined, expected|has no text|is not supported|order of this set|more than \d+ bits", message)


NUMBERS = ["0", "1", "2", "3", "7", "-1", "10", "100", "0.5", "1.5", "2.5", "-0.0", "0.1", "1e3", "1e-7", "1e16", "3.14159", "10**20", "12345678901234567890", "True", "False"]
TEXTS = ["''", "'a'", "'abc'", "'Hello World'", "'12'", "'1.5'", "' x '", "'a,b,,c'", "'-7'", "'_'", "'ab' 'cd'", "'%s'", "'%5.2f|'", "'%d'", "'%-6s|'", "'%05d'", "'%g'", "'%x'"]
LISTS = ["[]", "[1, 2, 3]", "[3, 1.5, 2]", "['b', 'a']", "(1, 2)", "range(4)", "[0, 1, 0]", "list('abc')", "dict(a=1, b=2)", "[[1, 2], [3]]", "('x',)"]
OPERATORS = ["+", "-", "*", "/", "//", "%", "**", "==", "!=", "<", "<=", ">", ">=", "and", "or", "in", "not in", "&", "|", "^", "<<", ">>"]
CALLS = ["len", "str", "int", "float", "bool", "round", "min", "max", "list", "sorted", "python.sum", "python.abs", "python.any", "python.all", "python.repr", "floor", "ceil", "sqrt", "sin", "cos", "exp", "log", "fabs", "trunc", "radians", "python.tuple", "isnan", "factorial", "math.isqrt"]
PAIRS = ["pow", "atan2", "min", "max", "round", "python.divmod", "fmod", "hypot", "copysign", "gcd", "math.comb", "log", "isclose", "math.remainder", "range", "int"]
METHODS = ["upper()", "lower()", "strip()", "split()", "split(',')", "title()", "capitalize()", "isdigit()", "isalpha()", "zfill(6)", "center(9, '*')", "ljust(5)", "rjust(7)", "count('a')", "find('b')", "replace('a', 'xy')", "startswith('a')", "swapcase()", "partition(',')", "rsplit(',', 1)", "splitlines()", "index(1)", "keys()", "items()", "get('a')", "is_integer()", "bit_length()", "format(1, 2.5)", "join(['x', 'y'])", "istitle()", "isupper()"]
SLICES = ["[0]", "[-1]", "[1:]", "[:-1]", "[::-1]", "[::2]", "[1:3]", "['a']", "[5]", "[-2:]"]


def random_expression(draw, depth):
    pick = draw.choice
    if depth == 0:
        return pick(NUMBERS + NUMBERS + TEXTS + LISTS)
    inner = lambda: random_expression(draw, draw.randint(0, depth - 1))
    kind = draw.randint(0, 13)
    if kind <= 3:
        return f"{inner()} {pick(OPERATORS)} {inner()}"
    if kind == 4:
        return f"({inner()}) {pick(OPERATORS)} ({inner()})"
    if kind == 5:
        return f"{pick(['-', 'not ', '+', '~'])}{inner()}"
    if kind == 6:
        return f"{pick(CALLS)}({inner()})"
    if kind == 7:
        return f"{pick(PAIRS)}({inner()}, {inner()})"
    if kind == 8:
        return f"({inner()}).{pick(METHODS)}"
    if kind == 9:
        return f"({inner()}){pick(SLICES)}"
    if kind == 10:
        return f"{inner()} if {inner()} else {inner()}"
    if kind == 11:
        return f"[{pick(['x', 'x + 1', 'str(x)', 'x * 2', '(x, 1)', '-x'])} for x in {inner()}{pick(['', ' if x', ' if x != 1'])}]"
    if kind == 12:
        return f"{pick(TEXTS)} % ({inner()})"
    return f"({inner()}, {inner()})"


if __name__ == "__main__":
    sys.exit(main())
