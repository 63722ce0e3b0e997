//! What is derived on first use, once for all systems of a code.

use std::sync::{Mutex, OnceLock, PoisonError};

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::ffi::call_error::CallError;

/// A value that the first who needs it derives; others wait for it meanwhile. It is stored if it is known.
pub(crate) struct Once<T> {
    value: OnceLock<T>,
    deriving: Mutex<()>,
}

impl<T> Default for Once<T> {
    fn default() -> Once<T> {
        Once { value: OnceLock::new(), deriving: Mutex::default() }
    }
}

impl<T> Once<T> {
    /// The value, derived if it is not known.
    pub(crate) fn get(&self, derive: impl FnOnce() -> Result<T, CallError>) -> Result<&T, CallError> {
        if let Some(known) = self.value.get() {
            return Ok(known);
        }
        // A derivation that failed or panicked leaves nothing behind.
        let _deriving = self.deriving.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = self.value.get() {
            return Ok(known);
        }
        let value = derive()?;
        Ok(self.value.get_or_init(|| value))
    }
}

impl<T: Clone> Once<T> {
    /// The copy in `own`, made from the common value on first use.
    pub(crate) fn own<'a>(
        &self,
        own: &'a mut Option<T>,
        derive: impl FnOnce() -> Result<T, CallError>,
    ) -> Result<&'a mut T, CallError> {
        let value = match own.take() {
            Some(value) => value,
            None => self.get(derive)?.clone(),
        };
        Ok(own.insert(value))
    }
}

impl<T: Serialize> Serialize for Once<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.value.get().serialize(serializer)
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Once<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Once<T>, D::Error> {
        let known = Option::<T>::deserialize(deserializer)?;
        let once = Once::default();
        if let Some(known) = known {
            let _ = once.value.set(known); // it is empty
        }
        Ok(once)
    }
}

/// The same for things that have names.
#[derive(Serialize, Deserialize)]
pub(crate) struct Named<T>(Mutex<Vec<(String, T)>>);

impl<T> Default for Named<T> {
    fn default() -> Named<T> {
        Named(Mutex::default())
    }
}

impl<T: Clone> Named<T> {
    /// A copy of the thing with this name, derived if it is not known.
    pub(crate) fn get(
        &self,
        name: &str,
        derive: impl FnOnce() -> Result<T, CallError>,
    ) -> Result<T, CallError> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, thing)) = known.iter().find(|(known, _)| known == name) {
            return Ok(thing.clone());
        }
        let thing = derive()?;
        known.push((name.to_owned(), thing.clone()));
        Ok(thing)
    }
}
