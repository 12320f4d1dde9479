use corpuscle::{gpu::*, geometry::*, plan::*, scene::Method, subdomain::*, simulation::*};
fn main() {
    let n: usize = std::env::args().nth(1).map(|s| s.parse().unwrap()).unwrap_or(8000);
    let x: f64 = std::env::args().nth(2).map(|s| s.parse().unwrap()).unwrap_or(0.1);
    let rounds: u32 = std::env::args().nth(3).map(|s| s.parse().unwrap()).unwrap_or(3);
    let f: f64 = std::env::args().nth(4).map(|s| s.parse().unwrap()).unwrap_or(0.1);
    let steps: u32 = std::env::args().nth(5).map(|s| s.parse().unwrap()).unwrap_or(320);
    let l = 0.1f64; let vol = l*l*l; let nd = n as f64/vol;
    let sigma = (6.0*f/(std::f64::consts::PI*nd)).cbrt();
    let m=0.028; let t=300.0; let c0=(8.314462618f64*t/m).sqrt();
    let gbar=(16.0/std::f64::consts::PI).sqrt()*c0;
    let tau=1.0/(nd*std::f64::consts::PI*sigma*sigma*gbar);
    let dt=x*tau; let gmax=6.0*c0; let h=(sigma*sigma+(gmax*dt/2.0).powi(2)).sqrt()*1.0001;
    let grid=Grid::around([0.0;3],[l;3],h).unwrap();
    println!("sigma {sigma:.4e} h {h:.4e} cells {:?} per cell {:.2}", grid.cells, nd*h*h*h);
    let device=Device::open(None).unwrap(); println!("{}", device.adapter().info.name);
    let plan=Plan{method:Method::ClosestApproach,particles:n as u64,initial_particles:n as u64,injected_particles:0,moles_per_particle:1e-6,
      chambers:vec![ChamberPlan{name:"a".into(),volume:vol,particles:vec![n as u64]}],gases:vec![GasPlan{name:"n2".into(),molar_mass:m,spin_dof:2.0,exchange_probability:{let a=2.0/6.0;let p0=1.5/5.0;(1.0-(1.0f64-2.0*a*p0).sqrt())/a},particles:n as u64}],openings:vec![],diameter:sigma,occupancy:f,mean_free_path:0.0,collision_number:5.0,rounds,collision_limit:0.3,time_step:dt,ladder_levels:12,steps_per_interval:32,tally_every:8,grid,block_cells_log2:2,temperature_reference:t,temperature_max:t,seed:7,end_time:1.0,estimated_steps:0.0,reasons:vec![],warnings:vec![]};
    // box triangles, normals inwards
    let c:Vec<[f64;3]>=(0..8).map(|i|[if i&1==1{l}else{0.0},if i&2==2{l}else{0.0},if i&4==4{l}else{0.0}]).collect();
    let faces:[([usize;4],[f32;3]);6]=[([0,2,6,4],[1.,0.,0.]),([1,5,7,3],[-1.,0.,0.]),([0,4,5,1],[0.,1.,0.]),([2,3,7,6],[0.,-1.,0.]),([0,1,3,2],[0.,0.,1.]),([4,6,7,5],[0.,0.,-1.])];
    let mut tg=TriangleGrid{triangles:vec![],start:vec![],list:vec![],class:vec![]};
    for (q,nrm) in faces { for tri in [[q[0],q[1],q[2]],[q[0],q[2],q[3]]] { 
        let p=tri.map(|i|grid.to_fixed(c[i]).unwrap().map(|v|v as i32));
        tg.triangles.push(FixedTriangle{corners:p,ids:tri.map(|i|i as u32),normal:nrm,source:0}); } }
    let lo=grid.cell_of(grid.to_fixed([0.0;3]).unwrap()); let hi=grid.cell_of(grid.to_fixed([l;3]).unwrap());
    for z in 0..grid.cells[2]{for y in 0..grid.cells[1]{for xx in 0..grid.cells[0]{
        let cc=[xx,y,z]; tg.start.push(tg.list.len() as u32);
        for (k,_) in tg.triangles.iter().enumerate(){ let face=k/2; let axis=face/2; let at=if face%2==0{lo[axis]}else{hi[axis]};
          if cc[axis]==at && (0..3).all(|a|cc[a]>=lo[a]&&cc[a]<=hi[a]) {tg.list.push(k as u32);} }
        let s=(0..3).any(|a|cc[a]<lo[a]||cc[a]>hi[a]); let cut=(0..3).any(|a|cc[a]==lo[a]||cc[a]==hi[a]); let near=(0..3).any(|a|cc[a]<=lo[a]+1||cc[a]+1>=hi[a]);
        tg.class.push(if s{CellClass::Solid}else if cut{CellClass::Cut}else if near{CellClass::Gas}else{CellClass::Clear});
    }}} tg.start.push(tg.list.len() as u32);
    let walls=Walls::new(&tg,&grid,&vec![0;12]);
    let mut state=12345u64; let mut r=||{state=state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); ((state>>33) as f64+0.5)/(1u64<<31) as f64};
    let parts:Vec<GpuParticle>=(0..n).map(|i|{ let mut g=||(-2.0*r().ln()).sqrt()*(6.283185307*r()).cos(); let v=[g()*c0,g()*c0,g()*c0]; GpuParticle{position:grid.to_fixed([r()*l,r()*l,r()*l]).unwrap(),tag:i as u32,velocity:v.map(|a|a as f32),spin:(-(r().ln())*c0*c0) as f32}}).collect();
    let zones=vec![zone_of(None,&grid),zone_of(None,&grid)];
    let mut sub=Subdomain::new(&device,&SubdomainInput{plan:&plan,walls:&walls,zones:&zones,patches:1,particles:&parts}).unwrap();
    let energy=|p:&[GpuParticle]|->f64{p.iter().map(|p|0.5*p.velocity.iter().map(|v|(*v as f64).powi(2)).sum::<f64>()+p.spin as f64).sum()};
    let e0=energy(&sub.particles(&device).unwrap());
    let timer=PhaseTimer::new(&device).unwrap();
    let t0=std::time::Instant::now(); let mut coll=0; let mut phases=std::collections::BTreeMap::new(); let mut imp=0i64; let mut bounces=0u64; let (mut lost,mut samp)=(0,0);
    for i in 0..steps/32 {
        let slots=sub.begin_interval(&device,i as u64*32,dt,&[0;32],&[],0).unwrap();
        let mut enc=device.encoder(); let mut names=vec![];
        for (k,s) in slots.iter().enumerate(){
            let timed=k==31; let mut pass=TimedPass::new(&mut enc, if timed{timer.as_ref()}else{None});
            step(&sub,&device,&mut pass,*s,rounds,Sampling{lost:k==0,tally:k%8==7});
            if timed { names=pass.end(); }
        }
        let st=sub.encode_readback(&device,&mut enc,timer.as_ref().map(|t|(t,names.len()))).unwrap();
        let subm=device.submit(enc); let rb=device.read_later(st,subm);
        let (t,b)=sub.finish_readback(&device,rb).unwrap();
        coll+=t.counters.collisions; bounces+=t.counters.bounces as u64; lost+=t.counters.lost; samp+=t.counters.sampled;
        imp+=t.surfaces[0].hits;
        if i==1 {println!("{:?}",t.counters);}
        if i>0 {for (n,s) in timer.as_ref().unwrap().seconds(&names,&b){*phases.entry(n).or_insert(0.0)+=s*32.0;}}
    }
    let el=t0.elapsed().as_secs_f64();
    println!("{:.1} ns per particle-step, {:.3} ms per step", el*1e9/(n as f64*steps as f64), el*1e3/steps as f64);
    let rate=2.0*coll as f64/(n as f64*steps as f64*dt)*tau; println!("rate/theory {rate:.4} bounces {bounces} hits {imp} lost {lost} of {samp}");
    let e1=energy(&sub.particles(&device).unwrap()); println!("energy drift {:.3e}",(e1-e0)/e0);
    for (k,v) in phases {println!("{k:12} {:.1} ns",v/(steps as f64-32.0)/n as f64*1e9);}
}
