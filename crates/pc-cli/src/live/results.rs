//! Results on their way to the page: each is a line of JSON, sent as soon as it is there.

use std::convert::Infallible;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

use hyper::body::{Body, Bytes, Frame};
use pc_expr::Cancel;
use serde_json::Value;
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};
use tokio::task::{spawn, spawn_blocking};

use crate::live::compute::{Extent, compute};
use crate::live::desk::Desk;
use crate::live::request::Job;

/// The lines of an answer, as they come.
///
/// The channel has no bounds: the results of one text are a few megabytes at most, and whoever reads slowly does not hold up the
/// work of others.
pub(super) struct Lines(UnboundedReceiver<Bytes>);

impl Lines {
    /// Begins the work on a text; it is cancelled once nobody reads its results any more.
    pub(super) fn of(desk: Arc<Desk>, job: Job, extent: Extent) -> Lines {
        let (sender, receiver) = unbounded_channel();
        let cancel = Cancel::default();
        let (reader, given_up) = (sender.clone(), cancel.clone());
        let watch = spawn(async move {
            reader.closed().await;
            given_up.cancel();
        });
        spawn(async move {
            let Ok(place) = desk.places.acquire().await else { return };
            let asked = Arc::clone(&desk);
            let work = spawn_blocking(move || {
                // Who is gone is told nothing.
                let tell = |result: Value| _ = sender.send(Bytes::from(format!("{result}\n")));
                compute(&asked, &job, extent, &cancel, &tell);
            });
            // A panic has said what it is on standard error; the answer ends without `done`.
            _ = work.await;
            drop(place);
            watch.abort();
        });
        Lines(receiver)
    }
}

impl Body for Lines {
    type Data = Bytes;
    type Error = Infallible;

    fn poll_frame(
        mut self: Pin<&mut Self>,
        context: &mut Context<'_>,
    ) -> Poll<Option<Result<Frame<Bytes>, Infallible>>> {
        self.0.poll_recv(context).map(|line| line.map(|line| Ok(Frame::data(line))))
    }
}
