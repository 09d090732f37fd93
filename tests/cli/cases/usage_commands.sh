# Commands that do not exist, and none at all.
. "$CASES/case.sh"
mc
mc extrakt v.vdb
mc xyzzy
mc --verison
mc extract
mc check
mc info
mc sample
mc help nonsense
mc help extract more
