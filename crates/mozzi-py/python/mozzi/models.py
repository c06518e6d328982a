"""The embedded robots, each a function: ``mozzi.models.ur5()``."""

from ._mozzi import Model


def ur5(*, floating: bool = False) -> Model:
    """Universal Robots' UR5."""
    return Model._embedded("ur5", floating)


def panda(*, floating: bool = False) -> Model:
    """Franka Emika's Panda, with its hand."""
    return Model._embedded("panda", floating)


def anymal(*, floating: bool = True) -> Model:
    """ANYbotics' ANYmal, by default with a floating base."""
    return Model._embedded("anymal", floating)


def two_link_planar(*, floating: bool = False) -> Model:
    """Two links in a plane."""
    return Model._embedded("two_link_planar", floating)


def double_pendulum(*, floating: bool = False) -> Model:
    """A double pendulum."""
    return Model._embedded("double_pendulum", floating)


def furuta_pendulum(*, floating: bool = False) -> Model:
    """Furuta's pendulum."""
    return Model._embedded("furuta_pendulum", floating)
