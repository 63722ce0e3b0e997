//! The operations of a tape that become instructions, in order, and the uses of each value.

use rustc_hash::FxHashSet;

use super::super::tape::{LaneTape, LaneValue, Node};

/// An operation that becomes instructions.
#[derive(Clone, Copy, Debug)]
pub(super) enum Line {
    /// The value of a node.
    Node(u32),
    /// Notes the lanes in which a ≤ b does not hold.
    Note(u32, u32),
}

/// The lines of a tape.
pub(super) struct Lines {
    pub(super) lines: Vec<Line>,
    /// For a value that equals another one in range ([`Node::Near`]), that other; else the value
    /// itself.
    same_as: Vec<u32>,
    /// The lines that read each value; values written at the end are read by a line after the last.
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
        let end = result.lines.len() as u32;
        for value in result.written_last(tape) {
            uses[value as usize].push(end);
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

    /// The values written after the last line: to rows of inputs, and those that no line computes.
    fn written_last(&self, tape: &LaneTape) -> Vec<u32> {
        let replaced = tape.replaced.iter().map(|&(_, value)| self.value(value));
        let passed = tape
            .outputs
            .iter()
            .map(|&value| self.value(value))
            .filter(|&value| matches!(tape.nodes[value as usize], Node::Input(_) | Node::Constant(_)));
        passed.chain(replaced).collect()
    }
}
