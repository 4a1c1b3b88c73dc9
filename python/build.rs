//! On macOS, the linker is told that Python brings its own symbols.

fn main() {
    pyo3_build_config::add_extension_module_link_args();
}
