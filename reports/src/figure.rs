//! A picture as a part of a page.

use crate::page::Part;

/// The picture `svg` under `caption`; its width is that of the page, at most its own.
pub(crate) fn figure(svg: &str, caption: &str) -> Part {
    // In a page the kind of its elements is known; of a file it has to say it by an address.
    let svg = svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    Part::Figure(svg.trim_end().to_owned(), caption.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_picture_in_a_page_names_no_address() {
        let svg = plots::svg((30, 20), |_| Ok(())).expect("a picture");
        assert!(svg.contains("http://"), "a file needs the address: {svg}");
        let Part::Figure(svg, caption) = figure(&svg, "empty") else { panic!("a figure") };
        assert!(svg.starts_with("<svg") && !svg.contains("http"), "{svg}");
        assert_eq!(caption, "empty");
    }
}
