//! Names for long or repeated parts of a page of expressions.
//!
//! Expressions share parts, so that a page on which all parts are written out may be as long as 2 to the
//! power of the depth of the expressions. Here such parts are named, each once, before they are used: just
//! enough of them for every piece between two signs to fit on a line, and any others that shorten the page.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;
use crate::print::piece::Piece;
use crate::print::style::Style;
use crate::print::writer::{Writer, signed};

/// Candidates for the least width at which a repeated part is named; the one that gives the shortest page is
/// taken.
const WORTH_A_NAME: [usize; 7] = [usize::MAX, 80, 48, 32, 24, 16, 12];
/// The cost of a name to its reader, in characters.
const PRICE: usize = 24;
/// The least width of a value replaced by a shorthand.
const WORTH_A_SHORTHAND: usize = 20;
/// The least width of a line that is named because it recurs in one other line.
const WIDE_LINE: usize = 80;
/// A placeholder for a name while widths are measured.
const PLACEHOLDER: &str = "z10";

/// An existing name for the value of an expression.
#[derive(Clone, Debug)]
pub struct Given<'g> {
    /// The name.
    pub name: String,
    /// Its value.
    pub value: Expr<'g>,
    /// Whether the value is always printed; then the name replaces only long values.
    pub shorthand: bool,
}

/// An expression to be written, with names for its parts.
#[derive(Clone, Copy, Debug)]
pub enum Side<'g> {
    /// A line: a sum may be broken between two of its terms and continue on the next line.
    Sum(Expr<'g>),
    /// A part of a line, such as a coefficient, which must fit as a whole.
    Factor(Expr<'g>),
}

impl<'g> Side<'g> {
    /// The expression.
    pub fn expression(self) -> Expr<'g> {
        match self {
            Side::Sum(expression) | Side::Factor(expression) => expression,
        }
    }
}

/// A name with its value.
#[derive(Clone, Debug)]
pub struct Name<'g> {
    /// The name.
    pub name: String,
    /// Its value.
    pub value: Expr<'g>,
    /// Whether the name was [`Given`] as a shorthand.
    pub shorthand: bool,
    /// The number of the first line that uses the name.
    pub line: usize,
}

/// The names on a page of expressions.
#[derive(Debug)]
pub struct Names<'g> {
    graph: &'g Graph,
    lines: Vec<Expr<'g>>,
    list: Vec<Name<'g>>,
}

impl Graph {
    /// Names for parts of `lines`, besides those `given`, so that the text between two signs of a line has at
    /// most `room` columns.
    ///
    /// ```
    /// # use pc_expr::{Graph, Side, Style};
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// let long = (0..9).fold(x, |sum, n| (sum + y).powi(2) * f64::from(n + 2) + x);
    /// let names = graph.names(&[Side::Sum(long), Side::Sum(long.sin())], &[], 60);
    /// let written = names.written(Style::Text);
    /// assert!(written.terms(long).iter().all(|term| term.len() <= 60));
    /// assert_eq!(names.list()[0].name, "z1");
    /// ```
    pub fn names<'g>(&'g self, lines: &[Side<'g>], given: &[Given<'g>], room: usize) -> Names<'g> {
        Names::new(self, lines, given, room)
    }
}

impl<'g> Names<'g> {
    pub(super) fn new(graph: &'g Graph, lines: &[Side<'g>], given: &[Given<'g>], room: usize) -> Names<'g> {
        let roots: Vec<Atom> = lines.iter().map(|line| line.expression().atom_in(graph)).collect();
        let factors = lines.iter().filter_map(|line| match line {
            Side::Factor(expression) => Some(expression.atom_in(graph)),
            Side::Sum(_) => None,
        });
        let factors: FxHashSet<Atom> = factors.collect();
        let given_nodes: FxHashMap<NodeId, &Given<'g>> = given
            .iter()
            .rev() // of two names for a value the first is taken
            .filter_map(|given| match given.value.atom_in(graph) {
                Atom::Node(node) => Some((node, given)),
                Atom::Constant(_) => None,
            })
            .collect();
        let list = graph.with(|dag| {
            let page = Page::new(dag, roots, factors, &given_nodes, room);
            let named = page.shortest();
            page.in_order(&named, given)
        });
        let name = |(name, node, shorthand, line)| {
            let value = graph.expr(Atom::Node(node));
            Name { name, value, shorthand, line }
        };
        let lines = lines.iter().map(|line| line.expression()).collect();
        Names { graph, lines, list: list.into_iter().map(name).collect() }
    }

    /// The names in order of first use; the meaning of each name uses only earlier names.
    pub fn list(&self) -> &[Name<'g>] {
        &self.list
    }

    /// The lines and the meanings of the names, written with the names.
    pub fn written(&self, style: Style) -> Written {
        let roots = self.lines.iter().chain(self.list.iter().map(|name| &name.value));
        let roots: Vec<Atom> = roots.map(|expression| expression.atom_in(self.graph)).collect();
        let (terms, pieces) = self.graph.with(|dag| {
            let mut writer = Writer::new(dag, style);
            let names: FxHashMap<NodeId, &str> = self
                .list
                .iter()
                .filter_map(|name| match name.value.atom_in(self.graph) {
                    Atom::Node(node) => Some((node, name.name.as_str())),
                    Atom::Constant(_) => None,
                })
                .collect();
            for node in Cone::below(dag, roots.iter().copied()).order {
                match names.get(&node) {
                    Some(name) => writer.name(node, name),
                    None => writer.write(node),
                }
            }
            let line = |&root: &Atom| {
                let terms = match root {
                    Atom::Node(node) => signed(style, writer.line(node)),
                    Atom::Constant(_) => vec![writer.atom(root).text],
                };
                (root, terms)
            };
            (roots.iter().map(line).collect(), writer.into_pieces())
        });
        let names = self.list.iter().filter(|name| !name.shorthand).map(|name| name.value.atom());
        Written { style, terms, pieces, named: names.collect() }
    }

    /// One of the lines, followed by the names and their meanings.
    pub(super) fn sentence(&self, line: Expr<'g>, style: Style) -> String {
        let written = self.written(style);
        let [wheres, equals, comma] = style.words();
        let meaning = |name: &Name<'g>| {
            format!("{}{equals}{}", written.sentence_name(&name.name), written.meaning(name.value).join(" "))
        };
        let names: Vec<String> = self.list.iter().map(meaning).collect();
        match names.as_slice() {
            [] => written.line(line),
            names => format!("{}{wheres}{}", written.line(line), names.join(comma)),
        }
    }
}

/// The text of lines, together with the meanings of the names on the page.
pub struct Written {
    style: Style,
    /// The terms of lines and of the meanings of names.
    terms: FxHashMap<Atom, Vec<String>>,
    pieces: FxHashMap<NodeId, Piece>,
    named: FxHashSet<Atom>,
}

impl Written {
    /// The terms of a line, all except the first with their sign and a space before them; a named expression is its
    /// name, unless the name is a shorthand.
    pub fn terms(&self, line: Expr<'_>) -> Vec<String> {
        if self.named.contains(&line.atom()) { vec![self.text(line)] } else { self.meaning(line) }
    }

    /// The terms of a line side by side.
    pub fn line(&self, line: Expr<'_>) -> String {
        self.terms(line).join(" ")
    }

    /// The terms of the meaning of a name.
    pub fn meaning(&self, value: Expr<'_>) -> Vec<String> {
        self.terms.get(&value.atom()).cloned().unwrap_or_else(|| vec![value.display(self.style)])
    }

    /// An expression on the page as part of another expression.
    pub fn text(&self, expression: Expr<'_>) -> String {
        match expression.atom() {
            Atom::Node(node) if self.pieces.contains_key(&node) => self.pieces[&node].text.clone(),
            _ => expression.display(self.style),
        }
    }

    /// A name for use in a sentence: in a LaTeX sentence it is text that can be read back.
    fn sentence_name(&self, name: &str) -> String {
        if self.style == Style::MathMl { self.name(name) } else { name.to_owned() }
    }

    /// A name in the style of the text.
    pub fn name(&self, name: &str) -> String {
        self.style.symbol(name).text
    }
}

/// A page whose names are being chosen.
struct Page<'d, 'g> {
    dag: &'d Dag,
    roots: Vec<Atom>,
    /// The nodes of which lines are multiples.
    lines: FxHashSet<NodeId>,
    factors: FxHashSet<Atom>,
    order: Vec<NodeId>,
    /// How often each node occurs in the nodes that are written.
    uses: FxHashMap<NodeId, usize>,
    given: &'d FxHashMap<NodeId, &'d Given<'g>>,
    room: usize,
}

impl<'d, 'g> Page<'d, 'g> {
    fn new(
        dag: &'d Dag,
        roots: Vec<Atom>,
        factors: FxHashSet<Atom>,
        given: &'d FxHashMap<NodeId, &'d Given<'g>>,
        room: usize,
    ) -> Page<'d, 'g> {
        let order = Cone::below(dag, roots.iter().copied()).order;
        let mut uses: FxHashMap<NodeId, usize> = FxHashMap::default();
        for root in &roots {
            if let Atom::Node(node) = root {
                *uses.entry(*node).or_default() += 1;
            }
        }
        for &node in order.iter().rev() {
            let times = if is_scaled(dag, node) { uses[&node] } else { 1 };
            dag.for_each_child(node, |child| *uses.entry(child).or_default() += times);
        }
        let line = |root: &Atom| match root {
            Atom::Node(node) if !factors.contains(root) => Some(dag.split_coefficient(*node, Number::ONE).0),
            _ => None,
        };
        let lines = roots.iter().filter_map(line).collect();
        Page { dag, roots, lines, factors, order, uses, given, room }
    }

    /// The nodes with names on the shortest page.
    fn shortest(&self) -> FxHashSet<NodeId> {
        let plain = self.named(None);
        if self.length(&plain).1 <= self.room && plain.iter().all(|node| self.given.contains_key(node)) {
            return plain; // every line fits
        }
        // Once the budget is spent, no page is printed.
        let pages =
            WORTH_A_NAME.iter().take_while(|_| !self.dag.has_spent()).map(|&least| self.named(Some(least)));
        pages.chain([plain]).min_by_key(|named| self.length(named).0).unwrap_or_default()
    }

    /// The named nodes: shorthands, parts that recur and have at least this width, and those needed to make
    /// the lines fit; only the latter if no width is given.
    fn named(&self, least: Option<usize>) -> FxHashSet<NodeId> {
        let mut writer = Writer::new(self.dag, Style::Book);
        let mut named = FxHashSet::default();
        for &node in &self.order {
            self.narrow(&mut writer, node, &mut named);
            writer.write(node);
            if !named.contains(&node) && self.is_worth_a_name(&writer, node, least) {
                self.name(&mut writer, node, &mut named);
            }
        }
        named
    }

    fn is_worth_a_name(&self, writer: &Writer<'_>, node: NodeId, least: Option<usize>) -> bool {
        let columns = writer.columns(node);
        match self.given.get(&node) {
            _ if !is_composite(self.dag, node) => false,
            Some(given) if given.shorthand => least.is_some() && columns >= WORTH_A_SHORTHAND,
            Some(_) => true,
            None if is_scaled(self.dag, node) => false,
            None => {
                // A name for the value of a line would leave that line empty.
                let lines = usize::from(self.lines.contains(&node) && columns < WIDE_LINE);
                let again = self.uses[&node] > 1 + lines && least.is_some_and(|least| columns >= least);
                again || self.factors.contains(&Atom::Node(node)) && columns > self.room
            }
        }
    }

    /// Names the widest parts of a piece between two signs of a node, until the piece fits.
    fn narrow(&self, writer: &mut Writer<'_>, node: NodeId, named: &mut FxHashSet<NodeId>) {
        let parts: Vec<NodeId> = match self.dag.node(node) {
            Node::Constant(_) | Node::Symbol(_) => return,
            Node::Sum { terms, .. } => {
                // Products already fit.
                for &(term, q) in self.dag.terms(terms) {
                    let is_sum = matches!(self.dag.node(term), Node::Sum { .. });
                    if is_sum && writer.opened(term, q).is_none() && writer.columns(term) > self.room {
                        self.name(writer, term, named);
                    }
                }
                return;
            }
            Node::Product { .. } | Node::Call { .. } | Node::Applied { .. } => {
                let mut parts = Vec::new();
                self.dag.for_each_child(node, |child| parts.push(child));
                parts
            }
        };
        // A product that is a line of its own may continue on the next line within its bracket.
        if self.lines.contains(&node) && self.uses[&node] == 1 && writer.bracketed(node).is_some() {
            return;
        }
        while writer.composed(node).columns() > self.room {
            let nameable = |part: &&NodeId| {
                is_composite(self.dag, **part)
                    && !writer.is_named(**part)
                    && writer.columns(**part) > PLACEHOLDER.len()
            };
            // Of equally wide parts the first is named, so that the choice is unique.
            let widest = parts
                .iter()
                .filter(nameable)
                .max_by_key(|&&part| (writer.columns(part), std::cmp::Reverse(part)));
            let Some(&part) = widest else { return };
            self.name(writer, part, named);
        }
    }

    fn name(&self, writer: &mut Writer<'_>, part: NodeId, named: &mut FxHashSet<NodeId>) {
        writer.name(part, self.given.get(&part).map_or(PLACEHOLDER, |given| given.name.as_str()));
        named.insert(part);
    }

    /// The number of characters on the page when names are used, and in its widest line.
    fn length(&self, named: &FxHashSet<NodeId>) -> (usize, usize) {
        let mut writer = Writer::new(self.dag, Style::Book);
        let mut length = 0;
        for &node in &self.order {
            if !named.contains(&node) {
                writer.write(node);
                continue;
            }
            let given = self.given.get(&node);
            if given.is_none_or(|given| !given.shorthand) {
                length += writer.composed(node).columns() + 2 * PLACEHOLDER.len() + PRICE;
            }
            writer.name(node, given.map_or(PLACEHOLDER, |given| given.name.as_str()));
        }
        let columns = |root: &Atom| writer.atom(*root).columns();
        let widest = self.roots.iter().map(columns).max().unwrap_or(0);
        (length + self.roots.iter().map(columns).sum::<usize>(), widest)
    }

    /// Names, their meanings, whether these are always printed, and the first line that uses each.
    fn in_order(&self, named: &FxHashSet<NodeId>, given: &[Given<'g>]) -> Vec<(String, NodeId, bool, usize)> {
        let letter = self.letter(given);
        let (mut seen, mut count) = (FxHashSet::default(), 0);
        let mut list = Vec::new();
        for (line, root) in self.roots.iter().enumerate() {
            let mut open: Vec<NodeId> = Vec::new();
            let mut new: Vec<NodeId> = Vec::new();
            let mut reach = |node: NodeId, open: &mut Vec<NodeId>| {
                if seen.insert(node) {
                    open.push(node);
                }
            };
            if let Atom::Node(node) = root {
                reach(*node, &mut open);
            }
            while let Some(node) = open.pop() {
                if named.contains(&node) {
                    new.push(node);
                }
                self.dag.for_each_child(node, |child| reach(child, &mut open));
            }
            new.sort_unstable(); // parts before the nodes that contain them
            list.extend(new.into_iter().map(|node| match self.given.get(&node) {
                Some(given) => (given.name.clone(), node, given.shorthand, line),
                None => {
                    count += 1;
                    (format!("{letter}{count}"), node, false, line)
                }
            }));
        }
        list
    }

    /// A letter that, followed by a number, begins no symbol and no given name.
    fn letter(&self, given: &[Given<'g>]) -> String {
        let symbols = self.order.iter().filter_map(|&node| match self.dag.node(node) {
            Node::Symbol(index) => Some(self.dag.symbol_name(index)),
            _ => None,
        });
        let taken: Vec<&str> = symbols.chain(given.iter().map(|given| given.name.as_str())).collect();
        let is_free = |letter: &String| {
            let rest = taken.iter().filter_map(|name| name.strip_prefix(letter.as_str()));
            !rest
                .into_iter()
                .any(|rest| rest.trim_start_matches('_').starts_with(|c: char| c.is_ascii_digit()))
        };
        let letters = ["z", "w", "u", "h", "n"].map(str::to_owned).into_iter();
        let longer = (2..).map(|times| "z".repeat(times));
        letters.chain(longer).find(is_free).unwrap_or_default()
    }
}

/// Whether a node is more than a symbol or a number.
fn is_composite(dag: &Dag, node: NodeId) -> bool {
    !matches!(dag.node(node), Node::Constant(_) | Node::Symbol(_))
}

/// Whether a node is a multiple of another, which is named instead.
fn is_scaled(dag: &Dag, node: NodeId) -> bool {
    matches!(dag.node(node), Node::Sum { constant, terms } if constant.is_zero() && dag.terms(terms).len() == 1)
}
