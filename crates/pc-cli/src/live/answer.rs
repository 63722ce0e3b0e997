//! The answer to a request.

use std::convert::Infallible;
use std::fmt::Display;
use std::sync::Arc;
use std::time::Duration;

use http_body_util::combinators::UnsyncBoxBody;
use http_body_util::{BodyExt, Full, LengthLimitError, Limited};
use hyper::body::{Bytes, Incoming};
use hyper::header::{
    CACHE_CONTROL, CONTENT_DISPOSITION, CONTENT_SECURITY_POLICY, CONTENT_TYPE, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS,
};
use hyper::http::response::Builder;
use hyper::{Method, Request, Response, StatusCode};
use pc_model::document::SCHEMA;
use serde::de::DeserializeOwned;
use tokio::time::timeout;

use crate::live::compute::Extent;
use crate::live::desk::Desk;
use crate::live::guard::{Guard, random};
use crate::live::notebook::notebook;
use crate::live::order::{self, Line};
use crate::live::original::Unsaved;
use crate::live::page::{page, policy};
use crate::live::program::{self, Outcome};
use crate::live::request::{Job, Order, Saving};
use crate::live::results::Lines;

/// The largest request: a text of this many bytes is longer than anybody writes.
const LARGEST: usize = 4 << 20;
/// A page on the same computer has sent its request after this time.
const PATIENCE: Duration = Duration::from_secs(10);

pub(super) type Answer = Response<UnsyncBoxBody<Bytes, Infallible>>;

/// Answers a request; one that is not from our own page learns only that there is nothing.
pub(super) async fn answer(desk: Arc<Desk>, guard: Arc<Guard>, request: Request<Incoming>) -> Answer {
    let path = request.uri().path().to_owned();
    let Some(path) = guard.admit(&path, request.headers()) else {
        return refused(Refusal::nothing_here());
    };
    let answer = match (request.method(), path) {
        (&Method::GET, "") => served(&desk),
        (&Method::GET, "schema") => Ok(whole("application/schema+json", SCHEMA)),
        (&Method::POST, "compute") => computed(desk, request, Extent::All).await,
        (&Method::POST, "motion") => computed(desk, request, Extent::Motion).await,
        (&Method::POST, "output") => printed(&desk, request).await,
        (&Method::POST, "export") => exported(&desk, request).await,
        (&Method::POST, "save") => saved(&desk, request).await,
        _ => Err(Refusal::nothing_here()),
    };
    answer.unwrap_or_else(refused)
}

/// Why a request is not answered as it was meant.
struct Refusal {
    status: StatusCode,
    message: String,
}

impl Refusal {
    fn new(status: StatusCode, message: impl Into<String>) -> Refusal {
        Refusal { status, message: message.into() }
    }

    fn nothing_here() -> Refusal {
        Refusal::new(StatusCode::NOT_FOUND, "")
    }

    fn failed(message: impl Display) -> Refusal {
        Refusal::new(StatusCode::INTERNAL_SERVER_ERROR, message.to_string())
    }
}

fn served(desk: &Desk) -> Result<Answer, Refusal> {
    let nonce = random::<16>().map_err(Refusal::failed)?;
    let page = page(&desk.original, &nonce);
    let builder = headed("text/html; charset=utf-8").header(CONTENT_SECURITY_POLICY, policy(&nonce));
    Ok(finished(builder, page))
}

async fn computed(desk: Arc<Desk>, request: Request<Incoming>, extent: Extent) -> Result<Answer, Refusal> {
    let job: Job = read(request).await?;
    let lines = Lines::of(desk, job, extent).boxed_unsync();
    headed("application/x-ndjson").body(lines).map_err(Refusal::failed)
}

async fn printed(desk: &Desk, request: Request<Incoming>) -> Result<Answer, Refusal> {
    let order: Order = read(request).await?;
    let line = order::printed(&order).ok_or_else(|| unknown(&order))?;
    let (text, _) = done(desk, &line, &order).await?;
    Ok(whole("text/plain; charset=utf-8", text))
}

async fn exported(desk: &Desk, request: Request<Incoming>) -> Result<Answer, Refusal> {
    let order: Order = read(request).await?;
    let stem = desk.original.stem();
    let (bytes, ending) = if order.what == "notebook" {
        let text = notebook(&stem, &order.job);
        (
            text.map_err(|error| Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, error.report()))?
                .into_bytes(),
            "ipynb",
        )
    } else {
        let line = order::made(&order).ok_or_else(|| unknown(&order))?;
        done(desk, &line, &order).await?
    };
    let name = format!("attachment; filename*=UTF-8''{}", escaped(&format!("{stem}.{ending}")));
    Ok(finished(headed("application/octet-stream").header(CONTENT_DISPOSITION, name), bytes))
}

async fn saved(desk: &Desk, request: Request<Incoming>) -> Result<Answer, Refusal> {
    let Saving { text, force } = read(request).await?;
    match desk.original.save(&text, force) {
        Ok(()) => Ok(finished(headed("text/plain").status(StatusCode::NO_CONTENT), "")),
        Err(error) => {
            let status = match error {
                Unsaved::NoFile => StatusCode::NOT_FOUND,
                Unsaved::Changed { .. } => StatusCode::CONFLICT,
                Unsaved::Unwritten { .. } => StatusCode::INTERNAL_SERVER_ERROR,
            };
            Err(Refusal::new(status, error.to_string()))
        }
    }
}

/// What comes of a command, once there is a place for its work.
async fn done(desk: &Desk, line: &Line, order: &Order) -> Result<(Vec<u8>, &'static str), Refusal> {
    let _place = desk.places.acquire().await.map_err(Refusal::failed)?;
    match program::run(desk, line, &order.job.text).await.map_err(Refusal::failed)? {
        Outcome::Done(bytes, ending) => Ok((bytes, ending)),
        Outcome::Failed(message) => Err(Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, message)),
    }
}

fn unknown(order: &Order) -> Refusal {
    Refusal::new(StatusCode::NOT_IMPLEMENTED, format!("there is no `{}` here", order.what))
}

/// The body of a request, which is short and comes soon.
async fn read<T: DeserializeOwned>(request: Request<Incoming>) -> Result<T, Refusal> {
    let body = Limited::new(request.into_body(), LARGEST).collect();
    let body = timeout(PATIENCE, body)
        .await
        .map_err(|_| Refusal::new(StatusCode::REQUEST_TIMEOUT, "the request takes too long"))?;
    let bytes = body.map_err(|error| match error.is::<LengthLimitError>() {
        true => {
            Refusal::new(StatusCode::PAYLOAD_TOO_LARGE, format!("the text is longer than {LARGEST} bytes"))
        }
        false => Refusal::new(StatusCode::BAD_REQUEST, error.to_string()),
    })?;
    serde_json::from_slice(&bytes.to_bytes())
        .map_err(|error| Refusal::new(StatusCode::BAD_REQUEST, error.to_string()))
}

fn whole(kind: &'static str, bytes: impl Into<Bytes>) -> Answer {
    finished(headed(kind), bytes)
}

fn refused(refusal: Refusal) -> Answer {
    finished(headed("text/plain; charset=utf-8").status(refusal.status), refusal.message)
}

/// The head of any answer: nothing is kept, guessed, or told to others.
fn headed(kind: &'static str) -> Builder {
    Response::builder()
        .header(CONTENT_TYPE, kind)
        .header(CACHE_CONTROL, "no-store")
        .header(X_CONTENT_TYPE_OPTIONS, "nosniff")
        .header(REFERRER_POLICY, "no-referrer")
}

fn finished(head: Builder, bytes: impl Into<Bytes>) -> Answer {
    let body = Full::new(bytes.into()).boxed_unsync();
    // Heads consist of our own words and escaped names.
    head.body(body).unwrap_or_else(|_| Response::new(Full::default().boxed_unsync()))
}

/// A name as RFC 5987 writes it.
fn escaped(name: &str) -> String {
    let byte = |byte: u8| match byte {
        b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'.' | b'_' | b'-' => char::from(byte).to_string(),
        other => format!("%{other:02X}"),
    };
    name.bytes().map(byte).collect()
}
