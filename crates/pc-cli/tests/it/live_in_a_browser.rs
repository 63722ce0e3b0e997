//! The page of `pc live` in Chromium, as somebody uses it: types, slides, chooses, saves. Skipped with a message if there is
//! no Chromium.

use std::fs;

use serde_json::json;

use crate::browser::{BROWSER, chromium};
use crate::devtools::Tab;
use crate::live::{Live, builtin};

/// Puts a text in place of that in the editor, as typing does.
fn write(tab: &mut Tab, text: &str) {
    tab.value("document.querySelector('.cm-content').focus(); document.execCommand('selectAll')");
    tab.call("Input.insertText", &json!({ "text": text }));
}

#[test]
fn the_page_follows_the_text() {
    let Some(chromium) = chromium() else {
        eprintln!("skipped: there is no Chromium here (on Debian: apt-get install chromium)");
        return;
    };
    let directory = tempfile::tempdir().unwrap();
    let file = directory.path().join("sleigh.toml");
    let text = builtin("chaplygin-sleigh");
    fs::write(&file, &text).unwrap();
    let live = Live::of(directory.path(), "sleigh.toml");
    let address = format!("http://127.0.0.1:{}/", live.port);
    let _alone = BROWSER.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    let mut tab = Tab::open(&chromium, directory.path(), &format!("{address}{}/", live.token));

    // Everything is there without a touch.
    tab.until("document.querySelector('#equations-markup math')");
    tab.until("document.querySelector('#verdicts-markup')?.textContent.includes('second derivation')");
    tab.until("document.querySelector('#player') && !document.querySelector('#player').hidden");
    tab.until("document.querySelectorAll('#plots canvas').length > 1");
    tab.until("document.querySelector('#status .light').dataset.state === 'good'");

    // A slider: the motion follows.
    let summary = "document.querySelector('#summary').textContent";
    let before = tab.value(summary);
    tab.value(
        "(() => { const row = [...document.querySelectorAll('.slider')].find((row) => row.textContent.startsWith('a')); \
         const track = row.querySelector('input[type=range]'); track.value = Number(track.max) * 0.9; \
         track.dispatchEvent(new Event('input', { bubbles: true })); })()",
    );
    tab.until(&format!("{summary} !== {before}"));
    let value = tab.value("document.querySelector('.slider.changed .slider-value').value");
    tab.value("document.querySelector('#reset-all').click()");
    tab.until(&format!("{summary}.split('\\n').at(-2) === {before}.split('\\n').at(-2)"));
    assert_ne!(value, "");

    // A mistake is marked at its place, and what was there stays.
    write(&mut tab, &text.replace("kinetic = \"", "kinetic = \"oops + "));
    tab.until("document.querySelector('#status .problems').textContent === '1 error'");
    tab.until("document.querySelector('.cm-lintRange-error')?.textContent === 'oops'");
    assert_eq!(tab.value("document.querySelectorAll('#equations-markup math').length > 0"), true);

    // It is mended, with other equations.
    let equations = "document.querySelector('#equations-markup').textContent";
    let before = tab.value(equations);
    let heavier = text.replace("kinetic = \"", "kinetic = \"m*v^2/4 + ");
    write(&mut tab, &heavier);
    tab.until("document.querySelector('#status .problems').textContent === 'no errors'");
    tab.until(&format!("{equations} !== {before}"));

    // It is saved by the keyboard.
    let save =
        json!({ "type": "keyDown", "modifiers": 2, "key": "s", "code": "KeyS", "windowsVirtualKeyCode": 83 });
    tab.call("Input.dispatchKeyEvent", &save);
    tab.until("document.querySelector('#status .note').textContent === 'saved'");
    assert_eq!(fs::read_to_string(&file).unwrap(), heavier);

    // A command, with the line that does the same.
    tab.value("document.querySelector('[data-tab=commands]').click()");
    tab.value(
        "[...document.querySelectorAll('.action')].find((button) => button.textContent === 'Derive').click()",
    );
    tab.until("document.querySelector('#output').textContent.includes('equations')");
    assert_eq!(
        tab.value("document.querySelectorAll('.command code')[2].textContent"),
        "pc derive sleigh.toml"
    );

    // Neither on a screen nor on a telephone does anything stick out.
    for width in [1280, 400] {
        let size = json!({ "width": width, "height": 900, "deviceScaleFactor": 1, "mobile": false });
        tab.call("Emulation.setDeviceMetricsOverride", &size);
        tab.until(&format!("innerWidth === {width}"));
        assert_eq!(tab.value("document.documentElement.scrollWidth - innerWidth"), 0, "{width}");
    }
    let strange: Vec<String> = tab
        .requests()
        .into_iter()
        .filter(|url| !url.starts_with(&address) && !url.starts_with("data:") && !url.starts_with("blob:"))
        .collect();
    assert!(strange.is_empty(), "{strange:?}");
    assert!(tab.wrong().is_empty(), "{:?}", tab.wrong());
}
