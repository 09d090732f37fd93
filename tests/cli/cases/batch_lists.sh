# Names from lists, several files at once, and what is there already.
. "$CASES/case.sh"
mkdir in out
for n in 1 2 3 4 5 6 7 8; do ball in/v$n.raw --n 8; done
: > in/v3.raw
S="--dims 8,8,8 --type u8 --iso 20"
show() {
  python3 -c '
import json, sys
for line in open(sys.argv[1]):
    r = json.loads(line)
    print(r["input"]["place"], r["status"], r["triangles"], *(["skipped"] if r.get("skipped") else []))' "$1"
}
echo "lines, in order"
ls in/*.raw | mc extract --files-from - $S --out-dir out --to ply --report r.json -q
show r.json
ls out
echo "again"
printf 'in/v9.raw\n\nin/v1.raw\n' > list
ball in/v9.raw --n 8
mc extract in/v2.raw --files-from list $S --out-dir out --to ply --report r.json -q --skip-existing
show r.json
echo "names with ends of lines"
ball "in/two
lines.raw" --n 8
find in -name 'two*' -print0 | mc extract --files-from - -0 $S --out-dir out --to ply -q
ls out | grep -c -e two -e lines
echo "the same for any number of threads"
rm in/v3.raw
for threads in 1 2 7; do
  mkdir t$threads
  mc extract in/v*.raw $S --out-dir t$threads --to ply --threads $threads --report t.json 2> t$threads.txt
  show t.json | cksum
  cat t$threads/*.ply | cksum
done
cmp t1.txt t2.txt && cmp t1.txt t7.txt
echo "refused before any work"
mc extract --files-from none.txt $S --out-dir out
mc extract --files-from /dev/null $S --out-dir out
mc extract --files-from list $S -o m.ply
mc extract in/v1.raw -0 $S --out-dir out
mc extract in/v1.raw --skip-existing $S -o m.ply
mc extract in/v1.raw --skip-existing --force $S --out-dir out
find in -print0 | mc extract --files-from - $S --out-dir out
printf 'in/v1.raw\nin/../in/v1.raw\n' | mc extract --files-from - $S --out-dir out
mkdir packed && gzip -c in/v1.raw > packed/v1.raw.gz
mc extract in/v1.raw packed/v1.raw.gz $S --out-dir out
mc extract packed/v1.raw.gz $S --out-dir packed --to ply -q && cmp packed/v1.ply out/v1.ply
