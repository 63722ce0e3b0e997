//! The target of the build, for `pc --version --verbose`.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    if let Ok(target) = std::env::var("TARGET") {
        println!("cargo::rustc-env=PC_TARGET={target}");
    }
}
