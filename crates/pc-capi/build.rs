//! Names the shared library for the dynamic linker, and keeps what it is made of to itself.

/// Raised when a program linked with an earlier library no longer runs with this one; `PC_ABI_VERSION` in the header.
const ABI_VERSION: u32 = 0;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-env=PC_ABI_VERSION={ABI_VERSION}");
    match std::env::var("CARGO_CFG_TARGET_OS").as_deref() {
        Ok("linux" | "freebsd" | "android") => {
            println!("cargo:rustc-cdylib-link-arg=-Wl,-soname,libpc.so.{ABI_VERSION}");
            // SUNDIALS comes with us; a program may use another one.
            println!("cargo:rustc-cdylib-link-arg=-Wl,--exclude-libs,ALL");
        }
        Ok("macos") => {
            println!("cargo:rustc-cdylib-link-arg=-Wl,-install_name,@rpath/libpc.{ABI_VERSION}.dylib");
        }
        _ => {}
    }
}
