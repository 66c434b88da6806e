#!/bin/sh
# Sessions of the library under valgrind, 1000 or COUNT of them: tests/cli/valgrind.sh [COUNT]. It knows no
# AVX-512, so the library is built for any processor.
set -eu
cd "$(dirname "$0")/.."
cmake -S . -B build/portable -G Ninja -DCMAKE_BUILD_TYPE=Release -DBOUGH_NATIVE=OFF >/dev/null
cmake --build build/portable --target sessions
OPENBLAS_NUM_THREADS=1 valgrind --quiet --error-exitcode=9 --leak-check=full \
    --errors-for-leak-kinds=definite,possible \
    build/portable/tests/sessions tests/data/scenes/example-turbine.yaml "${1:-1000}"
echo "no error, nothing lost"
