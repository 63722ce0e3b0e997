//! The models that come with the library.

use crate::diagnostics::error::ModelError;
use crate::diagnostics::source::Source;
use crate::document::Document;

/// A model that comes with the library.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// Its name, which can be given in place of a model file.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

macro_rules! models {
    ($($name:literal),* $(,)?) => {
        &[$(Builtin { name: $name, text: include_str!(concat!("../../models/", $name, ".toml")) }),*]
    };
}

/// Models that come with the library, one for each kind of mechanics.
pub const BUILTIN: &[Builtin] = models![
    "heavy-top-lagrange",
    "heavy-top-kovalevskaya",
    "heavy-top-goryachev-chaplygin",
    "heavy-top-euler",
    "heavy-top-euler-symmetric",
    "heavy-top-quaternion",
    "euler-top",
    "rigid-body-spring",
    "gravity-gradient",
    "gimbals",
    "reaction-wheels",
    "quadrotor",
    "spherical-pendulum-cartesian",
    "spherical-pendulum-meridian",
    "double-pendulum-cartesian",
    "double-pendulum-links",
    "turning-wire",
    "turning-hoop",
    "rotating-oscillator",
    "charged-particle",
    "charged-particle-induction",
    "damped-oscillator",
    "damped-oscillator-scaled-frame",
    "relativistic-particle",
    "relativistic-constant-force",
    "pendulum-chain",
    "pendulum-chain-cartesian",
    "toda-chain",
    "chaplygin-sleigh",
    "vertical-disk",
    "vertical-disk-driven",
    "tilted-disk",
    "nonholonomic-particle",
    "suslov",
    "suslov-in-gravity",
    "turntable",
    "turntable-accelerated",
    "ball-in-cylinder",
    "snakeboard",
    "snakeboard-driven",
    "carriage",
    "voronets",
    "voronets-rheonomic",
    "stiff-sleigh",
    "bouncing-ball",
    "stick-slip-block",
    "rocking-block",
    "stick-slip-sleigh",
    "rocking-disk",
    "appell-hamel",
];

/// Further models that come with the library: larger ones, made of bodies on joints, whose equations fill
/// pages.
pub const TREES: &[Builtin] = models![
    "puma-560",
    "four-bar-loop",
    "slider-crank-loop",
    "spatial-chain",
    "satellite",
    "quadruped",
    "stewart-platform",
];

/// Further models that come with the library: classical motions about which books have been written.
pub const CLASSICS: &[Builtin] = models![
    "foucault-pendulum",
    "kapitza-pendulum",
    "swinging-atwood",
    "wilberforce-pendulum",
    "double-spherical-pendulum",
    "three-bodies",
    "dumbbell-satellite",
    "elroys-beanie",
    "cart-pole",
    "furuta-pendulum",
    "segway",
    "quarter-car",
    "roller-racer",
    "snake",
    "tractor-trailers",
    "whipple-bicycle",
    "rattleback",
    "rolling-spheroid",
    "disk-on-bumps",
];

impl Builtin {
    /// All models that come with the library.
    pub fn all() -> impl Iterator<Item = &'static Builtin> {
        BUILTIN.iter().chain(TREES).chain(CLASSICS)
    }

    /// The built-in model with this name.
    pub fn named(name: &str) -> Option<&'static Builtin> {
        Builtin::all().find(|model| model.name == name)
    }

    /// Its document.
    ///
    /// # Errors
    /// [`ModelError`]; the tests make sure that it does not occur.
    pub fn document(&self) -> Result<Document, ModelError> {
        Document::parse(Source::new(format!("{}.toml", self.name), self.text))
    }
}
