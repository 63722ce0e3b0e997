//! The values of the members of a sweep.

use pc_model::{Model, UnknownValue};
use pc_solve::member_stream;
use rand_distr::{Distribution, LogNormal, Normal, Uniform};

use super::error::SweepError;
use crate::args::sweep::{Law, Random, SweepArguments, Vary};

/// The members, numbered from 0, with their values.
#[derive(Clone, Debug)]
pub(crate) struct Design {
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
    /// All combinations, the last one changing fastest.
    Grid(Vec<Vary>),
    /// Independent draws from the stream of the member, in order.
    Random { laws: Vec<Law>, seed: u64 },
}

impl Design {
    /// # Errors
    /// [`SweepError`] if a name is not in the model, is given twice or is also set, or there are
    /// too many members.
    pub(crate) fn new(model: &Model, arguments: &SweepArguments) -> Result<Design, SweepError> {
        let varied = arguments.vary.iter().map(|vary| &vary.name);
        let random = arguments.random.iter().map(|random| &random.name);
        let names: Vec<&String> = varied.chain(random).collect();
        for (i, &name) in names.iter().enumerate() {
            if names[..i].contains(&name) || arguments.model.set.iter().any(|set| &set.name == name) {
                return Err(SweepError::Twice { name: name.clone() });
            }
        }
        let targets = names.iter().map(|name| target(model, name)).collect::<Result<_, _>>()?;
        let mut counts = arguments.vary.iter().map(|vary| vary.values.count());
        let grid = || counts.try_fold(1, u64::checked_mul);
        let members = arguments.samples.or_else(grid).ok_or(SweepError::TooMany)?;
        let values = match arguments.samples {
            Some(_) => Values::Random {
                laws: arguments.random.iter().map(|Random { law, .. }| *law).collect(),
                seed: arguments.seed,
            },
            None => Values::Grid(arguments.vary.clone()),
        };
        Ok(Design { targets, values, members })
    }

    /// Number of members.
    pub(crate) fn members(&self) -> u64 {
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
    pub(crate) fn values(&self, member: u64) -> Vec<f64> {
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
            Values::Random { laws, seed } => {
                let mut stream = member_stream(*seed, member);
                // The command line has refused invalid distributions.
                let nan = f64::NAN;
                let draw = |law: &Law| match *law {
                    Law::Normal(m, s) => Normal::new(m, s).map_or(nan, |law| law.sample(&mut stream)),
                    Law::LogNormal(m, s) => LogNormal::new(m, s).map_or(nan, |law| law.sample(&mut stream)),
                    Law::Uniform(a, b) => {
                        Uniform::new_inclusive(a, b).map_or(nan, |law| law.sample(&mut stream))
                    }
                };
                laws.iter().map(draw).collect()
            }
        }
    }

    /// The model with these values.
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
