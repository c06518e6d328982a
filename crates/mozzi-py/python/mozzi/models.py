"""The embedded robots, each a function: ``mozzi.models.ur5()``."""

from typing import TYPE_CHECKING

from ._mozzi import Model
from ._names import listed as _listed
from ._names import missing as _missing

__all__ = ["anymal", "double_pendulum", "furuta_pendulum", "panda", "two_link_planar", "ur5"]


def ur5(*, floating: bool = False) -> Model:
    """Universal Robots' UR5.

    Parameters
    ----------
    floating : bool
        True for a floating base.

    Returns
    -------
    Model
    """
    return Model._embedded("ur5", floating)


def panda(*, floating: bool = False) -> Model:
    """Franka Emika's Panda, with its hand.

    Parameters
    ----------
    floating : bool
        True for a floating base.

    Returns
    -------
    Model
    """
    return Model._embedded("panda", floating)


def anymal(*, floating: bool = True) -> Model:
    """ANYbotics' ANYmal; its base is floating by default.

    Parameters
    ----------
    floating : bool
        True for a floating base.

    Returns
    -------
    Model
    """
    return Model._embedded("anymal", floating)


def two_link_planar(*, floating: bool = False) -> Model:
    """A planar arm of two links.

    Parameters
    ----------
    floating : bool
        True for a floating base.

    Returns
    -------
    Model
    """
    return Model._embedded("two_link_planar", floating)


def double_pendulum(*, floating: bool = False) -> Model:
    """A double pendulum.

    Parameters
    ----------
    floating : bool
        True for a floating base.

    Returns
    -------
    Model
    """
    return Model._embedded("double_pendulum", floating)


def furuta_pendulum(*, floating: bool = False) -> Model:
    """Furuta's pendulum.

    Parameters
    ----------
    floating : bool
        True for a floating base.

    Returns
    -------
    Model
    """
    return Model._embedded("furuta_pendulum", floating)


if not TYPE_CHECKING:  # for which every name would exist

    def __getattr__(name: str) -> object:
        """The robots and the reader of files, for a name that does not exist."""
        meant = dict.fromkeys(("load", "open", "from_file", "from_urdf"), "mozzi.Model.load(path)")
        robots = f"the robots are {', '.join(__all__)}; mozzi.Model.load(path) reads a file"
        raise _missing("mozzi.models", name, meant, robots)

    __dir__ = _listed(globals())
