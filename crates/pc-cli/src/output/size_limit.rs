//! The limit on the size of files, `ulimit -f`.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use signal_hook::consts::SIGXFSZ;
use signal_hook::flag;

/// From now on, what goes beyond the limit is a result that cannot be written, as on a full disk; without a handler, the system
/// ends the program there.
pub fn catch() {
    // The failed write says all that the signal says.
    let _ = flag::register(SIGXFSZ, Arc::new(AtomicBool::new(false)));
}
