# What can be wrong with mc edit, and what is left when it is.
. "$CASES/case.sh"
ball ball.raw
H='{"format":"mc-edits","version":1,"space":"index"}'
A='{"op":"subtract","shape":{"type":"sphere","center":[8,13,8],"radius":4},"strength":200}'
printf '%s\n' "$H" "$A" > good.jsonl
printf '%s\n' "$H" '{"op":"add","shape":{"type":"sphere","radius":0}}' "$A" '{"op":"ad"}' > bad.jsonl
in="ball.raw $RAW --iso 100"

mc edit
mc edit ball.raw
mc edit $in --script good.jsonl
mc edit $in --script missing.jsonl -o m.ply
mc edit $in --script bad.jsonl -o m.ply
mc edit $in --script bad.jsonl -o m.ply --keep-going -q
ls m.ply
mc edit $in --script good.jsonl -o m.ply
mc edit $in --script good.jsonl -o n.xyz
mc edit $in --script good.jsonl -o n.ply -o n.ply
mc edit $in --script good.jsonl -o - --to ply --report -
mc edit $in --script good.jsonl --chunk-dir chunks -o n.ply
mc edit $in --script good.jsonl --chunk-cells 16 -o n.ply
mc edit $in --script good.jsonl --emit-at write -o n.ply
mc edit $in --script good.jsonl --emit chunks --emit-at end
mc edit $in --script good.jsonl --emit chunks --chunk-cells 24
mc edit $in --script good.jsonl --emit everything
mc edit $in --script good.jsonl --emit chunks -o - --to ply
mc edit $in --script good.jsonl --emit chunks --chunk-dir .. -o - --to ply
mc edit $in,50 --script good.jsonl --emit chunks
mc edit $in --script good.jsonl --emit chunks --chunk-dir missing -q | cut -c1-80
mc edit $in --script good.jsonl --emit chunks --chunk-dir good.jsonl -q | cut -c1-80
"$MC" edit $in --script good.jsonl --emit chunks -q > /dev/full || echo "status $?"
mc edit $in --script good.jsonl -o n.ply --journal good.jsonl
mc edit - $RAW --script - -o n.ply
mc edit $in --script good.jsonl -o n.ply -o missing/n.ply
ls n.ply 2>&1 || true
printf '%s\n' "$H" '{"op":"write","path":"a.xyz"}' | mc edit $in --script /dev/stdin -o n.ply
printf '%s\n' "$H" '{"op":"write","path":"a.ply"}' '{"op":"write","path":"a.ply"}' > twice.jsonl
mc edit $in --script twice.jsonl
ls a.ply 2>&1 || true
# Live: what came before a bad record stands.
printf '%s\n' "$H" "$A" '{"op":"ad"}' "$A" | mc edit $in --script - -o live.ply
ls live.ply
# Outside is no fault; past the first undo neither.
printf '%s\n' "$H" '{"op":"add","shape":{"type":"sphere","center":[99,0,0],"radius":4}}' \
  '{"op":"add","shape":{"type":"sphere","center":[0,-99,0],"radius":4}}' '{"op":"undo","count":9}' > outside.jsonl
mc edit $in --script outside.jsonl -o outside.ply
mc extract ball.raw $RAW --iso 100 -o untouched.ply -q
cmp outside.ply untouched.ply
# Nothing left: no surface.
printf '%s\n' "$H" '{"op":"fill","value":0}' > clear.jsonl
mc edit $in --script clear.jsonl -o clear.ply
mc edit $in --script clear.jsonl -o clear.ply --allow-empty
