//! `pc sweep` over a parameter or a start, each member against `pc run` of its value.

use super::child::Outcome;
use super::runs::form;
use super::table::Table;
use super::tried::Tried;
use crate::fuzz::comparison::exceeds;

/// Members and runs have the same tolerances, but not the same steps: relative to a number or to 1.
const TOLERANCE: f64 = 1e-7;

/// How much more than what a tighter tolerance changes two motions may be apart: as of other methods.
const GROWTH: f64 = 100.0;

/// A part of the value by which members differ from the model.
const APART: f64 = 0.04;

/// Three members about the value of a parameter or a start.
pub(super) fn examine(tried: &mut Tried<'_>) {
    let of_parameters = tried.random.chance(60);
    let names = match of_parameters && !tried.parameters.is_empty() {
        true => &tried.parameters,
        false => &tried.starts,
    };
    let Some((name, value)) = (!names.is_empty()).then(|| tried.random.pick(names).clone()) else { return };
    let (form, arguments) = form(tried);
    // A sweep knows Hamel's form by the text only.
    let mut arguments = if form == "hamel" { Vec::new() } else { arguments };
    if tried.random.chance(30) {
        arguments.push("--project-start".to_owned());
    }
    let apart = if value == 0.0 { APART } else { APART * value };
    let values = [value - apart, value, value + 0.7 * apart];
    let list = values.map(|value| format!("{value:?}")).join(",");
    let sweep = [
        vec!["--vary".to_owned(), format!("{name}={list}"), "-o".to_owned(), "s.csv".to_owned()],
        arguments.clone(),
    ];
    let sweep = sweep.concat();
    if tried.output("pc sweep", "sweep", &sweep).is_none() {
        return;
    }
    let text = tried.contents("s.csv");
    let Some(table) = tried.table(&text, &sweep, has_ended) else { return };
    if table.rows.len() != values.len() {
        tried
            .tally
            .find("a sweep lacks members", format!("{} of {}: {text}", table.rows.len(), values.len()));
        return;
    }
    for (member, value) in values.into_iter().enumerate() {
        let mut run =
            vec!["--set".to_owned(), format!("{name}={value:?}"), "--rows".to_owned(), "2".to_owned()];
        run.extend(arguments.clone());
        if let Some(difference) = of_member(tried, &table, member, &run) {
            let detail = format!("{difference}: sweep {}; run {}", sweep.join(" "), run.join(" "));
            tried.tally.find("a member of a sweep is not the run of its value", detail);
            return;
        }
    }
}

/// Whether a member came to its end.
fn has_ended(table: &Table, member: usize) -> bool {
    matches!(table.word(member, "status"), Some("completed" | "event"))
}

/// What a member has otherwise than a run.
fn of_member(tried: &mut Tried<'_>, table: &Table, member: usize, run: &[String]) -> Option<String> {
    let outcome = tried.call("run", run);
    let status = table.word(member, "status").unwrap_or_default().to_owned();
    let text = match (outcome, has_ended(table, member)) {
        (Outcome::Done(text), true) => text,
        (Outcome::Done(_), false) => return Some(format!("{status}, but the run is done")),
        (Outcome::Refused(_, message), true) => {
            return Some(format!("{status}, but the run is refused: {message}"));
        }
        _ => return None,
    };
    let row = tried.table(&text, run, |_, _| true)?;
    apart(table, member, &row, 0.0)?;
    // What is apart may be what motions do that part from each other: these change at tighter tolerances, too.
    let tight = ["--rtol", "1e-12", "--atol", "1e-14"].map(str::to_owned);
    let tight = tried.output("pc run", "run", &[run, &tight[..]].concat())?;
    let tight = Table::of(&tight).ok()?;
    let last = |table: &Table, name: &str| Some(table.rows.last()?[table.place(name)?]);
    let moved = |name: &String| f64::abs(last(&row, name)? - last(&tight, name)?).into();
    let moved = row.columns.iter().filter_map(moved).fold(0.0, f64::max);
    apart(table, member, &row, moved)
}

/// A column of a member that is not that of the last row of a run, where motions move so far at other tolerances.
fn apart(table: &Table, member: usize, run: &Table, moved: f64) -> Option<String> {
    let (found, wanted) = (&table.rows[member], run.rows.last()?);
    for (name, &wanted) in run.columns.iter().zip(wanted) {
        let Some(place) = table.place(name) else { return Some(format!("there is no column {name}")) };
        let allowed = TOLERANCE * wanted.abs().max(1.0) + GROWTH * moved;
        if exceeds(found[place] - wanted, allowed) && !(found[place].is_nan() && wanted.is_nan()) {
            return Some(format!("{name} is {:?}, not {wanted:?}; {allowed:.0e} allowed", found[place]));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_member_that_is_another_motion_is_found() {
        let members = "member,p,status,t,x,message\n0,0.5,completed,1,0.25,\n1,0.6,failed,0.4,NaN,\"a, b\"\n";
        let members = Table::of(members).expect("a table");
        let run = |text: &str| Table::of(text).expect("a table");
        assert_eq!(apart(&members, 0, &run("t,x\n0,1\n1,0.25\n"), 0.0), None);
        let other = run("t,x\n0,1\n1,0.26\n");
        assert!(apart(&members, 0, &other, 0.0).is_some_and(|detail| detail.contains("x is 0.25, not 0.26")));
        assert_eq!(apart(&members, 0, &other, 1e-3), None);
        assert!(apart(&members, 0, &run("t,y\n1,0.25\n"), 0.0).is_some());
        assert!(has_ended(&members, 0) && !has_ended(&members, 1));
    }
}
