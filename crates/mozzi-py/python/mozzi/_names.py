"""Names of the package's modules: those that `dir` lists, and the one that was meant by another library's name."""

from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any


def listed(module: dict[str, Any]) -> Callable[[], list[str]]:
    """Make the `__dir__` of a module: its `__all__`, its own modules and Python's names, without what it imports."""

    def names() -> list[str]:
        inside = module["__name__"] + "."
        return [
            name
            for name, value in module.items()
            if name in module["__all__"]
            or (name.startswith("__") and name.endswith("__"))
            or (isinstance(value, ModuleType) and value.__name__.startswith(inside) and not name.startswith("_"))
        ]

    return names


def missing(module: str, name: str, meant: Mapping[str, str], otherwise: str = "") -> AttributeError:
    """Make the error for a name that does not exist: what was meant, or what the module has."""
    hint = f"that is {meant[name]}" if name in meant else "" if name.startswith("_") else otherwise
    return AttributeError(f"module '{module}' has no attribute '{name}'{': ' if hint else ''}{hint}", name=name)
