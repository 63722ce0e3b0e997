//! The picture of a root locus.

use pc_analysis::{Eigenvalue, RootLocus};
use pc_print::short;
use pc_report::picture::{Content, Curve, Panel, Picture, Root, Scale};

/// The decades below the largest eigenvalue that signed logarithms show.
const MOST_DECADES: i32 = 6;

/// The axes of the complex plane in the picture of a root locus.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Axes {
    /// Both are linear, with the same scale.
    #[default]
    Linear,
    /// Both are logarithmic with a sign, and linear about zero: for eigenvalues of very different sizes.
    Symlog,
}

/// The branches in the complex plane, and their parts against the quantity `name`. `present` is its present value, `modes` the
/// names of each branch's largest components.
pub(crate) fn picture(
    (title, name): (&str, &str),
    locus: &RootLocus,
    (present, modes): (Option<f64>, &[Vec<String>]),
    axes: Axes,
) -> Picture {
    let (Some(first), Some(last)) = (locus.values().first(), locus.values().last()) else {
        return Picture { title: title.to_owned(), remarks: Vec::new(), panels: Vec::new() };
    };
    let scale = match axes {
        Axes::Linear => Scale::Linear,
        Axes::Symlog => Scale::SignedDecades(least_decade(locus)),
    };
    let way = |(number, branch): (usize, &Branch)| Root {
        title: said(number, branch, (name, locus.values()), modes.get(number - 1)),
        points: branch.iter().map(|lambda| placed(*lambda, scale)).collect(),
        present: present
            .and_then(|present| at(locus.values(), branch, present))
            .map(|lambda| placed(Some(lambda), scale)),
    };
    let roots: Vec<Root> = (1..).zip(locus.branches()).map(way).collect();
    let marked = match present.filter(|_| roots.iter().any(|root| root.present.is_some())) {
        Some(present) => format!("; a disc at the present {}", short(present, 6)),
        None => String::new(),
    };
    let remark =
        format!("{name} from {} (crosses) to {} (circles){marked}", short(*first, 6), short(*last, 6));
    let plane = Panel {
        across: ("Re λ".to_owned(), scale),
        up: ("Im λ".to_owned(), scale),
        equal: axes == Axes::Linear,
        content: Content::Roots(roots),
        ..Panel::over("Re λ", "Eigenvalues in the complex plane", scale, Vec::new())
    };
    let panels =
        vec![plane, over(name, "Re λ", locus, |l| l.real), over(name, "Im λ", locus, |l| l.imaginary)];
    Picture { title: title.to_owned(), remarks: vec![remark], panels }
}

type Branch = Vec<Option<Eigenvalue>>;

/// One part of the eigenvalues against the quantity.
fn over(name: &str, title: &str, locus: &RootLocus, part: fn(&Eigenvalue) -> f64) -> Panel {
    let points = |branch: &Branch| {
        let all = locus.values().iter().zip(branch);
        all.map(|(&value, lambda)| (value, lambda.as_ref().map_or(f64::NAN, part))).collect()
    };
    let curve = |(i, branch)| Curve { name: format!("λ{i}"), points: points(branch) };
    Panel::over(name, title, Scale::Linear, (1..).zip(locus.branches()).map(curve).collect())
}

fn placed(lambda: Option<Eigenvalue>, scale: Scale) -> (f64, f64) {
    lambda.map_or((f64::NAN, f64::NAN), |l| (scale.of(l.real), scale.of(l.imaginary)))
}

/// The power of ten below which an axis of signed logarithms is linear: that of the smallest eigenvalue that is not a rounding
/// error beside the largest.
fn least_decade(locus: &RootLocus) -> i32 {
    let sizes = locus.branches().iter().flatten().flatten().map(|l| l.real.hypot(l.imaginary));
    let sizes: Vec<f64> = sizes.filter(|size| *size > 0.0 && size.is_finite()).collect();
    let decade = |size: f64| size.log10().floor() as i32;
    let Some(largest) = sizes.iter().copied().reduce(f64::max).map(decade) else { return 0 };
    sizes.into_iter().map(decade).filter(|size| *size >= largest - MOST_DECADES).min().unwrap_or(largest)
}

/// The eigenvalue of a branch between two of the values, along the line through its neighbours.
fn at(values: &[f64], branch: &Branch, value: f64) -> Option<Eigenvalue> {
    if let Some(place) = values.iter().position(|known| *known == value) {
        return branch[place];
    }
    let i = values.windows(2).position(|pair| (pair[0] < value) != (pair[1] < value))?;
    let (a, b) = (branch[i]?, branch[i + 1]?);
    let part = (value - values[i]) / (values[i + 1] - values[i]);
    let between = |a: f64, b: f64| a + part * (b - a);
    Some(Eigenvalue { real: between(a.real, b.real), imaginary: between(a.imaginary, b.imaginary) })
}

/// What is said of a branch where a viewer points at it.
fn said(
    number: usize,
    branch: &Branch,
    (name, values): (&str, &[f64]),
    mode: Option<&Vec<String>>,
) -> String {
    let mode = mode.filter(|mode| !mode.is_empty());
    let mode = mode.map_or_else(String::new, |mode| format!(", mostly {}", mode.join(", ")));
    let known: Vec<(f64, Eigenvalue)> =
        values.iter().zip(branch).filter_map(|(&value, lambda)| Some((value, (*lambda)?))).collect();
    let at = |(value, lambda): &(f64, Eigenvalue)| {
        let sign = if lambda.imaginary < 0.0 { "−" } else { "+" };
        let imaginary = match lambda.imaginary {
            0.0 => String::new(),
            imaginary => format!(" {sign} {}i", short(imaginary.abs(), 4)),
        };
        // Zero has no sign.
        format!("{}{imaginary} at {name} = {}", short(lambda.real + 0.0, 4), short(*value, 6))
    };
    match (known.first(), known.last()) {
        (Some(first), Some(last)) => format!("λ{number}{mode}: from {} to {}", at(first), at(last)),
        _ => format!("λ{number}{mode}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn locus() -> RootLocus {
        let mut locus = RootLocus::default();
        for i in 0..=4 {
            let p = f64::from(i);
            let values = [(-p, 1.0), (-p, -1.0), (-1000.0, 0.0)];
            let values = values.map(|(real, imaginary)| Eigenvalue { real, imaginary });
            locus.push(p, Some(&values)).unwrap_or_else(|error| panic!("{error}"));
        }
        locus
    }

    #[test]
    fn the_present_value_lies_between_its_neighbours() {
        let (locus, modes) = (locus(), vec![vec!["x".to_owned(), "x'".to_owned()]; 3]);
        let picture = picture(("a", "p"), &locus, (Some(1.5), &modes), Axes::Linear);
        assert_eq!(picture.remarks, ["p from 0 (crosses) to 4 (circles); a disc at the present 1.5"]);
        let Content::Roots(roots) = &picture.panels[0].content else { panic!("{picture:?}") };
        assert_eq!(roots[0].present, Some((-1.5, 1.0)));
        assert_eq!(roots[1].title, "λ2, mostly x, x': from 0 − 1i at p = 0 to -4 − 1i at p = 4");
        assert!(picture.panels[0].equal);
    }

    #[test]
    fn logarithms_begin_at_the_smallest_eigenvalue() {
        let picture = picture(("a", "p"), &locus(), (None, &[]), Axes::Symlog);
        assert_eq!(picture.panels[0].across.1, Scale::SignedDecades(0));
        let Content::Roots(roots) = &picture.panels[0].content else { panic!("{picture:?}") };
        assert_eq!(roots[0].points[0], (0.0, 2f64.log10()));
        assert!((roots[2].points[0].0 + 1001f64.log10()).abs() < 1e-12);
    }
}
