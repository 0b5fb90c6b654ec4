#!/bin/bash
# SPDX-License-Identifier: GPL-2.0-or-later
# Builds the Debian package of this release into out/packages and shows what lintian says of it.
set -uo pipefail
root=$(cd -- "$(dirname -- "$(readlink -f -- "$0")")/.." && pwd)
. "$root/scripts/lib/common.sh"
. "$root/scripts/lib/build.sh"

case ${1:-} in
-h | --help) echo "Usage: scripts/make_package.sh   (after ./play or ./test; the package goes to out/packages)"; exit 0 ;;
'') ;;
*) die_usage "unknown option '$1'" ;;
esac
has dpkg-shlibdeps || die "dpkg-dev is missing: apt install dpkg-dev"
check_writable
build_targets play # which needs nothing of the tests; cpack builds what else is installed
rm -f "$root"/out/packages/ref-vkpt_*.deb
run_step package "Packing" cpack --config "$build_dir/CPackConfig.cmake" -B "$root/out/packages" || exit 1
rm -rf "$root/out/packages/_CPack_Packages"
package=$(find "$root/out/packages" -name 'ref-vkpt_*.deb' | head -n 1)
[[ -n $package ]] || die "cpack made no package; see $log_dir/package.log"
say "${package#"$root"/}"
if has lintian; then
    lintian --allow-root --fail-on error,warning "$package" || die "lintian found the above"
    say "lintian: no remarks"
else
    note "lintian is not installed: not checked"
fi
