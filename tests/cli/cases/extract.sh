# What is printed and written by an ordinary run, in every format.
. "$CASES/case.sh"
ball ball.raw
for type in ply obj stl glb gltf; do
  mc extract ball.raw $RAW --iso 100 -o m.$type
  mc check --closed m.$type | head -3
done
mc extract ball.raw $RAW --iso 100 -o text.ply --ascii -q
head -14 text.ply | sed 's/mc [0-9.]*/mc N/'
mc extract ball.raw $RAW --iso p95 -o p.ply
mc extract ball.raw $RAW -o otsu.ply -v 2>&1 | grep -v ' s$' | sed -E '/memory/s/[0-9.]+ .i?B/N/g'
mc info ball.raw $RAW --memory-estimate | sed -nE '/memory/s/[0-9.]+ .i?B/N/gp'
mc info ball.raw $RAW | sed -n "/memory/p"
mc info ball.raw $RAW --json --memory-estimate --memory 64MiB |
    grep -oE '"memory":\{"budget":67108864,"expected":[0-9]+,"most":[0-9]+,"least":[0-9]+\}' |
    sed -E 's/(expected|most|least)":[0-9]+/\1":N/g'
mc extract ball.raw $RAW --iso 20,100 -o two.obj -q
grep '^o ' two.obj
ls
