//! Diagnostics as rustc shows its own: the lines of the file, underlined.

use std::iter;
use std::ops::Range;

use annotate_snippets::{AnnotationKind, Group, Level, Origin, Renderer, Snippet, Title};

use super::{Diagnostic, Diagnostics, Severity};
use crate::words::text::Text;

/// Most bytes of the file in one excerpt.
const EXCERPT_LIMIT: usize = 4096;

type Mark<'a> = (AnnotationKind, Range<usize>, Option<&'a str>);

impl Diagnostics {
    /// Draws the diagnostics by place, with the lines they are about, all labels and the help.
    pub fn render(&self, color: bool) -> String {
        let renderer = if color { Renderer::styled() } else { Renderer::plain() };
        let drawn = self.sorted().into_iter().map(|item| renderer.render(&[self.group(item)]));
        drawn.collect::<Vec<_>>().join("\n\n").replace(is_left_by_renderer, "\u{FFFD}")
    }

    fn group<'a>(&'a self, item: &'a Diagnostic) -> Group<'a> {
        let level = match item.severity {
            Severity::Error => Level::ERROR,
            Severity::Warning => Level::WARNING,
        };
        let title = level.primary_title(item.message.for_people()).id(item.rule.name);
        let group = match self.span(&item.at) {
            Some(span) => self.excerpts(title, item, span),
            None => title.element(Origin::path(self.source.name())),
        };
        let placeless = item.others.iter().filter(|(at, _)| self.span(at).is_none());
        group
            .elements(placeless.map(|(_, text)| Level::NOTE.message(text.for_people())))
            .elements(item.help.iter().map(|help| Level::HELP.message(help.for_people())))
    }

    /// Draws the places that are close to each other in one excerpt, and each of the others in its own.
    fn excerpts<'a>(&'a self, title: Title<'a>, item: &'a Diagnostic, primary: Range<usize>) -> Group<'a> {
        let others = item.others.iter().filter_map(|(at, text)| Some((self.span(at)?, text.for_people())));
        let others = others.map(|(span, text)| (AnnotationKind::Context, span, Some(text)));
        let (near, far): (Vec<Mark>, Vec<Mark>) = others.partition(|(_, span, _)| self.are_near(span, &primary));
        let marks =
            iter::once((AnnotationKind::Primary, primary, item.label.as_ref().map(Text::for_people))).chain(near);
        far.into_iter().fold(self.excerpt(marks.collect(), Group::with_title(title)), |group, mark| {
            self.excerpt(vec![mark], group)
        })
    }

    fn excerpt<'a>(&'a self, marks: Vec<Mark<'a>>, group: Group<'a>) -> Group<'a> {
        let start = marks.iter().map(|(_, span, _)| span.start).min().unwrap_or_default();
        let end = marks.iter().map(|(_, span, _)| span.end).max().unwrap_or_default();
        let shown = self.source.whole_lines(&(start..end));
        let (line, column) = self.source.line_column(start);
        let file = self.source.file_name(start);
        if shown.len() > EXCERPT_LIMIT {
            return group.element(Origin::path(file).line(line).char_column(column));
        }
        let annotations = marks
            .into_iter()
            .map(|(kind, span, label)| kind.span(span.start - shown.start..span.end - shown.start).label(label));
        let snippet = Snippet::source(&self.source.text()[shown.clone()]).line_start(line).path(file);
        group.element(snippet.annotations(annotations))
    }

    fn are_near(&self, one: &Range<usize>, other: &Range<usize>) -> bool {
        let file = |span: &Range<usize>| self.source.file_of(span.start);
        file(one) == file(other) && one.start.abs_diff(other.start) < EXCERPT_LIMIT
    }
}

/// Tests whether the renderer draws a control character as it is, so that it would act on a terminal.
fn is_left_by_renderer(character: char) -> bool {
    matches!(character, '\u{80}'..='\u{9F}')
}
