// OpenMP's functions for one thread, which core/base/pool.c calls. The FMU's library must need nothing beyond
// libc, and the static form of the compiler's run-time library cannot be part of a shared one.
#include <omp.h>

int omp_get_thread_num(void) { return 0; }

int omp_get_num_threads(void) { return 1; }

int omp_get_max_threads(void) { return 1; }

int omp_get_num_procs(void) { return 1; }
