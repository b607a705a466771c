import h5py,sys,glob,numpy as np
f=sorted(glob.glob(sys.argv[1]+'/snapshots/*.h5'))[-1]
h=h5py.File(f)['fluid']; x=h['x'][:]; v=h['v'][:]
nu=.1;F=.8
ex=F/(2*nu)*x[:,1]*(1-x[:,1])
if len(sys.argv)>2: ex=x[:,1]*float(sys.argv[2])
print(sys.argv[1],len(x),'max err',abs(v[:,0]-ex).max(),'rms',np.sqrt(((v[:,0]-ex)**2).mean()),'vy',abs(v[:,1]).max(),'p',h['p'][:].min(),h['p'][:].max(), 'umax', v[:,0].max())
