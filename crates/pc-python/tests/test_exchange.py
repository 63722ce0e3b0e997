"""Robots in URDF, and FMUs."""

import pathlib
import zipfile

import numpy as np
import pytest

import chetaev

ARM = """<robot name="arm">
  <link name="base"/>
  <link name="upper">
    <inertial>
      <origin xyz="0 0 -0.5"/>
      <mass value="2"/>
      <inertia ixx="0.2" iyy="0.2" izz="0.01" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <joint name="shoulder" type="continuous">
    <parent link="base"/>
    <child link="upper"/>
    <axis xyz="0 1 0"/>
  </joint>
</robot>
"""


def test_a_robot_is_a_pendulum(tmp_path: pathlib.Path) -> None:
    file = tmp_path / "arm.urdf"
    file.write_text(ARM)
    model = chetaev.Model.from_urdf(file)
    linear = model.linearize()
    # I = 0.2 + 2·0.5², so that ω² = m g l / I; gravity is that of the text.
    assert "[bodies" in model.text
    assert np.abs(linear.eigenvalues.imag).max() == pytest.approx(np.sqrt(2.0 * 9.81 * 0.5 / 0.7), rel=1e-3)
    with pytest.raises(chetaev.ChetaevError, match="arm.urdf"):
        file.write_text(ARM.replace('<mass value="2"/>', '<mass value="two"/>'))
        chetaev.Model.from_urdf(file)


def test_an_fmu_is_written_whole(tmp_path: pathlib.Path) -> None:
    path = tmp_path / "sleigh.fmu"
    model = chetaev.Model.builtin("chaplygin-sleigh")
    model.fmu(path, version=2, compiled=False)
    with zipfile.ZipFile(path) as archive:
        description = archive.read("modelDescription.xml").decode()
    assert 'fmiVersion="2.0"' in description and 'modelName="Chaplygin sleigh"' in description
    with pytest.raises(ValueError, match="choose one of 2, 3"):
        model.fmu(path, version=1)
    with pytest.raises(ValueError, match="choose one of dop853"):
        model.fmu(path, solver="euler", compiled=False)
    with pytest.raises(chetaev.ChetaevError, match="in velocities"):
        model.fmu(path, "canonical", compiled=False)
    with pytest.raises(OSError, match="nowhere"):
        model.fmu(tmp_path / "nowhere" / "a.fmu", compiled=False)
