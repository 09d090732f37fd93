# A mesh of an edit is what mc extract makes of the edited volume, however the script came.
. "$CASES/case.sh"
ball ball.raw
H='{"format":"mc-edits","version":1,"space":"index","defaults":{"strength":200}}'
A='{"op":"subtract","shape":{"type":"sphere","center":[8,13,8],"radius":4}}'
B='{"op":"add","shape":{"type":"capsule","radius":[2,1]},"path":{"points":[[2,2,2],[13,3,12]],"mode":"sweep"}}'
printf '%s\n' "$H" "$A" "$B" > lines.jsonl
printf '%s' "${H%\}},\"edits\":[$A,$B]}" > document.json
iso="--iso 100"

mc edit ball.raw $RAW $iso --script lines.jsonl -o one.ply -o one.nrrd -o one.raw
mc extract one.nrrd $iso -o again.ply -q
cmp one.ply again.ply
mc edit ball.raw $RAW $iso --script document.json -o document.ply -q
mc edit ball.raw $RAW $iso --script - -o piped.ply -q < lines.jsonl
mc edit ball.raw $RAW $iso --script - -o piped2.ply -q < document.json
mc edit ball.raw $RAW $iso --script lines.jsonl -o - --to ply -q > stdout.ply
mc edit ball.raw $RAW $iso --script lines.jsonl -o serial.ply --threads 1 -q
mkfifo fifo
cat lines.jsonl > fifo &
mc edit ball.raw $RAW $iso --script fifo -o fifo.ply -q
for other in document piped piped2 stdout serial fifo; do cmp one.ply $other.ply; done
mc check --closed one.ply | head -3

# The same edits of a sparse volume leave it sparse, and make the same surface.
mc sample one.nrrd -o edited.vdb -q
mc sample ball.raw $RAW -o ball.vdb -q
mc edit ball.vdb $iso --script lines.jsonl -o sparse.vdb -o sparse.ply -q
mc extract sparse.vdb $iso -o again-sparse.ply -q
cmp sparse.ply again-sparse.ply
mc check sparse.ply | head -2

# Specs are sampled where they must be; their own iso and side are taken.
mc edit "$DATA/specs/sphere.json" --script - -o bitten.glb <<END
{"format":"mc-edits","version":1}
{"op":"subtract","blend":"csg","shape":{"type":"sphere","center":[1,0,0],"radius":0.5}}
{"op":"write","path":"step-{n:03}.ply"}
{"op":"subtract","blend":"csg","shape":{"type":"sphere","center":[-1,0,0],"radius":0.5}}
{"op":"write","path":"step-{n:03}.nrrd"}
{"op":"undo","count":5}
{"op":"write","path":"step-{n:03}.ply"}
END
mc extract "$DATA/specs/sphere.json" -o whole.ply -q
cmp whole.ply step-003.ply && echo "undone is untouched"
ls step-* bitten.glb

# What would be touched.
mc edit ball.raw $RAW $iso --script lines.jsonl --dry-run
# A line for each record, mesh and run.
mc edit ball.raw $RAW $iso --script lines.jsonl -o r.ply --report report.jsonl -q
cut -c1-110 report.jsonl
# The journal is a script.
mc edit ball.raw $RAW $iso --script lines.jsonl -o j.ply --journal journal.jsonl -q
mc edit ball.raw $RAW $iso --script journal.jsonl -o j2.ply -q
cmp j.ply one.ply && cmp j2.ply one.ply
sed 's/"folder":"[^"]*"/"folder":F/; s/"[0-9a-f]\{16\}"/HASH/g' journal.jsonl
