//! Components of one vector, by their names.

use crate::picture::motion::moves;

/// A column with its name.
type Column = (String, Vec<f64>);

/// The letters and digits that tell components of a vector apart; those of a quaternion include w.
const MARKS: [&str; 3] = ["wxyz", "WXYZ", "0123456789₀₁₂₃₄₅₆₇₈₉"];
/// The largest number of components; more, such as the angles of a chain, are no vector.
const MOST: usize = 4;
/// A component is invisible beside another that changes by this many times as much.
const RATIO: f64 = 200.0;

/// The vectors among columns, each with two to four components, and the other columns.
pub(super) fn vectors(columns: &[Column]) -> (Vec<Vec<Column>>, Vec<Column>) {
    let mut vectors: Vec<Vec<usize>> = Vec::new();
    let mut is_taken = vec![false; columns.len()];
    for marks in MARKS {
        for i in 0..columns.len() {
            let found = stems(&columns[i].0, marks).into_iter().filter(|_| !is_taken[i]).find_map(|stem| {
                let alike = |j: &usize| !is_taken[*j] && stems(&columns[*j].0, marks).contains(&stem);
                let all: Vec<usize> = (0..columns.len()).filter(alike).collect();
                ((2..=MOST).contains(&all.len()) && are_visible(columns, &all)).then_some(all)
            });
            if let Some(all) = found {
                all.iter().for_each(|&j| is_taken[j] = true);
                vectors.push(all);
            }
        }
    }
    vectors.sort_unstable();
    let vectors = vectors.iter().map(|all| all.iter().map(|&j| columns[j].clone()).collect()).collect();
    let others = columns.iter().zip(is_taken).filter(|(_, taken)| !taken);
    (vectors, others.map(|(column, _)| column.clone()).collect())
}

/// What is before and after each mark in a name.
fn stems<'a>(name: &'a str, marks: &str) -> Vec<(&'a str, &'a str)> {
    let places = name.char_indices().filter(|(_, c)| marks.contains(*c));
    places.map(|(place, c)| (&name[..place], &name[place + c.len_utf8()..])).collect()
}

/// Whether each component that changes can be seen to change beside the others.
fn are_visible(columns: &[Column], all: &[usize]) -> bool {
    let spans = all.iter().map(|&j| &columns[j].1).filter(|values| moves(values)).map(|values| {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min)
    });
    let (low, high) = spans.fold((f64::INFINITY, 0.0), |(low, high), span| (span.min(low), span.max(high)));
    high <= RATIO * low
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(columns: &[(&str, f64)]) -> (Vec<String>, Vec<String>) {
        let columns: Vec<Column> =
            columns.iter().map(|(name, size)| ((*name).to_owned(), vec![0.0, *size])).collect();
        let (vectors, others) = vectors(&columns);
        let names =
            |list: &[Column]| list.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(" ");
        (
            vectors.iter().map(|list| names(list)).collect(),
            others.iter().map(|column| column.0.clone()).collect(),
        )
    }

    #[test]
    fn components_stay_together() {
        let body = ["x", "θ", "y", "q0", "z", "q1", "q2", "q3", "ω1", "hub_ω1", "ω3"].map(|name| (name, 1.0));
        let (vectors, others) = named(&body);
        assert_eq!(vectors, ["x y z", "q0 q1 q2 q3", "ω1 ω3"]);
        assert_eq!(others, ["θ", "hub_ω1"]);
        // Points of a plane, one by one.
        let points = ["x1", "y1", "x2", "y2"].map(|name| (name, 1.0));
        assert_eq!(named(&points).0, ["x1 y1", "x2 y2"]);
    }

    #[test]
    fn what_cannot_be_seen_beside_others_is_apart() {
        assert_eq!(named(&[("x", 100.0), ("y", 0.1)]).1, ["x", "y"]);
        assert_eq!(named(&[("q0", 1.0), ("q1", 0.0), ("q2", 0.1)]).0, ["q0 q1 q2"]);
        let chain = ["a1", "a2", "a3", "a4", "a5"].map(|name| (name, 1.0));
        assert!(named(&chain).0.is_empty());
    }
}
