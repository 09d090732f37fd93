# Help and version go to stdout.
. "$CASES/case.sh"
mc --help
mc help
mc help check
mc check --help
mc extract -v --help | grep -c -- '^ .*--'
mc -v extract --help | head -3
mc --version | sed 's/[0-9.]*$/N/'
mc --version -v | tail -n +2 | cut -c1-8
