//! Work on a separate thread, while the calling thread watches for signals.

use std::any::Any;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use pc_expr::Cancel;
use pyo3::prelude::*;

use crate::error::Error;

/// Time between two checks for signals: Ctrl-C ends work well within a tenth of a second.
const TICK: Duration = Duration::from_millis(25);

/// Bytes of stack, as many as a main thread usually has; deeper work uses a separate stack.
const STACK: usize = 8 << 20;

/// The result of `work`, for which the interpreter does not wait: other threads of Python continue. `tick` is called now
/// and then on this thread.
///
/// # Errors
/// Whatever a signal or `tick` raises, at once; the work is then cancelled and ends by itself.
pub(crate) fn attended<T: Send + 'static>(
    py: Python<'_>,
    cancel: &Cancel,
    mut tick: impl FnMut(Python<'_>) -> PyResult<()>,
    work: impl FnOnce() -> Result<T, Error> + Send + 'static,
) -> PyResult<T> {
    let (sender, mut receiver) = mpsc::channel();
    let worker = thread::Builder::new().name("chetaev".to_owned()).stack_size(STACK);
    // Nobody receives where it has been cancelled.
    let worker = worker.spawn(move || drop(sender.send(work())))?;
    loop {
        let receiver = &mut receiver;
        match py.detach(move || receiver.recv_timeout(TICK)) {
            Ok(result) => return Ok(result?),
            Err(RecvTimeoutError::Timeout) => {
                if let Err(raised) = py.check_signals().and_then(|()| tick(py)) {
                    cancel.cancel();
                    return Err(raised);
                }
            }
            Err(RecvTimeoutError::Disconnected) => {
                let message = worker.join().err().map_or_else(String::new, |panic| said(panic.as_ref()));
                return Err(Error::Panic { message }.into());
            }
        }
    }
}

/// The message of a panic.
fn said(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned());
    text.unwrap_or_else(|| "a panic without a message".to_owned())
}
