# An invalid spec is a usage error.
. "$CASES/case.sh"
echo '{ "format": "mc-volume", "version": 1, "gird": {} }' > bad.json
mc extract bad.json -o m.ply
ls
