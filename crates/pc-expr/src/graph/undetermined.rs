//! Undetermined functions: known by their names, their arguments and nothing else.
//!
//! V(r) stands for any smooth function. Its derivatives follow the chain rule, of any order, and are functions of the
//! same kind: V'(r), ∂²A/∂x∂y. What holds between such expressions holds for all functions of that name.

/// The largest number of arguments of an undetermined function.
pub const MOST_ARGUMENTS: usize = 3;
/// Derivatives up to this order have primes.
const MOST_PRIMES: u8 = 3;

/// An undetermined function, differentiated so many times with respect to each of its arguments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Undetermined {
    /// The index into the names of undetermined functions of the graph.
    pub(super) name: u32,
    arity: u8,
    orders: [u8; MOST_ARGUMENTS],
}

/// How a derivative is written.
pub(crate) enum Differentiation {
    None,
    /// V', V'', V'''
    Primes(usize),
    /// V^(4)
    Order(u8),
    /// A_,x,y: one index for each differentiation, the argument if it is a symbol and its number otherwise.
    Indices(Vec<String>),
}

impl Undetermined {
    /// The function whose name has this index, differentiated as often with respect to each argument as
    /// `orders` says.
    pub(super) fn new(name: u32, orders: &[u8]) -> Undetermined {
        let mut all = [0; MOST_ARGUMENTS];
        all[..orders.len()].copy_from_slice(orders);
        Undetermined { name, arity: orders.len() as u8, orders: all }
    }

    /// The same function with the index of its name in another graph.
    pub(super) fn with_name(self, name: u32) -> Undetermined {
        Undetermined { name, ..self }
    }

    /// How often the function is differentiated with respect to each argument.
    pub(crate) fn orders(&self) -> &[u8] {
        &self.orders[..usize::from(self.arity)]
    }

    /// The arguments among the places for them.
    pub(crate) fn args<'a, T>(&self, args: &'a [T; MOST_ARGUMENTS]) -> &'a [T] {
        &args[..usize::from(self.arity)]
    }

    /// The derivative with respect to one argument; `None` beyond the highest order that is counted.
    pub(crate) fn differentiated(mut self, position: usize) -> Option<Undetermined> {
        self.orders[position] = self.orders[position].checked_add(1)?;
        Some(self)
    }

    /// How the derivative is written when the arguments have these texts.
    pub(crate) fn differentiation(&self, args: &[String]) -> Differentiation {
        match *self.orders() {
            [0] | [0, 0] | [0, 0, 0] => Differentiation::None,
            [order] if order <= MOST_PRIMES => Differentiation::Primes(order.into()),
            [order] => Differentiation::Order(order),
            ref orders => {
                let is_symbol = |text: &&String| !text.contains(['(', ' ', '+', '-', '*', '/', '^']);
                let index = |(place, &order): (usize, &u8)| {
                    let index = args.get(place).filter(is_symbol).cloned();
                    std::iter::repeat_n(index.unwrap_or_else(|| (place + 1).to_string()), order.into())
                };
                Differentiation::Indices(orders.iter().enumerate().flat_map(index).collect())
            }
        }
    }

    /// The derivative in plain characters, without its arguments: `V'`, `A_,x,y`.
    pub(crate) fn text(&self, name: &str, args: &[String]) -> String {
        match self.differentiation(args) {
            Differentiation::None => name.to_owned(),
            Differentiation::Primes(count) => format!("{name}{}", "'".repeat(count)),
            Differentiation::Order(order) => format!("{name}^({order})"),
            Differentiation::Indices(indices) => format!("{name}_,{}", indices.join(",")),
        }
    }
}
