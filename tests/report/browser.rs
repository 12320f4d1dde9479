//! Pages in a browser: nothing fails, curves are drawn, what can be operated works by pointer and by keys.

use std::fs;
use std::path::Path;
use std::time::Duration;

use serde_json::json;

use super::driver::Browser;
use super::{bag, reported, run, scene};

const FIRST: &str = "figure[data-figure='0']";
const RIGHT: &str = "\u{e014}";
const TAB: &str = "\u{e004}";
const SHIFT: char = '\u{e008}';

/// Curves that the first chart shows.
fn drawn(browser: &Browser) -> u64 {
    let script = format!("return document.querySelectorAll(\"{FIRST} .scatterlayer .trace\").length");
    browser.evaluate(&script).as_u64().unwrap()
}

fn readout(browser: &Browser) -> String {
    let script = format!("return document.querySelector(\"{FIRST} .readout\").textContent");
    browser.evaluate(&script).as_str().unwrap().to_owned()
}

/// Of `0.002 s: inner 101325; ...`, with what stands for the first curve.
fn read_of(text: &str, label: &str) -> (f64, f64) {
    let (time, rest) = text.split_once(" s: ").unwrap_or_else(|| panic!("{text}"));
    let value =
        rest.split("; ").find_map(|part| part.strip_prefix(&format!("{label} "))).unwrap_or_else(|| panic!("{text}"));
    (time.parse().unwrap(), value.trim().parse().unwrap())
}

/// The value of a column in the row of that time.
fn in_history(run: &Path, head: &str, time: f64) -> f64 {
    let history = corpuscle::output::History::read(&run.join("history.csv")).unwrap();
    let points = history.points("time_s", head).unwrap();
    points.into_iter().min_by(|a, b| (a[0] - time).abs().total_cmp(&(b[0] - time).abs())).unwrap()[1]
}

fn charts_work(browser: &Browser, run: &Path, label: &str, head: &str) {
    browser.evaluate(&format!("document.querySelector(\"{FIRST}\").scrollIntoView()"));
    browser.wait_until(&format!("return document.querySelectorAll(\"{FIRST} .scatterlayer .trace\").length > 1"));
    let before = drawn(browser);
    let all = browser.evaluate(&format!("return document.querySelectorAll(\"{FIRST} input\").length"));
    assert_eq!(json!(before), all, "a curve for each column");
    // What is under the pointer is what the file has.
    // A chart that is being laid out takes no notice of a pointer that rests.
    let told = (0..60).any(|k| {
        browser.point(&format!("{FIRST} .plot"), 40 + k, 0);
        std::thread::sleep(Duration::from_millis(200));
        readout(browser).contains(" s: ")
    });
    assert!(told, "{}", readout(browser));
    let (time, value) = read_of(&readout(browser), label);
    assert!((value / in_history(run, head, time) - 1.0).abs() < 1e-5, "{value} at {time}");
    // The keys read the rows, one after the other.
    browser.press(&format!("{FIRST} .plot"), RIGHT);
    let first = readout(browser);
    browser.press(&format!("{FIRST} .plot"), &RIGHT.repeat(3));
    let (time, value) = read_of(&readout(browser), label);
    assert!(time > read_of(&first, label).0 && (value / in_history(run, head, time) - 1.0).abs() < 1e-5);
    let width = "const [low, high] = document.querySelector(\"figure[data-figure='0'] .plot\").layout.xaxis.range; return high - low";
    let wide = browser.evaluate(width).as_f64().unwrap();
    browser.press(&format!("{FIRST} .plot"), "+");
    assert!((browser.evaluate(width).as_f64().unwrap() / wide - 0.5).abs() < 0.01);
    browser.press(&format!("{FIRST} .plot"), "0");
    browser.click(&format!("{FIRST} input[data-curve='0']"));
    browser.wait_until(&format!(
        "return document.querySelectorAll(\"{FIRST} .scatterlayer .trace\").length === {}",
        before - 1
    ));
    browser.click(&format!("{FIRST} input[data-curve='0']"));
    browser
        .wait_until(&format!("return document.querySelectorAll(\"{FIRST} .scatterlayer .trace\").length === {before}"));
}

fn view_works(browser: &Browser, snapshots: u64) {
    browser.evaluate("document.getElementById('space').scrollIntoView()");
    browser.wait_until("return document.getElementById('moment').textContent.includes('particles')");
    let moment = || browser.evaluate("return document.getElementById('moment').textContent");
    let place = "const d = document.getElementById('view').data.find(t => t.type === 'scatter3d'); return d.x.length + ' ' + d.x[0]";
    assert_eq!(browser.evaluate("return Number(document.getElementById('frame').max)"), json!(snapshots));
    let (before, there) = (moment(), browser.evaluate(place));
    browser.press("#frame", &RIGHT.repeat(2));
    assert_ne!(moment(), before);
    assert_ne!(browser.evaluate(place), there, "the particles have moved");
    let marked =
        "return document.getElementById('view').data.filter(t => t.type === 'scatter3d').map(t => t.name).join()";
    assert!(browser.evaluate(marked).as_str().unwrap().starts_with("speed"));
    browser
        .evaluate("const c = document.getElementById('colour'); c.value = 'gas'; c.dispatchEvent(new Event('change'))");
    assert_eq!(browser.evaluate(marked), json!("air,nitrogen"));
    browser.evaluate(
        "const c = document.getElementById('colour'); c.value = 'temperature'; c.dispatchEvent(new Event('change'))",
    );
    assert!(browser.evaluate(marked).as_str().unwrap().starts_with("temperature"));
    let eye = "return document.getElementById('view').layout.scene.camera.eye.x";
    let from = browser.evaluate(eye);
    browser.press("#view", RIGHT);
    assert_ne!(browser.evaluate(eye), from, "the view has turned");
    browser.click("#walls input[data-wall='0']");
    let shown =
        "return document.getElementById('view').data.filter(t => t.type === 'mesh3d' && t.visible !== false).length";
    let walls = browser.evaluate("return document.querySelectorAll('#walls input').length").as_u64().unwrap();
    assert_eq!(browser.evaluate(shown), json!(walls - 1));
}

/// Goes on with the tabulator, back with Shift, until an element has the focus; each one on the way shows that it has it.
fn tab_to(browser: &Browser, selector: &str, held: Option<char>) {
    const MOST: usize = 300;
    let there = format!("return document.activeElement.matches(\"{selector}\")");
    let is_seen = "const e = document.activeElement; if (e === document.body) return true; const s = getComputedStyle(e); \
        return e.matches(':focus-visible') && s.outlineStyle !== 'none' && parseFloat(s.outlineWidth) >= 1";
    for _ in 0..MOST {
        browser.type_keys(held, TAB);
        assert_eq!(browser.evaluate(is_seen), json!(true), "no focus to be seen on the way to {selector}");
        if browser.evaluate(&there) == json!(true) {
            return;
        }
    }
    panic!("{MOST} tabulators do not lead to {selector}");
}

/// Without a pointer: a curve is switched off and on, the slider moves the view, the view turns, a wall goes.
fn keys_alone_work(browser: &Browser) {
    browser.evaluate("document.activeElement.blur(); scrollTo(0, 0)");
    let curves = format!("return document.querySelectorAll(\"{FIRST} .scatterlayer .trace\").length");
    tab_to(browser, &format!("{FIRST} .plot"), None);
    browser.wait_until(&format!("{curves} > 1"));
    let before = drawn(browser);
    tab_to(browser, &format!("{FIRST} input[data-curve='0']"), None);
    browser.type_keys(None, " ");
    browser.wait_until(&format!("{curves} === {}", before - 1));
    browser.type_keys(None, " ");
    browser.wait_until(&format!("{curves} === {before}"));
    tab_to(browser, "#frame", None);
    browser.wait_until("return document.getElementById('moment').textContent.includes('particles')");
    let first = browser.evaluate("return document.getElementById('moment').textContent");
    browser.type_keys(None, RIGHT);
    // What a screen reader is told, too.
    let told = "const m = document.getElementById('moment').textContent; \
        return m === document.getElementById('frame').getAttribute('aria-valuetext') && m !== ";
    browser.wait_until(&format!("{told}{first}"));
    tab_to(browser, "#view", None);
    let eye = "return document.getElementById('view').layout.scene.camera.eye.x";
    let from = browser.evaluate(eye);
    browser.type_keys(None, RIGHT);
    browser.wait_until(&format!("{eye} !== {from}"));
    tab_to(browser, "#walls input[data-wall='0']", None);
    let was = browser.evaluate("return document.activeElement.checked");
    browser.type_keys(None, " ");
    browser.wait_until(&format!("return document.activeElement.checked !== {was}"));
    // And back.
    tab_to(browser, "#play", Some(SHIFT));
}

/// The fabric is where it was at the time of the slider, and can be switched off.
fn fabric_moves(browser: &Browser) {
    browser.evaluate("document.getElementById('space').scrollIntoView()");
    browser.wait_until("return document.getElementById('moment').textContent.includes('particles')");
    let width = "const bag = document.getElementById('view').data.find(t => t.type === 'mesh3d' && t.name === 'bag'); \
        return bag.visible ? Math.max(...bag.x) - Math.min(...bag.x) : 0";
    let wide = browser.evaluate(width).as_f64().unwrap();
    assert!((wide / 0.09 - 1.0).abs() < 0.02, "{wide}");
    browser.press("#frame", &RIGHT.repeat(5));
    let squeezed = browser.evaluate(width).as_f64().unwrap() / wide;
    assert!((squeezed - 0.6934).abs() < 1e-4, "{squeezed}");
    browser.click("#walls input[data-wall='1']");
    assert_eq!(browser.evaluate(width), json!(0));
}

/// All charts are drawn for the printer, in both themes; nothing was loaded, and nothing failed.
fn all_is_well(browser: &Browser) {
    browser.evaluate("dispatchEvent(new Event('beforeprint'))");
    let missing = "return [...document.querySelectorAll('figure.chart .plot')].filter(plot => !plot.querySelector('.main-svg')).length";
    assert_eq!(browser.evaluate(missing), json!(0));
    let back = "return getComputedStyle(document.body).backgroundColor";
    let before = browser.evaluate(back);
    browser.click("#theme");
    assert_ne!(browser.evaluate(back), before);
    assert_eq!(browser.evaluate("return performance.getEntriesByType('resource').length"), json!(0));
    assert_eq!(browser.errors(), [""; 0]);
}

#[test]
fn pages_work_in_a_browser() {
    let Some(browser) = Browser::start() else { return };
    // The log of errors is that of the browser: an error is seen.
    let folder = tempfile::tempdir().unwrap();
    let bad = folder.path().join("bad.html");
    fs::write(&bad, "<script>nothing.of.that.name()</script>").unwrap();
    browser.open(&bad);
    assert_eq!(browser.errors().len(), 1);

    let tank =
        scene(folder.path(), "tank.toml", "4e-3", &[("rows = 100", "rows = 40"), ("snapshots = 10", "snapshots = 4")]);
    let tank = run(&tank, &folder.path().join("tank"), &["--particles", "1000", "--report", "--subdomains", "2"]);
    browser.open(&tank.join("report.html"));
    charts_work(&browser, &tank, "inner", "inner:pressure_pa");
    view_works(&browser, 4);
    browser.evaluate(
        "const c = document.getElementById('colour'); c.value = 'subdomain'; c.dispatchEvent(new Event('change'))",
    );
    let ranks = "return document.getElementById('view').data.filter(t => t.type === 'scatter3d').length";
    assert_eq!(browser.evaluate(ranks), json!(2));
    keys_alone_work(&browser);
    all_is_well(&browser);

    browser.open(&bag(folder.path()).join("report.html"));
    fabric_moves(&browser);
    all_is_well(&browser);

    let vent = scene(folder.path(), "vent.toml", "4e-3", &[]);
    let vent = run(&vent, &folder.path().join("vent"), &["--particles", "1000", "--report"]);
    browser.open(&vent.join("report.html"));
    charts_work(&browser, &vent, "inside", "inside:pressure_pa");
    view_works(&browser, 4);
    all_is_well(&browser);

    let other = folder.path().join("other");
    let other = run(&folder.path().join("vent.toml"), &other, &["--particles", "1000", "--seed", "2"]);
    let both = folder.path().join("both.html");
    let page = reported(&[vent.to_str().unwrap(), other.to_str().unwrap(), "--out", both.to_str().unwrap()]);
    browser.open(&page);
    charts_work(&browser, &other, "2: inside", "inside:pressure_pa");
    all_is_well(&browser);
}
