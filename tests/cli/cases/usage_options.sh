# What the command line alone can get wrong is found before any file is looked for.
. "$CASES/case.sh"
mc extract v.vdb
mc extract 'my scan.raw' --dims 2,2,2 --type u8
mc sample v.vdb
mc extract v.vdb -o m.xyz
mc extract v.vdb -o m
mc extract v.vdb -o -
mc extract v.vdb -o m.nrrd
mc sample v.vdb -o m.ply
mc extract v.vdb -o m.ply --to off
mc extract v.vdb -o m.ply --isso 3
mc extract v.vdb -o m.ply --iso
mc extract v.vdb -o m.ply --iso high
mc extract v.vdb -o m.ply --iso 1 --iso 2
mc extract v.vdb -o m.ply --iso 1,2
mc extract v.vdb -o m.ply --type u128 --dims 2,2,2
mc extract v.vdb -o m.ply --type u8
mc extract v.vdb -o m.ply --type u8 --dims 0,2,2
mc extract v.vdb -o m.ply --type u8 --dims -4,2,2
mc extract v.vdb -o m.ply --type u8 --dims 99999999999,2,2
mc extract v.vdb -o m.ply --type f64 --dims 2147483647,2147483647,2147483647
mc extract v.vdb -o m.ply --spacing 1,0,1
mc extract v.vdb -o m.ply --spacing 1,-1,1
mc extract v.vdb -o m.ply --spacing 1,1e999,1
mc extract v.vdb -o m.ply --region 0,0,0:0,5,5
mc extract v.vdb -o m.ply --topology trilinear
mc extract v.vdb -o m.ply --report m.ply
mc extract v.vdb -o - --to ply --report -
mc extract v.vdb -o m.ply --threads 0
mc extract v.vdb -o m.ply --memory lots
mc extract v.vdb -o m.ply --progress sometimes
mc check m.ply --closd
