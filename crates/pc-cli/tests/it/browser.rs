//! Reports in Chromium, wide and narrow, light and dark: there are no errors, nothing overflows,
//! formulas are laid out, nothing is requested from a network, and what moves is where the run
//! says. Skipped with a message if there is no Chromium.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

use serde_json::Value;

use crate::patience::send;

/// Widths of the page.
const WIDTHS: [u32; 2] = [1280, 400];
/// Frames that are compared, among SAMPLES.
const FRAMES: [usize; 3] = [0, 250, 600];
const SAMPLES: &str = "601";
/// A page on two slow cores takes a few seconds: a browser that takes longer hangs.
const PATIENCE: Duration = Duration::from_secs(1800);
/// Held while a browser runs: one at a time has the memory and the processors for itself.
pub(crate) static BROWSER: Mutex<()> = Mutex::new(());

/// A Chromium, by the variable `CHROMIUM` or on the path.
pub(crate) fn chromium() -> Option<PathBuf> {
    if let Some(named) = std::env::var_os("CHROMIUM") {
        return Some(named.into());
    }
    let path = std::env::var_os("PATH")?;
    let all = |directory: PathBuf| {
        ["chromium", "chromium-browser", "google-chrome"].map(|name| directory.join(name)).into_iter()
    };
    std::env::split_paths(&path).flat_map(all).find(|file| file.is_file())
}

/// A browser with all processes that it starts, which are killed with it.
struct Browser(Child);

impl Browser {
    fn start(command: &mut Command) -> Browser {
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(command, 0);
        Browser(command.spawn().expect("Chromium starts"))
    }

    /// How it ends; none if it hangs.
    fn ended(&mut self) -> Option<ExitStatus> {
        let start = Instant::now();
        while start.elapsed() < PATIENCE {
            if let Some(status) = self.0.try_wait().expect("a child") {
                return Some(status);
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        None
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        send("-KILL", &format!("-{}", self.0.id()));
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// The options of a Chromium without a window, whose profile is in a directory.
pub(crate) fn headless<'c>(command: &'c mut Command, directory: &Path) -> &'c mut Command {
    command
        .args(["--headless", "--no-sandbox", "--disable-quic", "--no-first-run"])
        // WebGL without a graphics card.
        .args(["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
        .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
        .args(["--disable-dev-shm-usage", "--hide-scrollbars"])
        .arg(format!("--user-data-dir={}", directory.join("profile").display()))
}

/// Runs headless Chromium on a page, in a separate directory.
fn browse(chromium: &Path, directory: &Path, more: &[&str], page: &Path) -> Output {
    let mut command = Command::new(chromium);
    headless(&mut command, directory)
        .arg("--host-resolver-rules=MAP * ~NOTFOUND")
        .args(more)
        .arg(format!("file://{}", page.display()))
        .stdin(Stdio::null());
    let (out, err) = (directory.join("out"), directory.join("err"));
    command.stdout(fs::File::create(&out).expect("a file")).stderr(fs::File::create(&err).expect("a file"));
    let _alone = BROWSER.lock().unwrap_or_else(PoisonError::into_inner);
    let status = Browser::start(&mut command).ended().unwrap_or_else(|| {
        panic!("Chromium does not end: {}", fs::read_to_string(&err).unwrap_or_default());
    });
    Output { status, stdout: fs::read(out).expect("a file"), stderr: fs::read(err).expect("a file") }
}

/// The page with the scripts that watch it, and a policy that forbids all requests.
fn watched(page: &str) -> String {
    let policy = "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; \
                  font-src data:; script-src 'unsafe-inline'\"/>";
    let first = format!("<script>{}</script>{policy}", include_str!("browser/first.js"));
    let last = include_str!("browser/last.js").replace("FRAMES", &format!("{FRAMES:?}"));
    let page = page.replacen("<head>", &format!("<head>{first}"), 1);
    let end = page.rfind("</body>").expect("a body");
    format!("{}<script>{last}</script>{}", &page[..end], &page[end..])
}

/// A page with frames of both widths, which report to it.
fn around() -> String {
    let frames: String = WIDTHS
        .map(|width| {
            format!("<iframe src=\"page.html\" style=\"width:{width}px;height:900px;border:0\"></iframe>")
        })
        .concat();
    format!(
        "<!DOCTYPE html><html style=\"color-scheme: light dark\"><body style=\"width:2000px\"><pre id=\"found\"></pre><script>\
         window.addEventListener('message', function (e) {{ var p = document.createElement('p'); p.textContent = e.data; \
         document.getElementById('found').append(p); }});</script>{frames}</body></html>"
    )
}

/// The measurements of the page, by width.
fn looks(chromium: &Path, page: &str, dark: bool) -> Vec<Value> {
    let directory = tempfile::tempdir().expect("a directory");
    fs::write(directory.path().join("page.html"), watched(page)).expect("written");
    let around_it = directory.path().join("around.html");
    fs::write(&around_it, around()).expect("written");
    // 0 is dark, 1 light.
    let scheme = format!("--blink-settings=preferredColorScheme={}", u8::from(!dark));
    let more = ["--dump-dom", "--window-size=2100,1000", "--virtual-time-budget=20000", &scheme];
    let output = browse(chromium, directory.path(), &more, &around_it);
    let dom = String::from_utf8(output.stdout).expect("UTF-8");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!said.contains("CONSOLE"), "nothing is said on the console: {said}");
    let found = dom.split("<p>").skip(1).filter_map(|rest| rest.split("</p>").next());
    let text = |html: &str| html.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    let found: Vec<Value> = found.map(|json| serde_json::from_str(&text(json)).expect("JSON")).collect();
    assert_eq!(found.len(), WIDTHS.len(), "each says something: {dom:.400} {said}");
    found
}

fn pc(arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_pc")).args(arguments).output().expect("pc runs");
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("UTF-8")
}

/// A model: its text, and numbers of a frame of the player with the expressions of the run that
/// they should equal.
struct Case<'a> {
    name: &'a str,
    text: String,
    places: &'a [(usize, &'a str)],
}

impl Case<'_> {
    /// Checks the page in Chromium, light and dark.
    fn check(&self, chromium: &Path) {
        let name = self.name;
        let directory = tempfile::tempdir().expect("a directory");
        let file = directory.path().join("model.toml");
        let outputs: String =
            self.places.iter().map(|(i, expression)| format!("shown{i} = \"{expression}\"\n")).collect();
        fs::write(&file, format!("{}\n[outputs]\n{outputs}", self.text)).expect("written");
        let path = file.to_str().expect("UTF-8");
        let page = pc(&["report", path, "--rows", SAMPLES]);
        let table = pc(&["run", path, "--rows", SAMPLES]);
        let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
        for dark in [false, true] {
            for look in looks(chromium, &page, dark) {
                let at = |key: &str| &look[key];
                let width = at("width").as_u64();
                let context = format!("{name}, {width:?}, dark {dark}: {:.1500}", look.to_string());
                assert!(WIDTHS.iter().any(|&w| Some(u64::from(w)) == width), "{context}");
                for nothing in ["wrong", "flat", "tall", "lying", "requests"] {
                    assert_eq!(at(nothing).as_array().map(Vec::len), Some(0), "{nothing}: {context}");
                }
                assert_eq!((at("overflow").as_i64(), at("small").as_i64()), (Some(0), Some(0)), "{context}");
                assert!(
                    at("formulas").as_u64() > Some(10) && at("fractions").as_u64() > Some(0),
                    "{context}"
                );
                assert_eq!(at("dark").as_bool(), Some(dark), "{context}");
                let colours = if dark {
                    ("rgb(20, 23, 28)", "rgb(230, 233, 238)")
                } else {
                    ("rgb(255, 255, 255)", "rgb(29, 36, 48)")
                };
                assert_eq!(
                    (at("background").as_str(), at("ink").as_str()),
                    (Some(colours.0), Some(colours.1)),
                    "{context}"
                );
                assert!(at("painted").as_u64() > Some(100), "the player draws: {context}");
                assert_eq!(at("font").as_bool(), Some(true), "formulas have their font: {context}");
                assert_eq!(at("cut").as_array().map(Vec::len), Some(0), "equations fit the page: {context}");
                assert!(at("plots").as_u64() > Some(1), "plots answer: {context}");
                assert_eq!(at("marked"), at("plots"), "they show the time of the page: {context}");
                for (k, &row) in FRAMES.iter().enumerate() {
                    for (i, _) in self.places {
                        let column = rows[0].iter().position(|known| *known == format!("shown{i}"));
                        let wanted: f64 = rows[row + 1][column.expect("a column")].parse().expect("a number");
                        let shown = at("frames")[k][i].as_f64().expect("a number");
                        // Equal but for rounding to single precision.
                        assert_eq!(shown as f32, wanted as f32, "frame {row}, number {i}: {context:.200}");
                    }
                }
            }
        }
        let pdf = directory.path().join("page.pdf");
        let to = format!("--print-to-pdf={}", pdf.display());
        let html = directory.path().join("page.html");
        fs::write(&html, &page).expect("written");
        browse(chromium, directory.path(), &[&to, "--no-pdf-header-footer"], &html);
        let bytes = fs::read(&pdf).expect("a page for print");
        assert!(bytes.starts_with(b"%PDF") && bytes.len() > 20_000, "{name}: {} bytes", bytes.len());
    }
}

fn builtin(name: &str) -> String {
    pc(&["models", name])
}

/// Tests a case, or reports that there is no Chromium.
fn shown(case: impl FnOnce() -> Case<'static>) {
    match chromium() {
        Some(chromium) => case().check(&chromium),
        None => eprintln!("skipped: there is no Chromium here (on Debian: apt-get install chromium)"),
    }
}

#[test]
fn the_page_of_a_rolling_disk() {
    // The centre of the disc, the end of the spoke, the point of contact.
    const PLACES: [(usize, &str); 6] = [
        (0, "X - r*cos(θ)*sin(ψ)"),
        (2, "r*sin(θ)"),
        (6, "r"),
        (12, "r*(1 + cos(φ))*sin(θ)"),
        (13, "X"),
        (14, "Y"),
    ];
    shown(|| Case { name: "disk", text: builtin("tilted-disk"), places: &PLACES });
}

#[test]
fn the_page_of_a_heavy_top() {
    // The end of the axis, the middle of the disc, the end of the trace.
    const PLACES: [(usize, &str); 4] =
        [(3, "2*r3*sin(θ)*sin(ψ)"), (5, "2*r3*cos(θ)"), (8, "r3*cos(θ)"), (14, "-2*r3*sin(θ)*cos(ψ)")];
    shown(|| Case { name: "top", text: builtin("heavy-top-euler-symmetric"), places: &PLACES });
}

#[test]
fn the_page_of_a_quadrotor() {
    // An end of an arm, a propeller and its normal, the velocity, the weight, and the thrust.
    const PLACES: [(usize, &str); 7] = [
        (18, "x - l*cos(ψ)*cos(θ)"),
        (32, "z - l*sin(θ) + 0.02*cos(θ)*cos(φ)"),
        (35, "cos(θ)*cos(φ)"),
        (58, "x"),
        (62, "v_y"),
        (66, "-m*g"),
        (69, "(f1 + f2 + f3 + f4)*cos(θ)*cos(φ)"),
    ];
    shown(|| Case { name: "quadrotor", text: builtin("quadrotor"), places: &PLACES });
}

#[test]
fn the_page_of_a_bicycle() {
    // The hub of the rear wheel, the first body.
    const PLACES: [(usize, &str); 3] = [(0, "Hx"), (1, "Hy"), (2, "Hz")];
    let text = || include_str!("../../../../tests/mechanisms/whipple-bicycle.toml").to_owned();
    shown(|| Case { name: "bicycle", text: text(), places: &PLACES });
}

#[test]
fn the_page_of_a_car_with_trailers() {
    // The axles along the line, the car, the trace of the last trailer.
    const PLACES: [(usize, &str); 5] = [(3, "x1"), (7, "y2"), (10, "y3"), (12, "x"), (15, "x3")];
    let text = || include_str!("browser/n-trailer.toml").to_owned();
    shown(|| Case { name: "trailers", text: text(), places: &PLACES });
}
