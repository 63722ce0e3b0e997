//! Models changed by chance.

use pc_model::BUILTIN;

use crate::fuzz::random::Random;

/// What may stand anywhere.
const WORDS: &[&str] = &[
    "0",
    "1e308",
    "-1e308",
    "5e-324",
    "nan",
    "inf",
    "1e400",
    "99999999999999999999",
    "-0.0",
    "0.1",
    "x",
    "t",
    "x'",
    "w1",
    "(",
    ")",
    "[",
    "]",
    "\"",
    "\\",
    "=",
    ",",
    "+",
    "-",
    "*",
    "/",
    "^",
    "^^",
    "'",
    "sin(",
    "sqrt(-1)",
    "1/0",
    "abs(",
    "step(",
    "min(",
    "atan2(0,0)",
    "[coordinates]",
    "[lagrangian]",
    "[constraints]",
    "[events.e]",
    "kinetic = ",
    "\u{0}",
    "\u{202e}",
    "é",
    "λ_k",
    "#",
    "\n",
    "\r",
    "samples = 10000000",
    "t_end = 1e300",
    "rtol = 1e-300",
    "x0 = \"x0\"",
];

/// A model that comes with the program, changed in some places; often no model any more.
pub fn changed(random: &mut Random) -> Vec<u8> {
    let mut text = random.pick(BUILTIN).text.as_bytes().to_vec();
    for _ in 0..=random.below(4) {
        change(&mut text, random);
    }
    text
}

fn change(text: &mut Vec<u8>, random: &mut Random) {
    let len = text.len();
    let lines: Vec<usize> =
        std::iter::once(0).chain((0..len).filter(|&i| text[i] == b'\n').map(|i| i + 1)).collect();
    let line = |random: &mut Random| {
        let i = random.below(lines.len());
        lines[i]..lines.get(i + 1).copied().unwrap_or(len)
    };
    let at = random.below(len + 1);
    match random.below(9) {
        0 => drop(text.drain(line(random))),
        1 => {
            let copied = text[line(random)].to_vec();
            text.splice(at..at, copied);
        }
        2 => {
            let (copied, to) = (text[line(random)].to_vec(), line(random).start);
            text.splice(to..to, copied);
        }
        3 => text.truncate(at),
        4 => {
            let end = (at + random.below(20)).min(len);
            text.drain(at..end);
        }
        5 => drop(text.splice(at..at, [random.below(256) as u8])),
        6 => number(text, at, random),
        _ => drop(text.splice(at..at, random.pick(WORDS).bytes())),
    }
}

/// Puts something else in the place of the next number.
fn number(text: &mut Vec<u8>, at: usize, random: &mut Random) {
    let is_digit = |byte: &u8| byte.is_ascii_digit() || *byte == b'.';
    let Some(start) = (at..text.len()).find(|&i| is_digit(&text[i])) else { return };
    let end = (start..text.len()).find(|&i| !is_digit(&text[i])).unwrap_or(text.len());
    text.splice(start..end, random.pick(WORDS).bytes());
}
