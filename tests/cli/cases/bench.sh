# The benchmark: what it prints, whatever the machine; and what it refuses.
. "$CASES/case.sh"
mc bench --size 16 --seconds 0 --threads 1,2 > text
# Figures become N, and a number of columns is left.
grep -c . text
sed -n 2p text
sed -E 's/ +[0-9.]+( us| ms| %)?/ N/g; s/\^3/^N/; s/^( *)[0-9]+/\1N/' text | sed -n '4,$p'
# Vertices and triangles are no timings.
awk '$1 ~ /\^3$/ { print $1, $2, $3 }
     $1 == "sphere" || $1 == "gyroid" { print $1, $3 }' text
mc bench --size 16 --seconds 0 --threads 1 --fields sphere --type u16 --normals gradient --json > json
python3 -c '
import json
b = json.load(open("json"))
print(b["size"], b["type"], b["normals"])
print([sorted(m) for m in b["memory"]])
print([sorted(d) for d in b["demo"]][0], [d["cells"] for d in b["demo"]])
(f,) = b["fields"]
print(sorted(f), f["field"], f["threads"], f["triangles"], sorted(f["time"]))
assert all(d["time"]["rounds"] >= 10 and d["time"]["ms"] > 0 for d in b["demo"])
assert f["bw"] > 0 and f["times_read"] > 0 and f["read"]["rounds"] >= 10
assert b["memory"][0]["read"] == max(b["memory"][0]["read_one_stream"],
                                     b["memory"][0]["read_eight_streams"])'
mc bench --noise --size 16 --seconds 0 > noise
sed -n '2p;4s/  *.*/ N/p;5,$p' noise | sed -E 's/ +[0-9.]+/ N/g; s/( N)+$/ N/'
mc bench --noise --size 16 --seconds 0 --json > json
python3 -c '
import json
b = json.load(open("json"))
first, last = b["noises"][0], b["noises"][-1]
print(b["size"], sorted(first), sorted(last), last["simd"])
names = [n["noise"] for n in b["noises"] if n["simd"] == "scalar"]
print(names, len(b["noises"]) % len(names))
# A core does between 0.3 and 8 GHz, and makes no value of these in less than a cycle.
assert all(3e8 < n["hz"] < 8e9 and 0 < n["points_per_second"] < n["hz"] for n in b["noises"])'
mc bench --noise --threads 2
mc bench --noise --fields sphere
mc bench --size 30000 2>&1 | sed 's/[0-9.]* GiB/N GiB/g'
mc bench --size 7
mc bench --fields sphere,cube
mc bench --fields gyriod
mc bench --threads 0
mc bench --threads 1,,2
mc bench --seconds -1
mc bench --type i64
mc bench --normals up
mc bench volume.raw
