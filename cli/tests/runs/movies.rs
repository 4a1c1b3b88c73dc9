//! `plunge movie`: films that other programs can read, of the size and length that were asked for.

use std::fs;
use std::io::Read as _;
use std::ops::ControlFlow;
use std::path::Path;

use exchange::frames::each_frame;
use flate2::read::ZlibDecoder;

use crate::common::{Call, folder, names, program};

/// A run of the small model with frames enough to choose from.
fn run(out: &Path) {
    Call::run(out).set(&["log.frames_per_s=1000"]).done();
}

fn movie(run: &Path, out: &Path, options: &[&str]) -> Call {
    Call::new(["movie", "--out"]).arg(out).arg(run).args(options)
}

/// Width and height of a GIF, and those of each of its pictures, by its blocks.
///
/// Source: Graphics Interchange Format, version 89a (CompuServe, 1990).
fn pictures_of_gif(bytes: &[u8]) -> ((u16, u16), Vec<(u16, u16)>) {
    let pair = |at: usize| {
        let side = |at: usize| u16::from_le_bytes([bytes[at], bytes[at + 1]]);
        (side(at), side(at + 2))
    };
    let colours = |flags: u8| if flags & 0x80 == 0 { 0 } else { 3 << ((flags & 7) + 1) };
    // Blocks that follow each other until an empty one.
    let behind = |mut at: usize| {
        while bytes[at] != 0 {
            at += 1 + usize::from(bytes[at]);
        }
        at + 1
    };
    assert_eq!(&bytes[..6], b"GIF89a");
    let (mut at, mut pictures) = (13 + colours(bytes[10]), Vec::new());
    loop {
        match bytes[at] {
            0x21 => at = behind(at + 2),
            0x2c => {
                pictures.push(pair(at + 5));
                at = behind(at + 11 + colours(bytes[at + 9]));
            }
            end => {
                assert_eq!((end, at + 1), (0x3b, bytes.len()), "the trailer ends the file");
                return (pair(6), pictures);
            }
        }
    }
}

/// Width and height of a PNG of red, green and blue, and its pictures: filter bytes and pixels, row by row.
///
/// Source: Portable Network Graphics, third edition (W3C, 2025), with its animations.
fn pictures_of_png(bytes: &[u8]) -> ((u32, u32), Vec<Vec<u8>>) {
    let number = |at: usize| u32::from_be_bytes(std::array::from_fn(|byte| bytes[at + byte]));
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    assert_eq!(&bytes[24..26], &[8, 2], "eight bits of each of three colours");
    let (mut at, mut packed): (usize, Vec<Vec<u8>>) = (8, Vec::new());
    while at < bytes.len() {
        let (length, kind) = (number(at) as usize, &bytes[at + 4..at + 8]);
        let data = &bytes[at + 8..at + 8 + length];
        match kind {
            b"fcTL" => packed.push(Vec::new()),
            b"IDAT" if packed.is_empty() => packed.push(data.to_vec()),
            b"IDAT" => packed.last_mut().expect("a picture").extend(data),
            b"fdAT" => packed.last_mut().expect("a picture").extend(&data[4..]),
            _ => {}
        }
        at += 12 + length;
    }
    let unpacked = packed.iter().map(|packed| {
        let mut rows = Vec::new();
        ZlibDecoder::new(&packed[..]).read_to_end(&mut rows).expect("a whole picture");
        rows
    });
    ((number(16), number(20)), unpacked.collect())
}

#[test]
fn a_film_has_the_pictures_and_the_size_that_were_asked_for_and_the_same_bytes_again() {
    let out = folder();
    run(out.path());
    let options = ["--frames", "5", "--size", "320x240"];
    for (name, again) in [("a.gif", "b.gif"), ("a.png", "b.png")] {
        let [first, second] = [name, again].map(|name| {
            let file = out.path().join(name);
            movie(out.path(), &file, &options).done();
            fs::read(file).expect("a film")
        });
        assert!(first == second, "{name}");
        if name == "a.gif" {
            assert_eq!(pictures_of_gif(&first), ((320, 240), vec![(320, 240); 5]));
            continue;
        }
        let (size, pictures) = pictures_of_png(&first);
        assert_eq!((size, pictures.len()), ((320, 240), 5));
        assert!(pictures.iter().all(|rows| rows.len() == 240 * (1 + 3 * 320)));
        assert!(pictures[0] != pictures[4], "something moves");
    }
}

#[test]
fn stills_are_of_the_frames_next_to_their_times() {
    let out = folder();
    run(out.path());
    let file = out.path().join("still.svg");
    let call = movie(out.path(), &file, &["--at", "contact, 4.2 ms,greatest,rest", "--json"]);
    let said = call.done().json();
    let time = |at: usize| said["files"][at]["time_s"].as_f64().expect("a time");
    // A frame every millisecond, at a step of at most 20 µs.
    assert!(time(0) == 0.0 && (time(1) - 0.004).abs() < 2e-5, "{said}");
    assert!(time(2) > 0.0 && time(2) <= time(3), "{said}");
    for name in ["still-contact.svg", "still-4.2ms.svg", "still-greatest.svg", "still-rest.svg"] {
        let svg = fs::read_to_string(out.path().join(name)).expect("a still");
        assert!(svg.contains("depth (mm)") && svg.contains("stroke-linecap"), "{name}");
    }
    let one = out.path().join("one.png");
    movie(out.path(), &one, &["--at", "rest", "--size", "320x240", "--colour", "displacement"])
        .done();
    let (size, pictures) = pictures_of_png(&fs::read(one).expect("a still"));
    assert_eq!((size, pictures.len()), ((320, 240), 1));
}

#[test]
fn what_cannot_be_filmed_is_told_with_what_can() {
    let (out, not, law) = (folder(), folder(), folder());
    run(out.path());
    Call::run(not.path()).set(&["log.grains=false"]).done();
    Call::new(["run", "--json", "--out"]).arg(law.path()).arg("two-term-vector").done();
    let before = names(out.path());
    let gif = out.path().join("a.gif");
    for (run, file, options, said) in [
        (not.path(), "a.gif", &[][..], "--set log.grains=true"),
        (law.path(), "a.gif", &[], "which has no grains"),
        (out.path(), "a.avi", &[], "a film is .mp4, .gif or .png"),
        (out.path(), "a.svg", &[], "say when with --at"),
        (out.path(), "a.gif", &["--frames", "100000"], "log.frames_per_s"),
        (out.path(), "a.gif", &["--size", "321x240"], "two even numbers"),
        (out.path(), "a.png", &["--at", "9 s"], "the log goes from 0 to"),
        (out.path(), "a.png", &["--at", "5"], "--at 5"),
        (out.path(), "a.gif", &["--from", "above"], "from the side alone"),
        (out.path(), "a.gif", &["--slice", "3 kg"], "--slice 3 kg"),
    ] {
        let message = movie(run, &out.path().join(file), options).fails(2);
        assert!(message.contains(said), "{said}: {message}");
    }
    assert_eq!(names(out.path()), before, "nothing is left");
    movie(out.path(), &gif, &["--frames", "2", "--size", "64x64"]).done();
    let message = movie(out.path(), &gif, &["--frames", "2"]).fails(2);
    assert!(message.contains("--force"), "{message}");
    fs::write(out.path().join("summary.json"), "{").expect("a file");
    let message = movie(out.path(), &gif, &["--frames", "2", "--force"]).fails(1);
    assert!(message.contains("summary.json"), "{message}");
}

#[cfg(unix)]
#[test]
fn an_mp4_is_made_by_ffmpeg_and_without_it_the_message_offers_a_gif() {
    let (out, programs) = (folder(), folder());
    run(out.path());
    let file = out.path().join("a.mp4");
    let call = || movie(out.path(), &file, &["--frames", "3", "--size", "64x64"]);
    let path = |programs: &Path| format!("PATH={}:/usr/bin:/bin; export PATH", programs.display());
    if !Path::new("/usr/bin/ffmpeg").exists() && !Path::new("/bin/ffmpeg").exists() {
        let message = call().after(&path(programs.path())).fails(2);
        assert!(message.contains(".gif"), "{message}");
    }
    // Takes pictures as the real one does, and keeps them as they come.
    let keeps = "#!/bin/sh\nfor last; do :; done\ncat > \"$last\"\n";
    program(&programs.path().join("ffmpeg"), keeps);
    call().after(&path(programs.path())).done();
    assert_eq!(fs::metadata(&file).expect("a film").len(), 3 * 3 * 64 * 64);
    fs::remove_file(&file).expect("a film");
    program(&programs.path().join("ffmpeg"), "#!/bin/sh\necho no such codec >&2\nexit 1\n");
    let message = call().after(&path(programs.path())).fails(1);
    assert!(message.contains("no such codec"), "{message}");
    assert!(!file.exists() && !names(out.path()).iter().any(|name| name.contains("partial")));
}

#[cfg(unix)]
#[test]
fn a_clip_beside_a_film_is_at_its_pace_and_touches_when_it_does() {
    let (out, programs) = (folder(), folder());
    run(out.path());
    let (file, clip) = (out.path().join("a.mp4"), out.path().join("clip.mp4"));
    let told = out.path().join("told");
    let tells = format!(
        "#!/bin/sh\nprintf '%s\\n' \"$@\" > {}\nfor last; do :; done\ncat > \"$last\"\n",
        told.display()
    );
    program(&programs.path().join("ffmpeg"), &tells);
    let path = format!("PATH={}:/usr/bin:/bin; export PATH", programs.path().display());
    let options = ["--frames", "3", "--size", "64x64", "--per-second", "10", "--beside"];
    let call = |to: &Path, more: &[&str]| {
        movie(out.path(), to, &options).arg(&clip).args(more).arg("--force").after(&path)
    };
    assert!(call(&file, &[]).fails(2).contains("no such file"));
    fs::write(&clip, "pictures").expect("a clip");
    assert!(call(&out.path().join("a.gif"), &[]).fails(2).contains(".mp4"));
    assert!(call(&file, &["--beside-rate", "0 Hz"]).fails(2).contains("some frames a second"));
    assert!(call(&file, &["--beside-contact", "3 m"]).fails(2).contains("--beside-contact 3 m"));
    call(&file, &["--beside-contact", "350 ms", "--beside-rate", "1 kHz"]).done();
    let told = fs::read_to_string(&told).expect("what it was told");
    assert!(told.lines().any(|word| word == format!("file:{}", clip.display())), "{told}");
    // Three pictures at ten a second take 0.2 s from the first to the last frame of the log, which begins at contact.
    let mut times = Vec::new();
    let log = out.path().join("grains.mcap");
    each_frame(&log, |frame| {
        times.push(frame.time);
        ControlFlow::Continue(())
    })
    .expect("a log");
    let slower = 0.2 / (times[times.len() - 1] - times[0]);
    let after = told.split("setpts=((T-(0.35))*FR/1000*").nth(1).expect(&told);
    let (factor, _) = after.split_once("+(0))/TB,fps=fps=10:start_time=0").expect(&told);
    let factor: f64 = factor.parse().expect("a number");
    assert!((factor / slower - 1.0).abs() < 1e-9, "{factor} {slower}");
}
