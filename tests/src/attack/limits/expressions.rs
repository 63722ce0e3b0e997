//! Expressions of any length that are larger than they look.

use crate::fuzz::random::Random;

/// Levels of parentheses that a text may have, less what is put around an expression.
const DEEPEST: usize = 150;
/// Functions without a pole or an edge where their argument is positive.
const FUNCTIONS: &[&str] =
    &["sin", "cos", "tanh", "atan", "exp", "log", "sqrt", "abs", "sinh", "tan", "cot", "acos", "sign"];

const EXPONENTS: &[&str] = &["0.5", "1.5", "(1/3)", "-0.25", "0.7", "(-2/7)", "1.0000001", "2.5", "-3", "pi"];

/// Makes expressions in some names, and the definitions that these use.
#[derive(Debug)]
pub(super) struct Expressions<'r> {
    random: &'r mut Random,
    names: Vec<String>,
    definitions: Vec<String>,
}

impl<'r> Expressions<'r> {
    /// Expressions in these names, of which there is at least one.
    pub(super) fn new(names: Vec<String>, random: &'r mut Random) -> Expressions<'r> {
        Expressions { random, names, definitions: Vec::new() }
    }

    /// The lines of the definitions that were used.
    pub(super) fn definitions(self) -> Vec<String> {
        self.definitions
    }

    /// An expression without definitions.
    pub(super) fn plain(&mut self) -> String {
        self.leaf()
    }

    /// How many expressions of which length make a text that is no longer than `most`.
    pub(super) fn several(&mut self, most: f64) -> (usize, usize) {
        let [count, size] = [most / 20.0, 1000.0].map(|most: f64| self.random.number(0.0, most.ln()).exp());
        (count.min(most / size) as usize, size as usize)
    }

    /// Some of 0..count, one at least.
    pub(super) fn chosen(&mut self, count: usize) -> Vec<usize> {
        let one = self.random.below(count);
        (0..count).filter(|&at| at == one || self.random.chance(15)).collect()
    }

    /// An expression of about so many bytes, with its definitions.
    pub(super) fn any(&mut self, bytes: usize) -> String {
        match self.random.below(20) {
            0 => self.powers(bytes),
            1 => self.nested("1/({} + {leaf})", bytes),
            2 => self.joined("/", 40, bytes),
            3 => self.joined("*", 40, bytes),
            4 => self.nested("({}*{leaf} + {leaf})", bytes),
            5 => self.tower(bytes),
            6 => self.functions(bytes),
            7 => self.sum_of_sines(bytes),
            8 => self.power_of_sum(bytes),
            9 => self.product_of_sums(bytes),
            10 => self.great_power(),
            11 => self.digits(bytes),
            12 => self.pieces(bytes),
            13 => self.extremes(bytes),
            14 => self.sum_of_quotients(bytes),
            15 => self.sum_of_roots(bytes),
            16 => self.doubled(bytes),
            _ => self.mixed(bytes),
        }
    }

    /// Short, and positive where the name is not far from 0.
    fn leaf(&mut self) -> String {
        let name = self.random.pick(&self.names).clone();
        let k = self.random.below(1000) + 1;
        match self.random.below(5) {
            0 => format!("(1 + {name}^2)"),
            1 => format!("(2 + sin({k}*{name}))"),
            2 => format!("(3 + 0.{k}*{name})"),
            3 => format!("(1.5 + cos({name} + {k}))"),
            _ => format!("({name}^2 + {k})"),
        }
    }

    fn exponent(&mut self) -> &'static str {
        let exponent: &&str = self.random.pick(EXPONENTS);
        exponent
    }

    /// `step` put into itself, as deep as parentheses go.
    fn nested(&mut self, step: &str, bytes: usize) -> String {
        let levels = (bytes / (step.len() + 14)).clamp(1, DEEPEST);
        (0..levels).fold(self.leaf(), |inner, _| {
            let mut text = step.replace("{}", &inner);
            while text.contains("{leaf}") {
                text = text.replacen("{leaf}", &self.leaf(), 1);
            }
            text
        })
    }

    fn powers(&mut self, bytes: usize) -> String {
        let levels = (bytes / 20).clamp(1, DEEPEST);
        (0..levels).fold(self.leaf(), |inner, _| match self.random.below(3) {
            0 => format!("({inner} + {})^{}", self.leaf(), self.exponent()),
            1 => format!("({inner})^{}", self.exponent()),
            _ => format!("(0.1 + {inner}^{})", self.exponent()),
        })
    }

    fn functions(&mut self, bytes: usize) -> String {
        let levels = (bytes / 10).clamp(1, DEEPEST);
        let alike = self.random.chance(50).then(|| *self.random.pick(FUNCTIONS));
        (0..levels).fold(self.leaf(), |inner, _| {
            let function = alike.unwrap_or_else(|| *self.random.pick(FUNCTIONS));
            if self.random.chance(30) {
                format!("{function}({inner} + {})", self.leaf())
            } else {
                format!("{function}({inner})")
            }
        })
    }

    /// So many leaves with an operator between them.
    fn joined(&mut self, operator: &str, each: usize, bytes: usize) -> String {
        self.list(bytes / each, operator, |all, _| {
            let leaf = all.leaf();
            match all.random.below(3) {
                0 => format!("{leaf}^{}", all.exponent()),
                1 => format!("sin({leaf})"),
                _ => leaf,
            }
        })
    }

    fn list(
        &mut self,
        count: usize,
        between: &str,
        mut entry: impl FnMut(&mut Self, usize) -> String,
    ) -> String {
        (1..=count.max(1)).map(|i| entry(self, i)).collect::<Vec<_>>().join(between)
    }

    fn sum_of_sines(&mut self, bytes: usize) -> String {
        let function = *self.random.pick(&["sin", "cos", "exp", "tanh", "atan"]);
        let [a, b] = [0, 1].map(|_| self.random.pick(&self.names).clone());
        let of_two = self.random.chance(50);
        self.list(bytes / 20, " + ", |_, i| {
            if of_two {
                format!("{function}({i}*{a} + {b})/{i}^2")
            } else {
                format!("{function}({i}*{a})/{i}^3")
            }
        })
    }

    fn sum_of_quotients(&mut self, bytes: usize) -> String {
        self.list(bytes / 30, " + ", |all, i| format!("{}/({} + {i})", all.leaf(), all.leaf()))
    }

    fn sum_of_roots(&mut self, bytes: usize) -> String {
        self.list(bytes / 30, " + ", |all, i| format!("({} + {i})^{}", all.leaf(), all.exponent()))
    }

    fn power_of_sum(&mut self, bytes: usize) -> String {
        let exponent = *self.random.pick(&[2, 3, 5, 8, 12, 30, 100, 1000]);
        format!("({})^{exponent}", self.list(bytes / 16, " + ", |all, _| all.leaf()))
    }

    fn product_of_sums(&mut self, bytes: usize) -> String {
        let terms = 2 + self.random.below(20);
        self.list(bytes / (16 * terms), "*", |all, _| {
            format!("({})", all.list(terms, " + ", |all, _| all.leaf()))
        })
    }

    fn great_power(&mut self) -> String {
        let leaf = self.leaf();
        let [a, b] =
            [0, 1].map(|_| *self.random.pick(&[7_u64, 100, 65_535, 1_000_000, 2_147_483_647, 1 << 53]));
        match self.random.below(3) {
            0 => format!("{leaf}^{a}"),
            1 => format!("({leaf}^{a})^{b}"),
            _ => format!("({leaf}^{a} + {})^{b}", self.leaf()),
        }
    }

    /// Numbers of many digits.
    fn digits(&mut self, bytes: usize) -> String {
        let each = 20 + self.random.below(1000);
        self.list(bytes / each, " + ", |all, _| {
            let digits: String = (0..each).map(|_| char::from(b'0' + all.random.below(10) as u8)).collect();
            let leaf = all.leaf();
            match all.random.below(3) {
                0 => format!("0.{digits}*{leaf}"),
                1 => format!("{leaf}*0.{digits}/0.1{}", &digits[1..]),
                _ => format!("{leaf}^0.{digits}"),
            }
        })
    }

    /// A function that is another one on each of many intervals.
    fn pieces(&mut self, bytes: usize) -> String {
        let name = self.random.pick(&self.names).clone();
        let levels = (bytes / 40).clamp(1, DEEPEST);
        (0..levels).fold(self.leaf(), |inner, i| format!("step({name} - {i}.25, {}, {inner})", self.leaf()))
    }

    fn extremes(&mut self, bytes: usize) -> String {
        let levels = (bytes / 24).clamp(1, DEEPEST);
        (0..levels).fold(self.leaf(), |inner, _| {
            let function = *self.random.pick(&["min", "max", "atan2"]);
            format!("{function}({}, {inner})", self.leaf())
        })
    }

    /// Definitions, each by the one before.
    fn tower(&mut self, bytes: usize) -> String {
        let steps = [
            "{}^1.5",
            "({} + 0.1)^0.5",
            "sin({})",
            "1/(1 + {})",
            "{leaf}*{}",
            "exp(-{})",
            "{}*{} + {leaf}",
            "{}/{leaf} + {leaf}",
            "tanh({})*{leaf}",
            "abs({} - 1)",
            "max({}, {leaf})",
            "step({} - 1, {}, {leaf})",
            "atan2({}, {leaf})",
            "({})^2/(1 + {}^2)",
        ];
        let alike = self.random.chance(50).then(|| *self.random.pick(&steps));
        self.chain(bytes / 24, |all| alike.unwrap_or_else(|| *all.random.pick(&steps)).to_owned())
    }

    /// Definitions that each have the one before in them more than once: twice as long, written out, with each.
    fn doubled(&mut self, bytes: usize) -> String {
        let steps =
            ["{}*{}", "{} + sin({})", "({} + 1)*({} + 2)", "{}*sin({}) + cos({})*{}", "({} + {leaf})*{}"];
        let step = *self.random.pick(&steps);
        self.chain(bytes / 24, |_| step.to_owned())
    }

    fn chain(&mut self, levels: usize, mut step: impl FnMut(&mut Self) -> String) -> String {
        let mut last = self.leaf();
        for _ in 0..levels.max(1) {
            let mut text = step(self).replace("{}", &last);
            while text.contains("{leaf}") {
                text = text.replacen("{leaf}", &self.leaf(), 1);
            }
            last = format!("d{}", self.definitions.len());
            self.definitions.push(format!("{last} = \"{text}\""));
        }
        last
    }

    fn mixed(&mut self, bytes: usize) -> String {
        if bytes < 100 {
            return self.leaf();
        }
        let [a, b] = [0, 1].map(|_| self.any(bytes / 2));
        match self.random.below(5) {
            0 => format!("({a})*({b})"),
            1 => format!("({a})/({b})"),
            2 => format!("sin({a})*({b})"),
            3 => format!("({a})^2*({b})"),
            _ => format!("{a} + {b}"),
        }
    }
}
