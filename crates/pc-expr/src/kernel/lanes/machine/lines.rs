//! The operations of a tape that become instructions, in order, and the uses of each value.

use rustc_hash::FxHashSet;

use super::super::tape::{LaneTape, LaneValue, Node};

/// An operation that becomes instructions.
#[derive(Clone, Copy, Debug)]
pub(super) enum Line {
    /// The value of a node.
    Node(u32),
    /// Records the lanes in which a ≤ b does not hold.
    Note(u32, u32),
}

/// The lines of a tape.
pub(super) struct Lines {
    pub(super) lines: Vec<Line>,
    /// For a value that equals another one in range ([`Node::Near`]), the other one; else the value
    /// itself.
    same_as: Vec<u32>,
    /// The lines that read each value. Each value that is [written last](Lines::written_last) is read by a
    /// separate line after all others, so that it is kept until the end.
    pub(super) uses: Vec<Vec<u32>>,
}

impl Lines {
    pub(super) fn of(tape: &LaneTape) -> Lines {
        let needed = tape.needed();
        let mut same_as: Vec<u32> = (0..tape.nodes.len() as u32).collect();
        let mut lines = Vec::with_capacity(tape.nodes.len());
        let mut noted = FxHashSet::default();
        for (i, node) in tape.nodes.iter().enumerate().filter(|(i, _)| needed[*i]) {
            match *node {
                Node::Input(_) | Node::Constant(_) => {}
                Node::Near { size, bound, value, .. } => {
                    same_as[i] = same_as[value.index()];
                    let test = (same_as[size.index()], same_as[bound.index()]);
                    if noted.insert(test) {
                        lines.push(Line::Note(test.0, test.1));
                    }
                }
                _ => lines.push(Line::Node(i as u32)),
            }
        }
        let mut uses = vec![Vec::new(); tape.nodes.len()];
        let result = Lines { lines, same_as, uses: Vec::new() };
        for (at, &line) in result.lines.iter().enumerate() {
            for operand in result.operands(tape, line) {
                let uses: &mut Vec<u32> = &mut uses[operand as usize];
                if uses.last() != Some(&(at as u32)) {
                    uses.push(at as u32);
                }
            }
        }
        let end = result.lines.len();
        for (at, (_, value)) in result.written_last(tape).enumerate() {
            uses[value as usize].push((end + at) as u32);
        }
        Lines { uses, ..result }
    }

    pub(super) fn value(&self, value: LaneValue) -> u32 {
        self.same_as[value.index()]
    }

    /// The values that a line reads.
    pub(super) fn operands(&self, tape: &LaneTape, line: Line) -> Vec<u32> {
        match line {
            Line::Note(a, b) => vec![a, b],
            Line::Node(i) => tape.nodes[i as usize].operands().map(|value| self.value(value)).collect(),
        }
    }

    /// The rows and values written after the last line: outputs that no line computes, then the inputs that are
    /// replaced.
    pub(super) fn written_last<'t>(&'t self, tape: &'t LaneTape) -> impl Iterator<Item = (u32, u32)> + 't {
        self.passed(tape).chain(tape.replaced.iter().map(|&(row, value)| (row, self.value(value))))
    }

    /// The rows and values of outputs that no line computes.
    pub(super) fn passed<'t>(&'t self, tape: &'t LaneTape) -> impl Iterator<Item = (u32, u32)> + 't {
        let outputs = tape.outputs.iter().enumerate();
        outputs
            .map(|(k, &value)| ((tape.inputs + k) as u32, self.value(value)))
            .filter(|&(_, value)| matches!(tape.nodes[value as usize], Node::Input(_) | Node::Constant(_)))
    }
}
