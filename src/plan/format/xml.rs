//! XML of other programs as a sequence of elements and texts: no document type, bounded depth, local names.

use std::borrow::Cow;
use std::ops::Range;

use quick_xml::events::{BytesStart, Event};
use quick_xml::{Reader, XmlVersion};

use super::Problems;
use super::bounds::{MAX_ATTRIBUTES, MAX_DEPTH};

/// A part of a document.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// The beginning of an element. An empty element has an [`Part::End`], too.
    Start(Element),
    /// Text with its entities resolved; never empty.
    Text(String),
    /// The end of the element that began last.
    End,
}

/// The beginning of an element.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Element {
    /// The name without a namespace prefix.
    pub(super) name: String,
    /// The names without a namespace prefix, and the values.
    attributes: Vec<(String, String)>,
    /// The place of the tag in the text.
    pub(super) span: Range<usize>,
}

impl Element {
    /// Returns the value of an attribute.
    pub(super) fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(key, _)| key == name).map(|(_, value)| value.as_str())
    }
}

/// A part of a document. Its text is borrowed from the document where possible.
enum Borrowed<'t> {
    Start(Element),
    /// The text, and its place in the document.
    Text(Cow<'t, str>, usize),
    End,
}

/// The reader of a document.
pub(super) struct Parts<'t> {
    reader: Reader<&'t [u8]>,
    depth: usize,
    /// The end of an empty element is due.
    is_empty: bool,
    is_over: bool,
}

impl<'t> Parts<'t> {
    /// Begins to read a text.
    pub(super) fn new(text: &'t str) -> Self {
        let mut reader = Reader::from_str(text);
        reader.config_mut().check_end_names = true;
        Self { reader, depth: 0, is_empty: false, is_over: false }
    }

    /// Returns the place that was read last, as a byte of the text.
    pub(super) fn position(&self) -> usize {
        self.reader.buffer_position() as usize
    }

    /// Returns the next part. Returns `None` at the end, and after a fault, which it adds to `problems`.
    pub(super) fn next(&mut self, problems: &mut Problems<'_>) -> Option<Part> {
        self.next_borrowed(problems).map(|part| match part {
            Borrowed::Start(element) => Part::Start(element),
            Borrowed::Text(text, _) => Part::Text(text.into_owned()),
            Borrowed::End => Part::End,
        })
    }

    /// Passes the text of the element that began last to `take`, piece by piece with their places, without a copy of
    /// it. Skips the elements in it, and reads its end.
    pub(super) fn texts(&mut self, problems: &mut Problems<'_>, mut take: impl FnMut(&str, usize)) {
        let mut open = 1;
        while open > 0 {
            match self.next_borrowed(problems) {
                Some(Borrowed::Start(_)) => open += 1,
                Some(Borrowed::End) => open -= 1,
                Some(Borrowed::Text(text, at)) if open == 1 => take(&text, at),
                Some(Borrowed::Text(..)) => {}
                None => return,
            }
        }
    }

    fn next_borrowed(&mut self, problems: &mut Problems<'_>) -> Option<Borrowed<'t>> {
        if std::mem::take(&mut self.is_empty) {
            self.depth -= 1;
            return Some(Borrowed::End);
        }
        while !self.is_over {
            let start = self.position();
            match self.step(start) {
                Ok(Some(part)) => return Some(part),
                Ok(None) => {}
                Err(message) => {
                    self.is_over = true;
                    let end = self.position().max(start + 1);
                    problems.add(start..end, message, "this XML cannot be read");
                }
            }
        }
        None
    }

    /// Skips the rest of the element that began last, with all elements in it.
    pub(super) fn skip(&mut self, problems: &mut Problems<'_>) {
        self.texts(problems, |_, _| {});
    }

    /// Returns the text of the element that began last, without the texts of elements in it, and reads its end.
    pub(super) fn text(&mut self, problems: &mut Problems<'_>) -> String {
        let mut text = String::new();
        loop {
            match self.next(problems) {
                Some(Part::Text(more)) => text.push_str(&more),
                Some(Part::Start(_)) => self.skip(problems),
                Some(Part::End) | None => return text.trim().to_owned(),
            }
        }
    }

    fn step(&mut self, start: usize) -> Result<Option<Borrowed<'t>>, String> {
        let event = self.reader.read_event().map_err(|error| error.to_string())?;
        let part = match event {
            Event::Start(tag) => {
                self.depth += 1;
                Some(Borrowed::Start(element(&tag, start..self.position())?))
            }
            Event::Empty(tag) => {
                self.depth += 1;
                self.is_empty = true;
                Some(Borrowed::Start(element(&tag, start..self.position())?))
            }
            Event::End(_) => {
                self.depth -= 1;
                Some(Borrowed::End)
            }
            Event::Text(text) => some_text(text.xml10_content(), start),
            Event::CData(text) => some_text(text.xml10_content(), start),
            Event::GeneralRef(entity) => {
                let name = entity.xml10_content().into_owned();
                let character = entity.resolve_char_ref().map_err(|error| error.to_string())?;
                let known = || quick_xml::escape::resolve_xml_entity(&name).map(str::to_owned);
                let text = character.map(String::from).or_else(known);
                some_text(Cow::Owned(text.ok_or_else(|| format!("the entity &{name}; is not known"))?), start)
            }
            Event::DocType(_) => {
                return Err("a document type is not allowed: it can define entities without end".to_owned());
            }
            Event::Decl(_) | Event::PI(_) | Event::Comment(_) => None,
            Event::Eof if self.depth > 0 => return Err("the text ends inside an element".to_owned()),
            Event::Eof => {
                self.is_over = true;
                None
            }
        };
        if self.depth > MAX_DEPTH {
            return Err(format!("elements are nested deeper than {MAX_DEPTH}"));
        }
        Ok(part)
    }
}

fn some_text(text: Cow<'_, str>, at: usize) -> Option<Borrowed<'_>> {
    (!text.is_empty()).then_some(Borrowed::Text(text, at))
}

fn element(tag: &BytesStart<'_>, span: Range<usize>) -> Result<Element, String> {
    let name = tag.local_name().as_ref().to_owned();
    let mut attributes = Vec::new();
    for attribute in tag.attributes() {
        let attribute = attribute.map_err(|error| error.to_string())?;
        if attributes.len() == MAX_ATTRIBUTES {
            return Err(format!("an element has more than {MAX_ATTRIBUTES} attributes"));
        }
        let value = attribute.normalized_value(XmlVersion::Implicit1_0).map_err(|error| error.to_string())?;
        attributes.push((attribute.key.local_name().as_ref().to_owned(), value.into_owned()));
    }
    Ok(Element { name, attributes, span })
}

/// Returns the part of a text that a document can hold and that [`Parts::text`] returns.
pub(super) fn carried(text: &str) -> String {
    let is_allowed =
        |c: &char| !matches!(c, '\u{fffe}' | '\u{ffff}') && (!c.is_control() || "\t\n\r".contains(*c));
    text.chars().filter(is_allowed).collect::<String>().trim().to_owned()
}

/// Returns a text for the inside of elements and attributes.
pub(super) fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in carried(text).chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            // A reader turns a plain one into a line end.
            '\r' => out.push_str("&#13;"),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(text: &str) -> (Vec<Part>, Vec<String>) {
        let mut problems = Problems::new("x", text);
        let mut reader = Parts::new(text);
        let parts = std::iter::from_fn(|| reader.next(&mut problems)).collect();
        (parts, problems.into_errors().iter().map(super::super::PlanError::headline).collect())
    }

    #[test]
    fn elements_and_texts_come_in_order() {
        let (parts, faults) = parts("<?xml version='1.0'?><k:a b='1&amp;2'>x&lt;&#65;<!-- no --><c/></k:a>");
        let names: Vec<String> = parts
            .iter()
            .map(|part| match part {
                Part::Start(element) => {
                    format!("<{} {:?}>", element.name, element.attribute("b").unwrap_or_default())
                }
                Part::Text(text) => text.clone(),
                Part::End => "end".to_owned(),
            })
            .collect();
        assert_eq!(names, ["<a \"1&2\">", "x", "<", "A", "<c \"\">", "end", "end"]);
        assert_eq!(faults, [""; 0]);
    }

    #[test]
    fn hostile_documents_are_refused_with_their_place() {
        let bomb = "<?xml version='1.0'?>\n<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>";
        assert_eq!(
            parts(bomb).1,
            ["x:2:1: a document type is not allowed: it can define entities without end"]
        );
        assert!(parts("<a>&b;</a>").1[0].contains("the entity &b; is not known"));
        assert!(parts(&"<a>".repeat(65)).1[0].contains("nested deeper than 64"));
        let many: String = (0..65).map(|n| format!(" a{n}=''")).collect();
        assert!(parts(&format!("<a{many}/>")).1[0].contains("more than 64 attributes"));
        for cut in ["<a>", "<a", "<a></b>", "<a b='1' b='2'/>"] {
            assert_eq!(parts(cut).1.len(), 1, "{cut}");
        }
    }

    #[test]
    fn texts_and_subtrees_can_be_taken_at_once() {
        let text = "<a><b> x <c>y</c>z</b><d><e/></d><f/></a>";
        let mut problems = Problems::new("x", text);
        let mut reader = Parts::new(text);
        reader.next(&mut problems);
        reader.next(&mut problems);
        assert_eq!(reader.text(&mut problems), "x z");
        reader.next(&mut problems);
        reader.skip(&mut problems);
        assert!(matches!(reader.next(&mut problems), Some(Part::Start(element)) if element.name == "f"));
    }
}
