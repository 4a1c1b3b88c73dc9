//! Tables as programs write them, with blanks, holes and marks where the programs have them.

use std::fmt::Write as _;

use crate::world::{Camera, Drop, drop};

/// Length of a pixel (m).
pub(crate) const PIXEL: f64 = 2e-4;

/// Row of the surface on the picture (px), counted downward.
pub(crate) const SURFACE_ROW: f64 = 812.0;

/// Two drops, from 10 and 30 cm.
pub(crate) fn two() -> [Drop; 2] {
    [(0.1, 11), (0.3, 12)].map(|(height, seed)| drop(height, Camera { seed, ..Camera::USUAL }))
}

fn row_on_picture(z: f64) -> f64 {
    SURFACE_ROW - z / PIXEL
}

/// Tracker: metres, seconds, tabs, scientific notation.
pub(crate) fn tracker(one: &Drop) -> String {
    let mut text = String::from("mass A\nt\tx\ty\n");
    for (t, z) in &one.readings {
        let _ = writeln!(text, "{t:.9E}\t{:.6E}\t{:.6E}", 0.012, z + 0.02);
    }
    text
}

/// Tracker 6 with two tracks; the second one starts later.
pub(crate) fn tracker_multi([a, b]: &[Drop; 2]) -> String {
    let mut text = String::from("#multi:\n\tmass A\t\tmass B\t\t\nt\tx\ty\tx\ty\t\n");
    for (k, ((t, za), (_, zb))) in a.readings.iter().zip(&b.readings).enumerate() {
        let second = if k < 40 { "\t".to_owned() } else { format!("0.2\t{zb:.6}") };
        let _ = writeln!(text, "{t:.6}\t0.1\t{za:.6}\t{second}\t");
    }
    text
}

/// TrackMate: four rows of names and units, spots in any order, one spot of no track.
pub(crate) fn trackmate(drops: &[Drop; 2]) -> String {
    let mut text = String::from(
        "LABEL,ID,TRACK_ID,QUALITY,POSITION_X,POSITION_Y,POSITION_Z,POSITION_T,FRAME,RADIUS,VISIBILITY\n\
         Label,Spot ID,Track ID,Quality,X,Y,Z,T,Frame,Radius,Visibility\n\
         Label,Spot ID,Track ID,Quality,X,Y,Z,T,Frame,R,Visibility\n\
         ,,,(quality),(pixel),(pixel),(pixel),(sec),,(pixel),\n",
    );
    for (track, one) in drops.iter().enumerate() {
        for (k, (t, z)) in one.readings.iter().enumerate().rev() {
            let y = row_on_picture(*z);
            let _ = writeln!(text, "ID{k},{k},{track},3.1,301.25,{y:.3},0.0,{t:.6},{k},5.0,1");
        }
    }
    text.push_str("ID9999,9999,,1.0,10.0,10.0,0.0,0.5,325,5.0,1\n");
    text
}

/// ImageJ's Manual Tracking: slices and pixels.
pub(crate) fn manual_tracking(drops: &[Drop; 2]) -> String {
    let mut text = String::from(" \tTrack n°\tSlice n°\tX\tY\tDistance\tVelocity\tPixel Value\n");
    let mut row = 0;
    for (track, one) in drops.iter().enumerate() {
        for (k, (_, z)) in one.readings.iter().enumerate() {
            row += 1;
            let _ = writeln!(
                text,
                "{row}\t{}\t{}\t301\t{:.2}\t-1.0\t-1.0\t34.0",
                track + 1,
                k + 1,
                row_on_picture(*z)
            );
        }
    }
    text
}

/// MTrackJ: identities of tracks and points, units in the names.
pub(crate) fn mtrackj(drops: &[Drop; 2]) -> String {
    let mut text = String::from("Nr\tTID\tPID\tx [mm]\ty [mm]\tt [sec]\tI [val]\n");
    let mut row = 0;
    for (track, one) in drops.iter().enumerate() {
        for (k, (t, z)) in one.readings.iter().enumerate() {
            row += 1;
            let _ = writeln!(
                text,
                "{row}\t{}\t{}\t60.2\t{:.4}\t{t:.6}\t0",
                track + 1,
                k + 1,
                150.0 - 1e3 * z
            );
        }
    }
    text
}

/// DLTdv: a row for each frame, NaN before a point is digitized.
pub(crate) fn dltdv([a, b]: &[Drop; 2]) -> String {
    let mut text = String::from("pt1_cam1_X,pt1_cam1_Y,pt2_cam1_X,pt2_cam1_Y\n");
    for (k, ((_, za), (_, zb))) in a.readings.iter().zip(&b.readings).enumerate() {
        let second = match k < 60 {
            true => "NaN,NaN".to_owned(),
            false => format!("520.5,{:.3}", row_on_picture(*zb)),
        };
        let _ = writeln!(text, "301.5,{:.3},{second}", row_on_picture(*za));
    }
    text
}

/// Kinovea: text with blanks, one named block for each path, milliseconds, centimetres.
pub(crate) fn kinovea(drops: &[Drop; 2]) -> String {
    let mut text = String::from("#Kinovea Trajectory data export\r\n#T X Y\r\n\r\n");
    for (name, one) in ["Ball 1", "Ball 2"].iter().zip(drops) {
        let _ = write!(text, "# {name}\r\n");
        for (t, z) in &one.readings {
            let row = format!("{:.3} {:.3} {:.4}\r\n", 1e3 * t, 3.2, 1e2 * z);
            let _ = write!(text, "{}", row.replace('.', ","));
        }
        text.push_str("\r\n");
    }
    text
}

/// LoggerPro's text.
pub(crate) fn loggerpro(one: &Drop) -> String {
    let mut text = String::from(
        "Vernier Format 2\nUntitled.cmbl 11/2/2010 11:30:12 .\nRun 1\nTime\tPosition\tVelocity\nt\td\tv\n\
         s\tcm\tcm/s\n\n",
    );
    for (t, z) in &one.readings {
        // A motion detector above the body counts away from itself.
        let _ = writeln!(text, "{t:.6}\t{:.4}\t", 60.0 - 1e2 * z);
    }
    text
}

/// LoggerPro's table of two runs.
pub(crate) fn loggerpro_table([a, b]: &[Drop; 2]) -> String {
    let mut text = String::from(
        "\"Run 1: Time (s)\",\"Run 1: Position (m)\",\"Run 2: Time (s)\",\"Run 2: Position (m)\"\n",
    );
    for ((t, za), (u, zb)) in a.readings.iter().zip(&b.readings) {
        let _ = writeln!(text, "{t:.6},{:.6},{u:.6},{:.6}", 0.6 - za, 0.6 - zb);
    }
    text
}

/// A LabVIEW measurement file without a column of times.
pub(crate) fn labview(one: &Drop) -> String {
    let step = one.readings[1].0 - one.readings[0].0;
    let mut text = format!(
        "LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t,\n\
         Multi_Headings\tNo\nX_Columns\tNo\nTime_Pref\tRelative\nOperator\tlab\nDate\t2024/03/11\n\
         Time\t10:15:00\n***End_of_Header***\t\n\t\nChannels\t1\t\nSamples\t{}\t\nDate\t2024/03/11\t\n\
         Time\t10:15:00\t\nY_Unit_Label\tmm\t\nX_Dimension\tTime\t\nX0\t0,0E+0\t\nDelta_X\t{step:.9}\t\n\
         ***End_of_Header***\t\t\nX_Value\theight\tComment\n",
        one.readings.len()
    );
    for (_, z) in &one.readings {
        let _ = writeln!(text, "\t{:.4}\t", 1e3 * z + 7.0);
    }
    text.replace('.', ",").replace(",lvm", ".lvm")
}

/// DeepLabCut: three rows of names; the first frames are not seen.
pub(crate) fn deeplabcut(one: &Drop) -> String {
    let mut text = String::from(
        "scorer,DLC_resnet50,DLC_resnet50,DLC_resnet50\nbodyparts,ball,ball,ball\ncoords,x,y,likelihood\n",
    );
    for (k, (_, z)) in one.readings.iter().enumerate() {
        let (y, likelihood) = if k < 20 { (3.0, 0.02) } else { (row_on_picture(*z), 0.999) };
        let _ = writeln!(text, "{k},301.7,{y:.4},{likelihood}");
    }
    text
}

/// Long form with a column of runs, trailing commas, empty cells, a doubled first frame and missing frames.
pub(crate) fn long(drops: &[Drop; 2]) -> String {
    let mut text = String::from("# made by hand\nrun,condition,time [ms],height [mm],\n\n");
    for (name, one) in ["a1", "b1"].iter().zip(drops) {
        for (k, (t, z)) in one.readings.iter().enumerate() {
            let row = format!(
                "{name},{}cm,{:.4},{:.4},\n",
                if *name == "a1" { 10 } else { 30 },
                1e3 * t,
                1e3 * z
            );
            match k {
                0 => text.push_str(&row.repeat(2)),
                k if k % 97 == 5 => {}
                k if k % 97 == 9 => {
                    let _ = writeln!(
                        text,
                        "{name},{}cm,{:.4},,",
                        if *name == "a1" { 10 } else { 30 },
                        1e3 * t
                    );
                }
                _ => text.push_str(&row),
            }
        }
    }
    text
}

/// Wide form: a column for each drop, semicolons, decimal commas, a row of units.
pub(crate) fn wide([a, b]: &[Drop; 2]) -> String {
    let mut text = String::from("time;drop 1;drop 2\nms;cm;cm\n");
    for ((t, za), (_, zb)) in a.readings.iter().zip(&b.readings) {
        let row = format!("{:.3};{:.4};{:.4}\n", 1e3 * t, 18.4 + 1e2 * za, 18.4 + 1e2 * zb);
        text.push_str(&row.replace('.', ","));
    }
    text
}

/// Points of a picture: `frame,x1,y1,x2,y2` in pixels.
pub(crate) fn points([a, b]: &[Drop; 2]) -> String {
    let mut text = String::from("frame,x1 (px),y1 (px),x2 (px),y2 (px)\n");
    for (k, ((_, za), (_, zb))) in a.readings.iter().zip(&b.readings).enumerate() {
        let _ = writeln!(
            text,
            "{},11.5,{:.3},402.5,{:.3}",
            k + 1000,
            row_on_picture(*za),
            row_on_picture(*zb)
        );
    }
    text
}

/// One drop without any unit: seconds and millimetres, downward.
pub(crate) fn bare(one: &Drop) -> String {
    let mut text = String::from("t y\n");
    for (t, z) in &one.readings {
        let _ = writeln!(text, "{t:.6} {:.4}", 500.0 - 1e3 * z);
    }
    text
}
