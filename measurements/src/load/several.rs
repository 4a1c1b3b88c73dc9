//! Several tables of trajectories: a list, or a pattern such as `drops/*.csv`.

use std::path::Path;

use configs::{Diagnostic, shorten};

use crate::document::FileName;
use crate::table::findings::Findings;

/// Characters of a pattern.
const WILD: [char; 3] = ['*', '?', '['];

/// The tables that `names` mean in `folder`, those of one pattern in the order of their names; a pattern that
/// nothing fits is reported.
pub(crate) fn expand(names: &[FileName], folder: &Path, findings: &mut Findings) -> Vec<FileName> {
    let mut all = Vec::new();
    for named in names {
        let is_file = folder.join(&named.name).is_file();
        match named.name.contains(WILD) && !is_file {
            true => all.extend(matches(named, folder, findings)),
            false => all.push(FileName { name: named.name.clone(), span: named.span }),
        }
    }
    all
}

/// The tables that fit one pattern.
fn matches(named: &FileName, folder: &Path, findings: &mut Findings) -> Vec<FileName> {
    let escaped = glob::Pattern::escape(&folder.display().to_string());
    let pattern = format!("{escaped}/{}", named.name);
    let found = glob::glob(&pattern).map(|paths| {
        let below = |path: &Path| Some(path.strip_prefix(folder).ok()?.display().to_string());
        let names = paths.filter_map(|path| below(&path.ok()?));
        names.map(|name| FileName { name, span: named.span }).collect::<Vec<_>>()
    });
    let shown = shorten(&named.name);
    match found {
        Ok(found) if !found.is_empty() => found,
        Ok(_) => {
            findings.report(
                Diagnostic::error(format!("no file fits `{shown}`"))
                    .at(named.span, "looked for in the folder of this file"),
            );
            Vec::new()
        }
        Err(error) => {
            findings.report(
                Diagnostic::error(format!("`{shown}` is not a pattern: {}", error.msg))
                    .at(named.span, "`*` is any text, `?` one character, `[ab]` one of these"),
            );
            Vec::new()
        }
    }
}
