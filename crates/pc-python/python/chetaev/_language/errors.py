"""The errors of this package."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from chetaev._protocols import MotionLike


class ChetaevError(Exception):
    """Base class of the errors of this package."""


class ModelError(ChetaevError, ValueError):
    """An error in a model, with its position in the text.

    Attributes
    ----------
    message : str
        What is wrong, without the position.
    entry : str
        Section and entry, such as ``[lagrangian] kinetic``; empty where there is none.
    line, column : int
        Where the error begins, both counted from 1, the column in characters.
    help : str or None
        A suggested correction.

    Examples
    --------
    >>> try:
    ...     Model.from_text('[coordinates]\\nx = 1.0\\n[lagrangian]\\nkinetic = "x\\'^2/2"\\npotential = "k*x^2"').check()
    ... except ModelError as error:
    ...     print(error.line, error.column, error.entry, error.message)
    5 14 [lagrangian] potential the name `k` is not declared
    """

    def __init__(
        self,
        text: str,
        message: str = "",
        entry: str = "",
        line: int = 0,
        column: int = 0,
        help: str | None = None,
    ) -> None:
        super().__init__(text)
        self.message = message or text
        self.entry = entry
        self.line = line
        self.column = column
        self.help = help


class UnknownNameError(ChetaevError, KeyError):
    """A name that the model does not have."""

    def __str__(self) -> str:
        # KeyError would put the sentence in quotes.
        return str(self.args[0]) if self.args else ""


class EvaluationError(ChetaevError, ArithmeticError):
    """The equations have no value at a state."""


class DisagreementError(ChetaevError):
    """The two derivations of a model give different motions."""


class IntegrationError(ChetaevError, RuntimeError):
    """An integration could not continue.

    Attributes
    ----------
    motion : Motion or None
        The motion up to that point.
    """

    def __init__(self, text: str, motion: MotionLike | None = None) -> None:
        super().__init__(text)
        self.motion = motion
