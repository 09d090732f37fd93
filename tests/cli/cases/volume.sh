# A volume in a document: what was sampled to a file and is read at its own samples is the same volume again, bit by
# bit, and so is its mesh. Turned and mirrored ones are meshed alike whether samples are skipped or not, on every target.
. "$CASES/case.sh"
mkdir parts
cat > head.txt <<'JSON'
{ "format": "mc-volume", "version": 1, "border": "open",
  "grid": { "samples": [41, 33, 37], "spacing": [0.1, 0.12, 0.15], "origin": [-2.03, -1.9, -2.7] },
JSON
document() { # document NAME FIELD
  { cat head.txt; echo "  \"field\": $2 }"; } > "$1"
}
document rock.json '{ "type": "add", "inputs": [ { "type": "sphere", "radius": 1.5 },
    { "type": "mul", "inputs": [0.4, { "type": "perlin", "frequency": 1.3 }] } ] }'
mc sample rock.json -q -o rock.raw
mc sample rock.json -q -o parts/rock.nrrd
mc sample rock.json -q -o parts/rock.vdb
cp rock.json parts
mc extract rock.json -q -o rock.ply
for name in rock.nrrd rock.vdb rock.json; do
  document again.json "{ \"type\": \"volume\", \"path\": \"parts/$name\" }"
  mc sample again.json -q --force -o again.raw
  cmp rock.raw again.raw && echo "$name: same samples"
  mc extract again.json -q --force -o again.ply
  cmp rock.ply again.ply && echo "$name: same mesh"
done

volume='{ "type": "volume", "path": "parts/rock.nrrd", "outside": -1 }'
same() { # same NAME FIELD
  document moved.json "$2"
  mc extract moved.json -q --force -o skipped.ply
  mc extract moved.json -q --force --no-skip -o whole.ply
  MC_SIMD=scalar mc extract moved.json -q --force --threads 1 -o scalar.ply
  cmp skipped.ply whole.ply && cmp skipped.ply scalar.ply && echo "$1: same"
  mc extract moved.json --force -v -o skipped.ply 2>&1 | grep -c skipped
}
same turned "{ \"type\": \"rotate\", \"degrees\": [10, 20, 30], \"source\": $volume }"
same mirrored "{ \"type\": \"scale\", \"factor\": [-0.7, 0.8, 0.9], \"source\": $volume }"
same warped "{ \"type\": \"union\", \"a\": { \"type\": \"sphere\", \"center\": [1, 1, 1], \"radius\": 0.5 },
    \"b\": { \"type\": \"warp\", \"source\": $volume, \"warp\": { \"type\": \"simplex\" }, \"amplitude\": 0.2 } }"
mc check --closed skipped.ply | head -1

# A level set, by the name of its grid; its own background lies beyond it.
cp "$DATA/corpus/vdb/float_level_set.vdb" parts/level.vdb
mc info parts/level.vdb
document level.json '{ "type": "volume", "path": "parts/level.vdb", "grid": "density" }'
mc info level.json
document none.json '{ "type": "volume", "path": "parts/level.vdb", "grid": "temperature" }'
mc info none.json
document bare.json '{ "type": "volume", "path": "rock.raw" }'
mc info bare.json
rm rock.nhdr
mc info bare.json
document ring.json '{ "type": "volume", "path": "ring.json" }'
mc info ring.json
