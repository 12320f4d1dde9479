#!/usr/bin/env bash
# Hashes of the history and the final state of each scene by each method that it takes, alone, in three parts and by two ranks. Two builds that
# print the same here give the same bits:  ./scripts/bits.sh > after.txt; git stash; ./scripts/bits.sh | diff - after.txt
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export NODEVICE_SELECT=1 LP_NUM_THREADS="${LP_NUM_THREADS:-0}"
export XDG_RUNTIME_DIR="${XDG_RUNTIME_DIR:-/tmp}"
cargo test --release --locked --features mpi --test invariance -- hashes_of_scenes --ignored --nocapture --test-threads 1 |
  sed -n 's/^.*bits \([a-z]*\.toml \)/\1/p'
