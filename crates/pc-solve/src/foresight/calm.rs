//! Neighbourhoods of states in which steep functions hide nothing.
//!
//! A step moves a state by little, and most steep functions change little around it. Once they are enclosed over a
//! neighbourhood, the steps within it need no enclosures of their own.

use pc_expr::SteepFunctions;

/// The radii of a neighbourhood, relative to the way of the next step, that are tried in turn, from the last one
/// that was calm.
const RADII: [f64; 5] = [128.0, 32.0, 8.0, 4.0, 2.0];
/// After as many neighbourhoods of one size, a larger one is tried.
const PATIENCE: u32 = 8;
/// After functions have not been calm near a state, as many steps pass before the next trial.
const PAUSE: u32 = 2;

/// A neighbourhood of states, by the components on which the functions depend.
#[derive(Debug)]
pub(super) struct Calm {
    components: Vec<usize>,
    /// Where it lies, and how far it reaches; empty if none is known.
    centres: Vec<f64>,
    radii: Vec<f64>,
    /// Which of the radii was the last one to be calm, and how many neighbourhoods since it was tried.
    size: usize,
    found: u32,
    pause: u32,
}

impl Calm {
    pub(super) fn of(steep: &SteepFunctions) -> Calm {
        let (centres, radii) = (Vec::new(), Vec::new());
        Calm { components: steep.components(), centres, radii, size: 1, found: 0, pause: 0 }
    }

    /// Whether the functions hide nothing along a motion each of whose components stays within a radius of a
    /// centre; false if that is not known, or if `range` does not know these.
    pub(super) fn covers(
        &mut self,
        steep: &mut SteepFunctions,
        mut range: impl FnMut(usize) -> Option<(f64, f64)>,
    ) -> bool {
        let Calm { components, centres, radii, size, found, pause } = self;
        let mut is_within = !radii.is_empty();
        for (place, &i) in components.iter().enumerate() {
            let Some((middle, reach)) = range(i) else { return false };
            is_within = is_within && (middle - centres[place]).abs() + reach <= radii[place];
        }
        if is_within {
            return true;
        }
        radii.clear();
        if *pause > 0 {
            *pause -= 1;
            return false;
        }
        if *found == PATIENCE {
            (*size, *found) = (size.saturating_sub(1), 0);
        }
        while let Some(times) = RADII.get(*size) {
            centres.clear();
            radii.clear();
            for (middle, reach) in components.iter().filter_map(|&i| range(i)) {
                centres.push(middle);
                radii.push(times * reach);
            }
            if steep.are_calm_near(centres, radii) {
                *found += 1;
                return true;
            }
            (*size, *found) = (*size + 1, 0);
        }
        radii.clear();
        (*size, *pause) = (RADII.len() - 1, PAUSE);
        false
    }
}
