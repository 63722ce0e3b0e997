//! Eigenvalues in the complex plane.

use pc_print::short;

use crate::picture::axes::Axis;
use crate::picture::svg::put;

const SIDE: f64 = 260.0;
const EDGE: f64 = 26.0;

/// The eigenvalues of a steady motion, drawn with a real and an imaginary axis; eigenvalues of growing modes
/// have another colour.
pub(crate) fn figure(spectrum: &[(f64, f64)], id: &str) -> String {
    let largest = spectrum.iter().fold(0.0f64, |size, (re, im)| size.max(re.abs()).max(im.abs()));
    let half = if largest > 0.0 && largest.is_finite() { 1.15 * largest } else { 1.0 };
    let re = Axis::new((-half, half), (EDGE, SIDE - EDGE));
    let im = Axis::new((-half, half), (SIDE - EDGE, EDGE));
    let growing = spectrum.iter().filter(|(re, _)| *re > 0.0).count();
    let listed: Vec<String> = spectrum
        .iter()
        .map(|&(re, im)| match im {
            0.0 => short(re, 4),
            _ => format!("{} {} {}i", short(re, 4), if im < 0.0 { "−" } else { "+" }, short(im.abs(), 4)),
        })
        .collect();
    let mut svg = format!(
        "<svg viewBox=\"0 0 {SIDE} {SIDE}\" role=\"img\" aria-labelledby=\"{id}-t {id}-d\">\
         <title id=\"{id}-t\">Eigenvalues in the complex plane</title><desc id=\"{id}-d\">{growing} of {} have positive real \
         parts: {}</desc>\n",
        spectrum.len(),
        listed.join(", ")
    );
    let (low, high) = (EDGE, SIDE - EDGE);
    for value in re.ticks(4) {
        let (x, y) = (re.place(value), im.place(value));
        put(&mut svg, format_args!("<path class=\"grid\" d=\"M{x:.1} {low}V{high}M{low} {y:.1}H{high}\"/>"));
        if value != 0.0 {
            let label = short(value, 4).replace('-', "−");
            put(
                &mut svg,
                format_args!(
                    "<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>",
                    high + 14.0
                ),
            );
        }
    }
    let zero = SIDE / 2.0;
    put(&mut svg, format_args!("<path class=\"axis\" d=\"M{zero} {low}V{high}M{low} {zero}H{high}\"/>"));
    put(&mut svg, format_args!("<text x=\"{}\" y=\"{}\">Im</text>", zero + 4.0, low + 4.0));
    put(&mut svg, format_args!("<text x=\"{high}\" y=\"{}\" text-anchor=\"end\">Re</text>\n", zero - 5.0));
    for &(a, b) in spectrum {
        let class = if a > 0.0 { "root right" } else { "root" };
        put(
            &mut svg,
            format_args!(
                "<circle class=\"{class}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"4\"/>",
                re.place(a),
                im.place(b)
            ),
        );
    }
    svg += "</svg>";
    format!("<figure class=\"plane\">{svg}</figure>\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn growing_motions_stand_out() {
        let drawn = figure(&[(0.5, 0.0), (-0.5, 0.0), (0.0, 2.0), (0.0, -2.0)], "x");
        assert_eq!(drawn.matches("\"root right\"").count(), 1);
        assert_eq!(drawn.matches("\"root\"").count(), 3);
        assert!(drawn.contains("1 of 4 have positive real parts: 0.5, -0.5, 0 + 2i, 0 − 2i"), "{drawn}");
    }
}
