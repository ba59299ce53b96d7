#!/usr/bin/env bash
# The first day of a reader who has nothing but Debian 12: installs Feldspar as the front page says, then works through the
# tutorials.
#
#   scripts/try-in-bare-debian.sh            in a temporary folder, which is removed in the end
#   scripts/try-in-bare-debian.sh FOLDER     in this one, which is absent or empty before and stays
#   scripts/try-in-bare-debian.sh FILE.deb [FOLDER]   of a reader who has this package and no source
#
# A Debian 12 of its smallest packages and sudo gets a clone of what is committed here, and a user. This user runs the
# commands of README.md that install, `feldspar version`, and each page of docs/tutorials in a folder of its own, with
# the files as they are printed there. The time of each stage is printed; the first command that fails ends the trial.
# File systems mounted inside go with the commands that need them.
#
# Needs root, Debian's mmdebstrap and git, 5 GB of disk, and a host whose /etc/apt reaches the packages of Debian 12: the
# trial takes it over. With a package, what apt draws in runs the command and the module, and the programs of
# examples/library are built.
set -euo pipefail
usage=$(sed -n '2,/^set/s/^# \?//p' "$0")
tree=$(git -C "$(dirname "${BASH_SOURCE[0]}")" rev-parse --show-toplevel)

die()
{
  printf 'try-in-bare-debian.sh: %s\n' "$*" >&2
  exit 1
}

case "${1:-}" in
  -h | --help)
    printf '%s\n' "$usage"
    exit
    ;;
  -*) die "no option is called $1; see --help" ;;
esac
((EUID == 0)) || die "only root can make a Debian inside of this one"
command -v mmdebstrap >/dev/null || die "it needs the package mmdebstrap"
package=
if [[ ${1:-} == *.deb ]]; then
  package=$(realpath --canonicalize-existing "$1")
  shift
fi
if (($#)); then
  [[ -z $(ls -A "$1" 2>/dev/null) ]] || die "$1 is not empty"
  mkdir -p "$1"
  root=$(realpath "$1")
else
  root=$(mktemp --directory)
  trap 'rm --recursive --force --one-file-system "$root"' EXIT
fi

# stage NAME COMMAND...
stage()
{
  local begin=$SECONDS
  printf '\n==> %s\n' "$1"
  "${@:2}" || die "failed after $((SECONDS - begin)) s: $1"
  printf '==> %s took %d s\n' "$1" $((SECONDS - begin))
}

make_root()
{
  # shellcheck disable=SC2016 # expanded by the hook
  mmdebstrap --quiet --variant=minbase --include=sudo \
    --setup-hook='rm "$1/etc/apt/sources.list" && cp --recursive /etc/apt/. "$1/etc/apt"' \
    --customize-hook='cp /etc/hosts "$1/etc"' bookworm "$root" &&
    inside root <<'END'
useradd --create-home --shell /bin/bash reader
echo 'reader ALL=(ALL) NOPASSWD: ALL' >/etc/sudoers.d/reader
END
}

# Clones what is committed, as a reader gets it.
clone()
{
  git clone --quiet --no-local "$tree" "$clone" && inside root <<<'chown --recursive reader: /home/reader/feldspar'
}

# Runs standard input as a script of USER in the root, in the folder of that user. The name of the command that fails is said.
# inside USER
inside()
{
  local user=$1
  { echo "set -eE -o pipefail; trap 'echo \"failed: \$BASH_COMMAND\" >&2' ERR" && cat; } >"$root/tmp/script"
  # shellcheck disable=SC2016 # expanded by the inner shell
  unshare --mount --pid --fork --kill-child bash -ec '
    mount --types proc proc "$0/proc"
    mount --types tmpfs tmpfs "$0/dev/shm"
    mount --types devpts --options newinstance,ptmxmode=666 devpts "$0/dev/pts"
    exec chroot "$0" runuser --login "$1" --command "bash /tmp/script </dev/null"' "$root" "$user"
}

# as_script PAGE: its files and its commands, in their order.
as_script()
{
  awk '
    !fence && /^```/ {
      fence = $1
      file = fence == "```text" ? $2 : ""
      if (file) print "cat >\"" file "\" <<\"END OF " file "\""
      next
    }
    /^```/ {
      if (file) print "END OF " file
      fence = file = ""
      next
    }
    file || fence == "```sh"' "$1"
}

work_through()
{
  local name
  name=$(basename "$1" .md)
  { echo "mkdir '$name'; cd '$name'" && as_script "$1"; } | inside reader
}

try_package()
{
  cp "$package" "$root/tmp/package.deb"
  (cd "$tree" && cp --recursive --parents examples/{library,first-run,beishan-granite/reference.json} \
    scripts/bits/multiscale-plane.prm "$root/home/reader")
  stage "apt" inside root <<<"apt-get update --quiet; DEBIAN_FRONTEND=noninteractive apt-get install --quiet --yes /tmp/package.deb"
  stage "the command" inside reader <<'END'
feldspar version
feldspar lab examples/first-run/granite.prm --output granite --quiet --set 'Specimen/Width = 15 mm' --set 'Specimen/Height = 30 mm'
feldspar multiscale scripts/bits/multiscale-plane.prm --output multiscale --quiet --set 'Seeds/Seeds = 1'
ls granite multiscale
END
  stage "the Python module" inside reader <<<"python3 -m feldspar.check"
  stage "compilers" inside root <<<"DEBIAN_FRONTEND=noninteractive apt-get install --quiet --yes --no-install-recommends g++ cmake libdeal.ii-dev"
  stage "the programs of examples/library" inside reader <<'END'
cmake -S examples/library -B build
cmake --build build
for program in uniaxial_compression one_point notched_plate; do build/$program | tail -n 2; done
END
}

stage "a bare Debian 12" make_root
if [[ $package ]]; then
  try_package
  exit
fi
clone=$root/home/reader/feldspar
stage "a clone" clone
while read -r command; do
  stage "$command" inside reader <<<"cd feldspar; $command"
done < <(as_script "$clone/README.md" | grep --after-context=1 '^./bootstrap.sh install ' | sed 's/ *#.*//')
stage "feldspar version" inside reader <<<"feldspar version"
for page in "$clone"/docs/tutorials/*.md; do
  stage "${page#"$clone/"}" work_through "$page"
done
printf '\n==> all of it took %d s\n' "$SECONDS"
