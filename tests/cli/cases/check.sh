# Meshes with and without defects.
. "$CASES/case.sh"
cat > open.obj <<OBJ
v 0 0 0
v 1 0 0
v 0 1 0
f 1 2 3
OBJ
cat > bad.obj <<OBJ
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
f 1 2 3
f 1 2 4
f 1 1 2
OBJ
mc check open.obj
mc check open.obj --closed
mc check bad.obj --json | sed 's/"mc":"[0-9.]*"/"mc":N/'
mc check open.obj bad.obj nope.obj --json -q | cut -d, -f2-4
mc check - < open.obj | head -1
