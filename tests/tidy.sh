#!/usr/bin/env bash
# clang-tidy (.clang-tidy) over what ./test compiled: `tests/tidy.sh` all of it, `tests/tidy.sh REGEX...` the files whose
# paths match. Needs the package clang-tidy and a build by ./test.
set -euo pipefail
cd "$(dirname "$0")/.."
[ -n "$(type -P run-clang-tidy)" ] || { echo "run-clang-tidy is missing: apt-get install clang-tidy" >&2; exit 3; }
# clang cannot read g++'s precompiled headers; every file includes what it uses.
mkdir -p build/tidy
sed -E 's/ -Winvalid-pch//; s/ -include [^ ]*cmake_pch\.hxx//' build/release/compile_commands.json >build/tidy/compile_commands.json
exec run-clang-tidy -quiet -p build/tidy "$@"
