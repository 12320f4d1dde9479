//! The tags of an XML text, as far as VTK's files need it: no entities, no namespaces.

/// A tag, and the text from it to the next.
#[derive(Debug, PartialEq)]
pub(super) struct Tag<'a> {
    /// Of a closing tag with its slash: `/Piece`.
    pub name: &'a str,
    attributes: Vec<(&'a str, &'a str)>,
    /// It closes itself.
    empty: bool,
    text: &'a str,
    pub line: usize,
}

impl Tag<'_> {
    pub fn get(&self, attribute: &str) -> Option<&str> {
        self.attributes.iter().find(|(name, _)| *name == attribute).map(|(_, value)| *value)
    }

    pub fn place(&self) -> String {
        format!("line {}, `{}`", self.line, self.name)
    }
}

/// Without comments and declarations. What is no XML gives few tags or none.
pub(super) fn tags(text: &str) -> Vec<Tag<'_>> {
    let mut tags = Vec::new();
    let (mut at, mut line) = (0, 1);
    while let Some(begin) = text[at..].find('<').map(|k| at + k) {
        let body = &text[begin + 1..];
        let (inner, end) = match body {
            _ if body.starts_with("!--") => (None, body.find("-->").map(|k| k + 3)),
            _ if body.starts_with(['?', '!']) => (None, body.find('>').map(|k| k + 1)),
            _ => {
                let end = end_of(body);
                (end.map(|k| &body[..k - 1]), end)
            }
        };
        let Some(end) = end.map(|k| begin + 1 + k) else { break };
        line += text[at..begin].matches('\n').count();
        if let Some(inner) = inner {
            let next = text[end..].find('<').map_or(text.len(), |k| end + k);
            tags.push(tag(inner, &text[end..next], line));
        }
        line += text[begin..end].matches('\n').count();
        at = end;
    }
    tags
}

/// Behind the bracket that is in no quotes.
fn end_of(body: &str) -> Option<usize> {
    let mut quote = None;
    for (k, c) in body.char_indices() {
        match quote {
            Some(open) if c == open => quote = None,
            Some(_) => {}
            None if c == '"' || c == '\'' => quote = Some(c),
            None if c == '>' => return Some(k + 1),
            None => {}
        }
    }
    None
}

fn tag<'a>(inner: &'a str, text: &'a str, line: usize) -> Tag<'a> {
    let (inner, empty) = inner.strip_suffix('/').map_or((inner, false), |inner| (inner, true));
    let name_end = inner.find(char::is_whitespace).unwrap_or(inner.len());
    let mut rest = &inner[name_end..];
    let mut attributes = Vec::new();
    while let Some((name, after)) = rest.split_once('=') {
        let after = after.trim_start();
        let Some(quote) = after.chars().next().filter(|c| ['"', '\''].contains(c)) else { break };
        let Some((value, more)) = after[1..].split_once(quote) else { break };
        attributes.push((name.trim(), value));
        rest = more;
    }
    Tag { name: &inner[..name_end], attributes, empty, text, line }
}

/// The text of the element that begins with a tag, without that of elements in it.
pub(super) fn text_of(tags: &[Tag<'_>], at: usize) -> String {
    let mut text = tags[at].text.to_string();
    if tags[at].empty {
        return String::new();
    }
    let mut depth = 0;
    for tag in &tags[at + 1..] {
        match (tag.name.starts_with('/'), tag.empty) {
            (true, _) if depth == 0 => break,
            (true, _) => depth -= 1,
            (false, true) => {}
            (false, false) => depth += 1,
        }
        if depth == 0 {
            text += tag.text;
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tags_have_names_attributes_lines_and_text() {
        let text =
            "<?xml version=\"1.0\"?>\n<!-- <a> -->\n<A b=\"1 > 0\" c='x'>\n 1 2<K n=\"u\"><V>9</V></K> 3\n</A><B/>";
        let tags = tags(text);
        let names: Vec<&str> = tags.iter().map(|tag| tag.name).collect();
        assert_eq!(names, ["A", "K", "V", "/V", "/K", "/A", "B"]);
        assert_eq!((tags[0].get("b"), tags[0].get("c"), tags[0].get("d")), (Some("1 > 0"), Some("x"), None));
        assert_eq!((tags[0].line, tags[1].line, tags[5].line), (3, 4, 5));
        assert_eq!(text_of(&tags, 0).split_whitespace().collect::<Vec<_>>(), ["1", "2", "3"]);
        assert_eq!((text_of(&tags, 2).as_str(), text_of(&tags, 6).as_str()), ("9", ""));
    }

    #[test]
    fn what_is_no_xml_has_no_tags() {
        for text in ["", "plain", "<", "<a", "<a b=\"", "<!-- x", "<?x", "1 < 2"] {
            assert_eq!(tags(text), [], "{text}");
        }
        assert!(tags("<>")[0].name.is_empty() && tags("<a b>")[0].get("b").is_none());
    }
}
