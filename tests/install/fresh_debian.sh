#!/usr/bin/env bash
# Does what a newcomer does: `tests/install/fresh_debian.sh [run] [test]` copies the tracked files of this checkout into a
# fresh minimal Debian 12 and gives that one command there, alone: first as nobody, who must be told which packages are
# missing, then as root. Each command has a system of its own; without arguments, both are tried.
#
# Needs root, debootstrap, git, and the Debian mirror of this machine's apt sources. It leaves nothing behind but the minimal
# system, packed, in AIRLIGHT_FRESH_CACHE (default /var/cache/airlight), which saves the next run from making it.
# Exit: 0 done, 1 a command failed, 77 skipped: such a system cannot be had here, and why.
set -euo pipefail
cd "$(dirname "$0")/../.."
release=bookworm
cache=${AIRLIGHT_FRESH_CACHE:-/var/cache/airlight}
log_lines=40

skip() {
  echo "fresh_debian.sh: skipped: $1" >&2
  exit 77
}

commands=("$@")
[ $# -gt 0 ] || commands=(run test)
for command in "${commands[@]}"; do
  case $command in
    run | test) ;;
    *)
      echo "usage: tests/install/fresh_debian.sh [run] [test]" >&2
      exit 2
      ;;
  esac
done

[ "$(id -u)" -eq 0 ] || skip "only root can make a system and enter it"
for program in debootstrap git unshare chroot; do
  [ -n "$(type -P "$program")" ] || skip "$program is not installed"
done
unshare --mount --pid --fork true 2>/dev/null || skip "this machine does not let root mount (unshare --mount --pid fails)"

work=$(mktemp -d "${TMPDIR:-/var/tmp}/airlight_fresh.XXXXXX")
# Mounts are made in a mount namespace that dies with its processes, so that nothing but files is left to remove.
trap 'rm -rf --one-file-system "$work"' EXIT
trap 'exit 1' INT TERM HUP

base=$cache/$release-$(dpkg --print-architecture).tar
if [ ! -f "$base" ]; then
  mirror() {
    # shellcheck disable=SC2016  # apt's own variables
    apt-get indextargets --format '$(RELEASE) $(COMPONENT) $(REPO_URI)' 'Identifier: Packages' |
      awk -v release=$release '$1 == release && $2 == "main" { print $3; exit }'
  }
  # apt names what it has lists of.
  [ -n "$(mirror)" ] || apt-get update -qq >&2 || true
  mirror=$(mirror)
  [ -n "$mirror" ] || skip "this machine's apt sources name no mirror of Debian's $release"
  echo "Making a minimal Debian ($release)" >&2
  debootstrap --variant=minbase "$release" "$work/base" "$mirror" >"$work/debootstrap.log" 2>&1 || {
    tail -n 5 "$work/debootstrap.log" >&2
    skip "debootstrap failed, as said above"
  }
  # The mirror's address is this machine's business, as are names and proxies: see fresh_system.
  mkdir -p "$cache"
  tar -C "$work/base" -cf "$base.$$" .
  mv "$base.$$" "$base"
  rm -rf --one-file-system "$work/base"
fi

# fresh_system FOLDER: a minimal system that reaches the network as this machine does, with the checkout in /airlight.
fresh_system() {
  mkdir "$1"
  tar -C "$1" -xf "$base"
  cp /etc/resolv.conf /etc/hosts "$1/etc/"
  apt-config dump | grep -E '^Acquire::https?::' >"$1/etc/apt/apt.conf.d/90network" || true
  # What is tracked, as it stands: uncommitted changes of tracked files included, nothing else.
  local tree
  tree=$(git -c user.name=airlight -c user.email=airlight stash create)
  mkdir "$1/airlight"
  git archive "${tree:-HEAD}" | tar -C "$1/airlight" -xf -
}

# within SYSTEM USER COMMAND...: runs it in /airlight there, with none of this shell's environment.
within() {
  # shellcheck disable=SC2016  # for the inner shells
  unshare --mount --pid --fork --kill-child bash -c '
    set -e
    system=$1 user=$2
    shift 2
    mount -t proc proc "$system/proc"
    mount --rbind /dev "$system/dev"
    exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 ${http_proxy:+http_proxy="$http_proxy"} \
      chroot --userspec="$user" "$system" sh -c "cd /airlight && exec \"\$@\"" sh "$@"
  ' bash "$@" </dev/null
}

failures=0
# report WHAT OK LOG: a line for what went well; the log's end for what did not.
report() {
  if [ "$2" = yes ]; then
    echo "ok: $1"
  else
    echo "FAILED: $1; the end of what it said:"
    tail -n $log_lines "$3" | sed 's/^/    /'
    failures=$((failures + 1))
  fi
}

for command in "${commands[@]}"; do
  system=$work/$command
  log=$work/$command.log
  fresh_system "$system"

  status=0
  within "$system" nobody:nogroup "./$command" >"$log" 2>&1 || status=$?
  named=no
  if [ "$status" -eq 3 ] && grep -q 'apt-get install .*cmake .*g++' "$log"; then named=yes; fi
  report "./$command as nobody exits with 3 and names the packages to install (it exited with $status)" $named "$log"

  status=0
  start=$SECONDS
  within "$system" root:root "./$command" >"$log" 2>&1 || status=$?
  worked=no
  if [ "$status" -eq 0 ]; then
    worked=yes
    tail -n 12 "$log" | sed 's/^/    /'
  fi
  report "./$command as root, alone in a fresh minimal Debian 12 (exit $status, $((SECONDS - start)) s)" $worked "$log"
  rm -rf --one-file-system "$system"
done
[ "$failures" -eq 0 ]
