#!/usr/bin/env bash
# Checks what corpuscle needs to build and run, and installs what is missing (Debian, Ubuntu).
# Touches nothing, and needs no network, when everything is there.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)

fail() {
  printf 'setup: %s\n' "$@" >&2
  exit 1
}

# Rust: not installed from here, since its home and version are the user's choice.
wanted=$(sed -n 's/^rust-version *= *"\(.*\)"/\1/p' "$root/Cargo.toml")
if ! command -v cargo >/dev/null || ! command -v rustc >/dev/null; then
  fail "Rust is missing: install version $wanted or later from https://rustup.rs and run this again."
fi
found=$(rustc --version | sed 's/^rustc \([0-9.]*\).*/\1/')
if ! printf '%s\n' "$wanted" "$found" | sort --version-sort --check=quiet; then
  fail "Rust $found is too old, $wanted or later is needed: run 'rustup update' and run this again."
fi

# The list is taken whole: 'grep -q' would hang up on ldconfig, which pipefail takes for its failure.
library_present() {
  local list
  list=$(PATH=$PATH:/sbin:/usr/sbin ldconfig -p 2>/dev/null) && [[ $list == *"$1"* ]]
}

# A Vulkan driver manifest whose name matches.
driver_present() {
  local folder
  for folder in /usr/share/vulkan/icd.d /usr/local/share/vulkan/icd.d /etc/vulkan/icd.d; do
    if compgen -G "$folder/$1" >/dev/null; then return 0; fi
  done
  return 1
}

# What bindgen reads MPI's header with: the library and the headers of the compiler itself, in Debian's folders or
# those of other systems. LIBCLANG_PATH is the user's word that it is there.
clang_present() {
  if [ -n "${LIBCLANG_PATH:-}" ]; then return 0; fi
  local folder
  for folder in /usr/lib/llvm-*/lib /usr/lib64 /usr/lib; do
    if compgen -G "$folder/clang/*/include/stddef.h" >/dev/null &&
      { compgen -G "$folder/libclang.so*" || compgen -G "$folder/libclang-[0-9]*.so*"; } >/dev/null; then
      return 0
    fi
  done
  return 1
}

missing=()
if ! command -v cc >/dev/null; then missing+=(gcc); fi
# cc may be there without the C library's headers and start files.
if ! cc -x c -o /dev/null - 2>/dev/null <<<$'#include <stdio.h>\nint main(void) { return 0; }'; then
  missing+=(libc6-dev)
fi
if ! library_present libvulkan.so.1; then missing+=(libvulkan1); fi
# lavapipe, which runs and tests everything where there is no GPU.
if ! driver_present 'lvp_icd*.json'; then missing+=(mesa-vulkan-drivers); fi
# Any MPI will do; where there is none it is Open MPI.
if ! command -v mpicc >/dev/null; then missing+=(libopenmpi-dev); fi
if ! command -v mpirun >/dev/null; then missing+=(openmpi-bin); fi
if ! clang_present; then missing+=(libclang-dev); fi

if [ ${#missing[@]} -eq 0 ]; then
  exit 0
fi

if ! command -v apt-get >/dev/null; then
  if [ "${missing[*]}" = mesa-vulkan-drivers ] && driver_present '*.json'; then
    echo "setup: lavapipe (Mesa's software Vulkan) is not installed; going on with the Vulkan driver that is there." >&2
    exit 0
  fi
  fail "these Debian packages, or their likes on this system, are missing: ${missing[*]}" \
    "There is no apt-get here: install them with this system's package manager and run this again."
fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    fail "missing: ${missing[*]}" \
      "Neither root nor sudo: ask an administrator for 'apt-get install --no-install-recommends ${missing[*]}'."
  fi
  as_root=(sudo)
fi
echo "setup: installing ${missing[*]} with apt-get" >&2
# The guard keeps bash before 4.4 from taking an empty array for an unset one.
${as_root[@]+"${as_root[@]}"} apt-get update -q
${as_root[@]+"${as_root[@]}"} env DEBIAN_FRONTEND=noninteractive \
  apt-get install -q -y --no-install-recommends "${missing[@]}"
