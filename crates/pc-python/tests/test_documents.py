"""Examples in documents run."""

import doctest
import importlib
import pathlib
import re

import pytest

import chetaev

README = pathlib.Path(__file__).parents[1] / "README.md"
MODULES = [f"chetaev{name}" for name in ("", *(f"._{m}" for m in "builder errors expressions model motion sweep system".split()))]


@pytest.mark.parametrize("name", MODULES)
def test_docstrings(name: str) -> None:
    module = importlib.import_module(name)
    names = {name: getattr(chetaev, name) for name in chetaev.__all__}
    outcome = doctest.testmod(module, extraglobs=names)
    assert outcome.failed == 0


def test_readme() -> None:
    blocks = re.findall(r"^```python\n(.*?)^```", README.read_text(encoding="utf-8"), flags=re.M | re.S)
    assert len(blocks) >= 4
    names: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, str(README), "exec"), names)


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
