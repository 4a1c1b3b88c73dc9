use engine::bed::*;
use engine::body::RigidBody;
use engine::boundary::Container;
use engine::contact::ContactStage;
use engine::grain_bed::GrainBed;
use engine::math::Vec3;
use engine::params::ParamTable;
use engine::simulation::*;
fn stage(mu: f64) -> Box<dyn ContactStage> {
    let mut p = ParamTable::new();
    for (k, v) in [
        ("normal_stiffness", 3200.0),
        ("tangential_stiffness", 3200.0),
        ("normal_damping_rate", 1e4),
        ("tangential_damping_rate", 8e3),
        ("friction", mu),
        ("wall_friction", mu),
        ("intruder_friction", mu),
    ] {
        p.set(k, v);
    }
    (contact_laws::find("linear-spring-dashpot").unwrap().build)(&p)
}
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let mu: f64 = a[1].parse().unwrap();
    let threads: usize = a[2].parse().unwrap();
    engine::parallel::with_threads(threads, || {
 let key=[mu as u8;32]; let path = std::path::PathBuf::from(format!("/tmp/bed-{mu}"));
 let c = Container{width:if std::env::var("SMALL").is_ok() {0.3} else {1.0185},depth:0.0}; let g = Vec3::new(0.0,0.0,-9.81);
 let resting = match engine::checkpoint::load::<engine::grain_bed::RestingBed>(&path,&key) { Ok(r) => r, Err(_) => {
 let grains = fill(&[GrainKind{count:if std::env::var("SMALL").is_ok() {1260} else {12600},radius:2.28e-3,mass:4.9e-5},GrainKind{count:if std::env::var("SMALL").is_ok() {240} else {2400},radius:3.175e-3,mass:9.7e-5}], &c, 1);
 let mut s = Settling::new(&grains, c, g, vec![stage(mu)], std::env::var("PDT").map_or(1e-5, |x| x.parse().unwrap())); let t=std::time::Instant::now();
 let lim: u64 = std::env::var("LIM").map_or(u64::MAX, |x| x.parse().unwrap()); while !s.is_at_rest() && s.clock().step < lim { s.advance().unwrap(); if s.clock().step % 5000==0 { let g=&s.bed().grains; let e=|i:usize| 0.5*g.mass[i]*g.velocity[i].norm_squared()+0.5*g.inertia[i]*g.spin[i].norm_squared(); let mut o:Vec<usize>=(0..g.len()).collect(); o.sort_by(|a,b| e(*b).total_cmp(&e(*a))); for &i in &o[..3] { println!("  {i} {:.2e} x {:.4} {:.4} v {:?} w {:.3}", e(i), g.position[i].x, g.position[i].z, g.velocity[i], g.spin[i].y);} } if s.clock().step % 5000 == 0 { println!("t {:.3} restless {:.2e} wall {:.1}", s.clock().time(), s.restlessness(), t.elapsed().as_secs_f64()); } }
 if lim<u64::MAX {return;} println!("settle: {} steps {:.1} s, {:.1} M grain-steps/s", s.clock().step, t.elapsed().as_secs_f64(), 15e-3*s.clock().step as f64/t.elapsed().as_secs_f64());
 let r = s.bed().resting(); engine::checkpoint::save(&path,&key,&r).unwrap(); r } };
 let dt: f64 = a.get(3).map_or(1e-5, |x| x.parse().unwrap()); let v: f64 = a.get(4).map_or(2.0, |x| x.parse().unwrap());
 let bed = GrainBed::new(&resting, c, g, vec![stage(0.28)], 1);
 println!("{:?}", BedReport::of(&bed));
 let mut p = ParamTable::new(); p.set("diameter",0.0446);
 let shape = (intruders::find("disc").unwrap().build)(&p, engine::grains::Space::Planar);
 let mut b = RigidBody::new("disc", shape.surface, 0.0322, shape.inertia_per_mass*0.0322);
 let x = 0.5*c.width; let mut z = 0.0f64; for gr in &resting.grains { let dx=gr.position.x-x; let r=gr.radius+0.0223; if dx.abs()<r { z=z.max(gr.position.z+(r*r-dx*dx).sqrt()); } }
 b.launch(Vec3::new(x,0.0,z), Vec3::new(0.0,0.0,-v), Vec3::zeros());
 let mut s = Simulation::new(bed, Box::new(b), Settings{dt, duration:0.4, abort_above:0.5});
 let t=std::time::Instant::now();
 while !s.is_over() { s.advance().unwrap(); }
 let w=t.elapsed().as_secs_f64();
 println!("impact v {v} dt {dt}: {} steps {w:.2} s {:.2} M grain-steps/s; T {:?} depth {} closure {:.2e} rest {:?}", s.clock().step, 15e-3*s.clock().step as f64/w, s.stopping().stopping_time(), s.stopping().depth(), s.closure(), s.stopping().rest_time());
 for (t,v) in s.ledger().terms().iter().zip(&s.ledger().balance().values) { println!("  {} {:.4}", t.key(), v/s.impact_energy()); }
 }).unwrap();
}
