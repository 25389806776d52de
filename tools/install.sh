#!/usr/bin/env bash
# Installs the C library that `cargo build --release` has built: headers, shared and static library, and what pkg-config
# and CMake need to find them. `tools/install.sh [PREFIX [FOLDER]]`; PREFIX is /usr/local, FOLDER target/release.
# cargo-c does the same: `cargo cinstall --release`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

case ${1:-} in
    -h | --help)
        sed -n '2,4s/^# //p' "tools/install.sh"
        exit 0
        ;;
esac
prefix=${1:-/usr/local}
built=${2:-target/release}
version=$(sed -n 's/^version = "\(.*\)"$/\1/p' Cargo.toml | head -n 1)
abi=$(sed -n 's/^#define HS_ABI_VERSION \([0-9]*\)$/\1/p' include/halfshade.h)
for file in libhalfshade.so libhalfshade.a; do
    if [ ! -e "$built/$file" ]; then
        echo "install: $built/$file is not there; run cargo build --release first" >&2
        exit 1
    fi
done
mkdir -p "$prefix/include" "$prefix/lib/pkgconfig" "$prefix/share/halfshade/cmake"
prefix=$(cd "$prefix" && pwd)
install -m 644 include/halfshade.h include/halfshade_vulkan.h "$prefix/include"
install -m 755 "$built/libhalfshade.so" "$prefix/lib/libhalfshade.so.$abi"
ln -sf "libhalfshade.so.$abi" "$prefix/lib/libhalfshade.so"
install -m 644 "$built/libhalfshade.a" "$prefix/lib"
sed -e "s|@PREFIX@|$prefix|" -e "s|@VERSION@|$version|" packaging/halfshade.pc.in >"$prefix/lib/pkgconfig/halfshade.pc"
install -m 644 packaging/halfshade-config.cmake "$prefix/share/halfshade/cmake"
echo "install: halfshade $version is in $prefix"
