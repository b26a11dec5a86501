# Sourced: a minimal Debian or Ubuntu in a folder, made by debootstrap. Needs root.
# shellcheck shell=bash

# bare_system RELEASE FOLDER [COMPONENTS]: makes it where it is not there; proc, /dev with pts and the network work in it
# until the script ends.
bare_system() {
  local release=$1 mirror=${MIRROR:-http://deb.debian.org/debian}
  folder=$2
  [[ $release != noble ]] || mirror=${MIRROR:-http://archive.ubuntu.com/ubuntu}
  [[ $(id -u) == 0 ]] || { echo "needs root, for debootstrap and chroot" >&2; return 2; }
  if [[ ! -e $folder/etc/os-release ]]; then
    command -v debootstrap >/dev/null || { echo "debootstrap is missing: apt-get install debootstrap" >&2; return 2; }
    debootstrap --variant=minbase --components="${3:-main}" "$release" "$folder" "$mirror" >"$folder.log" 2>&1 ||
      { echo "debootstrap failed; its messages are in $folder.log" >&2; return 2; }
    rm -f -- "$folder.log"
  fi
  trap 'umount -q -R "$folder/proc" "$folder/dev" || true' EXIT
  mkdir -p -- "$folder/proc" "$folder/dev"
  mountpoint -q "$folder/proc" || mount -t proc proc "$folder/proc"
  mountpoint -q "$folder/dev" || mount --rbind --make-rslave /dev "$folder/dev"
  [[ ! -e /etc/resolv.conf ]] || cp -L /etc/resolv.conf "$folder/etc/resolv.conf"
}

inside() { chroot "$folder" "$@"; }      # inside COMMAND...: in that system
size() { du -sxm -- "$folder" | cut -f1; } # [MB]
