"""Events of a run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from chetaev._language.toml import formula, quoted


@dataclass(frozen=True)
class Event:
    """An event of a run, in addition to those of the text.

    Parameters
    ----------
    when : expression
        The event occurs where this expression vanishes.
    direction : str
        ``"rising"``, ``"falling"`` or ``"both"``.
    terminal : bool
        Whether the event ends the motion.
    reset : mapping
        New values of coordinates and quasi-velocities.
    """

    when: Any
    direction: str = "both"
    terminal: bool = False
    reset: Mapping[str, Any] = field(default_factory=dict)

    def text(self, name: str) -> str:
        """The section for this event in the text of a model."""
        lines = [
            f"[events.{quoted(name)}]",
            f"when = {formula(self.when)}",
            f"direction = {quoted(self.direction)}",
            f"terminal = {'true' if self.terminal else 'false'}",
        ]
        lines += [f"reset.{quoted(variable)} = {formula(value)}" for variable, value in self.reset.items()]
        return "\n".join(lines) + "\n"
