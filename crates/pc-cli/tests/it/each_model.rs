//! What `pc` says of each built-in model, asked once for all tests.

use std::collections::HashMap;
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock, Mutex, OnceLock};
use std::thread;

use pc_model::Builtin;

/// Answers by the arguments.
type Answers = HashMap<Vec<String>, Arc<OnceLock<Output>>>;

/// Each given by one process, however many tests ask.
static ANSWERS: LazyLock<Mutex<Answers>> = LazyLock::new(Mutex::default);

/// What `pc` answers to these arguments.
pub(crate) fn answer(arguments: &[&str]) -> Output {
    let key: Vec<String> = arguments.iter().map(|&argument| argument.to_owned()).collect();
    let place = {
        let mut answers = ANSWERS.lock().expect("no test panics while it holds the lock");
        Arc::clone(answers.entry(key).or_default())
    };
    let ask = || Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc runs");
    place.get_or_init(ask).clone()
}

/// A claim of each of these models, tried by all processors.
///
/// # Panics
/// With the claim's own message, where it does not hold.
pub(crate) fn each<'a>(models: impl IntoIterator<Item = &'a Builtin>, claim: impl Fn(&Builtin) + Sync) {
    let (models, next): (Vec<&Builtin>, _) = (models.into_iter().collect(), AtomicUsize::new(0));
    let work = || {
        while let Some(model) = models.get(next.fetch_add(1, Ordering::Relaxed)) {
            claim(model);
        }
    };
    thread::scope(|scope| {
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        for worker in workers {
            if let Err(panic) = worker.join() {
                std::panic::resume_unwind(panic);
            }
        }
    });
}
