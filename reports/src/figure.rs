//! A picture as a part of a page.

use crate::page::Part;

/// The picture `svg` under `caption`, at least as wide as it was drawn.
pub(crate) fn figure(svg: &str, caption: &str) -> Part {
    let (svg, caption) = panel(svg, caption);
    Part::Figure(svg, caption)
}

/// The picture `svg` and its `caption`, as one of several side by side.
pub(crate) fn panel(svg: &str, caption: &str) -> (String, String) {
    // In a page the kind of its elements is known; of a file it has to say it by an address.
    let svg = svg.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    let label = caption.replace('&', "&amp;").replace('"', "&quot;").replace('<', "&lt;");
    // Whoever cannot see it hears what it shows; it is not read letter by letter.
    let named = format!("<svg role=\"img\" aria-label=\"{label}\" ");
    (svg.trim_end().replacen("<svg ", &named, 1), caption.to_owned())
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
