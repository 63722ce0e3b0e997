"""Runs the quick start of the README, with nothing but the package and numpy: python tests/quick_start.py"""

import pathlib
import re
import sys

README = pathlib.Path(__file__).parents[1] / "README.md"


def programs(page: pathlib.Path) -> list[str]:
    """The programs in a page."""
    return re.findall(r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.M | re.S)


if __name__ == "__main__":
    exec(compile(programs(README)[0], str(README), "exec"), {})
    if foreign := {"scipy", "sympy", "pandas", "matplotlib"} & set(sys.modules):
        sys.exit(f"the quick start has imported {foreign}")
