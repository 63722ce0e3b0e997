//! Compiled code is freed. A process of its own keeps allocations of other tests out.
#![cfg(all(feature = "jit", target_os = "linux"))]

use std::fs;

use pc_expr::{Graph, Inputs, Jit, Kernel, Program};

fn mappings() -> usize {
    fs::read_to_string("/proc/self/maps").map_or(0, |maps| maps.lines().count())
}

fn resident_pages() -> usize {
    let numbers = fs::read_to_string("/proc/self/statm").unwrap_or_default();
    numbers.split_whitespace().nth(1).and_then(|pages| pages.parse().ok()).unwrap_or(0)
}

#[test]
fn compiling_and_dropping_does_not_leak() -> Result<(), Box<dyn std::error::Error>> {
    let graph = Graph::new();
    let [x, v, k] = graph.symbols(["x", "v", "k"]);
    let inputs = Inputs { time: None, state: vec![x, v], parameters: vec![k] };
    let program = Program::new(&graph, &inputs, &[v, -k * x.sin() * x.cos() - v.abs() * v, (x * v).exp()])?;
    let cycle = || -> Result<(), Box<dyn std::error::Error>> {
        let mut jit = Jit::new(&program)?;
        let mut fork = jit.fork();
        let mut out = [0.0; 3];
        jit.eval(0.0, &[0.3, 1.0], &[2.0], &mut out);
        drop(jit);
        fork.eval(0.0, &[0.3, 1.0], &[2.0], &mut out);
        Ok(())
    };
    let cycles = std::env::var("JIT_CYCLES").ok().and_then(|n| n.parse().ok()).unwrap_or(1000);
    for _ in 0..100 {
        cycle()?;
    }
    let (maps, pages) = (mappings(), resident_pages());
    for _ in 0..cycles {
        cycle()?;
    }
    // Code takes at least a page a cycle: a leak shows as `cycles` of them.
    let (more_maps, more_pages) = (mappings().saturating_sub(maps), resident_pages().saturating_sub(pages));
    assert!(more_maps <= 4, "{more_maps} more mappings after {cycles} cycles");
    assert!(more_pages < 256, "{more_pages} more pages after {cycles} cycles");
    Ok(())
}
