"""Agreement within a tolerance, and numbers in print."""

import numpy as np
from numpy.typing import ArrayLike


def agree(what: str, found: ArrayLike, expected: ArrayLike, tolerance: float) -> None:
    """Says how well two arrays agree, relative to the largest number expected; refuses to go on if they do not."""
    found, expected = np.asarray(found), np.asarray(expected)
    assert found.shape == expected.shape, f"{what}: arrays of two shapes"
    error = abs(found - expected).max() / (abs(expected).max() or 1.0)
    assert error <= tolerance, f"{what}: they differ by {error:e}, more than {tolerance:e}: {found} {expected}"
    print(f"  ✓ {what}: relative difference {error:.0e} ≤ {tolerance:.0e}")


def row(numbers: ArrayLike) -> str:
    """A row of numbers, four decimals each, as text."""
    return " ".join(f"{0.0 if abs(x) < 5e-5 else x:9.4f}" for x in np.asarray(numbers))
