//! A million events in one run, half of them resets, to be run under a memory profiler.

use std::ops::ControlFlow::Continue;

use pc_solve::{Event, FnEvents, Integration, Method, Options, from_fn};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let clock = from_fn(1, |_, _: &[f64], ydot: &mut [f64]| {
        ydot[0] = 1.0;
        Ok(())
    });
    let events = FnEvents::new().with(Event::new("half").rising(), |_, y| Ok(y[0] - 0.5)).with_reset(
        Event::new("tooth").rising(),
        |_, y| Ok(y[0] - 1.0),
        |_, y| {
            y[0] = 0.0;
            Ok(())
        },
    );
    let options = Options::new(Method::Adams).relative_tolerance(1e-6).absolute_tolerance(1e-6);
    let mut saw = Integration::new(clock, 0.0, &[0.0], &options)?.with_events(events)?;
    let mut count = 0_u64;
    saw.advance_to(500_000.25, |_| {
        count += 1;
        Continue(())
    })?;
    println!("{count} events, y = {}, {} steps", saw.state()[0], saw.statistics().steps);
    Ok(())
}
