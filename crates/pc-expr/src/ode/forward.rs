//! Methods that are forwarded to another value.

/// Defines methods of a trait, given by their signatures, each of which calls the same method of the value before `=>`;
/// with `@each` before `=>`, that of `method` in `each!(self, method => …)`, a macro that finds the value.
///
/// A wrapper of a field, of events or of a stepper has to forward methods that have a default, too: without them it would
/// hide properties of what it wraps.
///
/// ```
/// use pc_expr::{Event, Events, Failure, forward};
///
/// struct Named<E>(E);
/// impl<E: Events> Events for Named<E> {
///     forward! { self.0 =>
///         fn events(&self) -> &[Event];
///         fn evaluate(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure>;
///         fn reset(&mut self, event: usize, t: f64, y: &mut [f64]) -> Result<(), Failure>;
///     }
/// }
/// ```
#[macro_export]
macro_rules! forward {
    (@$each:ident => $(fn $name:ident($($of:tt)*) $(-> $out:ty)?;)*) => {
        $($crate::forward!(@one $each, $name($($of)*) $(-> $out)?);)*
    };
    (@one $each:ident, $name:ident(&$this:ident $(, $arg:ident: $kind:ty)*) $(-> $out:ty)?) => {
        fn $name(&$this $(, $arg: $kind)*) $(-> $out)? {
            $each!($this, method => method.$name($($arg),*))
        }
    };
    (@one $each:ident, $name:ident(&mut $this:ident $(, $arg:ident: $kind:ty)*) $(-> $out:ty)?) => {
        fn $name(&mut $this $(, $arg: $kind)*) $(-> $out)? {
            $each!($this, method => method.$name($($arg),*))
        }
    };
    ($to:expr =>) => {};
    ($to:expr => fn $name:ident(&$this:ident $(, $arg:ident: $kind:ty)*) $(-> $out:ty)?; $($more:tt)*) => {
        fn $name(&$this $(, $arg: $kind)*) $(-> $out)? {
            $to.$name($($arg),*)
        }
        $crate::forward!($to => $($more)*);
    };
    ($to:expr => fn $name:ident(&mut $this:ident $(, $arg:ident: $kind:ty)*) $(-> $out:ty)?; $($more:tt)*) => {
        fn $name(&mut $this $(, $arg: $kind)*) $(-> $out)? {
            $to.$name($($arg),*)
        }
        $crate::forward!($to => $($more)*);
    };
}
