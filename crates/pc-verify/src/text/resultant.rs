//! Reactions on bodies.

use crate::numbers::sized::Sized;

/// A component of the reaction of a constraint on a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Resultant {
    pub(crate) constraint: usize,
    pub(crate) body: usize,
    /// Whether it is a component of the torque.
    pub(crate) turns: bool,
    pub(crate) axis: usize,
}

impl Resultant {
    /// The component with the name `F_CONSTRAINT_BODY_x` or `N_CONSTRAINT_BODY_1`.
    pub(crate) fn named(name: &str, constraints: &[String], bodies: &[String]) -> Option<Resultant> {
        let (turns, axes, rest) = match (name.strip_prefix("F_"), name.strip_prefix("N_")) {
            (Some(rest), _) => (false, ["_x", "_y", "_z"], rest),
            (_, Some(rest)) => (true, ["_1", "_2", "_3"], rest),
            _ => return None,
        };
        let axis = axes.iter().position(|axis| rest.ends_with(axis))?;
        let rest = rest.strip_suffix(axes[axis])?;
        let pairs = (0..constraints.len()).flat_map(|a| (0..bodies.len()).map(move |b| (a, b)));
        let of_pair = |&(a, b): &(usize, usize)| {
            let after = rest.strip_prefix(constraints[a].as_str()).and_then(|after| after.strip_prefix('_'));
            after == Some(bodies[b].as_str())
        };
        pairs.into_iter().find(of_pair).map(|(constraint, body)| Resultant { constraint, body, turns, axis })
    }
}

/// All components of the reactions on bodies at a place.
#[derive(Clone, Debug, Default)]
pub(crate) struct Resultants {
    /// The first row of the force on each body, and the first row of the torque.
    pub(crate) rows: Vec<[usize; 2]>,
    pub(crate) kept: Vec<usize>,
    /// For each row, the value due to each independent constraint.
    pub(crate) values: Vec<Vec<Sized>>,
}

impl Resultants {
    /// A component; zero if the constraint is dependent on others, or if the body has no such component.
    pub(crate) fn get(&self, resultant: Resultant) -> Sized {
        let place = self.kept.iter().position(|&kept| kept == resultant.constraint);
        let row = self.rows[resultant.body][usize::from(resultant.turns)] + resultant.axis;
        place.and_then(|place| self.values.get(row)?.get(place).copied()).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_with_underscores_are_parsed() {
        let [constraints, bodies] = [["rod", "rod_a"], ["a_b", "b"]].map(|list| list.map(str::to_owned));
        let found = |name: &str| Resultant::named(name, &constraints, &bodies);
        let rod = Resultant { constraint: 0, body: 0, turns: false, axis: 2 };
        assert_eq!(found("F_rod_a_b_z"), Some(rod));
        let other = Resultant { constraint: 1, body: 1, turns: true, axis: 0 };
        assert_eq!(found("N_rod_a_b_1"), Some(Resultant { turns: true, axis: 0, ..rod }));
        assert_eq!(found("N_rod_a_a_b_1"), Some(Resultant { body: 0, ..other }));
        assert_eq!((found("F_rod_a_b_1"), found("F_rod_c_x"), found("x")), (None, None, None));
    }
}
