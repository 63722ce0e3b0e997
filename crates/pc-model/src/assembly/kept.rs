//! A result that is derived only once for the values of time and state at which it is first requested.

use std::cell::OnceCell;

use pc_mech::Expr;

/// The result of a derivation at some values of time and state.
#[derive(Clone, Debug)]
pub(super) struct Kept<T>(OnceCell<(Vec<f64>, T)>);

impl<T> Default for Kept<T> {
    fn default() -> Kept<T> {
        Kept(OnceCell::new())
    }
}

impl<T: Clone> Kept<T> {
    /// The result at the values `at`, derived anew unless `at` are those of the first successful call.
    ///
    /// # Errors
    /// The errors of the derivation, which the next call tries again.
    pub(super) fn at<E>(
        &self,
        at: &[(Expr<'_>, f64)],
        derive: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        let there: Vec<f64> = at.iter().map(|&(_, value)| value).collect();
        if let Some((_, known)) = self.0.get().filter(|(first, _)| *first == there) {
            return Ok(known.clone());
        }
        let derived = derive()?;
        self.0.get_or_init(|| (there, derived.clone()));
        Ok(derived)
    }
}
