//! The results of a text, one after the other.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use pc_expr::Cancel;
use pc_model::{Assembly, Document, Model, Source};
use pc_print::Form;
use pc_report::{Scene, pieces};
use pc_run::motion::integrate::Besides;
use pc_run::motion::remarks;
use pc_run::motion::run::Run;
use pc_run::motion::summary;
use pc_run::motion::verification::checked;
use pc_run::observer::Observer;
use pc_run::{Plan, RunError, Wishes};
use serde_json::{Value, json};

use crate::args::input;
use crate::error::CliError;
use crate::live::desk::Desk;
use crate::live::diagnostics::diagnostic;
use crate::live::request::Job;
use crate::live::values::names;

/// Rows of a motion: a curve through them looks smooth, and they are quickly sent.
const ROWS: usize = 401;

/// How much is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Extent {
    /// Everything, from the names of the values to the verdicts.
    All,
    /// The motion alone, while a slider moves.
    Motion,
}

/// Computes the results of a text and tells each as soon as it is there, until it is cancelled; the last of them is `done`.
pub(super) fn compute(desk: &Desk, job: &Job, extent: Extent, cancel: &Cancel, tell: &dyn Fn(Value)) {
    let begun = Instant::now();
    let source = Source::new(desk.original.source(), job.text.as_str());
    let work = Work { desk, job, extent, cancel, notes: Notes::default(), tell };
    if let Err(error) = work.results(source.clone())
        && !cancel.is_cancelled()
    {
        tell(json!({ "kind": "diagnostics", "list": [diagnostic(&error, &source)] }));
    }
    tell(json!({ "kind": "done", "milliseconds": begun.elapsed().as_millis() as u64 }));
}

struct Work<'w> {
    desk: &'w Desk,
    job: &'w Job,
    extent: Extent,
    cancel: &'w Cancel,
    notes: Notes,
    tell: &'w dyn Fn(Value),
}

impl Work<'_> {
    fn results(&self, source: Source) -> Result<(), CliError> {
        let mut model = Model::new(Document::parse(source)?);
        model.limit(self.desk.limits(self.cancel));
        let is_whole = self.extent == Extent::All;
        if is_whole {
            (self.tell)(names(&model));
        }
        input::set(&mut model, &self.job.settings())?;
        let graph = model.graph();
        let assembly = model.assemble(&graph)?;
        if !is_whole {
            return self.motion(&model, &assembly);
        }
        // The page keeps the last good state, and marks at once what is wrong.
        let equations = assembly.equations()?;
        (self.tell)(json!({ "kind": "diagnostics", "list": [] }));
        self.equations(&model, &assembly)?;
        let moved = self.motion(&model, &assembly);
        let check = checked(&model, &assembly, &equations)?;
        (self.tell)(json!({ "kind": "verdicts", "html": pieces::verdicts(&check) }));
        moved
    }

    /// The equations in the chosen form, or what is wrong with the choice.
    fn equations(&self, model: &Model, assembly: &Assembly<'_>) -> Result<(), CliError> {
        let html = pieces::equations(model, assembly, self.form(model));
        assembly.within_limits()?;
        let html =
            html.unwrap_or_else(|error| format!("<p>{}</p>", pieces::text(&error.diagnostic().message)));
        (self.tell)(json!({ "kind": "equations", "html": html }));
        Ok(())
    }

    /// The chosen form, that of the text, or Poincaré's equations.
    fn form(&self, model: &Model) -> Form {
        let written = model.document().simulation.form.as_ref().map(|form| form.value.into());
        Form::named(&self.job.form).or(written).unwrap_or(Form::Poincare)
    }

    /// The motion and its plots, if there is an end of time.
    fn motion(&self, model: &Model, assembly: &Assembly<'_>) -> Result<(), CliError> {
        let chosen = Form::named(&self.job.form).and_then(Form::variables);
        let wishes = Wishes { form: chosen, t_end: self.job.t_end, ..Wishes::default() };
        let mut plan = match Plan::of(model, &wishes) {
            Err(RunError::NoEnd { .. }) => return self.still(model),
            plan => plan?,
        };
        plan.samples = plan.samples.max(ROWS);
        let derived = self.desk.kept.derived(model, assembly, plan.form);
        let derived = match (derived, chosen) {
            // What is printed in this form may be integrated in that of the text alone.
            (Err(_), Some(_)) => {
                plan.form = Plan::form(model, &Wishes::default());
                self.desk.kept.derived(model, assembly, plan.form)?
            }
            (derived, _) => derived?,
        };
        if self.extent == Extent::All {
            remarks::say(assembly, &self.notes)?;
        }
        let run = Run::of_derived(model, &derived, plan, &Besides::default(), &self.notes)?;
        self.show(model, assembly, &run)?;
        Ok(run.outcome()?)
    }

    fn show(&self, model: &Model, assembly: &Assembly<'_>, run: &Run) -> Result<(), CliError> {
        if self.cancel.is_cancelled() {
            return Ok(());
        }
        let record = run.record();
        let scene = Scene::of(model, assembly, &record)?;
        (self.tell)(json!({ "kind": "scene", "data": scene.map(|scene| scene.data()) }));
        (self.tell)(json!({ "kind": "plots", "data": pieces::plots(assembly, &record) }));
        let text = self.notes.text() + &summary::text(run);
        (self.tell)(
            json!({ "kind": "summary", "name": model.title(), "text": text, "t_end": run.plan.t_end }),
        );
        Ok(())
    }

    /// A model without an end of time has no motion.
    fn still(&self, model: &Model) -> Result<(), CliError> {
        (self.tell)(json!({ "kind": "scene", "data": null }));
        (self.tell)(json!({ "kind": "summary", "name": model.title(), "text": "" }));
        Ok(())
    }
}

/// Takes remarks down.
#[derive(Default)]
struct Notes(Mutex<String>);

impl Notes {
    fn text(&self) -> String {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }
}

impl Observer for Notes {
    fn remark(&self, remark: &str) {
        let mut notes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        *notes += &format!("note: {}\n", remark.replace('\n', "\n      "));
    }
}
