//! What a process takes of the machine.

use std::fs;
use std::time::Instant;

/// Ticks of the processor's clock a second, as /proc counts them on all systems.
const TICKS: f64 = 100.0;

/// Time and memory of a process up to when it was last looked at.
#[derive(Clone, Copy, Debug)]
pub struct Usage {
    begin: Instant,
    wall: f64,
    processor: Option<f64>,
    peak: Option<f64>,
}

impl Usage {
    /// That of a process that begins now.
    pub(super) fn new() -> Usage {
        Usage { begin: Instant::now(), wall: 0.0, processor: None, peak: None }
    }

    /// Looks at a process; what is not known, as after its end or where there is no /proc, stays as it was.
    pub(super) fn look(&mut self, process: u32) {
        self.wall = self.begin.elapsed().as_secs_f64();
        let read = |name: &str| fs::read_to_string(format!("/proc/{process}/{name}")).ok();
        self.processor = read("stat").as_deref().and_then(processor).or(self.processor);
        self.peak = read("status").as_deref().and_then(peak).or(self.peak);
    }

    /// The seconds that it took: no more than those in which it computed, since others may compute on the same machine.
    pub fn seconds(&self) -> f64 {
        self.processor.map_or(self.wall, |processor| processor.min(self.wall))
    }

    /// The most memory that it had at a time, in MB; 0 where that is not known.
    pub fn megabytes(&self) -> f64 {
        self.peak.unwrap_or(0.0)
    }
}

/// The seconds that all threads computed, themselves or in the system.
fn processor(stat: &str) -> Option<f64> {
    // The second field is a name in parentheses, which may have anything in it.
    let (_, fields) = stat.rsplit_once(')')?;
    let mut times = fields.split_whitespace().skip(11).map(|field| field.parse::<f64>().ok());
    Some((times.next()?? + times.next()??) / TICKS)
}

fn peak(status: &str) -> Option<f64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix(" kB")?.parse::<f64>().ok()? * 1024e-6)
}
