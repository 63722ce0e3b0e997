//! Run times of a chain of 200 links with each linear solver: minimum and median of interleaved
//! runs.

#[path = "../tests/it/common/chain.rs"]
mod chain;

use std::error::Error;
use std::time::Instant;

use chain::Chain;
use pc_solve::{Krylov, LinearSolver, Method, Options, Trajectory, solve};

const RUNS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let solvers = [
        ("dense", LinearSolver::Dense),
        ("band", LinearSolver::Band { lower: 7, upper: 4 }),
        ("sparse", LinearSolver::Sparse),
        ("Krylov", LinearSolver::Krylov(Krylov::new(30))),
    ];
    let mut times = solvers.each_ref().map(|_| Vec::new());
    let mut motions: [Option<Trajectory>; 4] = Default::default();
    for _ in 0..RUNS {
        for (((_, solver), times), motion) in solvers.iter().zip(&mut times).zip(&mut motions) {
            let options = Options::new(Method::Bdf)
                .relative_tolerance(1e-10)
                .absolute_tolerance(1e-10)
                .linear_solver(solver.clone());
            let chain = Chain::new(200);
            let start = chain.start();
            let begin = Instant::now();
            *motion = Some(solve(chain, 0.0, &start, &[2.0], &options)?);
            times.push(begin.elapsed().as_secs_f64());
        }
    }
    for times in &mut times {
        times.sort_by(f64::total_cmp);
    }
    let median = |times: &[f64]| times[RUNS / 2];
    println!("         min (ms)  median (ms)  dense/this  from dense  steps  set-ups  products");
    for (((name, _), of), motion) in solvers.iter().zip(&times).zip(&motions) {
        let (Some(motion), Some(dense)) = (motion, &motions[0]) else { continue };
        let difference = motion.state(0).iter().zip(dense.state(0)).map(|(a, b)| (a - b).abs());
        let work = motion.statistics();
        println!(
            "{name:8} {:9.2} {:12.2} {:11.1} {:11.1e} {:6} {:8} {:9}",
            of[0] * 1e3,
            median(of) * 1e3,
            median(&times[0]) / median(of),
            difference.fold(0.0, f64::max),
            work.steps,
            work.linear_setups,
            work.jacobian_products,
        );
    }
    Ok(())
}
