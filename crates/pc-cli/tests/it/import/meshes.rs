//! Meshes of a robot are drawn where their files are there.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

/// A pendulum whose mesh is in a package, with a ball without a file at its end.
const ROBOT: &str = r#"<robot name="pendulum">
  <link name="base"/>
  <link name="rod">
    <inertial><origin xyz="0 0 -0.5"/><mass value="1"/><inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" iyz="0" ixz="0"/></inertial>
    <visual>
      <origin xyz="0 0 -0.5" rpy="0 0 1.5707963267948966"/>
      <geometry><mesh filename="package://swing/meshes/rod.obj" scale="0.001 0.001 0.001"/></geometry>
    </visual>
    <visual><geometry><mesh filename="package://swing/meshes/ball.stl"/></geometry></visual>
    <collision><geometry><mesh filename="package://swing/meshes/rod.obj"/></geometry></collision>
  </link>
  <joint name="pivot" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint>
</robot>
"#;

/// A bar of 1000 mm.
const BAR: &str = "v -20 -20 -500\nv 20 -20 -500\nv 0 30 -500\nv -20 -20 500\nv 20 -20 500\nv 0 30 500\n\
                   f 1 3 2\nf 4 5 6\nf 1 2 5 4\nf 2 3 6 5\nf 3 1 4 6\n";

fn pc(directory: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).current_dir(directory).output().unwrap()
}

fn done(directory: &Path, arguments: &[&str]) {
    let output = pc(directory, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

#[test]
fn meshes_that_are_there_are_drawn() {
    let directory = tempfile::tempdir().unwrap();
    let here = directory.path();
    let package = here.join("robots/swing");
    fs::create_dir_all(package.join("urdf")).unwrap();
    fs::create_dir_all(package.join("meshes")).unwrap();
    fs::create_dir_all(here.join("models")).unwrap();
    fs::write(package.join("urdf/swing.urdf"), ROBOT).unwrap();
    fs::write(package.join("meshes/rod.obj"), BAR).unwrap();
    done(here, &["import", "robots/swing/urdf/swing.urdf", "-o", "models/swing.toml"]);
    let text = fs::read_to_string(here.join("models/swing.toml")).unwrap();
    assert!(
        text.ends_with(
            "\n[[draw]]\nkind = \"mesh\"\nbody = \"rod\"\nfile = \"../robots/swing/meshes/rod.obj\"\nat = [0, 0, -0.5]\n\
             rotation = [0, -1.0, 0, 1.0, 0, 0, 0, 0, 1.0]\nscale = [0.001, 0.001, 0.001]\n"
        ),
        "{text}"
    );
    assert!(
        text.contains("# mesh: package://swing/meshes/ball.stl\n")
            && !text.contains("# mesh: package://swing/meshes/rod")
    );

    done(here, &["animate", "models/swing.toml", "--set", "pivot=1", "--t-end", "2", "-o", "swing.html"]);
    let page = fs::read_to_string(here.join("swing.html")).unwrap();
    let (_, data) = page.split_once("id=\"player-data\">").unwrap();
    let data: Value = serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap();
    assert!(data["shapes"].as_array().unwrap().contains(&json!(["mesh", 12, "0"])), "{data}");
    // Three numbers for each of eight triangles, of four bytes each, in base 64.
    assert_eq!(data["meshes"][0]["faces"].as_str().unwrap().len(), 8 * 3 * 4 / 3 * 4);
    for still in ["swing.svg", "swing.png", "swing.gif"] {
        done(here, &["animate", "models/swing.toml", "--set", "pivot=1", "--t-end", "0.1", "-o", still]);
        assert!(fs::metadata(here.join(still)).unwrap().len() > 1000, "{still}");
    }
    // Each of the eight triangles, and its shadow.
    let svg = fs::read_to_string(here.join("swing.svg")).unwrap();
    let paths = svg.split("d=\"M").skip(1).filter_map(|path| path.split_once("Z\""));
    assert_eq!(paths.filter(|(corners, _)| corners.matches('L').count() == 2).count(), 16, "{svg}");

    // Standard output is for the present directory.
    let output = pc(here, &["import", "robots/swing/urdf/swing.urdf"]);
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("file = \"robots/swing/meshes/rod.obj\"\n"), "{text}");

    // A run needs no mesh; a drawing says which file is not there, and where the text names it.
    fs::remove_file(package.join("meshes/rod.obj")).unwrap();
    done(here, &["run", "models/swing.toml", "--t-end", "1", "-o", "swing.csv"]);
    let output = pc(here, &["animate", "models/swing.toml", "--t-end", "1", "-o", "none.html"]);
    assert_eq!(output.status.code(), Some(3));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("models/swing.toml:")
            && said.contains("`../robots/swing/meshes/rod.obj` cannot be drawn"),
        "{said}"
    );
    assert!(!here.join("none.html").exists());
}
