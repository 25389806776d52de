//! The page in a browser: opened from its file, sorted by a click, looked at. Needs Debian's chromium and
//! chromium-driver, which `tools/test.sh` installs.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use halfshade::study::{Folder, Outcome, Run};
use halfshade::technique::Technique;
use serde_json::{Value, json};

use super::made_up;

/// A browser behind its WebDriver, which ends with it.
struct Browser {
    driver: Child,
    /// Address of the session.
    session: String,
}

impl Browser {
    fn open() -> Self {
        let mut driver = Command::new("chromedriver")
            .arg("--port=0")
            .stdout(Stdio::piped())
            .spawn()
            .expect("chromedriver, from Debian's package chromium-driver");
        let output = driver.stdout.take().expect("it is piped");
        let port = BufReader::new(output)
            .lines()
            .map_while(Result::ok)
            .find_map(|line| {
                let port = line.split_once("successfully on port ")?.1;
                port.trim_end_matches('.').parse::<u16>().ok()
            })
            .expect("chromedriver says its port");
        let server = format!("http://127.0.0.1:{port}");
        let arguments = [
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--disable-background-networking",
            "--disable-component-update",
            "--no-first-run",
            "--window-size=1400,1600",
        ];
        let wanted = json!({ "capabilities": { "alwaysMatch": {
            "goog:chromeOptions": { "args": arguments },
            "goog:loggingPrefs": { "browser": "ALL" },
        } } });
        let answer = post(&format!("{server}/session"), &wanted);
        let id = answer["sessionId"].as_str().expect("a session");
        Self {
            driver,
            session: format!("{server}/session/{id}"),
        }
    }

    fn post(&self, what: &str, body: &Value) -> Value {
        post(&format!("{}/{what}", self.session), body)
    }

    /// What a script returns.
    fn evaluate(&self, script: &str) -> Value {
        self.post("execute/sync", &json!({ "script": script, "args": [] }))
    }

    fn click(&self, selector: &str) {
        let found = self.post(
            "element",
            &json!({ "using": "css selector", "value": selector }),
        );
        let element = found.as_object().and_then(|found| found.values().next());
        let id = element.and_then(Value::as_str).expect("an element");
        self.post(&format!("element/{id}/click"), &json!({}));
    }

    fn screenshot(&self) -> Vec<u8> {
        let mut answer = ureq::get(format!("{}/screenshot", self.session))
            .call()
            .expect("a screenshot");
        let answer: Value = answer.body_mut().read_json().expect("JSON");
        let text = answer["value"].as_str().expect("base64");
        STANDARD.decode(text).expect("base64")
    }

    /// What the page complained about.
    fn complaints(&self) -> Value {
        self.post("se/log", &json!({ "type": "browser" }))
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // Closes the browser; its driver is ended whatever it answers.
        let _ = ureq::delete(&self.session).call();
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}

fn post(address: &str, body: &Value) -> Value {
    let mut answer = ureq::post(address).send_json(body).expect(address);
    let answer: Value = answer.body_mut().read_json().expect("JSON");
    answer["value"].clone()
}

/// A study of three techniques on two shots, one of which failed.
fn study(folder: &Path) {
    let folder = Folder::open(folder).expect("a folder");
    let keep = |run: &Run| {
        let pictures = made_up::pictures();
        folder.keep(run, Some(&pictures)).expect("it is kept");
    };
    keep(&made_up::run("plate", Technique::Hard, 1.0, 0.2));
    keep(&made_up::run("plate", Technique::PacketContour, 10.0, 0.01));
    keep(&made_up::run("plate", Technique::Pcss, 9.0, 0.3));
    keep(&made_up::run("knot", Technique::Pcss, 100.0, 0.05));
    let mut failed = made_up::run("knot", Technique::Bitmask, 0.0, 0.0);
    failed.outcome = Outcome::Failed("no memory </script><b>".into());
    folder.keep(&failed, None).expect("it is kept");
    folder.report().expect("reports");
}

#[test]
fn it_opens_from_its_file_and_sorts_by_a_click() {
    let folder = tempfile::tempdir().expect("a folder");
    study(folder.path());
    let browser = Browser::open();
    let page = folder.path().join("index.html");
    browser.post(
        "url",
        &json!({ "url": format!("file://{}", page.display()) }),
    );
    let column = |index: u32| {
        browser.evaluate(&format!(
            "return [...document.querySelectorAll('#runs tbody tr')].map(row => row.cells[{index}].textContent)"
        ))
    };
    // By time at first; what failed comes last. The third column is the error.
    let errors = ["0.200000", "0.300000", "0.010000", "0.050000", ""];
    assert_eq!(column(2), json!(errors));
    browser.click("button[data-column=mae_shadow]");
    let ascending = ["0.010000", "0.050000", "0.200000", "0.300000", ""];
    assert_eq!(column(2), json!(ascending));
    browser.click("button[data-column=mae_shadow]");
    let descending = ["0.300000", "0.200000", "0.050000", "0.010000", ""];
    assert_eq!(column(2), json!(descending));
    let address = browser.evaluate("return location.hash");
    assert_eq!(address, json!("#sort=-mae_shadow"));
    browser.click("#only-front");
    assert_eq!(column(2), json!(["0.200000", "0.050000", "0.010000"]));
    browser.click("#only-front");
    let picture = browser.screenshot();
    let seen = Path::new(env!("CARGO_TARGET_TMPDIR")).join("study_page.png");
    std::fs::write(&seen, &picture).expect("the screenshot");
    let screenshot = image::load_from_memory(&picture)
        .expect("a picture")
        .to_rgb8();
    let colours: std::collections::BTreeSet<_> = screenshot.pixels().map(|pixel| pixel.0).collect();
    assert!(colours.len() > 50, "{} colours", colours.len());
    assert_eq!(browser.complaints(), json!([]));
    // The sheets' pictures load from beside the page.
    browser.evaluate("document.querySelectorAll('details').forEach(one => { one.open = true; one.querySelector('img').loading = 'eager' })");
    let script = "return Promise.all([...document.images].map(image => image.decode())).then(() => document.images.length)";
    assert_eq!(browser.evaluate(script), json!(4));
}
