//! A page: plain data to one HTML file that needs no network.
//!
//! What can be read without scripts (verdict, tables, texts, pictures) stands in the file as HTML; curves and the view in
//! three dimensions are data that its scripts draw. Scripts, styles and plotly.js are in the file, and its content policy
//! lets a browser load nothing else.

use minijinja::value::Serde;
use minijinja::{AutoEscape, Environment, context};
use serde::Serialize;
use std::path::Path;

use super::super::error::{OutputError, write_atomically};
use super::figure::Figure;
use super::series::Series;
use super::verdict::{Verdict, Warned};
use super::view::View;

const TEMPLATE: &str = include_str!("page/page.html");
const STYLE: &str = include_str!("page/page.css");
const SCRIPTS: [&str; 3] = [include_str!("page/data.js"), include_str!("page/curves.js"), include_str!("page/view.js")];
/// By which a file is known as one of ours.
const MARK: &str = "<meta name=\"generator\" content=\"corpuscle";

#[derive(Debug, Default, Serialize)]
pub struct Page {
    pub title: String,
    /// Below it: what it is of.
    pub subtitle: String,
    pub verdict: Option<Verdict>,
    pub warnings: Vec<Warned>,
    /// Before the curves.
    pub heads: Vec<Table>,
    pub figures: Vec<Figure>,
    /// Of how ranks share the work.
    pub balance: Vec<Figure>,
    pub pictures: Vec<Picture>,
    /// Behind the curves.
    pub tables: Vec<Table>,
    pub texts: Vec<Text>,
    /// Of a run; its notes alone say why there is no view.
    pub view: Option<View>,
    pub view_notes: Vec<String>,
    pub is_run: bool,
    /// What the page does not show, and what it is made of.
    pub notes: Vec<String>,
    /// Of the axes.
    pub time: &'static str,
    #[serde(skip)]
    pub series: Vec<Series>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Table {
    pub id: String,
    pub title: String,
    /// Above it; may be empty.
    pub note: String,
    pub head: Vec<String>,
    pub rows: Vec<Vec<String>>,
}

#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Text {
    pub title: String,
    pub text: String,
}

/// A file of the folder, as it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Picture {
    pub title: String,
    pub alt: String,
    /// base64.
    pub svg: String,
}

/// What the scripts draw.
#[derive(Serialize)]
struct Data<'a> {
    time: &'a str,
    series: &'a [Series],
    figures: Vec<&'a Figure>,
    view: &'a Option<View>,
}

impl Table {
    pub fn new(id: &str, title: &str, head: &[&str], rows: Vec<Vec<String>>) -> Table {
        let head = head.iter().map(|&cell| cell.to_owned()).collect();
        Table { id: id.to_owned(), title: title.to_owned(), note: String::new(), head, rows }
    }

    pub fn noted(self, note: impl Into<String>) -> Table {
        Table { note: note.into(), ..self }
    }
}

impl Page {
    /// # Errors
    /// If the page cannot be written, or another file is in its place.
    pub fn write(&self, path: &Path) -> Result<(), OutputError> {
        let broken = |problem: String| OutputError::BadFile { path: path.to_path_buf(), problem };
        if path.exists() && !is_page(path) {
            return Err(OutputError::OverForeign { path: path.to_path_buf() });
        }
        let html = self.html().map_err(broken)?;
        write_atomically(path, |out| out.write_all(html.as_bytes()))
    }

    fn html(&self) -> Result<String, String> {
        let figures = self.figures.iter().chain(&self.balance).collect();
        let data = Data { time: self.time, series: &self.series, figures, view: &self.view };
        let json = serde_json::to_string(&data).map_err(|error| error.to_string())?;
        let mut environment = Environment::new();
        environment.set_auto_escape_callback(|_| AutoEscape::Html);
        environment.add_template("page", TEMPLATE).map_err(|error| error.to_string())?;
        let template = environment.get_template("page").map_err(|error| error.to_string())?;
        let needs_charts = !self.series.is_empty() || self.view.is_some();
        let html = template.render(context! {
            page => Serde(self),
            version => env!("CARGO_PKG_VERSION"),
            // No text of a name can end the element that it stands in.
            data => json.replace('<', "\\u003c"),
            style => STYLE,
            scripts => if needs_charts { SCRIPTS.join("\n") } else { SCRIPTS[0].to_owned() },
            plotly => if needs_charts { plotly_js() } else { String::new() },
            figures => self.figures.len(),
        });
        html.map_err(|error| format!("{error:#}"))
    }
}

/// Whether a file is a page that this program has written.
fn is_page(path: &Path) -> bool {
    use std::io::Read;
    let mut start = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(4096).read_to_end(&mut start));
    read.is_ok() && String::from_utf8_lossy(&start).contains(MARK)
}

/// Of the scripts that the crate has, the one of the charts; the other sets formulas.
fn plotly_js() -> String {
    let all = plotly::Plot::offline_js_sources();
    let scripts = all.split("<script type=\"text/javascript\">").filter_map(|part| part.split("</script>").next());
    scripts.into_iter().find(|script| script.contains("plotly.js v")).unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_charts_script_is_there_and_the_formulas_are_not() {
        let script = plotly_js();
        assert!(script.contains("plotly.js v") && !script.contains("</script") && !script.contains("MathJax.js"));
        assert!((3 << 20..6 << 20).contains(&script.len()), "{}", script.len());
    }

    #[test]
    fn names_cannot_break_out_of_the_page() {
        let page = Page { title: "</title><script>alert(1)</script>".to_owned(), ..Page::default() };
        let html = page.html().unwrap();
        assert!(!html.contains("<script>alert") && html.contains("&lt;script&gt;alert"));
        let hostile = Figure { id: "a".into(), title: "</script><b>".into(), alt: "\"><b>".into(), curves: Vec::new() };
        let html = Page { figures: vec![hostile], ..Page::default() }.html().unwrap();
        assert!(!html.contains("</script><b>") && !html.contains("\"><b>"));
    }

    #[test]
    fn a_file_of_the_user_stays() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("report.html");
        std::fs::write(&path, "mine").unwrap();
        assert!(matches!(Page::default().write(&path), Err(OutputError::OverForeign { .. })));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "mine");
        std::fs::remove_file(&path).unwrap();
        Page::default().write(&path).unwrap();
        Page::default().write(&path).unwrap();
    }
}
