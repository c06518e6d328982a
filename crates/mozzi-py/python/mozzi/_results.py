"""Results of several parts. The compiled methods make them by position."""

from typing import Any, NamedTuple


class InverseDynamicsDerivatives(NamedTuple):
    """∂τ/∂θ, ∂τ/∂θ̇, ∂τ/∂θ̈ = M, each (..., n, n)."""

    by_theta: Any
    by_dtheta: Any
    by_ddtheta: Any


class ForwardDynamicsDerivatives(NamedTuple):
    """θ̈ (..., n); ∂θ̈/∂θ, ∂θ̈/∂θ̇, ∂θ̈/∂τ = M⁻¹, each (..., n, n)."""

    ddtheta: Any
    by_theta: Any
    by_dtheta: Any
    by_tau: Any


class TaskSpaceDynamics(NamedTuple):
    """Λ (..., k, k) and η (..., k) of 𝓕 = Λ𝒱̇ + η."""

    Lambda: Any
    eta: Any


class EnergyRegressors(NamedTuple):
    """The rows of the kinetic and the potential energy, each (..., parameters)."""

    kinetic: Any
    potential: Any


class ScrewLists(NamedTuple):
    """The book's lists, over the moving links: see ``Model.screws``."""

    joints: list[str]
    links: list[str]
    parents: list[int]
    M: Any
    M_relative: Any
    S: Any
    A: Any
    B: Any
    G: Any
    end_effector: Any


class Trajectory(NamedTuple):
    """A simulated motion: one row for each recorded time; works in J since the start."""

    t: Any
    theta: Any
    dtheta: Any
    ddtheta: Any
    tau: Any
    kinetic_energy: Any
    potential_energy: Any
    motor_work: Any
    friction_loss: Any
    applied_work: Any
    position_names: list[str]
    velocity_names: list[str]

    @property
    def energy(self) -> Any:
        """Kinetic and potential, J."""
        return self.kinetic_energy + self.potential_energy

    def to_pandas(self) -> Any:
        """A pandas.DataFrame over t, with the columns theta.<joint>, dtheta.<joint>, ddtheta.<joint>, tau.<joint>."""
        import pandas

        columns = {f"theta.{name}": self.theta[:, k] for k, name in enumerate(self.position_names)}
        for what in ("dtheta", "ddtheta", "tau"):
            columns |= {f"{what}.{name}": getattr(self, what)[:, k] for k, name in enumerate(self.velocity_names)}
        return pandas.DataFrame(columns, index=pandas.Index(self.t, name="t"))
