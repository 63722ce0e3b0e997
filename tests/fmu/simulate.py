"""Validates and simulates FMUs by FMPy, and compares their numbers with those of `pc run`.

    simulate.py PC DIRECTORY

PC is the program; FMUs, tables and models are made in DIRECTORY. `cargo xtask fmu` runs this. Model Exchange is integrated by
FMPy's CVODE, Co-Simulation by the FMUs themselves.
"""

import csv
import ctypes
import subprocess
import sys
from pathlib import Path

import fmpy
import fmpy.validation
import numpy as np

# Of numbers near one, and the tolerances of runs and of Co-Simulation: errors add up over some hundred steps.
AGREEMENT = 1e-8
TOLERANCE = 1e-11

# FMPy integrates by formulas of low order, whose errors add up; in a stiff layer smaller ones are rounding.
FINE, IN_LAYERS = 1e-13, 1e-10

# The models, and the tolerances of the runs and of Co-Simulation, and of Model Exchange.
MODELS = [
    ("heavy-top-lagrange", TOLERANCE, FINE),
    ("heavy-top-kovalevskaya", TOLERANCE, FINE),
    ("heavy-top-quaternion", TOLERANCE, FINE),
    ("bouncing-ball", TOLERANCE, FINE),
    ("rocking-block", TOLERANCE, FINE),
    ("spherical-pendulum-cartesian", TOLERANCE, FINE),
    ("chaplygin-sleigh", TOLERANCE, FINE),
    ("stiff-sleigh", IN_LAYERS, IN_LAYERS),
    ("stick-slip-block", TOLERANCE, FINE),
]


class Disagreement(Exception):
    """Numbers that differ, or a description that is not valid."""


def pc(program, *arguments):
    """Runs pc."""
    command = [program, *map(str, arguments)]
    outcome = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)
    if outcome.returncode != 0:
        raise Disagreement(f"pc {' '.join(map(str, arguments))}: {outcome.stderr}")


def table(program, model, place, tolerance, *more):
    """The columns of `pc run` by their names."""
    file = place / "run.csv"
    pc(program, "run", model, "--rtol", tolerance, "--atol", tolerance / 100, "--no-verify", "-o", file, *more)
    with open(file, encoding="utf-8", newline="") as lines:
        names, *rows = list(csv.reader(lines))
    columns = np.array(rows, dtype=float).T
    return dict(zip(names, columns, strict=True))


def valid(fmu):
    """Validates an FMU by the schemas of FMI and the rules that FMPy knows."""
    problems = fmpy.validation.validate_fmu(str(fmu))
    if problems:
        raise Disagreement(f"{fmu.name} is not valid: {problems}")


def compare(what, columns, names, found):
    """The largest difference of all columns, relative where they are large."""
    worst, where = 0.0, ""
    for name in names:
        expected = columns[name]
        if len(found[name]) != len(expected):
            raise Disagreement(f"{what}: {name} has {len(found[name])} rows instead of {len(expected)}")
        difference = np.max(np.abs(found[name] - expected) / np.maximum(1.0, np.abs(expected)))
        if not difference <= worst:
            worst, where = difference, name
    print(f"  {what:<54} {len(names):3} columns, differ by {worst:.1e}" + (f" in {where}" if where else ""), flush=True)
    if not worst <= AGREEMENT:
        raise Disagreement(f"{what}: {where} differs by {worst:.3e}")


def simulate(fmu, kind, columns, tolerance, **more):
    """A simulation at the times of a table."""
    t, names = columns["t"], [name for name in columns if name != "t"]
    known = {variable.name for variable in fmpy.read_model_description(str(fmu)).modelVariables}
    missing = [name for name in names if name not in known]
    if missing:
        raise Disagreement(f"{fmu.name}: there is no {missing}")
    result = fmpy.simulate_fmu(
        str(fmu),
        fmi_type=kind,
        start_time=t[0],
        stop_time=t[-1],
        output_interval=(t[-1] - t[0]) / (len(t) - 1),
        relative_tolerance=tolerance,
        record_events=False,
        output=names,
        **more,
    )
    return names, result


def check_models(program, place):
    """Models of the program, without inputs."""
    for model, tolerance, exchange in MODELS:
        columns = table(program, model, place, tolerance)
        for version in (2, 3):
            fmu = place / f"{model}-{version}.fmu"
            pc(program, "emit", model, "--fmu", version, "-o", fmu)
            valid(fmu)
            for kind, within in (("ModelExchange", exchange), ("CoSimulation", tolerance)):
                names, found = simulate(fmu, kind, columns, within)
                compare(f"{model}, FMI {version}, {kind}", columns, names, found)
            if version == 3 and fmpy.read_model_description(str(fmu)).coSimulation.hasEventMode:
                more = {"use_event_mode": True, "early_return_allowed": True}
                names, found = simulate(fmu, "CoSimulation", columns, tolerance, **more)
                # There are rows at events too.
                found = found[[np.argmin(np.abs(found["time"] - t)) for t in columns["t"]]]
                compare(f"{model}, FMI {version}, CoSimulation, event mode", columns, names, found)


def controller(x, angle, v, rate):
    """A linear feedback that holds the pole up."""
    return 1.5 * x + 2.5 * v + 35.0 * angle + 8.0 * rate


def exchange(fmu, version, t, length, steps):
    """Steps of the classical Runge–Kutta method, over which inputs are constant."""
    fill = fmu.getDerivatives if version == 2 else fmu.getContinuousStateDerivatives
    y, k = np.zeros(4), np.zeros((4, 4))

    def at(array):
        return array.ctypes.data_as(ctypes.POINTER(ctypes.c_double))

    fmu.getContinuousStates(at(y), 4)
    h = length / steps
    for n in range(steps):
        for stage, part in enumerate((0.0, 0.5, 0.5, 1.0)):
            z = np.ascontiguousarray(y + part * h * k[stage - 1])
            fmu.setTime(t + (n + part) * h)
            fmu.setContinuousStates(at(z), 4)
            fill(at(k[stage]), 4)
        y += h / 6.0 * (k[0] + 2.0 * k[1] + 2.0 * k[2] + k[3])
    fmu.setTime(t + length)
    fmu.setContinuousStates(at(y), 4)
    fmu.completedIntegratorStep()


def closed_loop(file, version, kind, end, steps):
    """Outputs, and what the controller did, at each of its times."""
    description = fmpy.read_model_description(str(file))
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    fmu = fmpy.instantiate_fmu(fmpy.extract(str(file), str(file.with_suffix(""))), description, kind)
    get = fmu.getReal if version == 2 else fmu.getFloat64
    put = fmu.setReal if version == 2 else fmu.setFloat64
    if version == 2:
        fmu.setupExperiment(tolerance=TOLERANCE, startTime=0.0, stopTime=end)
        fmu.enterInitializationMode()
    else:
        fmu.enterInitializationMode(tolerance=TOLERANCE, startTime=0.0, stopTime=end)
    fmu.exitInitializationMode()
    if kind == "ModelExchange":
        (fmu.newDiscreteStates if version == 2 else fmu.updateDiscreteStates)()
        fmu.enterContinuousTimeMode()
    names = [v.name for v in description.modelVariables if v.causality == "output" and v.name != "power"]
    rows, forces, step = [], [], end / steps
    for n in range(steps + 1):
        rows.append(get([references[name] for name in names]))
        forces.append(float(controller(*get([references[name] for name in ("x", "θ", "x'", "θ'")]))))
        if n < steps:
            put([references["F"]], [forces[-1]])
            if kind == "ModelExchange":
                exchange(fmu, version, n * step, step, 40)
            else:
                fmu.doStep(currentCommunicationPoint=n * step, communicationStepSize=step)
    fmu.terminate()
    fmu.freeInstance()
    return dict(zip(names, np.array(rows).T, strict=True)), forces


def check_controller(program, place, model):
    """A controller in the loop: what it did is then the table of the input of a run, which has to give the same motion."""
    # Errors of a run, which nothing controls, grow by e⁴ in this time.
    text, end, steps = model.read_text(encoding="utf-8"), 1.0, 50
    for version in (2, 3):
        fmu = place / f"cart-pole-{version}.fmu"
        pc(program, "emit", model, "--fmu", version, "-o", fmu)
        valid(fmu)
        for kind in ("ModelExchange", "CoSimulation"):
            found, forces = closed_loop(fmu, version, kind, end, steps)
            if not np.max(np.abs(found["θ"])) < 0.25:
                raise Disagreement("the controller does not hold the pole up")
            times = [n * (end / steps) for n in range(steps + 1)]
            entry = f'F = {{ times = {times}, values = {forces}, interpolation = "hold" }}'
            held = place / "held.toml"
            held.write_text(text.replace("F = 0.0", entry), encoding="utf-8")
            columns = table(program, held, place, TOLERANCE)
            compare(f"cart-pole, FMI {version}, {kind}, controlled", columns, list(found), found)


# The torques on the arm and their derivatives: those of order n are multiplied by the n-th power of the frequency.
TORQUES = {"shoulder": (1.0, 1.0, 0.0), "elbow": (0.5, 2.0, 0.5)}


def torque(name, t, order=0):
    """The derivative of a torque of this order, that of a sin(w t + p) being a wⁿ sin(w t + p + n π/2)."""
    size, frequency, phase = TORQUES[name]
    return size * frequency**order * np.sin(frequency * t + phase + order * np.pi / 2)


def driven(file, version, end, steps, smooth):
    """Outputs of Co-Simulation with torques that are set at communication points, and where they are smooth between them too:
    by three derivatives in FMI 2, by intermediate update in FMI 3."""
    description = fmpy.read_model_description(str(file))
    references = {variable.name: variable.valueReference for variable in description.modelVariables}
    names = [v.name for v in description.modelVariables if v.causality == "output"]
    inputs = [references[name] for name in TORQUES]
    folder = fmpy.extract(str(file), str(file.with_suffix("")))

    def update(_environment, t, set_requested, *_rest):
        if set_requested:
            fmu.setFloat64(inputs, [torque(name, t) for name in TORQUES])

    more = {"intermediate_update": update, "required_intermediate_variables": inputs} if version == 3 and smooth else {}
    fmu = fmpy.instantiate_fmu(folder, description, "CoSimulation", early_return_allowed=version == 3, **more)
    put = fmu.setReal if version == 2 else fmu.setFloat64
    get = fmu.getReal if version == 2 else fmu.getFloat64
    times = {"tolerance": TOLERANCE, "startTime": 0.0, "stopTime": end}
    if version == 2:
        fmu.setupExperiment(**times)
        fmu.enterInitializationMode()
    else:
        fmu.enterInitializationMode(**times)
    put(inputs, [torque(name, 0.0) for name in TORQUES])
    fmu.exitInitializationMode()
    rows = [get([references[name] for name in names])]
    for n in range(steps):
        t = n * end / steps
        put(inputs, [torque(name, t) for name in TORQUES])
        if version == 2 and smooth:
            for order in (1, 2, 3):
                fmu.setRealInputDerivatives(inputs, [order] * 2, [torque(name, t, order) for name in TORQUES])
        fmu.doStep(currentCommunicationPoint=t, communicationStepSize=end / steps)
        rows.append(get([references[name] for name in names]))
    fmu.terminate()
    fmu.freeInstance()
    return dict(zip(names, np.array(rows).T, strict=True))


def difference(columns, found):
    """The largest difference of all that does not depend on inputs directly."""
    return max(np.max(np.abs(found[name] - columns[name])) for name in columns if name not in ("t", "power"))


def check_inputs(program, place, model):
    """Torques that are sines, against a run of the model in which they are formulas."""
    text, end, steps = model.read_text(encoding="utf-8"), 4.0, 40
    for name, (size, frequency, phase) in TORQUES.items():
        text = text.replace(f"{name} = 0.0\n", "").replace(name, f"({size}*sin({frequency}*t + {phase}))")
    written = place / "driven.toml"
    written.write_text(text, encoding="utf-8")
    columns = table(program, written, place, TOLERANCE)
    # The series of a torque over a tenth of a second leaves 2⁴·0.5·0.1⁴/4! = 3e-5 at most.
    for version, within in ((2, 1e-3), (3, AGREEMENT)):
        fmu = place / f"arm-{version}.fmu"
        pc(program, "emit", model, "--fmu", version, "-o", fmu)
        valid(fmu)
        held = difference(columns, driven(fmu, version, end, steps, smooth=False))
        smooth = difference(columns, driven(fmu, version, end, steps, smooth=True))
        how = "three derivatives" if version == 2 else "intermediate update"
        print(f"  arm, FMI {version}: inputs held differ by {held:.1e}, with {how} by {smooth:.1e}", flush=True)
        if not smooth <= within < 0.02 < held:
            raise Disagreement(f"an arm with smooth inputs differs by {smooth:.3e}, with inputs that are held by {held:.3e}")


def main():
    """All of it."""
    program, place = sys.argv[1], Path(sys.argv[2])
    here = Path(__file__).parent
    try:
        check_models(program, place)
        check_controller(program, place, here / "cart-pole.toml")
        check_inputs(program, place, here / "arm.toml")
    except Disagreement as wrong:
        sys.exit(f"fmu: {wrong}")


if __name__ == "__main__":
    main()
