use crate::follower::*;
use lrp_sim::*;
fn load(n:&str)->World{ match World::parse(&std::fs::read_to_string(format!("{}/../../behaviors/worlds/{n}.world",env!("CARGO_MANIFEST_DIR"))).unwrap()){Ok(w)=>w,Err(f)=>{for x in f{println!("{x}")};panic!()}}}
#[test] fn layout(){ let n=std::env::var("W").unwrap_or("curve".into()); let w=load(&n);
 println!("len {}",w.line_length());
 for l in w.lines(){ println!("end {:?}",l.points.last());
  // strand separation: points further than 0.6 m along
  let p:Vec<Point>={let mut v=vec![];let mut acc=0.0;let mut a=l.points[0];v.push((0.0,a));for b in &l.points[1..]{let d=((b.x-a.x).powi(2)+(b.y-a.y).powi(2)).sqrt();let k=(d/0.01).ceil() as i32;for i in 1..=k{let f=i as f64/k as f64;v.push((acc+d*f,Point{x:a.x+(b.x-a.x)*f,y:a.y+(b.y-a.y)*f}))}acc+=d;a=*b;} let mut best=(9.,Point{x:0.,y:0.},Point{x:0.,y:0.});for (i,(s,q)) in v.iter().enumerate(){for (t,r) in &v[i..]{ if t-s>1.2 {let d=(q.x-r.x).hypot(q.y-r.y);if d<best.0{best=(d,*q,*r)}}}} println!("sep {best:?}"); v.into_iter().map(|x|x.1).collect()};
  let s=w.size(); let (cw,ch)=(0.05,0.1); let (nx,ny)=((s.width/cw) as usize+1,(s.height/ch) as usize+1); let mut g=vec![vec![' ';nx];ny];
  for q in p{ g[(q.y/ch) as usize][(q.x/cw) as usize]='#';}
  let st=w.start(); g[(st.y/ch) as usize][(st.x/cw) as usize]='S';
  for wl in &w.walls()[4..]{for i in 0..=100{let f=i as f64/100.;let x=wl.from.x+(wl.to.x-wl.from.x)*f;let y=wl.from.y+(wl.to.y-wl.from.y)*f;g[(y/ch) as usize][(x/cw) as usize]='W';}}
  for r in g.iter().rev(){println!("|{}|",r.iter().collect::<String>());}
 }}
#[test] fn grid(){ let n=std::env::var("W").unwrap_or("curve".into()); let w=load(&n);
 let secs=400;
 for ways in [Search::BothWays,Search::OnlyLeft,Search::OnlyRight]{ println!("{ways:?}");
 for forward in [0.1,0.15,0.2,0.25,0.3]{for maxlook in [1,2,3,4]{ print!("f {forward} look {maxlook}: ");
 for search in [0.2,0.4,0.6,0.8,1.0,1.2,1.5,2.0]{
  let f=Follower{forward,search,maxlook,ways};
  let r=f.run(&w,Noise::NONE,0,secs);
  match r.finished(){Some(t)=>print!(" {search}:{t:6.1}"),None=>print!(" {search}: fail{}",r.bumps.iter().flatten().count())}
 } println!();}}}}
#[test] fn variants(){ let n=std::env::var("W").unwrap_or("curve".into());
 let t=std::fs::read_to_string(format!("{}/../../behaviors/worlds/{n}.world",env!("CARGO_MANIFEST_DIR"))).unwrap();
 for width in ["0.04","0.05","0.06","0.08"]{for ahead in ["0.06","0.08","0.1"]{
  let w=World::parse(&(t.replace("line width 0.06",&format!("line width {width}"))+&format!("\nlight {ahead}\n"))).unwrap();
  print!("w {width} a {ahead}:");
  for (forward,search,maxlook) in [(0.2,0.2,1),(0.15,0.6,1),(0.2,0.6,1),(0.2,1.0,1),(0.2,1.0,2),(0.2,1.5,2),(0.3,1.0,2),(0.3,0.6,4)]{
   let f=Follower{forward,search,maxlook,ways:Search::BothWays};
   match f.run(&w,Noise::NONE,0,400).finished(){Some(t)=>print!(" {t:6.1}"),None=>print!("   fail")}}
  println!();}}}
