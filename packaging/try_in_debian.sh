#!/usr/bin/env bash
# Tries the packages of target/package/ as somebody would who has nothing: installs each in a bare Debian 12, asks `doctor`,
# paints a still life, removes the package, and compares the files of the system before and after.
#
#   cargo xtask package && packaging/try_in_debian.sh [deb] [tar] [wheel]
#
# Needs root, debootstrap and the network; everything lies below IMPASTO_TRY (default /tmp/impasto-try, 2 GB). The bare
# Debian is kept there for the next time, and so are the pictures: look at them. IMPASTO_RECOMMENDS=1 also installs what the
# Debian package recommends (ffmpeg among others).
set -euo pipefail

here="$(cd "$(dirname "$0")/.." && pwd)"
packages="$here/target/package"
work="${IMPASTO_TRY:-/tmp/impasto-try}"
mirror="${IMPASTO_MIRROR:-http://deb.debian.org/debian}"
base="$work/base"
root="$work/root"
pictures="$work/pictures"
# What the system itself writes down about installing: lists, logs and caches, with or without Impasto.
own_notes='^/(proc|sys|dev|tmp|run|var/log|var/cache|var/lib/apt|var/lib/dpkg|etc/ld\.so\.cache|etc/resolv\.conf|root/\.cache)(/|$)'

say() { printf '== %s\n' "$*"; }

inside() {
    env -i PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 \
        DEBIAN_FRONTEND=noninteractive PYTHONDONTWRITEBYTECODE=1 chroot "$root" "$@"
}

apt_install() { inside apt-get install --quiet=2 --yes --no-install-recommends "$@" >> "$work/apt.log" 2>&1; }

# Nothing below $root is removed while the system's own /proc lies there.
close_root() { if mountpoint --quiet "$root/proc"; then umount "$root/proc"; fi; }

# A fresh copy of the bare Debian.
open_root() {
    close_root
    rm -rf --one-file-system "$root"
    cp --archive --reflink=auto "$base" "$root"
    cp /etc/resolv.conf "$root/etc/resolv.conf"
    mount -t proc proc "$root/proc"
    inside apt-get update --quiet=2 >> "$work/apt.log" 2>&1
}

files() { (cd "$root" && find . -xdev \( -path ./proc -o -path ./sys \) -prune -o -print | sed 's,^\.,,' | grep -Ev "$own_notes" | sort); }

# paint NAME SCENE PROGRAM…: one frame, kept as NAME.png.
paint() {
    local name=$1 scene=$2
    shift 2
    inside "$@" doctor
    inside "$@" render "$scene" --frames 0 --size 480x270 --output /tmp/picture.png
    mkdir -p "$pictures"
    mv "$root/tmp/picture.png" "$pictures/$name.png"
    say "$name: painted $pictures/$name.png"
}

# nothing_left NAME BEFORE: fails where files came or went since.
nothing_left() {
    files > "$work/after"
    if ! diff "$2" "$work/after" > "$work/left"; then
        say "$1: the removal left or took files:"
        cat "$work/left"
        exit 1
    fi
    say "$1: nothing is left"
}

try_deb() {
    open_root
    files > "$work/before"
    cp "$packages"/impasto_*.deb "$root/tmp/impasto.deb"
    if [ -n "${IMPASTO_RECOMMENDS:-}" ]; then
        inside apt-get install --quiet=2 --yes /tmp/impasto.deb >> "$work/apt.log" 2>&1
    else
        apt_install /tmp/impasto.deb
    fi
    inside dpkg --verify impasto
    paint deb /usr/share/impasto/scenes/still_life.ron impasto
    inside apt-get purge --quiet=2 --yes --autoremove impasto >> "$work/apt.log" 2>&1
    nothing_left deb "$work/before"
}

try_tar() {
    open_root
    apt_install libegl1 libgl1-mesa-dri zstd
    files > "$work/before"
    cp "$packages"/impasto-*.tar.zst "$root/tmp/impasto.tar.zst"
    inside mkdir /opt/impasto
    inside tar --zstd -xf /tmp/impasto.tar.zst -C /opt/impasto --strip-components=1
    paint tar /opt/impasto/share/impasto/scenes/still_life.ron /opt/impasto/bin/impasto
    inside rm -r /opt/impasto
    nothing_left tar "$work/before"
}

try_wheel() {
    open_root
    apt_install libegl1 libgl1-mesa-dri python3-venv
    inside python3 -m venv /opt/painter
    files > "$work/before"
    cp "$packages"/impasto-*.whl "$root/tmp/"
    cp -r "$here/scenes" "$root/tmp/scenes"
    inside sh -c '/opt/painter/bin/pip install --quiet --no-index /tmp/impasto-*.whl'
    paint wheel /tmp/scenes/still_life.ron /opt/painter/bin/impasto
    inside /opt/painter/bin/pip uninstall --quiet --yes impasto
    nothing_left wheel "$work/before"
}

[ "$(id -u)" = 0 ] || { echo "this needs root: it makes a Debian of its own and changes into it" >&2; exit 1; }
command -v debootstrap > /dev/null || { echo "install debootstrap first (apt-get install debootstrap)" >&2; exit 1; }
mkdir -p "$work"
: > "$work/apt.log"
trap 'code=$?; close_root; [ "$code" = 0 ] || echo "failed; what apt said is in $work/apt.log" >&2' EXIT
if [ ! -e "$base/etc/debian_version" ]; then
    say "a bare Debian 12 into $base"
    rm -rf "$base"
    debootstrap --variant=minbase bookworm "$base.part" "$mirror" > "$work/debootstrap.log"
    mv "$base.part" "$base"
fi
[ $# -gt 0 ] || set -- deb tar wheel
for kind in "$@"; do
    say "$kind"
    "try_$kind"
done
for kind in "$@"; do
    cmp "$pictures/$1.png" "$pictures/$kind.png"
done
say "all painted the same picture; look at it: $pictures/$1.png"
close_root
rm -rf --one-file-system "$root"
