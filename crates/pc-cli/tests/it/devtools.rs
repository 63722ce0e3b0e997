//! A browser that is told what to do, by Chromium's protocol for developers over two pipes.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::thread;

use serde_json::{Value, json};

use crate::browser::headless;
use crate::patience::{PATIENCE, Reaped, send, started};

/// A tab of a browser that lives as long as the tab.
pub(crate) struct Tab {
    browser: Reaped,
    orders: File,
    messages: Receiver<Value>,
    session: Value,
    last: u64,
    /// What the browser has said without being asked: requests, and what was wrong.
    pub(crate) events: Vec<Value>,
}

impl Tab {
    /// Opens a page; `directory` is for the browser alone.
    pub(crate) fn open(chromium: &Path, directory: &Path, address: &str) -> Tab {
        let pipes = ["orders", "messages"].map(|name| directory.join(name));
        assert!(Command::new("mkfifo").args(&pipes).status().unwrap().success());
        // The protocol is spoken on the descriptors 3 and 4.
        let mut command = Command::new("sh");
        command.args(["-c", "exec \"$0\" \"$@\" 3<\"$ORDERS\" 4>\"$MESSAGES\""]).arg(chromium);
        command.env("ORDERS", &pipes[0]).env("MESSAGES", &pipes[1]);
        headless(&mut command, directory)
            .args(["--remote-debugging-pipe", "--window-size=1280,900"])
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let browser = started(&mut command);
        let orders = OpenOptions::new().write(true).open(&pipes[0]).unwrap();
        let mut said = BufReader::new(File::open(&pipes[1]).unwrap());
        let (sender, messages) = channel();
        thread::spawn(move || {
            let mut message = Vec::new();
            while said.read_until(0, &mut message).is_ok_and(|length| length > 0) {
                message.pop();
                let read = serde_json::from_slice(&message).expect("JSON");
                if sender.send(read).is_err() {
                    return;
                }
                message.clear();
            }
        });
        let mut tab = Tab { browser, orders, messages, session: Value::Null, last: 0, events: Vec::new() };
        let target = tab.call("Target.createTarget", &json!({ "url": "about:blank" }))["targetId"].clone();
        let attached = tab.call("Target.attachToTarget", &json!({ "targetId": target, "flatten": true }));
        tab.session = attached["sessionId"].clone();
        for domain in ["Runtime", "Log", "Network", "Page"] {
            tab.call(&format!("{domain}.enable"), &json!({}));
        }
        tab.call("Page.navigate", &json!({ "url": address }));
        tab
    }

    /// The result of a method of the protocol.
    pub(crate) fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.last += 1;
        let mut order = json!({ "id": self.last, "method": method, "params": parameters });
        if !self.session.is_null() {
            order["sessionId"] = self.session.clone();
        }
        self.orders.write_all(format!("{order}\0").as_bytes()).unwrap();
        loop {
            let mut message =
                self.messages.recv_timeout(PATIENCE).unwrap_or_else(|error| panic!("{method}: {error}"));
            if message["id"] == self.last {
                assert!(message["error"].is_null(), "{method}: {message}");
                return message["result"].take();
            }
            self.events.push(message);
        }
    }

    /// The value of an expression of JavaScript in the page; one that is promised is waited for.
    pub(crate) fn value(&mut self, expression: &str) -> Value {
        let asked = json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let mut answer = self.call("Runtime.evaluate", &asked);
        assert!(answer["exceptionDetails"].is_null(), "{expression}: {answer}");
        answer["result"]["value"].take()
    }

    /// Waits until an expression is true.
    #[track_caller]
    pub(crate) fn until(&mut self, expression: &str) {
        let begun = std::time::Instant::now();
        while self.value(&format!("Boolean({expression})")) != true {
            assert!(begun.elapsed() < PATIENCE, "never: {expression}");
            thread::sleep(std::time::Duration::from_millis(20));
        }
    }

    /// The addresses that were requested.
    pub(crate) fn requests(&self) -> Vec<String> {
        let sent = self.events.iter().filter(|event| event["method"] == "Network.requestWillBeSent");
        sent.map(|event| event["params"]["request"]["url"].as_str().unwrap().to_owned()).collect()
    }

    /// What was wrong: exceptions, errors and warnings on the console.
    pub(crate) fn wrong(&self) -> Vec<&Value> {
        let is_wrong = |event: &&Value| match event["method"].as_str() {
            Some("Runtime.exceptionThrown") => true,
            Some("Runtime.consoleAPICalled") => {
                matches!(event["params"]["type"].as_str(), Some("error" | "warning"))
            }
            Some("Log.entryAdded") => event["params"]["entry"]["level"] == "error",
            _ => false,
        };
        self.events.iter().filter(is_wrong).collect()
    }
}

impl Drop for Tab {
    fn drop(&mut self) {
        send("-KILL", &format!("-{}", self.browser.id()));
    }
}
