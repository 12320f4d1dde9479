#!/usr/bin/env bash
# Sets up, builds and runs a scene:  ./scripts/run.sh SCENE.toml [options of 'corpuscle run']
# Without --out the results go to results/NAME-OF-THE-SCENE, below the current folder.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

scene=
out=
previous=
for argument in "$@"; do
  case $previous in
    --out | -o) out=$argument ;;
  esac
  case $argument in
    --out=*) out=${argument#--out=} ;;
    -*) ;;
    *.toml) if [ -z "$scene" ] && [ "$previous" != --out ] && [ "$previous" != -o ]; then scene=$argument; fi ;;
  esac
  previous=$argument
done
if [ -z "$scene" ]; then
  echo "usage: $0 SCENE.toml [options of 'corpuscle run'], for instance: $0 scenes/tank.toml --particles 20000" >&2
  exit 2
fi
options=()
if [ -z "$out" ]; then
  out=results/$(basename "$scene" .toml)
  options=(--out "$out")
fi

"$root/scripts/setup.sh"
cargo build --release --locked --features mpi --manifest-path "$root/Cargo.toml"

# Silences warnings of Mesa's device selection layer and of the Vulkan loader.
export NODEVICE_SELECT=1
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-/tmp}"
status=0
cargo run --quiet --release --locked --features mpi --manifest-path "$root/Cargo.toml" -- \
  run "$@" ${options[@]+"${options[@]}"} || status=$?
# 4: the run ended and its audit failed; its results are there to look at. Above 128: a signal stopped it.
if [ "$status" -eq 0 ] || [ "$status" -eq 4 ] || { [ "$status" -gt 128 ] && [ -d "$out" ]; }; then
  echo "Results: $(cd "$out" && pwd)"
fi
exit "$status"
