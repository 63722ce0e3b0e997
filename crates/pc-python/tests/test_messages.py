"""Messages that name options do so in the notation of Python."""

import re

import pytest

import chetaev

OFF = """
[coordinates]
x = 0.0
y = -1.1
[constraints]
rod = "x^2 + y^2 - 1"
[lagrangian]
kinetic = "(x'^2 + y'^2)/2"  # --set is a comment here
potential = "9.81*y"
"""

DRIVEN = """
[coordinates]
x = 0.0
[lagrangian]
kinetic = "x'^2/2"
[forces]
x = "{force}"
"""


def test_messages_name_arguments_of_python() -> None:
    furuta = chetaev.Model.builtin("furuta-pendulum")
    driven = [chetaev.Model.from_text(DRIVEN.replace("{force}", force)) for force in ("sin(t)", "1 + x^2")]
    top = chetaev.Model.builtin("heavy-top-lagrange")
    attempts = [
        (lambda: furuta.linearize(hold=["z"]), "hold: there is no component `z`"),
        (lambda: furuta.root_locus("z", [1.0]), "^`z` is"),
        (lambda: furuta.equilibria({"z": (0, 1)}), "box: there is no component `z`"),
        (lambda: furuta.equilibria({"θ": (1, 0)}), "box: the box of `θ`"),
        (lambda: driven[0].linearize(), '`at="start"` gives their Jacobian'),
        (lambda: driven[1].linearize(), r"`start=\{NAME: VALUE\}`\), which `equilibria` finds .* \(`hold`\)"),
        (lambda: driven[1].equilibria(), r"`box=\{NAME: \(FROM, TO\)\}`\), or take more starts \(`starts`\)"),
        (lambda: chetaev.Model.from_text(OFF).system(), r"`project_start=True` \(`hold` names what is to stay\)"),
        (lambda: top.system(limit_memory=1 << 12), r"\(`limit_memory`, `limit_time`\)"),
        (lambda: top.system("hamel"), r"give them as `velocities=\{"),
    ]
    for attempt, message in attempts:
        with pytest.raises(chetaev.ChetaevError) as raised:
            attempt()
        shown = str(raised.value)
        assert re.search(message, " ".join(shown.split())), shown
        assert "--" not in shown.replace("# --set", "") and "`pc " not in shown, shown
        help = getattr(raised.value, "help", None)
        assert help is None or (help in shown and "--" not in help)
