"""Examples in documents run."""

import doctest
import importlib
import pathlib
import pkgutil

import pytest
from quick_start import README, programs

import chetaev

BOOK = pathlib.Path(__file__).parents[3] / "docs/python.md"
PACKAGES = pkgutil.walk_packages(chetaev.__path__, "chetaev.")
MODULES = ["chetaev", *(module.name for module in PACKAGES if module.name != "chetaev._native")]


@pytest.mark.parametrize("name", MODULES)
def test_docstrings(name: str) -> None:
    module = importlib.import_module(name)
    names = {name: getattr(chetaev, name) for name in chetaev.__all__}
    outcome = doctest.testmod(module, extraglobs=names)
    assert outcome.failed == 0


@pytest.mark.parametrize("page", [README, BOOK], ids=lambda page: page.name)
def test_programs_of_pages(page: pathlib.Path) -> None:
    if not page.exists():
        pytest.skip(f"{page} belongs to the repository")
    assert len(programs(page)) >= 4
    names: dict[str, object] = {}
    for program in programs(page):
        exec(compile(program, str(page), "exec"), names)


def test_every_public_name_is_documented() -> None:
    missing = []
    for name in chetaev.__all__:
        value = getattr(chetaev, name)
        if isinstance(value, chetaev.Expression):
            continue
        if not value.__doc__:
            missing.append(name)
        if isinstance(value, type):
            members = (m for m in vars(value) if not m.startswith("_"))
            missing += [f"{name}.{m}" for m in members if callable(getattr(value, m)) and not getattr(value, m).__doc__]
    assert not missing
