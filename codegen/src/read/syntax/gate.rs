//! Turns text into a tree and refuses the parts of YAML that a spec does not need.

mod cause;
mod complaint;

use std::ops::Range;

use indexmap::IndexMap;
use saphyr_parser::{Event, Parser, ScalarStyle, Span};

use crate::read::source::{Source, forbidden};
use crate::read::syntax::rules;
use crate::report::diagnostic::Diagnostic;
use crate::report::rule::Rule;
use crate::report::tree::{Content, Entry, Node};

/// Deepest nesting of maps and lists.
const DEPTH_LIMIT: usize = 64;

/// Most values in a spec and those that it is based on.
const NODE_LIMIT: usize = 600_000;

/// The reader stops after this number of errors.
const PROBLEM_LIMIT: usize = 1000;

/// Words that some readers of YAML take for a text, and others for a truth value or nothing.
const UNCLEAR_WORDS: [&str; 10] = ["on", "off", "yes", "no", "y", "n", "true", "false", "null", "~"];

/// Reads the tree of each file of a spec and reports all that is refused. There is no tree of a
/// file that cannot be read to its end.
pub(super) fn read(source: &Source) -> (Vec<Option<Node>>, Vec<Diagnostic>) {
    let mut gate = Gate::new(source);
    let trees = source.parts().map(|part| gate.read_part(part)).collect();
    (trees, gate.problems)
}

/// Reads the tree of the last file alone, if that is possible.
pub(super) fn read_last(source: &Source) -> Option<Node> {
    Gate::new(source).read_part(source.last_part())
}

/// An error after which reading on is pointless.
type Stopped = Box<Diagnostic>;

struct Gate<'a> {
    source: &'a Source,
    /// The bytes of the file that is read.
    part: Range<usize>,
    /// Number of characters before the file.
    before: usize,
    problems: Vec<Diagnostic>,
    open: Vec<Open>,
    root: Option<Node>,
    nodes: usize,
    /// Where the last event ended. Only indicators, blanks and comments stand between two events.
    gap: usize,
}

/// A map or a list whose end is still to come.
struct Open {
    start: usize,
    entries: Entries,
}

enum Entries {
    List(Vec<Node>),
    Map {
        entries: IndexMap<String, Entry>,
        key: Option<Key>,
        /// Whether the entries of a later map have got into it, by a name that is indented too deep.
        is_mixed: bool,
    },
}

struct Key {
    name: String,
    span: Range<usize>,
}

impl<'a> Gate<'a> {
    fn new(source: &'a Source) -> Self {
        let (problems, open) = (Vec::new(), Vec::new());
        Self { source, part: 0..0, before: 0, problems, open, root: None, nodes: 0, gap: 0 }
    }

    fn read_part(&mut self, part: Range<usize>) -> Option<Node> {
        (self.gap, self.before) = (part.start, self.source.characters_before(part.start));
        self.part = part;
        self.open.clear();
        let read = self.read_events().and_then(|()| self.finish());
        read.map_err(|stopped| self.problems.push(*stopped)).ok()
    }

    /// Returns the text up to the end of the file that is read.
    fn text(&self) -> &'a str {
        &self.source.text()[..self.part.end]
    }

    fn read_events(&mut self) -> Result<(), Stopped> {
        let mut parser = Parser::new_from_str(&self.text()[self.part.start..]);
        while let Some(event) = parser.next_event() {
            let (event, span) = event.map_err(|error| {
                let at = self.byte(error.marker().index());
                Box::new(self.translated(at, error.info()))
            })?;
            let span = self.bytes(span);
            self.take(event, span.clone())?;
            if self.problems.len() >= PROBLEM_LIMIT {
                let message = format!("more than {PROBLEM_LIMIT} errors, the rest of the file is not read");
                return Err(stopped(&rules::YAML, span, message, "check that this is the spec you mean"));
            }
        }
        Ok(())
    }

    /// Says what the parser complains about. What stands in other files is no cause of it.
    fn translated(&self, at: usize, complaint: &str) -> Diagnostic {
        let start = self.part.start;
        let opened = self.opened().map(|opened| opened - start);
        complaint::translate(&self.text()[start..], at - start, complaint, opened).moved(start)
    }

    /// Returns the bracket of the innermost map or list that is still to be closed.
    fn opened(&self) -> Option<usize> {
        let start = self.open.last()?.start;
        self.text()[start..].starts_with(['{', '[']).then_some(start)
    }

    fn finish(&mut self) -> Result<Node, Stopped> {
        match self.root.take() {
            Some(node @ Node { content: Content::Map(_), .. }) => Ok(node),
            Some(node) if node.content != Content::Text(String::new()) => {
                let message = format!("expected a map of the whole spec, found {}", node.describe());
                Err(stopped(&rules::WRONG_KIND, node.span, message, "start with `canspec: 1`"))
            }
            _ => Err(stopped(
                &rules::YAML,
                self.part.start..self.part.start,
                "the file is empty".to_owned(),
                "start with `canspec: 1`",
            )),
        }
    }

    fn take(&mut self, event: Event<'_>, span: Range<usize>) -> Result<(), Stopped> {
        match event {
            Event::DocumentStart(_) if self.root.is_some() => {
                let message = "a second document starts here".to_owned();
                return Err(stopped(&rules::YAML, span, message, "keep one spec to a file, and remove the `---`"));
            }
            Event::Scalar(text, style, anchor, tag) => {
                self.refuse_properties(anchor, tag.is_some(), &span);
                let span = self.written(span, text.is_empty() && style == ScalarStyle::Plain);
                self.scalar(text.into_owned(), style, span)?;
            }
            Event::Alias(_) => self.alias(span)?,
            Event::SequenceStart(anchor, tag) => {
                self.refuse_properties(anchor, tag.is_some(), &span);
                self.open(span, Entries::List(Vec::new()))?;
            }
            Event::MappingStart(anchor, tag) => {
                self.refuse_properties(anchor, tag.is_some(), &span);
                self.open(span, Entries::Map { entries: IndexMap::new(), key: None, is_mixed: false })?;
            }
            Event::SequenceEnd | Event::MappingEnd => self.close(span)?,
            Event::Nothing | Event::StreamStart | Event::StreamEnd | Event::DocumentStart(_) | Event::DocumentEnd => {}
        }
        Ok(())
    }

    fn scalar(&mut self, text: String, style: ScalarStyle, span: Range<usize>) -> Result<(), Stopped> {
        let is_key = self.expects_key();
        let mut node = Node { span, content: Content::Text(text) };
        if let Some(problem) = self.problem_of_text(&node, style, is_key) {
            self.problems.push(problem);
            node.content = if is_key { node.content } else { Content::Refused };
        }
        self.put(node)
    }

    fn problem_of_text(&mut self, node: &Node, style: ScalarStyle, is_key: bool) -> Option<Diagnostic> {
        let Content::Text(text) = &node.content else { return None };
        if self.open.is_empty() {
            return None;
        }
        let span = node.span.clone();
        if style == ScalarStyle::Plain && text.is_empty() {
            return Some(self.problem_of_nothing(span, is_key));
        }
        if style == ScalarStyle::Plain && UNCLEAR_WORDS.iter().any(|word| word.eq_ignore_ascii_case(text)) {
            let message = format!("`{text}` is written without quotes");
            let help = format!("write `\"{text}\"`: readers of YAML disagree on what the plain word means");
            return Some(
                Diagnostic::error(&rules::PLAIN_WORD, span, message).help(help).replacement(format!("\"{text}\"")),
            );
        }
        if is_key && style == ScalarStyle::Plain && text == "<<" {
            return Some(refused(span, "a merge key `<<`", "write out what it stands for"));
        }
        text.chars().find_map(|character| Some((character, forbidden(character)?))).map(|(character, what)| {
            let message = format!("the text holds the {what} U+{:04X}", u32::from(character));
            Diagnostic::error(&crate::read::source::rules::ENCODING, span, message)
                .help("write it without this character")
        })
    }

    fn problem_of_nothing(&mut self, span: Range<usize>, is_key: bool) -> Diagnostic {
        let outer = self.too_deep_in().filter(|_| !is_key).map(str::to_owned);
        if let Some(Open { entries: Entries::Map { is_mixed, .. }, .. }) = self.open.last_mut() {
            *is_mixed |= outer.is_some();
        }
        let key = match self.open.last() {
            Some(Open { entries: Entries::Map { key: Some(key), .. }, .. }) => Some(key),
            _ => None,
        };
        let (span, message) = match key {
            _ if is_key => (span.start..span.start, "this key has no name".to_owned()),
            Some(key) => (key.span.clone(), format!("`{}` has no value", key.name)),
            None => (span.start..span.start, "this item of the list has no value".to_owned()),
        };
        let help = match key {
            Some(key) if !is_key && self.has_no_colon(key) => {
                help_on_blank(key).unwrap_or_else(|| self.help_on_comma(key))
            }
            Some(key) if let Some(outer) = outer => format!(
                "it may be indented too deep, as the next key stands in `{outer}` already; \
                 then indent `{}` like `{outer}`, else write its value",
                key.name
            ),
            Some(key) if let Some(comment) = self.comment_after(key).filter(|_| !is_key) => {
                format!("`#` begins a comment here; if it belongs to the text, quote it: `{}: \"{comment}\"`", key.name)
            }
            _ => "write it, or remove the line".to_owned(),
        };
        Diagnostic::error(&rules::WRONG_KIND, span, message).help(help)
    }

    /// Tests whether a key is only the end of a text that holds a comma.
    fn has_no_colon(&self, key: &Key) -> bool {
        self.opened().is_some() && !self.text()[key.span.end..].trim_start().starts_with(':')
    }

    /// Returns the comment that stands in place of a value.
    fn comment_after(&self, key: &Key) -> Option<&str> {
        let line = self.text()[key.span.end..].lines().next()?;
        let rest = line.trim_start().strip_prefix(':')?.trim();
        rest.starts_with('#').then_some(rest)
    }

    /// Returns the name of the map around a key without a value, if the next key stands in it
    /// already.
    fn too_deep_in(&self) -> Option<&str> {
        let [.., around, Open { entries: Entries::Map { entries, key: Some(key), .. }, .. }] = &self.open[..] else {
            return None;
        };
        let Entries::Map { key: Some(outer), .. } = &around.entries else { return None };
        let mut lines = self.text()[key.span.end..].lines().skip(1).map(str::trim_start);
        let (next, _) = lines.find(|line| !line.is_empty() && !line.starts_with('#'))?.split_once(':')?;
        (self.opened().is_none() && entries.contains_key(next)).then_some(outer.name.as_str())
    }

    fn help_on_comma(&self, key: &Key) -> String {
        let before = self.text()[..key.span.start].trim_end_matches(',');
        let is_of_number = |letter: char| letter.is_ascii_digit() || matches!(letter, '-' | '.');
        let number = before.rsplit(|letter: char| !is_of_number(letter)).next().unwrap_or_default();
        let digit = |letter: char| letter.is_ascii_digit();
        if key.name.starts_with(digit) && number.ends_with(digit) && !number.contains('.') {
            return format!("write a decimal point for the comma: `{number}.{}`", key.name);
        }
        "quote the text that holds a comma: inside `{}` and `[]` a comma ends it".to_owned()
    }

    fn alias(&mut self, span: Range<usize>) -> Result<(), Stopped> {
        self.problems.push(refused(span.clone(), "an alias", "write out what it stands for"));
        self.put(Node { span, content: Content::Refused })
    }

    fn refuse_properties(&mut self, anchor: usize, tagged: bool, span: &Range<usize>) {
        if anchor > 0 {
            self.problems.push(refused(span.clone(), "an anchor", "remove it, and write out its aliases"));
        }
        if tagged {
            self.problems.push(refused(span.clone(), "a tag", "remove it: every value is read as text"));
        }
    }

    fn open(&mut self, span: Range<usize>, entries: Entries) -> Result<(), Stopped> {
        if self.open.len() == DEPTH_LIMIT {
            return Err(Box::new(complaint::too_deep(span)));
        }
        if self.expects_key() {
            self.refuse_question_mark(span.start);
        }
        self.gap = span.start;
        self.open.push(Open { start: span.start, entries });
        Ok(())
    }

    fn close(&mut self, span: Range<usize>) -> Result<(), Stopped> {
        let Some(open) = self.open.pop() else { return Ok(()) };
        let content = match open.entries {
            Entries::List(items) => Content::List(items),
            Entries::Map { entries, .. } => Content::Map(entries),
        };
        self.gap = span.end;
        self.put(Node { span: self.first_line(open.start..span.end.max(open.start)), content })
    }

    fn put(&mut self, node: Node) -> Result<(), Stopped> {
        self.nodes += 1;
        if self.nodes > NODE_LIMIT {
            let message = format!("more than {NODE_LIMIT} values in one spec");
            return Err(stopped(&rules::YAML, node.span, message, "check that this is the spec you mean"));
        }
        if self.expects_key() {
            self.put_key(node);
        } else {
            self.put_value(node);
        }
        Ok(())
    }

    fn put_key(&mut self, node: Node) {
        let name = if let Content::Text(name) = node.content {
            self.refuse_question_mark(node.span.start);
            self.gap = node.span.end;
            name
        } else {
            let what =
                if node.content == Content::Refused { "a key that is an alias" } else { "a key that is no text" };
            self.problems.push(refused(node.span.clone(), what, "write a plain name before the `:`"));
            self.text()[node.span.clone()].to_owned()
        };
        if let Some(Open { entries: Entries::Map { key, .. }, .. }) = self.open.last_mut() {
            *key = Some(Key { name, span: node.span });
        }
    }

    fn put_value(&mut self, node: Node) {
        if !matches!(node.content, Content::List(_) | Content::Map(_)) {
            self.gap = node.span.end;
        }
        match self.open.last_mut().map(|open| &mut open.entries) {
            None => self.root = Some(node),
            Some(Entries::List(items)) => items.push(node),
            Some(Entries::Map { entries, key, is_mixed }) => {
                if let Some(key) = key.take() {
                    let is_mixed = *is_mixed;
                    self.problems.extend(put_entry(entries, key, node).filter(|_| !is_mixed));
                }
            }
        }
    }

    fn expects_key(&self) -> bool {
        matches!(self.open.last(), Some(Open { entries: Entries::Map { key: None, .. }, .. }))
    }

    fn refuse_question_mark(&mut self, key: usize) {
        let mut start = self.gap.min(key);
        let gap = &self.text()[start..key];
        for line in gap.split_inclusive('\n') {
            let indicators = line.split('#').next().unwrap_or_default();
            if let Some(at) = indicators.find('?') {
                let span = start + at..start + at + 1;
                self.problems.push(refused(span, "a `?` before a key", "write the key as `name: value`"));
                return;
            }
            start += line.len();
        }
    }

    /// Ends the span of a text where the text ends. The parser stretches the span of an empty text
    /// up to what follows.
    fn written(&self, span: Range<usize>, unwritten: bool) -> Range<usize> {
        let length = if unwritten { 0 } else { self.text()[span.clone()].trim_end().len() };
        span.start..span.start + length
    }

    fn first_line(&self, span: Range<usize>) -> Range<usize> {
        let line = self.text()[span.clone()].lines().next().unwrap_or_default();
        span.start..span.start + line.trim_end().len()
    }

    fn bytes(&self, span: Span) -> Range<usize> {
        let start = self.byte(span.start.index());
        start..self.byte(span.end.index()).max(start)
    }

    /// Returns the place of a character of the file that is read.
    fn byte(&self, position: usize) -> usize {
        self.source.byte_of_character(self.before + position).min(self.part.end)
    }
}

/// Says that a blank is missing in what was read as a key.
fn help_on_blank(key: &Key) -> Option<String> {
    let (name, value) = key.name.split_once(':')?;
    let is_name = name.starts_with(char::is_alphabetic) && !value.is_empty();
    is_name.then(|| format!("put a blank after the `:`, as in `{name}: {value}`"))
}

fn put_entry(entries: &mut IndexMap<String, Entry>, key: Key, value: Node) -> Option<Diagnostic> {
    if let Some((index, name, first)) = entries.get_full(&key.name) {
        let text = format!("duplicate key `{name}`");
        let problem = if is_out_of_order(entries, index) {
            Diagnostic::error(&rules::DUPLICATE_KEY, first.key.clone(), text)
                .label("given here, out of order")
                .other(key.span, "given again here")
        } else {
            Diagnostic::error(&rules::DUPLICATE_KEY, key.span, text)
                .label("given again here")
                .other(first.key.clone(), "first given here")
        };
        let can_be_joined = match (&first.value.content, &value.content) {
            (Content::Map(one), Content::Map(other)) => !other.keys().any(|key| one.contains_key(key)),
            _ => false,
        };
        let help = if can_be_joined {
            "put the entries of both below one of the two, or give it another name"
        } else {
            "remove one of the two, or give it another name"
        };
        return Some(problem.help(help));
    }
    entries.insert(key.name, Entry { key: key.span, value });
    None
}

/// Tells whether a key ends in a higher number than the next key, as `M12` before `M11`.
fn is_out_of_order(entries: &IndexMap<String, Entry>, index: usize) -> bool {
    let numbered = |index| {
        let (name, _) = entries.get_index(index)?;
        let word = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
        Some((word, name[word.len()..].parse::<u32>().ok()?))
    };
    let (Some((word, number)), Some((next_word, next))) = (numbered(index), numbered(index + 1)) else { return false };
    word == next_word && number > next
}

fn refused(span: Range<usize>, what: &str, help: &str) -> Diagnostic {
    Diagnostic::error(&rules::YAML, span, format!("{what} may not stand in a spec")).help(help)
}

fn stopped(rule: &'static Rule, span: Range<usize>, message: String, help: &str) -> Stopped {
    Box::new(Diagnostic::error(rule, span, message).help(help))
}
