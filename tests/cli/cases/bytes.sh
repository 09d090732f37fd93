# The bytes of every format for the shipped specs, whatever the threads. A change here is a change for every
# user's files: the commit that makes it says why.
. "$CASES/case.sh"
for to in ply obj stl glb; do
  mc extract "$DATA/specs/demo-terrain.json" -o demo.$to -q
  mc extract "$DATA/specs/csg.json" -o csg.$to -q --threads 3
  sha256sum demo.$to csg.$to | cut -c1-16,65-
done
mc extract "$DATA/specs/torus.json" -o torus.ply --ascii --normals face --border open -q
head -n 24 torus.ply
