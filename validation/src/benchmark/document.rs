//! A page of which parts are generated: they stand between `<!-- begin NAME -->` and `<!-- end NAME -->`.

use thiserror::Error;

/// A page without a place for a generated part.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
#[error("the page has no lines `<!-- begin {0} -->` and, after it, `<!-- end {0} -->`")]
pub struct NoPlace(String);

/// `page` with `parts`, each a name and its text, in their places.
///
/// # Errors
/// If the page has no place for a part.
pub fn with_tables(page: &str, parts: &[(&str, &str)]) -> Result<String, NoPlace> {
    let mut page = page.to_owned();
    for (name, text) in parts {
        let (begin, end) = (format!("<!-- begin {name} -->\n"), format!("<!-- end {name} -->"));
        let missing = || NoPlace((*name).to_owned());
        let from = page.find(&begin).ok_or_else(missing)? + begin.len();
        let to = from + page[from..].find(&end).ok_or_else(missing)?;
        page.replace_range(from..to, &format!("\n{}\n\n", text.trim_end()));
    }
    Ok(page)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_replaced_and_the_rest_of_the_page_stays() {
        let page = "before\n<!-- begin a -->\nold\n<!-- end a -->\nafter\n";
        let once = with_tables(page, &[("a", "new\n")]).expect("there is a place");
        assert_eq!(once, "before\n<!-- begin a -->\n\nnew\n\n<!-- end a -->\nafter\n");
        assert_eq!(with_tables(&once, &[("a", "new")]), Ok(once.clone()));
        assert!(with_tables(page, &[("b", "")]).is_err());
    }
}
