//! Who may ask: pages that this program has served, on this computer.

use std::fmt::Write;

use hyper::HeaderMap;
use hyper::header::{HOST, HeaderValue, ORIGIN};

/// The token in the address of the page, and the names under which it is reached.
pub(super) struct Guard {
    token: String,
    hosts: [String; 2],
}

/// Random bytes in hexadecimal.
///
/// # Errors
/// [`getrandom::Error`] where the system has none to give.
pub(super) fn random<const N: usize>() -> Result<String, getrandom::Error> {
    let mut bytes = [0_u8; N];
    getrandom::fill(&mut bytes)?;
    let mut text = String::new();
    bytes.iter().for_each(|byte| _ = write!(text, "{byte:02x}")); // writing to a string succeeds
    Ok(text)
}

impl Guard {
    /// A guard with a new token of 128 bits, for a server on this port.
    ///
    /// # Errors
    /// As for [`random`].
    pub(super) fn new(port: u16) -> Result<Guard, getrandom::Error> {
        Ok(Guard {
            token: random::<16>()?,
            hosts: ["127.0.0.1", "localhost"].map(|name| format!("{name}:{port}")),
        })
    }

    /// The address of the page.
    pub(super) fn address(&self) -> String {
        format!("http://{}/{}/", self.hosts[0], self.token)
    }

    /// The part of the path after the token, if the request may be answered: it knows the token, it is for one of our names, which
    /// a page of another site whose name leads to this computer is not, and it comes from no other site.
    pub(super) fn admit<'p>(&self, path: &'p str, headers: &HeaderMap) -> Option<&'p str> {
        let value =
            |header: Option<&HeaderValue>| header.and_then(|value| value.to_str().ok()).map(str::to_owned);
        let host = value(headers.get(HOST))?;
        let is_own = self.hosts.contains(&host);
        let comes_from_here = match headers.get(ORIGIN) {
            None => true,
            origin => value(origin).is_some_and(|origin| origin == format!("http://{host}")),
        };
        let (token, rest) = path.strip_prefix('/')?.split_once('/')?;
        (is_own && comes_from_here && is_equal(token, &self.token)).then_some(rest)
    }
}

/// Whether two texts are equal, in a time that tells nothing of where they differ.
fn is_equal(one: &str, other: &str) -> bool {
    let differences = one.bytes().zip(other.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
    one.len() == other.len() && differences == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_our_own_pages_are_admitted() {
        let guard = Guard::new(8420).unwrap();
        let other = Guard::new(8420).unwrap();
        assert_ne!(guard.token, other.token);
        assert_eq!(guard.token.len(), 32);
        let path = format!("/{}/compute", guard.token);
        let from = |host: Option<&str>, origin: Option<&str>| {
            let mut headers = HeaderMap::new();
            host.map(|host| headers.insert(HOST, host.parse().unwrap()));
            origin.map(|origin| headers.insert(ORIGIN, origin.parse().unwrap()));
            headers
        };
        let admitted = |headers: &HeaderMap| guard.admit(&path, headers);
        assert_eq!(admitted(&from(Some("127.0.0.1:8420"), None)), Some("compute"));
        assert_eq!(admitted(&from(Some("localhost:8420"), Some("http://localhost:8420"))), Some("compute"));
        for (host, origin) in [
            (None, None),
            (Some("evil.example:8420"), None),
            (Some("127.0.0.1"), None),
            (Some("127.0.0.1:8421"), None),
            (Some("127.0.0.1:8420"), Some("http://evil.example")),
            (Some("127.0.0.1:8420"), Some("https://127.0.0.1:8420")),
            (Some("127.0.0.1:8420"), Some("null")),
            (Some("127.0.0.1:8420"), Some("http://localhost:8420")),
        ] {
            assert_eq!(admitted(&from(host, origin)), None, "{host:?} {origin:?}");
        }
        let own = from(Some("127.0.0.1:8420"), None);
        for path in ["", "/", "//compute", &format!("/{}/compute", other.token), &format!("/{}", guard.token)]
        {
            assert_eq!(guard.admit(path, &own), None, "{path}");
        }
    }
}
