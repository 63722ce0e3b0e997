//! The page of `pc live`: what its server answers, to whom, and that nobody can hold it up.

use std::fs;
use std::io::{Read, Write};
use std::net::{Shutdown, TcpStream};
use std::path::Path;
use std::process::{Command, Stdio};

use serde_json::{Value, json};

use crate::patience::{PATIENCE, Reaped, first_line, started};

/// More connections than the server has at a time.
const MANY: usize = 300;

/// A running `pc live`, with the address of its page.
pub(crate) struct Live {
    _program: Reaped,
    pub(crate) port: String,
    pub(crate) token: String,
}

/// An answer: its status, its head, and its body.
struct Answer {
    status: u16,
    head: String,
    body: Vec<u8>,
}

impl Answer {
    fn text(&self) -> String {
        String::from_utf8(self.body.clone()).unwrap()
    }

    /// The results, a line each.
    fn results(&self) -> Vec<Value> {
        assert_eq!(self.status, 200, "{}", self.text());
        self.text().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
    }

    /// The first result of a kind.
    fn result(&self, kind: &str) -> Value {
        self.results()
            .into_iter()
            .find(|result| result["kind"] == kind)
            .unwrap_or_else(|| panic!("{}", self.text()))
    }
}

impl Live {
    pub(crate) fn of(directory: &Path, model: &str) -> Live {
        Live::with(directory, &["live", model, "--limit-time", "3600"])
    }

    /// The server that a command line of the book or of the help starts. It runs on for ever, and so cannot be tried as others are.
    pub(crate) fn named(directory: &Path, line: &str) -> Option<Live> {
        let arguments: Vec<&str> = line.split_whitespace().collect();
        (arguments.get(..2)? == ["pc", "live"]).then(|| Live::with(directory, &arguments[1..]))
    }

    fn with(directory: &Path, arguments: &[&str]) -> Live {
        let mut command = Command::new(env!("CARGO_BIN_EXE_pc"));
        command.args(arguments).current_dir(directory);
        let mut program = started(command.stdin(Stdio::null()).stdout(Stdio::piped()));
        let line = first_line(&mut program);
        let (_, rest) = line.split_once("http://127.0.0.1:").expect("an address");
        let (port, token) = rest.trim().trim_end_matches('/').split_once('/').expect("a token");
        Live { _program: program, port: port.to_owned(), token: token.to_owned() }
    }

    fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    fn connected(&self) -> TcpStream {
        let stream = TcpStream::connect(self.host()).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        stream
    }

    fn send(&self, head: &str, body: &[u8]) -> TcpStream {
        let mut stream = self.connected();
        // A server that refuses need not read to the end.
        let _ = stream.write_all(&[head.as_bytes(), b"\r\n\r\n", body].concat());
        stream
    }

    fn get(&self, path: &str) -> Answer {
        answer(self.send(&format!("GET /{}/{path} HTTP/1.1\r\nHost: {}", self.token, self.host()), b""))
    }

    fn begin(&self, path: &str, body: &Value) -> TcpStream {
        let (host, body) = (self.host(), body.to_string());
        let head = format!(
            "POST /{}/{path} HTTP/1.1\r\nHost: {host}\r\nOrigin: http://{host}\r\nContent-Type: application/json\r\nContent-Length: {}",
            self.token,
            body.len()
        );
        self.send(&head, body.as_bytes())
    }

    fn post(&self, path: &str, body: &Value) -> Answer {
        answer(self.begin(path, body))
    }
}

fn answer(mut stream: TcpStream) -> Answer {
    let mut all = Vec::new();
    // A connection may be reset once its answer is there.
    let _ = stream.read_to_end(&mut all);
    let split =
        all.windows(4).position(|four| four == b"\r\n\r\n").unwrap_or_else(|| panic!("an answer: {all:?}"));
    let head = String::from_utf8(all[..split].to_vec()).unwrap();
    let status = head.split(' ').nth(1).unwrap().parse().unwrap();
    let body = &all[split + 4..];
    let is_chunked = head.to_lowercase().contains("transfer-encoding: chunked");
    Answer { status, body: if is_chunked { joined(body) } else { body.to_vec() }, head }
}

/// The chunks of a body as one.
fn joined(mut chunks: &[u8]) -> Vec<u8> {
    let mut body = Vec::new();
    while let Some(end) = chunks.windows(2).position(|two| two == b"\r\n") {
        let size = usize::from_str_radix(std::str::from_utf8(&chunks[..end]).unwrap(), 16).unwrap();
        body.extend_from_slice(&chunks[end + 2..end + 2 + size]);
        chunks = &chunks[end + 2 + size + 2..];
    }
    body
}

fn pc(directory: &Path, arguments: &[&str]) -> Vec<u8> {
    let output =
        Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).current_dir(directory).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    output.stdout
}

pub(crate) fn builtin(name: &str) -> String {
    String::from_utf8(pc(Path::new("."), &["models", name])).unwrap()
}

#[test]
fn the_page_is_for_who_knows_its_address() {
    let directory = tempfile::tempdir().unwrap();
    let live = Live::of(directory.path(), "chaplygin-sleigh");
    let (page, again) = (live.get(""), live.get(""));
    assert_eq!(page.status, 200);
    assert!(page.text().contains("id=\"live-data\"") && page.text().contains("[constraints]"));
    let policy = |answer: &Answer| {
        let line = answer
            .head
            .lines()
            .find(|line| line.starts_with("content-security-policy: "))
            .unwrap()
            .to_owned();
        let (_, nonce) = line.split_once("'nonce-").unwrap();
        let nonce = nonce.split('\'').next().unwrap().to_owned();
        assert_eq!(answer.text().matches(&format!("nonce=\"{nonce}\"")).count(), 3);
        assert!(
            line.contains("default-src 'none'") && !line.contains("script-src 'unsafe-inline'"),
            "{line}"
        );
        nonce
    };
    assert_ne!(policy(&page), policy(&again));
    assert_eq!(live.get("schema").body, pc(directory.path(), &["schema"]));

    let (host, token) = (live.host(), &live.token);
    let wrong = token.chars().rev().collect::<String>();
    for head in [
        format!("GET / HTTP/1.1\r\nHost: {host}"),
        format!("GET /{token} HTTP/1.1\r\nHost: {host}"),
        format!("GET /{wrong}/ HTTP/1.1\r\nHost: {host}"),
        format!("GET /{token}/ HTTP/1.1\r\nHost: evil.example"),
        format!("GET /{token}/ HTTP/1.1\r\nHost: {host}\r\nOrigin: http://evil.example"),
        format!("GET /{token}/ HTTP/1.0"),
        format!("GET /{token}/../{token}/ HTTP/1.1\r\nHost: {host}"),
        format!("GET /{token}/Cargo.toml HTTP/1.1\r\nHost: {host}"),
        format!("GET /{token}//etc/passwd HTTP/1.1\r\nHost: {host}"),
        format!("GET /{token}/compute HTTP/1.1\r\nHost: {host}"),
        format!("PUT /{token}/save HTTP/1.1\r\nHost: {host}\r\nContent-Length: 0"),
        format!("OPTIONS /{token}/compute HTTP/1.1\r\nHost: {host}\r\nOrigin: http://evil.example"),
    ] {
        let answer = answer(live.send(&head, b""));
        assert_eq!((answer.status, answer.text()), (404, String::new()), "{head}");
        assert!(!answer.head.to_lowercase().contains("access-control"), "{head}");
    }
}

#[test]
fn results_come_one_by_one() {
    let directory = tempfile::tempdir().unwrap();
    let live = Live::of(directory.path(), "chaplygin-sleigh");
    let text = builtin("chaplygin-sleigh");
    let whole = live.post("compute", &json!({ "text": text }));
    let kinds: Vec<Value> = whole.results().iter().map(|result| result["kind"].clone()).collect();
    assert_eq!(
        kinds,
        ["names", "diagnostics", "equations", "scene", "plots", "summary", "verdicts", "done"]
            .map(Value::from)
    );
    assert_eq!(whole.result("diagnostics")["list"], json!([]));
    let names = whole.result("names");
    assert_eq!(names["parameters"][0], json!({ "name": "m", "value": 1.0 }));
    assert!(whole.result("equations")["html"].as_str().unwrap().contains("<math"));
    assert!(whole.result("verdicts")["html"].as_str().unwrap().contains("second derivation"));
    let summary = whole.result("summary");
    let said = summary["text"].as_str().unwrap();
    assert!(said.contains("401 rows") && said.contains("drift "), "{said}");

    // Other values, another end and another form, as `pc run` has them.
    let body = json!({ "text": text, "set": { "a": "0.3" }, "t_end": 3.0, "form": "kane" });
    let (other, moved) = (live.post("compute", &body), live.post("motion", &body));
    assert_eq!(other.result("names"), names);
    assert_ne!(other.result("equations"), whole.result("equations"));
    assert_eq!(other.result("scene"), moved.result("scene"));
    assert_eq!(other.result("plots"), moved.result("plots"));
    let run = Command::new(env!("CARGO_BIN_EXE_pc"))
        .args(["run", "chaplygin-sleigh", "--set", "a=0.3", "--t-end", "3", "--rows", "401"])
        .output()
        .unwrap();
    let end =
        |text: &str| text.lines().find(|line| line.trim_start().starts_with("end ")).unwrap().to_owned();
    let of_run = end(&String::from_utf8(run.stderr).unwrap());
    assert_eq!(end(moved.result("summary")["text"].as_str().unwrap()), of_run);

    // A model without an end of time has no motion, and all else.
    let unending = text.replace("t_end", "t_start");
    let still = live.post("compute", &json!({ "text": unending }));
    assert_eq!(still.result("scene")["data"], Value::Null);
    assert!(still.result("verdicts")["html"].is_string());
}

#[test]
fn errors_have_their_places() {
    let directory = tempfile::tempdir().unwrap();
    let live = Live::of(directory.path(), "chaplygin-sleigh");
    let text = builtin("chaplygin-sleigh");
    let list = |body: Value| {
        live.post("compute", &body).results().into_iter().rfind(|result| result["kind"] == "diagnostics")
    };
    let wrong = text.replace("[parameters]", "[parameters]\nβ = 1 = 2");
    let line = wrong.lines().position(|line| line.starts_with("β")).unwrap() + 1;
    let found = list(json!({ "text": wrong })).unwrap()["list"][0].clone();
    assert_eq!((found["line"].as_u64(), found["column"].as_u64()), (Some(line as u64), Some(7)), "{found}");
    assert!(found["help"].is_string() && found["severity"] == "error");
    for (body, said) in [
        (
            json!({ "text": text, "set": { "nobody": "1" } }),
            "`nobody` is neither a parameter nor a start value",
        ),
        (json!({ "text": text, "set": { "m": "much" } }), "`much` is not a finite number"),
        (json!({ "text": text, "set": { "m": "0" } }), ""),
        (json!({ "text": "" }), ""),
        (json!({ "text": "\u{0}\u{202e}[[[" }), ""),
    ] {
        let found = list(body.clone()).unwrap_or_else(|| panic!("{body}"));
        let message = found["list"][0]["message"].as_str().unwrap_or_else(|| panic!("{body:.100}: {found}"));
        assert!(message.contains(said), "{message}");
    }
}

#[test]
fn who_goes_away_holds_nothing_up() {
    let directory = tempfile::tempdir().unwrap();
    let live = Live::of(directory.path(), "damped-oscillator");
    let text = builtin("damped-oscillator");
    // More motions without end than are computed at a time, and nobody who waits for them.
    for _ in 0..5 {
        let mut stream = live.begin("motion", &json!({ "text": text, "t_end": 1e15 }));
        let mut head = [0; 12];
        stream.read_exact(&mut head).unwrap();
        assert_eq!(&head, b"HTTP/1.1 200");
        stream.shutdown(Shutdown::Both).unwrap();
    }
    let idle: Vec<TcpStream> = (0..MANY).map(|_| live.connected()).collect();
    let halves: Vec<TcpStream> = (0..20)
        .map(|_| {
            live.send(
                &format!("POST /{}/save HTTP/1.1\r\nHost: {}\r\nContent-Length: 9", live.token, live.host()),
                b"{",
            )
        })
        .collect();
    assert!(live.post("motion", &json!({ "text": text })).result("summary")["text"].is_string());
    drop((idle, halves));
}

#[test]
fn what_is_no_request_is_refused() {
    let directory = tempfile::tempdir().unwrap();
    let live = Live::of(directory.path(), "damped-oscillator");
    let status = |path: &str, body: &Value| live.post(path, body).status;
    assert_eq!(status("compute", &json!({ "text": "#".repeat(5 << 20) })), 413);
    assert_eq!(status("compute", &json!({ "text": 3 })), 400);
    assert_eq!(status("compute", &json!(["text"])), 400);
    assert_eq!(status("output", &json!({ "what": "import", "text": "" })), 501);
    assert_eq!(status("export", &json!({ "what": "run -o /etc/x", "text": "" })), 501);
    assert_eq!(status("save", &json!({ "text": "" })), 404, "the model came from no file");
    let garbage = answer(live.send("\u{1}\u{2}GET", b"\xff\xfe"));
    assert_eq!(garbage.status, 400);
    // An option in a value is a value.
    let injected =
        json!({ "what": "check", "text": builtin("damped-oscillator"), "set": { "m": "1 --output=x" } });
    let refused = live.post("output", &injected);
    assert_eq!(refused.status, 422);
    assert!(refused.text().contains("is not a finite number"), "{}", refused.text());
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 0);
}

#[test]
fn only_the_file_of_the_model_is_written_and_not_over_the_work_of_others() {
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("sleigh.toml");
    let text = builtin("chaplygin-sleigh");
    fs::write(&file, &text).unwrap();
    let live = Live::of(directory.path(), "sleigh.toml");
    let mine = format!("{text}\n# mine\n");
    assert_eq!(live.post("save", &json!({ "text": mine })).status, 204);
    assert_eq!(fs::read_to_string(&file).unwrap(), mine);
    fs::write(&file, "# of somebody else\n").unwrap();
    let refused = live.post("save", &json!({ "text": text }));
    assert_eq!(
        (refused.status, refused.text().as_str()),
        (409, "sleigh.toml has changed on disk since it was read")
    );
    assert_eq!(fs::read_to_string(&file).unwrap(), "# of somebody else\n");
    assert_eq!(live.post("save", &json!({ "text": text, "force": true })).status, 204);
    assert_eq!(fs::read_to_string(&file).unwrap(), text);
    assert_eq!(fs::read_dir(directory.path()).unwrap().count(), 1);
}

#[test]
fn buttons_do_what_their_lines_do() {
    let directory = tempfile::tempdir().unwrap();
    fs::create_dir(directory.path().join("models")).unwrap();
    let file = directory.path().join("models/driven.toml");
    let text = "[coordinates]\nx = 1.0\n[inputs]\nu = { file = \"u.csv\", column = \"u\" }\n[parameters]\nm = 2.0\n\
                [lagrangian]\nkinetic = \"m*x'^2/2\"\n[forces]\nx = \"u\"\n[simulation]\nt_end = 1\n";
    fs::write(&file, text).unwrap();
    fs::write(directory.path().join("models/u.csv"), "t,u\n0,1\n2,3\n").unwrap();
    let live = Live::of(directory.path(), "models/driven.toml");
    let order = |what: &str| json!({ "what": what, "text": text, "set": { "m": "4" } });
    let run = pc(directory.path(), &["run", "models/driven.toml", "--set", "m=4"]);
    let table = live.post("export", &order("csv"));
    assert_eq!((table.status, table.text()), (200, String::from_utf8(run).unwrap()));
    assert!(table.head.contains("filename*=UTF-8''driven.csv"), "{}", table.head);
    assert!(
        live.post("compute", &order("")).result("summary")["text"].as_str().unwrap().contains("401 rows")
    );

    let free = text.replace("u = { file = \"u.csv\", column = \"u\" }", "u = 1.0");
    let order = |what: &str| json!({ "what": what, "text": free, "set": { "m": "4" }, "vary": "m=1:2:3", "at": "0.5" });
    let check = live.post("output", &order("check"));
    assert!(check.status == 200 && check.text().contains("second derivation"), "{}", check.text());
    for (what, ending, beginning) in [
        ("report", "html", "<!DOCTYPE html>".as_bytes()),
        ("latex", "tex", b"%"),
        ("sweep", "csv", b"member,m,"),
        ("c", "zip", b"PK"),
        ("rust", "zip", b"PK"),
        ("notebook", "ipynb", b"{"),
    ] {
        let made = live.post("export", &order(what));
        let body = String::from_utf8_lossy(&made.body).chars().take(200).collect::<String>();
        assert!(made.status == 200 && made.body.starts_with(beginning), "{what}: {} {body}", made.status);
        assert!(made.head.contains(&format!("filename*=UTF-8''driven.{ending}")), "{}", made.head);
    }
    let emitted = live.post("export", &order("c"));
    let mut archive = zip::ZipArchive::new(std::io::Cursor::new(emitted.body)).unwrap();
    assert!(archive.by_name("driven.c").is_ok() && archive.by_name("driven.h").is_ok());
    let drawn = live.post("export", &order("png"));
    assert!(drawn.status == 422 && drawn.text().contains("can be drawn"), "{}", drawn.text());
    let wrong = json!({ "what": "check", "text": "[coordinates]\nx = y\n" });
    let refused = live.post("output", &wrong);
    assert!(refused.status == 422 && refused.text().contains("driven.toml:2:"), "{}", refused.text());
    // Commands leave nothing beside the model.
    assert_eq!(fs::read_dir(directory.path().join("models")).unwrap().count(), 2);
}
