//! The comparison of results other than motions, made before they are returned.

use pc_mech::Folding;
use pc_model::{Assembly, Flow, Model, Variables};
use pc_print::Form;

use crate::comparison::agreement::Agreement;
use crate::comparison::compare::{Compared, Projection};
use crate::comparison::first::First;
use crate::comparison::printed::printed_name;
use crate::comparison::second::{LONG, Second};
use crate::error::VerifyError;

/// Equations to be given to a reader, a compiler or an integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outlet {
    /// Equations to integrate or linearize, in these variables.
    Equations(Variables),
    /// Equations to write as source, in these variables.
    Source(Variables),
    /// Equations to print, in this form.
    Page(Form),
    /// Equations to print, in this form, with all reactions as formulas.
    PageWithReactions(Form),
}

/// The number of random states, in addition to the start, at which equations are compared before they are
/// returned.
const NEAR: usize = 3;

/// Compares equations, in the form in which they are returned, with the second derivation at the start and at
/// three random states near it.
///
/// The equations of a large model are compared along random virtual velocities, as by [`Second::agrees`], in the form
/// that is integrated; its other forms are left out, and the agreement says so.
///
/// # Errors
/// As for [`verify`](crate::verify).
pub fn vouch(model: &Model, assembly: &Assembly<'_>, outlet: Outlet) -> Result<Agreement, VerifyError> {
    assembly.stage("the second derivation", || Second::new(model, assembly)?.vouches(model, assembly, outlet))
}

impl Second {
    pub(crate) fn vouches(
        &self,
        model: &Model,
        assembly: &Assembly<'_>,
        outlet: Outlet,
    ) -> Result<Agreement, VerifyError> {
        let mut agreement = self.nothing_yet();
        let is_large = self.cost() > LONG;
        let page = assembly.system.graph().page(Folding::Structural);
        let flow = |variables| Flow::with_stand_ins(model, assembly, variables);
        let first = match outlet {
            _ if is_large => None,
            Outlet::Source(Variables::QuasiVelocities) => {
                let first = First::emitted(assembly, self, &page, &mut agreement);
                first.map_err(|reason| agreement.leave_out("emit", &reason)).ok()
            }
            // Source in other variables is written of the expressions that are integrated.
            Outlet::Equations(variables) | Outlet::Source(variables) => {
                Some(First::flow(variables.name(), flow(variables)?, self, assembly, &mut agreement))
            }
            Outlet::Page(form) | Outlet::PageWithReactions(form) => {
                match self.too_large_for(form, assembly) {
                    Some(reason) => {
                        agreement.leave_out(&printed_name(form), reason);
                        None
                    }
                    None => {
                        let reactions = matches!(outlet, Outlet::PageWithReactions(_));
                        First::printed((form, reactions), assembly, self, &page, &mut agreement)
                    }
                }
            }
        };
        // What has no numbers of its own is made of the equations in quasi-velocities.
        let compared = match first {
            Some(first) => Compared::Wholly(vec![first]),
            None if is_large => {
                Compared::Along(Box::new(Projection::new(flow(Variables::QuasiVelocities)?, self)))
            }
            None => {
                let flow = flow(Variables::QuasiVelocities)?;
                Compared::Wholly(vec![First::flow("poincare", flow, self, assembly, &mut agreement)])
            }
        };
        self.compare_near_start(compared, NEAR, assembly, agreement)
    }
}
