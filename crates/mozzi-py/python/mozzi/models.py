"""The embedded robots, each a function: ``mozzi.models.ur5()``."""

from ._mozzi import Model


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
