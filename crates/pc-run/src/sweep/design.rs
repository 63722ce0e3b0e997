//! The values of the members of a sweep.

use pc_model::{Model, UnknownValue};

use super::error::SweepError;
use super::law::{Law, Random};
use super::values::Vary;

/// What is varied, and how: in a grid, or by drawing members at random.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variation {
    /// The quantities of a grid; each combination of their values is a member.
    pub vary: Vec<Vary>,
    /// The quantities that are drawn at random.
    pub random: Vec<Random>,
    /// The number of members to draw; none for a grid.
    pub members: Option<u64>,
    /// The seed of the random draws.
    pub seed: u64,
}

/// The members of a sweep, numbered from 0, with their values.
#[derive(Clone, Debug)]
pub struct Design {
    targets: Vec<Target>,
    values: Values,
    members: u64,
}

/// A quantity that is varied.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Target {
    Parameter(String),
    Start(String),
}

#[derive(Clone, Debug)]
enum Values {
    /// All combinations of values; the last quantity changes fastest.
    Grid(Vec<Vary>),
    /// Independent draws for each member, in order, from a random stream of its own.
    Random { laws: Vec<Law>, seed: u64 },
    /// The values of each member, one member after the other.
    Listed(Vec<f64>),
}

impl Design {
    /// The members of a variation of a model; the names in `set` must not be varied.
    ///
    /// # Errors
    /// [`SweepError`] if a name is not in the model, is given twice or is also set, or there are
    /// too many members.
    pub fn new(model: &Model, variation: &Variation, set: &[&str]) -> Result<Design, SweepError> {
        let Variation { vary, random, members, seed } = variation;
        let varied = vary.iter().map(|vary| vary.name.as_str());
        let names: Vec<&str> = varied.chain(random.iter().map(|random| random.name.as_str())).collect();
        for (i, &name) in names.iter().enumerate() {
            if names[..i].contains(&name) || set.contains(&name) {
                return Err(SweepError::Twice { name: name.to_owned() });
            }
        }
        let mut counts = vary.iter().map(|vary| vary.values.count());
        let grid = || counts.try_fold(1, u64::checked_mul);
        let count = members.or_else(grid).ok_or(SweepError::TooMany)?;
        let values = match members {
            Some(_) => {
                Values::Random { laws: random.iter().map(|Random { law, .. }| *law).collect(), seed: *seed }
            }
            None => Values::Grid(vary.clone()),
        };
        Ok(Design { targets: targets(model, &names)?, values, members: count })
    }

    /// Members with these values of the named quantities; `values` contains those of one member after the
    /// other.
    ///
    /// # Errors
    /// [`SweepError::UnknownValue`] if a name is not in the model.
    pub fn listed(model: &Model, names: &[&str], values: Vec<f64>) -> Result<Design, SweepError> {
        let members = (values.len() / names.len().max(1)) as u64;
        Ok(Design { targets: targets(model, names)?, values: Values::Listed(values), members })
    }

    /// The number of members.
    pub fn members(&self) -> u64 {
        self.members
    }

    /// The columns of the varied quantities.
    pub(crate) fn names(&self) -> Vec<String> {
        let name = |target: &Target| match target {
            Target::Parameter(name) => name.clone(),
            Target::Start(name) => format!("{name}(start)"),
        };
        self.targets.iter().map(name).collect()
    }

    /// The values of a member.
    pub fn values(&self, member: u64) -> Vec<f64> {
        match &self.values {
            Values::Grid(varied) => {
                let mut rest = member;
                let mut values: Vec<f64> = varied
                    .iter()
                    .rev()
                    .map(|vary| {
                        let place = rest % vary.values.count();
                        rest /= vary.values.count();
                        vary.values.at(place)
                    })
                    .collect();
                values.reverse();
                values
            }
            Values::Random { laws, seed } => Law::draw(laws, *seed, member),
            Values::Listed(values) => {
                let count = self.targets.len();
                values[member as usize * count..][..count].to_vec()
            }
        }
    }

    /// The model with these values of the varied quantities.
    pub(crate) fn model(&self, model: &Model, values: &[f64]) -> Model {
        let mut model = model.clone();
        for (target, &value) in self.targets.iter().zip(values) {
            // The names are known to be in this model.
            let _ = match target {
                Target::Parameter(name) => model.set(name, value).is_ok(),
                Target::Start(name) => model.set_start(name, value).is_ok(),
            };
        }
        model
    }
}

fn targets(model: &Model, names: &[&str]) -> Result<Vec<Target>, SweepError> {
    names.iter().map(|name| target(model, name)).collect()
}

fn target(model: &Model, name: &str) -> Result<Target, SweepError> {
    let (parameters, starts) = (model.parameter_names(), model.start_names());
    if parameters.iter().any(|known| known == name) {
        Ok(Target::Parameter(name.to_owned()))
    } else if starts.iter().any(|known| known == name) {
        Ok(Target::Start(name.to_owned()))
    } else {
        Err(SweepError::UnknownValue(UnknownValue { name: name.to_owned(), parameters, starts }))
    }
}
