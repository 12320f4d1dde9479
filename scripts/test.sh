#!/usr/bin/env bash
# Sets up and runs every check:  ./scripts/test.sh [--long]
# --long adds the tests that take more than minutes.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tests=()
case "$*" in
  '') ;;
  --long) tests=(--include-ignored) ;;
  *)
    echo "usage: $0 [--long]" >&2
    exit 2
    ;;
esac

./scripts/setup.sh
for component in rustfmt clippy; do
  if ! "cargo-${component/rust/}" --version >/dev/null 2>&1; then
    if ! command -v rustup >/dev/null; then
      echo "test: $component is missing and there is no rustup to add it: install it and run this again." >&2
      exit 1
    fi
    echo "test: adding $component with rustup" >&2
    rustup component add "$component"
  fi
done

# Silences warnings of Mesa's device selection layer and of the Vulkan loader.
export NODEVICE_SELECT=1
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-/tmp}"
# Open MPI refuses root, and more ranks than cores, unless told: test machines have both.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
export OMPI_MCA_rmaps_base_oversubscribe=1
# The release profile, compiled sooner: without lines of backtraces, and without optimization across the parts of a crate; zstd, which is C, is
# optimized less.
export CARGO_PROFILE_RELEASE_DEBUG=0 CARGO_PROFILE_RELEASE_LTO=off CFLAGS="${CFLAGS:-} -O1"
cargo fmt --all --check
# Without MPI: all code is looked at, and what behaves differently is run, compiled quickly.
cargo clippy --release --locked --all-targets -- -D warnings
cargo test --release --locked --config 'profile.release.package.corpuscle.opt-level = 0' --test ranks
cargo clippy --release --locked --all-targets --features mpi -- -D warnings
run() { cargo test --release --locked --features mpi "$@"; }
run --no-run
# What compares orders of threads is for a device that has several. All else runs side by side, and a software device is faster by up to a quarter if it
# has none beside the one that takes its commands.
run --test kernels ${tests[@]+-- "${tests[@]}"}
run --test invariance -- alone:: ${tests[@]+"${tests[@]}"}
export LP_NUM_THREADS=0
run --test invariance -- --skip alone:: ${tests[@]+"${tests[@]}"}
if [ "$(cd tests && echo [ik]*)" != 'invariance kernels' ]; then
  echo "test: the pattern below passes over a test whose name begins with i or k: give it a line of its own." >&2
  exit 1
fi
run --lib --bins --test '[!ik]*' ${tests[@]+-- "${tests[@]}"}
run --doc ${tests[@]+-- "${tests[@]}"}
if [ ${#tests[@]} -gt 0 ]; then
  cargo clippy --release --locked --package comparisons --all-targets --features corpuscle/mpi -- -D warnings
  cargo test --release --locked --package comparisons --features corpuscle/mpi
fi
