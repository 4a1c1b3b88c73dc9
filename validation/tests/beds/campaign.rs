//! Running many impacts: the same records however they are run, and nothing twice.

use std::fs;
use std::num::NonZero;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use configs::{Change, Model};
use diagnosis::beds::{BedModel, Variation};
use measurements::{Crater, Role, Run};
use runner::beds::{Impacts, Job, Place, Record};
use runner::{CampaignError, Progress, Unattended, Watch};

use crate::world::{condition, empty_set, model};

/// Counts what ends, and wants to stop after so many.
struct Patience {
    ended: AtomicUsize,
    most: usize,
}

impl Watch for Patience {
    fn progress(&self, progress: &Progress) {
        assert!(progress.done <= progress.of);
        self.ended.store(progress.done, Ordering::Relaxed);
    }
    fn warn(&self, message: &str) {
        panic!("{message}");
    }
    fn wants_to_stop(&self) -> bool {
        self.ended.load(Ordering::Relaxed) >= self.most
    }
}

fn jobs() -> Vec<Job> {
    let (model, set) = (model(&[]), empty_set(vec![condition(0.5, Role::Fit)]));
    let bed_model = BedModel::new(&model, &set).unwrap();
    let draws = bed_model.draws(0, 2, 2).concat();
    let plain = draws.iter().map(|&draw| bed_model.job(0, draw, &Variation::default()).unwrap());
    let rolling = Change::Effect("rolling-resistance", vec![("rolling_friction", 0.1)]);
    let rough = Variation::during(rolling);
    let rough = bed_model.job(0, draws[0], &rough).unwrap();
    plain.chain([rough]).collect()
}

#[test]
fn an_impact_leaves_a_crater_that_is_measured_when_the_bed_lies_still() {
    let [short, long] = [model(&[]), model(&["run.duration=\"1 s\""])];
    let mut set = empty_set(vec![condition(1.5, Role::Fit)]);
    let cache = tempfile::tempdir().unwrap();
    let place = Place {
        cache: cache.path(),
        workers: NonZero::new(1),
        watch: &Unattended as &dyn Watch,
        elsewhere: None,
    };
    let mut measured = |crater: Crater, model: &Model| {
        set.runs = vec![Run { stop_time: Some(0.05), crater, ..Run::new("a".to_owned(), 0) }];
        let bed_model = BedModel::new(model, &set).unwrap();
        let draw = bed_model.draws(0, 1, 1).concat()[0];
        let job = bed_model.job(0, draw, &Variation::default()).unwrap();
        (job.settles, place.run(&[job]).unwrap()[0].clone())
    };
    let crater = Crater { depth: Some(0.01), rim_diameter: None };
    assert_eq!(measured(crater, &short), (true, None), "the bed still moves");
    let (waits, at_rest) = measured(crater, &long);
    let (does_not, at_stop) = measured(Crater::default(), &long);
    let [at_rest, at_stop] = [at_rest, at_stop].map(Option::unwrap);
    assert_eq!([waits, does_not], [true, false]);
    assert!(at_rest.end > at_stop.end, "the bed moves for longer than the intruder");
    let n = at_stop.depth.len();
    assert_eq!(at_rest.depth[..n], at_stop.depth, "up to the stop they are one impact");
    let [depth, rim] = at_rest.crater.expect("a crater");
    // Below the intruder the surface lies in the gaps of the grains that carry it.
    let grain = set.bed.grain_diameter.unwrap();
    let beside = (depth - at_rest.deepest).abs();
    assert!(beside < 2.0 * grain, "a crater of {depth} m, an intruder {} m deep", at_rest.deepest);
    assert!(rim > set.conditions[0].diameter, "{rim} m from rim to rim");
}

/// What does not depend on how long it took.
fn bits(records: &[Option<Record>]) -> Vec<Record> {
    let same = |record: &Option<Record>| Record { wall: 0.0, ..record.clone().unwrap() };
    records.iter().map(same).collect()
}

#[test]
fn a_campaign_that_was_stopped_goes_on_where_it_was_and_ends_with_the_same_bits() {
    let jobs = jobs();
    let [whole, stopped] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let place = |cache, watch, workers| Place {
        cache,
        workers: NonZero::new(workers),
        watch,
        elsewhere: None,
    };
    let alone = place(whole.path(), &Unattended as &dyn Watch, 1);
    // Two draws of either of two conditions are on two beds, at two places each; the variation is on the first.
    let before = alone.outstanding(&jobs).unwrap();
    assert_eq!((before.impacts, before.beds), (5, 2));
    let expected = alone.run(&jobs).unwrap();
    assert_eq!(alone.outstanding(&jobs).unwrap().impacts, 0);

    let patience = Patience { ended: AtomicUsize::new(0), most: 3 };
    let result = place(stopped.path(), &patience as &dyn Watch, 2).run(&jobs);
    assert!(matches!(result, Err(CampaignError::Interrupted)));
    let pair = place(stopped.path(), &Unattended as &dyn Watch, 2);
    let left = pair.outstanding(&jobs).unwrap();
    assert!((1..5).contains(&left.impacts), "{left:?}");
    let found = pair.run(&jobs).unwrap();
    assert_eq!(bits(&found), bits(&expected));

    let deepest = |at: usize| expected[at].as_ref().unwrap().deepest;
    assert!(deepest(4) < deepest(0), "rolling resistance makes it shallower");
    assert!(
        (1..4).all(|at| deepest(at).to_bits() != deepest(0).to_bits()),
        "every place is another draw"
    );

    // What is kept costs nothing but reading: a hundredth of a second each, at most.
    let start = Instant::now();
    assert_eq!(bits(&pair.run(&jobs).unwrap()), bits(&expected));
    assert!(start.elapsed().as_secs_f64() < 1.0);
}

/// Notes what is told.
#[derive(Default)]
struct Listener(Mutex<Vec<String>>);

impl Watch for Listener {
    fn progress(&self, _: &Progress) {}
    fn warn(&self, message: &str) {
        self.0.lock().unwrap().push(message.to_owned());
    }
    fn wants_to_stop(&self) -> bool {
        false
    }
}

#[test]
fn a_damaged_record_is_told_once_and_its_impact_is_run_again() {
    let job = jobs().remove(0);
    let twice = [job.clone(), job];
    let (cache, listener) = (tempfile::tempdir().unwrap(), Listener::default());
    let workers = NonZero::new(1);
    let place = Place { cache: cache.path(), workers, watch: &listener, elsewhere: None };
    let expected = place.run(&twice).unwrap();
    let records = || fs::read_dir(cache.path().join("impacts")).unwrap();
    let record = records().next().expect("a record").unwrap().path();
    assert_eq!(records().count(), 1);
    fs::write(&record, "no record").unwrap();
    assert_eq!(bits(&place.run(&twice).unwrap()), bits(&expected));
    place.run(&twice).unwrap();
    let told = listener.0.into_inner().unwrap();
    let name = record.file_name().unwrap().to_str().unwrap();
    assert!(told.len() == 1 && told[0].contains(name), "{told:?}");
    assert!(told[0].ends_with("the impact is run again"), "{told:?}");
}
