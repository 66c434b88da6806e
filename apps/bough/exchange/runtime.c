// What core/base/pool.c asks of its compiler's run-time library: OpenMP's functions for one thread. The FMU's
// library must need nothing beyond libc, and the static form of that library cannot be part of a shared one.
#include <omp.h>

void GOMP_parallel(void (*task)(void *), void *data, unsigned n_thread, unsigned flags);

void GOMP_parallel(void (*task)(void *), void *data, unsigned n_thread, unsigned flags) {
    (void)n_thread;
    (void)flags;
    task(data);
}

int omp_get_thread_num(void) { return 0; }

int omp_get_num_threads(void) { return 1; }

int omp_get_max_threads(void) { return 1; }

int omp_get_num_procs(void) { return 1; }
