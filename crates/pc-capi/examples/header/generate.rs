//! The header from the sources.

use std::path::Path;

use cbindgen::{Builder, Config, DocumentationStyle, EnumConfig, Language, Style};

/// The text of `include/pc.h`.
pub(crate) fn header() -> String {
    let mut config = Config {
        language: Language::C,
        header: Some(pc::PREAMBLE.to_owned()),
        include_guard: Some("PC_H".to_owned()),
        cpp_compat: true,
        style: Style::Type,
        no_includes: true,
        sys_includes: ["stddef.h", "stdint.h"].map(str::to_owned).to_vec(),
        documentation_style: DocumentationStyle::Doxy,
        usize_is_size_t: true,
        line_length: 99,
        line_endings: cbindgen::LineEndingStyle::LF,
        ..Config::default()
    };
    config.function.prefix = Some("PC_API".to_owned());
    config.enumeration = EnumConfig { prefix_with_name: false, ..EnumConfig::default() };
    config.export.exclude = vec!["PREAMBLE".to_owned()];
    // The enumerations of options are only named in the documentation of their fields.
    config.export.include = [
        "pc_form",
        "pc_method",
        "pc_iteration",
        "pc_linear_solver",
        "pc_format",
        "pc_direction",
        "pc_inequality",
        "pc_about",
        "pc_linear_part",
        "pc_linear_matrix",
    ]
    .map(str::to_owned)
    .to_vec();
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut builder = Builder::new().with_config(config);
    for file in FILES {
        builder = builder.with_src(sources.join(file));
    }
    let bindings = builder.generate().expect("the sources are Rust");
    let mut text = Vec::new();
    bindings.write(&mut text);
    let text = String::from_utf8(text).expect("the sources are UTF-8");
    within_extern_c(&text.replace(" \n", "\n"))
}

/// What stands before each function: where it comes from, which some compilers ask for.
const EXPORT: &str = "\
#if !defined(PC_API)
  #if defined(_WIN32) && !defined(PC_STATIC)
    /* Comes from pc.dll; define PC_STATIC where the static library is linked instead. */
    #define PC_API __declspec(dllimport)
  #elif !defined(_WIN32) && defined(__GNUC__)
    #define PC_API __attribute__((visibility(\"default\")))
  #else
    #define PC_API
  #endif
#endif

";

/// The text with all of its declarations as those of C. cbindgen leaves out the types of functions, which in C++ are others.
fn within_extern_c(text: &str) -> String {
    const OPENING: &str = "#ifdef __cplusplus\nextern \"C\" {\n#endif // __cplusplus\n\n";
    const INCLUDES: &str = "#include <stdint.h>\n\n";
    assert!(text.matches(OPENING).count() == 1 && text.matches(INCLUDES).count() == 1);
    text.replace(OPENING, "").replace(INCLUDES, &format!("{INCLUDES}{EXPORT}{OPENING}"))
}

/// In the order in which a reader needs them.
const FILES: [&str; 44] = [
    "api/version.rs",
    "ffi/status.rs",
    "ffi/error.rs",
    "ffi/user_data.rs",
    "ffi/strings.rs",
    "api/model.rs",
    "api/builder.rs",
    "api/inputs.rs",
    "api/bodies.rs",
    "api/joints.rs",
    "api/action.rs",
    "api/settings.rs",
    "api/cancel.rs",
    "api/options.rs",
    "machinery/code.rs",
    "api/code.rs",
    "machinery/system.rs",
    "api/system.rs",
    "api/names.rs",
    "api/force.rs",
    "api/velocities.rs",
    "api/rates.rs",
    "api/observe.rs",
    "api/events.rs",
    "api/mechanics.rs",
    "api/kinematics.rs",
    "api/poses.rs",
    "api/slopes.rs",
    "api/linearization.rs",
    "api/bracket.rs",
    "api/legendre.rs",
    "api/source.rs",
    "api/theory.rs",
    "api/verify.rs",
    "api/kernel.rs",
    "api/solver.rs",
    "api/monitor.rs",
    "api/occurrences.rs",
    "api/sensitivity.rs",
    "api/dense.rs",
    "api/checkpoint.rs",
    "api/statistics.rs",
    "api/ensemble.rs",
    "api/gradient.rs",
];
