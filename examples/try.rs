use corpuscle::{gpu::*, scene, simulation::*};
struct O(std::time::Instant, Vec<Row>);
impl Observer for O { fn row(&mut self, r:&Row)->Result<(),SimulationError>{ self.1.push(r.clone()); Ok(()) }
 fn progress(&mut self,t:f64,s:u64,p:u64){ if s%1600==0 {eprintln!("{:.3} ms {} steps {:.1} s {:.0} ns/ps", t*1e3,s,self.0.elapsed().as_secs_f64(), self.0.elapsed().as_nanos() as f64/p as f64);} } }
fn main(){
  let a:Vec<String>=std::env::args().collect();
  let mut s=scene::load(std::path::Path::new(&a[1])).unwrap(); s.output.snapshots=0;
  if let Some(n)=a.get(2){s.model.particles=Some(n.parse().unwrap());}
  let m=match Model::new(s){Ok(m)=>m,Err(e)=>{eprintln!("{e}");return}};
  eprintln!("{}",m.plan.render());
  let d=Device::open(None).unwrap();
  let stop=a.get(3).map(|s|s.parse().unwrap());
  let sim=Simulation::new(&m,&d,Options{stop_after_steps:stop,..Default::default()}).unwrap();
  let mut o=O(std::time::Instant::now(),vec![]);
  let out=match sim.run(&mut o){Ok(o)=>o,Err(e)=>{eprintln!("{e}");return}};
  let times:Vec<f64>=o.1.iter().map(|r|r.time).collect(); let rf=reference(&m,&times);
  for (r,f) in o.1.iter().zip(&rf).step_by(4){ print!("{:8.3} dt {:.2e} n {}",r.time*1e3,r.step,r.particles); for (c,g) in r.chambers.iter().zip(f){print!(" | p {:.4e} ref {:.4e} ({:+.3}) T {:.1} {:.1}",c.pressure,g.pressure,c.pressure/g.pressure-1.0,c.temperature,g.temperature);} for s in &r.surfaces{print!(" || {:.4e} {}",s.pressure,s.hits);} println!(); }
  println!("{}{}",out.audit.render(),out.phases.render()); println!("steps {} repeated {} range {:?} collisions {} bounces {}",out.steps,out.repeated,out.step_range,out.collisions,out.bounces);
}
