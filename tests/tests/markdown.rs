//! The links of Markdown lead somewhere.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

/// The page that lists all pages.
const LIST: &str = "docs/README.md";

#[test]
fn every_link_leads_to_a_page_and_a_heading() {
    let broken: Vec<_> = pages().iter().flat_map(|page| broken_links(page)).collect();
    assert!(broken.is_empty(), "these links lead nowhere:\n{}", broken.join("\n"));
}

#[test]
fn the_list_of_pages_has_each_page_of_the_docs() {
    let list = root().join(LIST);
    let files = links(&list).into_iter().filter(|link| !link.contains('#')).map(|link| list.with_file_name(link));
    let listed: BTreeSet<_> = files.map(canonical).collect();
    let unlisted: Vec<_> =
        pages_below(&root().join("docs")).into_iter().map(canonical).filter(|page| !listed.contains(page)).collect();
    assert_eq!(unlisted, [canonical(list)], "each page but the list itself has its line in {LIST}");
}

/// Returns the links of a page whose file or heading does not exist.
fn broken_links(page: &Path) -> Vec<String> {
    let broken = links(page).into_iter().filter(|link| !exists(page, link));
    broken.map(|link| format!("{}: {link}", page.display())).collect()
}

/// Returns the links of a page within the repository.
fn links(page: &Path) -> Vec<String> {
    let text = read(page);
    let links = Parser::new_ext(&text, Options::ENABLE_TABLES).filter_map(|event| match event {
        Event::Start(Tag::Link { dest_url, .. }) if !dest_url.contains("://") => Some(dest_url.into_string()),
        _ => None,
    });
    links.collect()
}

fn exists(page: &Path, link: &str) -> bool {
    let (file, heading) = link.split_once('#').map_or((link, None), |(file, heading)| (file, Some(heading)));
    let target = if file.is_empty() { page.to_owned() } else { page.with_file_name(file) };
    target.exists() && heading.is_none_or(|heading| anchors(&read(&target)).contains(heading))
}

/// Returns the anchors of the headings, as hosts of repositories make them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut anchors = BTreeSet::new();
    let mut heading = None;
    for event in Parser::new(text) {
        match (event, &mut heading) {
            (Event::Start(Tag::Heading { .. }), _) => heading = Some(String::new()),
            (Event::Text(said) | Event::Code(said), Some(heading)) => heading.push_str(&said),
            (Event::End(TagEnd::Heading(_)), _) => anchors.extend(heading.take().map(|heading| anchor(&heading))),
            _ => {}
        }
    }
    anchors
}

fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|letter| letter.is_alphanumeric() || [' ', '-', '_'].contains(letter));
    kept.flat_map(char::to_lowercase).map(|letter| if letter == ' ' { '-' } else { letter }).collect()
}

/// Returns the pages beside the README, and all below `docs`.
fn pages() -> Vec<PathBuf> {
    let beside = entries(&root()).into_iter().filter(|path| is_page(path));
    beside.chain(pages_below(&root().join("docs"))).collect()
}

fn pages_below(folder: &Path) -> Vec<PathBuf> {
    let (folders, files): (Vec<_>, Vec<_>) = entries(folder).into_iter().partition(|path| path.is_dir());
    let below = folders.iter().flat_map(|folder| pages_below(folder));
    files.into_iter().filter(|path| is_page(path)).chain(below).collect()
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("the folder is there");
    entries.flatten().map(|entry| entry.path()).collect()
}

fn is_page(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "md")
}

fn canonical(path: PathBuf) -> PathBuf {
    path.canonicalize().unwrap_or(path)
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn read(page: &Path) -> String {
    fs::read_to_string(page).unwrap_or_default()
}
