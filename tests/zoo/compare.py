"""The accelerations of every robot in this folder, from pc, from rigid_bodies.py and from two peers.

    python tests/zoo/compare.py                      # all robots, with target/debug/pc
    python tests/zoo/compare.py hand34 --program pc  # one of them, with another program

Prints a table and ends with 1 where anything disagrees, where pc refuses what it should take or takes what
it should refuse, and where dynamics.json is not what record.py would write. The columns `pc`,
`Pinocchio` and `MuJoCo` have the largest difference from rigid_bodies.py over all accelerations, relative
to the largest acceleration. `residual` is what is left over where the accelerations of pc are put into the
equations of rigid_bodies.py: in each row relative to the sizes that its terms √M_ii √M_jj a_j and h_i can
have.

The tolerances. A difference of accelerations is at most the rounding, 1e-16 a few times, times the
condition of the mass matrix. Scaled to a unit diagonal, the matrices here have conditions up to 1e6 (column
`condition`; a snake of forty links): 1e-10. The residual does not know the condition. What remains is the
rounding of numbers that are added along a chain of up to forty links, and that of a file's angles: where
one is within 1e-10 of a multiple of π/2, pc takes it for this multiple. In arm_singular, one is 5e-12 away.
"""

import argparse
import json
import pathlib
import sys

import numpy as np

import peers
import program
import record
import rigid_bodies
import robot as robots
import states

HERE = pathlib.Path(__file__).parent
ACCELERATIONS = 1e-10
RESIDUAL = 1e-12


def main() -> int:
    """Compares; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", help="robots, by the names of their files; all if none is given")
    parser.add_argument("--program", default=str(HERE.parents[1] / "target/debug/pc"), help="the program pc")
    parser.add_argument("--no-check", action="store_true", help="leave out the times of `pc check`")
    arguments = parser.parse_args()
    paths = [HERE / f"{name}.urdf" for name in arguments.names] or sorted(HERE.glob("*.urdf"))
    columns = ("dof", "pc", "residual", "Pinocchio", "MuJoCo", "condition", "check [s]")
    print(f"{'':26}" + "".join(f"{column:>11}" for column in columns))
    found = [Row(path, arguments.program, not arguments.no_check) for path in paths]
    wrong = [row for row in found if not row.right]
    for row in found:
        for remark in row.remarks:
            print(f"{row.name}: {remark}")
    print(f"{len(found) - len(wrong)} passed, {len(wrong)} failed")
    return 1 if wrong else 0


class Row:
    """What is found of one robot: a line of the table."""

    def __init__(self, path: pathlib.Path, pc: str, timed: bool) -> None:
        self.name, self.remarks, self.right = path.stem, [], True
        header = robots.header_of(path)
        print(f"{self.name:26}", end="", flush=True)
        if "Expected: refused" in header:
            self._refused(pc, path, "Root: floating." in header)
        else:
            self._compared(pc, path, timed)

    def _refused(self, pc: str, path: pathlib.Path, floating: bool) -> None:
        try:
            program.check(pc, program.imported(pc, path, floating))
        except program.Failed as failed:
            print(f"{'–':>11}  refused, as expected")
            self.remarks.append(str(failed))
        else:
            print(f"{'–':>11}  taken, and should be refused")
            self.right = False

    def _compared(self, pc: str, path: pathlib.Path, timed: bool) -> None:
        robot = robots.read(path)
        state = states.of(robot, path.stem)
        equations = rigid_bodies.dynamics(robot, state)
        reference = equations.accelerations()
        if not _recorded(path.stem, record.of(path.stem, robot, state, equations)):
            self.remarks.append("dynamics.json has other numbers: run record.py")
            self.right = False
        print(f"{len(equations.names):11}", end="", flush=True)
        size = np.abs(reference).max()
        try:
            model = program.imported(pc, path, robot.floating)
            found = program.accelerations(pc, model, robot, state)
            self._number(np.abs(found - reference).max() / size, ACCELERATIONS)
            self._number(_residual(equations, found), RESIDUAL)
        except program.Failed as failed:
            model = None
            self._nothing("refused", str(failed), wrong=True)
            self._nothing("", "")
        for peer, route in ((peers.pinocchio, peers.by_pinocchio), (peers.mujoco, peers.by_mujoco)):
            if peer is None:
                self._nothing("absent", "")
                continue
            try:
                other = route(path, robot, state).accelerations()
                self._number(np.abs(other - reference).max() / size, ACCELERATIONS)
            except (peers.Refused, np.linalg.LinAlgError) as refused:
                self._nothing("–", f"{peer.__name__}: {refused}")
        scale = 1.0 / np.sqrt(np.diag(equations.mass))
        print(f"{np.linalg.cond(equations.mass * np.outer(scale, scale)):11.1e}", end="")
        if timed and model is not None:
            try:
                print(f"{program.check(pc, model):11.2f}", end="")
            except program.Failed as failed:
                self._nothing("failed", str(failed), wrong=True)
        print(flush=True)

    def _number(self, difference: float, tolerance: float) -> None:
        agrees = difference <= tolerance
        self.right = self.right and agrees
        print(f"{difference:10.1e}{' ' if agrees else '!'}", end="", flush=True)

    def _nothing(self, word: str, remark: str, wrong: bool = False) -> None:
        print(f"{word:>11}", end="", flush=True)
        self.right = self.right and not wrong
        if remark:
            self.remarks.append(remark)


def _recorded(name: str, entry: dict) -> bool:
    """Whether dynamics.json has these numbers, but for rounding, which depends on the processor."""
    kept = json.loads(record.FILE.read_text(encoding="utf-8")).get(name)
    if kept is None or _names(kept) != _names(entry):
        return False
    for kind in ("q", "v", "acceleration", "bias", "mass", "derivative"):
        one, two = (np.concatenate([joint[kind] for joint in each["joints"]]) for each in (entry, kept))
        if one.shape != two.shape or np.abs(one - two).max() > ACCELERATIONS * np.abs(one).max():
            return False
    return True


def _names(entry: dict) -> list[str]:
    return [joint["name"] for joint in entry["joints"]]


def _residual(equations: rigid_bodies.Dynamics, accelerations: np.ndarray) -> float:
    """The largest |M a + h|_i / (√M_ii Σ_j √M_jj |a_j| + |h_i|)."""
    root = np.sqrt(np.diag(equations.mass))
    terms = root * (root @ np.abs(accelerations)) + np.abs(equations.bias)
    return (np.abs(equations.mass @ accelerations + equations.bias) / terms).max()


if __name__ == "__main__":
    sys.exit(main())
