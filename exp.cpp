#include "bench/cloth_rays.h"
#include "host/program.h"
#include "tests/kernels/trace_kernels.h"
#include <algorithm>
#include <cstring>
#include <ctime>
using namespace wale; using namespace wale::test;
int main(int argc,char**argv){
  double wanted=atof(argv[1]); uint32_t side=atoi(argv[2]); int reps=atoi(argv[3]);
  const Strands cloth=bench::cloth(wanted); const Device& device=test_device();
  Tracer tracer(device,cloth);
  std::string opt=fmt::format("-DW_LANES={}",device.traits().lanes);
  auto rays=bench::cloth_rays(tracer,side,opt);
  struct V{std::string name;cl::Program p;int group;};
  std::vector<V> vs;
  for(int i=4;i<argc;++i){std::string a=argv[i],o;auto c=a.find(':');if(c!=a.npos){o=a.substr(c+1);a=a.substr(0,c);}
    int group=1; if(o.find("GROUP16")!=o.npos)group=16; 
    vs.push_back({argv[i],build_program(device,"exp.cl","-DW_HAS_PLIES "+opt+" "+o,a),group});}
  Buffer<uint32_t> counters(device,std::vector<uint32_t>(64,0));
  for(int kind=0;kind<3;++kind){
    const auto&r=kind==0?rays.primary:kind==1?rays.bounce:rays.shadow; bool any=kind==2;
    Buffer<Ray> in(device,r); Buffer<float> out(device,2*r.size());
    std::vector<std::vector<double>> ts(vs.size()); std::vector<float> ref;
    for(int k=-1;k<reps;++k)for(size_t v=0;v<vs.size();++v){
      cl::Kernel kn(vs[v].p,any?"occluded":(kind==0&&vs[v].group>1?"closest16":"closest"));
      kn.setArg(0,tracer.tree().nodes.cl());kn.setArg(1,tracer.tree().leaves.cl());kn.setArg(2,tracer.tree().root);kn.setArg(3,counters.cl());
      kn.setArg(4,in.cl());kn.setArg(5,out.cl());kn.setArg(6,uint32_t(r.size()));
      size_t items=r.size(); if(kind==0&&vs[v].group>1)items=(items+vs[v].group-1)/vs[v].group;
      clock_t s=clock();
      device.queue().enqueueNDRangeKernel(kn,cl::NullRange,device.global(items),device.local());device.queue().finish();
      double t=double(clock()-s)/CLOCKS_PER_SEC;
      if(k>=0)ts[v].push_back(t);
      else{auto h=out.read(device); h.resize(any?r.size():2*r.size()); if(v==0)ref=h; else{size_t d=0,dt=0;size_t n=any?1:2;for(size_t i=0;i<h.size();i+=n){ if(memcmp(&h[i],&ref[i],4*n)){++d; if(h[i]!=ref[i])++dt;}} if(d)fmt::print("kind {} {}: {} differ of {}, {} in t\n",kind,vs[v].name,d,r.size(),dt);}}
    }
    for(size_t v=0;v<vs.size();++v){std::vector<double> q;for(int k=0;k<reps;++k)q.push_back(ts[0][k]/ts[v][k]);std::sort(q.begin(),q.end());auto t=ts[v];std::sort(t.begin(),t.end());
      fmt::print("{} {:30} {:.2f} Mr/s, x{:.3f} ({:.3f}-{:.3f})\n",kind==0?"primary":kind==1?"bounce ":"shadow ",vs[v].name,r.size()/t[reps/2]*1e-6,q[reps/2],q.front(),q.back());}
  }
  auto c=counters.read(device); fmt::print("counters"); for(auto x:c)if(x)fmt::print(" {}",x); fmt::print("\n");
}
