//! The server: on this computer alone, for a few connections at a time.

use std::convert::Infallible;
use std::io;
use std::net::Ipv4Addr;
use std::sync::Arc;
use std::time::Duration;

use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::net::{TcpListener, TcpStream};
use tokio::runtime::Builder;
use tokio::sync::Semaphore;
use tokio::task::spawn;
use tokio::time::{sleep, timeout};

use crate::live::answer::answer;
use crate::live::desk::Desk;
use crate::live::guard::Guard;

/// Connections at a time; a page has six at most.
const CONNECTIONS: usize = 256;
/// A page on the same computer has sent the head of its request after this time.
const PATIENCE: Duration = Duration::from_secs(5);
/// The time that the slowest reader has for an answer, besides what the work takes.
const READING: Duration = Duration::from_secs(60);
/// The stack of a thread that computes, as large as that of a main thread.
const STACK: usize = 8 << 20;

/// Serves the page of a desk until the process ends; the address is told once it can be visited. Port 0 is any that is free.
///
/// # Errors
/// [`io::Error`] where the port is not to be had.
pub(crate) fn serve(desk: Desk, port: u16, tell: impl FnOnce(&str)) -> io::Result<()> {
    let runtime = Builder::new_current_thread().thread_stack_size(STACK).enable_all().build()?;
    runtime.block_on(async {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port)).await?;
        let guard = Guard::new(listener.local_addr()?.port()).map_err(io::Error::other)?;
        tell(&guard.address());
        let (desk, guard) = (Arc::new(desk), Arc::new(guard));
        let places = Arc::new(Semaphore::new(CONNECTIONS));
        loop {
            let Ok(place) = Arc::clone(&places).acquire_owned().await else { return Ok(()) };
            match listener.accept().await {
                Ok((stream, _)) => {
                    let work = connection(stream, Arc::clone(&desk), Arc::clone(&guard));
                    spawn(async move {
                        work.await;
                        drop(place);
                    });
                }
                // Out of descriptors, or the peer has gone already.
                Err(_) => sleep(Duration::from_millis(50)).await,
            }
        }
    })
}

/// One request and its answer. Where the reader goes away, the work on the answer ends.
async fn connection(stream: TcpStream, desk: Arc<Desk>, guard: Arc<Guard>) {
    let longest = 2 * desk.time + READING;
    let service = service_fn(move |request| {
        let answer = answer(Arc::clone(&desk), Arc::clone(&guard), request);
        async move { Ok::<_, Infallible>(answer.await) }
    });
    let mut http = http1::Builder::new();
    http.timer(TokioTimer::new()).header_read_timeout(PATIENCE).keep_alive(false);
    // A connection that breaks has nobody who could be told.
    _ = timeout(longest, http.serve_connection(TokioIo::new(stream), service)).await;
}
