"""Equations in print, and back in SymPy."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from conftest import regular_states

import chetaev


@pytest.mark.parametrize("name", ["heavy-top-lagrange", "chaplygin-sleigh", "turning-hoop", "relativistic-particle"])
def test_equations_of_sympy_have_the_values_of_the_system(name: str) -> None:
    sympy = pytest.importorskip("sympy")
    model = chetaev.Model.builtin(name)
    system = model.system()
    found = model.derive().sympy()
    symbols = found["coordinates"] + found["quasi_velocities"]
    assert [str(symbol) for symbol in symbols] == list(system.names)
    values = dict(model.parameters)
    rates = sympy.lambdify(
        [sympy.Symbol("t", real=True), symbols],
        [
            expression.subs({symbol: values[str(symbol)] for symbol in found["parameters"]})
            for expression in (found["velocities"], found["mass_matrix"], found["right_hand_side"])
        ],
        "numpy",
    )
    for y in regular_states(system, 5).T:
        velocities, mass, right = (np.array(part, dtype=float) for part in rates(0.3, y))
        expected = np.concatenate([velocities.ravel(), np.linalg.solve(mass, right).ravel()])
        # Rounding, in other orders of the operations.
        assert np.allclose(system(0.3, y), expected, rtol=1e-11, atol=1e-12)


def test_forms() -> None:
    model = chetaev.Model.builtin("chaplygin-sleigh")
    for form in ("poincare", "lagrange", "voronets", "reduced", "orthonormal", "maggi", "kane", "gibbs-appell"):
        equations = model.derive(form)
        assert equations.form == form and "Equations" in str(equations)
        assert "\\begin{align" in equations.latex()
        assert equations.data()["model"] == model.title
    assert model.derive("lagrange").text != model.derive("voronets").text
    assert "hamiltonian" in chetaev.Model.builtin("euler-top").derive("canonical").sympy()
    given = chetaev.Model.builtin("euler-top").derive("hamel", velocities={"u": "ω1 + ω2"})
    assert "u" in given.text


def test_forms_without_brackets_in_sympy() -> None:
    sympy = pytest.importorskip("sympy")
    model = chetaev.Model.builtin("chaplygin-sleigh")
    kane = model.derive("kane").sympy()
    assert (kane["inertia_forces"] + kane["acceleration_terms"]).expand().is_zero_matrix
    gibbs = model.derive("gibbs-appell").sympy()
    rates = [sympy.Symbol(f"{eta}'", real=True) for eta in gibbs["quasi_velocities"]]
    slopes = sympy.Matrix([gibbs["gibbs_function"].diff(rate) for rate in rates])
    assert (slopes - kane["acceleration_terms"]).expand().is_zero_matrix
    maggi = model.derive("maggi").sympy()
    assert len(maggi["lagrange_expressions"]) == 3 and maggi["vanishing"].shape == (2, 1)


def test_notebooks_show_formulas() -> None:
    equations = chetaev.Model.builtin("heavy-top-euler").derive()
    shown = equations._repr_html_()
    assert shown.count("<math") >= 3
    ElementTree.fromstring(f"<div>{shown}</div>")
    latex = equations._repr_latex_()
    assert "%" not in latex and "\\begin{align*}" in latex


def test_source_in_c() -> None:
    files = chetaev.Model.builtin("heavy-top-lagrange").derive().c("top")
    assert set(files) == {"top.h", "top.c"} and "top_rhs" in files["top.c"]
    with pytest.raises(chetaev.ChetaevError, match="velocities"):
        chetaev.Model.builtin("heavy-top-lagrange").derive("canonical").c()


def test_check_and_theory() -> None:
    model = chetaev.Model.builtin("euler-top")
    check = model.check()
    assert check.data["closure_residual"] == 0 and "second derivation" in check.text
    assert check._repr_html_().startswith("<pre>")
    theory = model.theory()
    assert "asimir" in theory.text and theory.data() and theory.latex()


def test_canonical_variables() -> None:
    model = chetaev.Model.from_text("[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\"")
    theory = model.theory(degree=1, canonical={"X": "x^2", "Y": "p_x/(2*x)"})
    assert theory.data()["canonical_variables"][-1]["verdict"] == "proved", theory.text


def test_pages() -> None:
    motion = chetaev.Model.builtin("heavy-top-lagrange").system().run(1.0)
    assert motion.report().html.startswith("<!DOCTYPE html>")
    drawn = [name for name in chetaev.Model.builtin_names() if "[[draw]]" in chetaev.Model.builtin(name).text]
    if drawn:
        page = chetaev.Model.builtin(drawn[0]).system().run(0.5).animate()
        assert "<script" in page.html and "srcdoc" in page._repr_html_()
    text = "[coordinates]\nx = 1.0\n[lagrangian]\nkinetic = \"x'^2/2\""
    with pytest.raises(chetaev.ChetaevError, match="nothing to be drawn"):
        chetaev.Model.from_text(text).system().run(1.0).animate()


def test_tables_and_plots() -> None:
    motion = chetaev.Model.builtin("heavy-top-lagrange").system().run(1.0, samples=5)
    pandas = pytest.importorskip("pandas")
    frame = motion.to_pandas()
    assert isinstance(frame, pandas.DataFrame) and list(frame.columns) == list(motion.columns[1:])
    assert (frame["ω1"].to_numpy() == motion["ω1"]).all()
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    titles = [axis.get_title(loc="left") for axis in motion.plot().axes]
    assert titles == ["Coordinates", "Quasi-velocities", "Quasi-velocities", "Relative drift of integrals"]
    figure = motion.plot(["γ3"])
    assert [line.get_label() for line in figure.axes[0].get_lines()] == ["γ3"]
    matplotlib.pyplot.close("all")
