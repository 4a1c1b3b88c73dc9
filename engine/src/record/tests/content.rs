//! What is in the files.

#![expect(clippy::float_cmp, reason = "values are written and read back bit for bit")]

use std::collections::BTreeMap;

use prost::Message;
use prost::bytes::Buf;
use prost::encoding::{decode_key, decode_varint};
use prost_types::FileDescriptorSet;
use prost_types::field_descriptor_proto::Type;

use super::*;

#[test]
fn topics_schemas_and_fields_are_the_published_ones() {
    let scratch = empty_folder();
    write_rest(RunLog::create(scratch.path(), &setup()).unwrap(), 0, 10, 3);
    let [run, grains] = files(&scratch).map(|file| describe(&file));
    assert_eq!(
        run,
        "\
/energy/budget plunge.EnergyBudget step:uint64 time_s:double unaccounted_J:double closure:double \
kinetic_intruder_J:double potential_gravity_J:double elastic_normal_elastic_J:double \
dissipated_sliding_J:double input_drive_J:double
/intruder/ball/state plunge.IntruderState step:uint64 time_s:double depth_m:double \
speed_m_per_s:double position:xyz velocity:xyz spin:xyz
/intruder/rear/state plunge.IntruderState step:uint64 time_s:double depth_m:double \
speed_m_per_s:double position:xyz velocity:xyz spin:xyz
/intruder/ball/load plunge.IntruderLoad step:uint64 time_s:double contacts:uint32 area_m2:double \
contact:xyz contact_torque:xyz gravity:xyz gravity_torque:xyz
/intruder/rear/load plunge.IntruderLoad step:uint64 time_s:double contacts:uint32 area_m2:double \
contact:xyz contact_torque:xyz gravity:xyz gravity_torque:xyz
/bed/activity plunge.BedActivity step:uint64 time_s:double moving_share:double
/intruder/ball/estimate plunge.CollisionalEstimate step:uint64 time_s:double \
geometric_area_m2:double magnitudes_N:double force:xyz
/intruder/rear/estimate plunge.CollisionalEstimate step:uint64 time_s:double \
geometric_area_m2:double magnitudes_N:double force:xyz
/bed/field foxglove.PointCloud
/bed/crater foxglove.PointCloud
/tf foxglove.FrameTransforms
/scene foxglove.SceneUpdate
/intruder/ball/pose foxglove.PoseInFrame
/intruder/rear/pose foxglove.PoseInFrame
/log foxglove.Log
"
    );
    assert_eq!(
        grains,
        "\
/grains foxglove.PointCloud
/intruder/ball/state plunge.IntruderState step:uint64 time_s:double depth_m:double \
speed_m_per_s:double position:xyz velocity:xyz spin:xyz
/intruder/rear/state plunge.IntruderState step:uint64 time_s:double depth_m:double \
speed_m_per_s:double position:xyz velocity:xyz spin:xyz
/tf foxglove.FrameTransforms
/scene foxglove.SceneUpdate
/intruder/ball/pose foxglove.PoseInFrame
/intruder/rear/pose foxglove.PoseInFrame
"
    );
}

#[test]
fn own_messages_decode_by_the_descriptors_in_the_file() {
    let scratch = empty_folder();
    write_rest(RunLog::create(scratch.path(), &setup()).unwrap(), 0, 10, 3);
    let [run, _] = files(&scratch);
    let messages: Vec<_> =
        mcap::MessageStream::new(&run).unwrap().map(|message| message.unwrap()).collect();
    let last = |topic: &str| {
        let message = messages.iter().rfind(|m| m.channel.topic == topic).unwrap();
        assert_eq!((message.sequence, message.log_time), (10, 100_000), "{topic}");
        assert_eq!(message.publish_time, message.log_time);
        decode(&message.channel.schema.as_ref().unwrap().data, &message.data)
    };
    let x = libm::sin(1.0);
    let budget = last("/energy/budget");
    assert_eq!(budget["step"], 10.0);
    assert_eq!(budget["kinetic_intruder_J"], x * x);
    assert_eq!(budget["input_drive_J"], 0.25);
    assert_eq!(budget["unaccounted_J"], 1e-9 * x);
    let state = last("/intruder/ball/state");
    assert_eq!(state["position.z"], (0.3 - 0.01 * x) - 0.3, "the surface is at z = 0");
    assert_eq!(state["speed_m_per_s"], 5.0);
    let load = last("/intruder/rear/load");
    assert_eq!(load["gravity.z"], -9.81);
    assert_eq!(load["contact_torque.y"], 0.1 * x);
    assert_eq!(load["contacts"], 0.0);
    assert_eq!(load["area_m2"], 0.25 * x);
    let estimate = last("/intruder/ball/estimate");
    assert_eq!(estimate["force.z"], x);
    assert_eq!(estimate["magnitudes_N"], 2.0);
    assert_eq!(last("/bed/activity")["moving_share"], 0.125);
}

#[test]
fn the_grain_log_opens_alone_and_its_points_lie_below_their_fields() {
    let scratch = empty_folder();
    write_rest(RunLog::create(scratch.path(), &setup()).unwrap(), 0, 10, 3);
    let [_, grains] = files(&scratch);
    let cloud: PointCloud = first(&grains, "/grains");
    assert_eq!(cloud.point_stride, 40);
    let offsets: Vec<_> = cloud.fields.iter().map(|f| (f.name.as_str(), f.offset)).collect();
    let names = ["x", "y", "z", "radius", "vx", "vy", "vz", "speed", "force", "id"];
    assert_eq!(offsets, names.into_iter().zip((0..).step_by(4)).collect::<Vec<_>>());
    let point = &cloud.data[40..80];
    let float = |at: usize| f32::from_le_bytes(point[at..at + 4].try_into().unwrap());
    assert_eq!([0, 8, 12].map(float), [1e-3, 0.0, 1e-3], "place and radius");
    assert_eq!([16, 20, 24, 28].map(float), [0.0, -2.0, 0.0, 2.0], "velocity and speed");
    assert_eq!(float(32), 1.0, "force");
    assert_eq!(point[36..], 1_u32.to_le_bytes());
    assert_eq!(cloud.data.len(), 3 * 40);
}

#[test]
fn the_arrow_of_a_force_starts_where_the_body_ends() {
    let scratch = empty_folder();
    write_rest(RunLog::create(scratch.path(), &setup()).unwrap(), 0, 10, 3);
    let [run, _] = files(&scratch);
    let scene: SceneUpdate = first(&run, "/scene");
    let arrow = &scene.entities.last().unwrap().arrows[0];
    let pose = arrow.pose.as_ref().unwrap();
    // The ball is 20 mm in radius, at the surface, and its force of 9.81 N points up.
    let start = pose.position.unwrap();
    assert!(start.x.abs() < 1e-15 && (start.z - 0.02).abs() < 1e-15, "{start:?}");
    assert!((arrow.shaft_length - 0.0981).abs() < 1e-15);
}

#[test]
fn the_grain_log_says_of_every_frame_how_bodies_move_as_the_other_log_does() {
    let scratch = empty_folder();
    write_rest(RunLog::create(scratch.path(), &setup()).unwrap(), 0, 10, 3);
    let [every_step, frames] = files(&scratch).map(|log| {
        let messages = mcap::MessageStream::new(&log).unwrap().map(|message| message.unwrap());
        let states = messages.filter(|message| message.channel.topic == "/intruder/rear/state");
        states.map(|message| (message.sequence, message.data.into_owned())).collect::<Vec<_>>()
    });
    assert_eq!(frames, [0, 7].map(|step| every_step[step].clone()));
    assert_eq!(frames[1].0, 7);
}

#[test]
fn fields_and_crater_are_clouds_in_the_frame_of_the_log() {
    let scratch = empty_folder();
    write_rest(RunLog::create(scratch.path(), &setup()).unwrap(), 0, 10, 3);
    let [run, _] = files(&scratch);
    let cloud = |topic: &str| -> PointCloud { first(&run, topic) };
    let value = |cloud: &PointCloud, point: usize, name: &str| {
        let field = cloud.fields.iter().find(|field| field.name == name).unwrap();
        let at = point * cloud.point_stride as usize + field.offset as usize;
        f32::from_le_bytes(cloud.data[at..at + 4].try_into().unwrap())
    };
    let field = cloud("/bed/field");
    assert_eq!(field.data.len(), 2 * field.point_stride as usize);
    // The surface lies at 0.3 m in the engine and at 0 in the log.
    assert_eq!(value(&field, 1, "z"), (0.4_f64 - 0.3) as f32);
    assert_eq!(value(&field, 1, "vz_m_per_s"), -4.0);
    assert_eq!(value(&field, 1, "speed_m_per_s"), 5.0);
    assert_eq!(value(&field, 1, "temperature_m2_per_s2"), 0.25);
    let crater = cloud("/bed/crater");
    assert_eq!(value(&crater, 0, "z"), (0.2_f64 - 0.3) as f32);
    assert_eq!(value(&crater, 0, "distance_m"), 0.05_f32);
}

#[test]
fn metadata_and_attachments_are_kept_with_the_closure_identity() {
    let scratch = empty_folder();
    write_rest(RunLog::create(scratch.path(), &setup()).unwrap(), 0, 0, 0);
    let [run, _] = files(&scratch);
    let summary = mcap::Summary::read(&run).unwrap().unwrap();
    let record = mcap::read::metadata(&run, &summary.metadata_indexes[0]).unwrap();
    assert_eq!(record.name, "run");
    assert_eq!(record.metadata["seed"], "7");
    assert_eq!(
        record.metadata["closure_identity"],
        "kinetic_intruder_J + potential_gravity_J + elastic_normal_elastic_J + \
         dissipated_sliding_J - input_drive_J = (its value at the first step) + unaccounted_J"
    );
    let attachment = mcap::read::attachment(&run, &summary.attachment_indexes[0]).unwrap();
    assert_eq!(*attachment.data, *b"name = \"made-up\"\n");
}

#[test]
fn a_value_that_is_not_finite_is_refused_before_anything_of_it_is_written() {
    let scratch = empty_folder();
    let mut log = RunLog::create(scratch.path(), &setup()).unwrap();
    let before = log.position();
    let error = log.energy(stamp(3), &[0.0, 0.0, f64::NAN, 0.0, 0.0], 0.0, 0.0).unwrap_err();
    assert_eq!(error.to_string(), "step 3: elastic_normal_elastic_J is not finite");
    let state = BodySample {
        position: Vec3::zeros(),
        velocity: Vec3::zeros(),
        spin: Vec3::zeros(),
        depth_m: 0.0,
    };
    let body = BodyFrame { state, orientation: Quat::identity(), force: Vec3::zeros() };
    let grain = GrainSample {
        position: Vec3::new(0.0, f64::INFINITY, 0.0),
        radius: 1.0,
        velocity: Vec3::zeros(),
        force: 0.0,
        id: 5,
    };
    let error = log.frame(stamp(3), &[body; 2], &mut [grain].into_iter()).unwrap_err();
    assert_eq!(error.to_string(), "step 3: grain 5 is not finite");
    assert_eq!(log.position(), before);
}

#[test]
fn names_that_viewers_could_not_show_are_refused() {
    let scratch = empty_folder();
    let refused = |change: &dyn Fn(&mut LogSetup)| {
        let mut setup = setup();
        change(&mut setup);
        matches!(RunLog::create(scratch.path(), &setup), Err(RecordError::Setup(_)))
    };
    assert!(refused(&|s| s.bodies[0].name = "a/b".to_owned()));
    assert!(refused(&|s| s.bodies[0].name = "rear".to_owned()));
    assert!(refused(&|s| s.energy_terms[0] = "closure".to_owned()));
    assert!(refused(&|s| s.force_origins[0] = "lift (Magnus)".to_owned()));
    assert!(refused(&|s| s.flush_every = 0));
    assert!(!refused(&|_| {}));
}

#[test]
fn steps_and_times_out_of_range_or_out_of_order_are_refused() {
    let scratch = empty_folder();
    let mut log = RunLog::create(scratch.path(), &setup()).unwrap();
    for at in [
        Stamp { step: 1 << 32, time_s: 0.0 },
        Stamp { step: 0, time_s: -1.0 },
        Stamp { step: 0, time_s: f64::NAN },
    ] {
        let error = log.event(at, EventLevel::Info, "").unwrap_err();
        assert!(matches!(error, RecordError::OutOfRange { .. }), "{error}");
    }
    log.event(stamp(9), EventLevel::Info, "").unwrap();
    let error = log.event(stamp(8), EventLevel::Info, "").unwrap_err();
    assert!(matches!(error, RecordError::StepOrder { step: 8, last: 9, .. }), "{error}");
}

/// The first message of `topic` in a log.
fn first<M: Message + Default>(log: &[u8], topic: &str) -> M {
    let mut messages = mcap::MessageStream::new(log).unwrap().map(|message| message.unwrap());
    let message = messages.find(|message| message.channel.topic == topic).unwrap();
    M::decode(message.data.as_ref()).unwrap()
}

/// One line per channel: topic, schema and, for our own messages, the fields.
fn describe(file: &[u8]) -> String {
    let summary = mcap::Summary::read(file).unwrap().unwrap();
    let channels: BTreeMap<_, _> = summary.channels.into_iter().collect();
    let mut lines = String::new();
    for channel in channels.values() {
        let schema = channel.schema.as_ref().unwrap();
        assert_eq!(
            (schema.encoding.as_str(), channel.message_encoding.as_str()),
            ("protobuf", "protobuf")
        );
        lines += &format!("{} {}", channel.topic, schema.name);
        if schema.name.starts_with("plunge.") {
            for (name, kind) in fields(&schema.data).values() {
                let kind = match kind {
                    Type::Uint64 => "uint64",
                    Type::Uint32 => "uint32",
                    Type::Double => "double",
                    _ => "xyz",
                };
                lines += &format!(" {name}:{kind}");
            }
        }
        lines.push('\n');
    }
    lines
}

/// Number, name and type of the fields of the last message of a descriptor set.
fn fields(descriptor: &[u8]) -> BTreeMap<u32, (String, Type)> {
    let set = FileDescriptorSet::decode(descriptor).unwrap();
    let message = &set.file.last().unwrap().message_type[0];
    message.field.iter().map(|f| (f.number() as u32, (f.name().to_owned(), f.r#type()))).collect()
}

/// Decodes a message into `name` and `name.x` by its descriptor alone.
fn decode(descriptor: &[u8], mut message: &[u8]) -> BTreeMap<String, f64> {
    let fields = fields(descriptor);
    let mut values = BTreeMap::new();
    while message.has_remaining() {
        let (number, _) = decode_key(&mut message).unwrap();
        let (name, kind) = &fields[&number];
        match kind {
            Type::Double => drop(values.insert(name.clone(), message.get_f64_le())),
            Type::Message => {
                assert_eq!(decode_varint(&mut message).unwrap(), 27);
                for axis in ["x", "y", "z"] {
                    decode_key(&mut message).unwrap();
                    values.insert(format!("{name}.{axis}"), message.get_f64_le());
                }
            }
            _ => drop(values.insert(name.clone(), decode_varint(&mut message).unwrap() as f64)),
        }
    }
    values
}
