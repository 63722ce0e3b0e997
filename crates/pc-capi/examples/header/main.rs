//! Writes `include/pc.h`: `cargo xtask header`.

mod generate;

fn main() -> std::io::Result<()> {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../include/pc.h");
    std::fs::write(path, generate::header())
}
