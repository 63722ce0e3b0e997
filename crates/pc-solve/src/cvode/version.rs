//! The version of the library.

use std::ffi::CStr;

use sundials_sys as sys;

/// The version of SUNDIALS with which the program is linked.
pub fn sundials_version() -> String {
    CStr::from_bytes_until_nul(sys::SUNDIALS_VERSION)
        .map_or_else(|_| String::new(), |version| version.to_string_lossy().into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bindings are written for major version 7.
    #[test]
    fn the_version_is_that_of_the_bindings() {
        let version = sundials_version();
        assert_eq!(version.split('.').count(), 3, "{version}");
        assert!(version.starts_with("7."), "{version}");
    }
}
