// What core/base/pool.c and LAPACK ask of their compilers' run-time libraries: OpenMP's functions for one
// thread, and Fortran's joining of texts. The FMU's library must need nothing beyond libc, and the
// static forms of those libraries cannot be part of a shared one.
#include <omp.h>
#include <stddef.h>
#include <string.h>

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

// to = first, second, blanks.
void _gfortran_concat_string(ptrdiff_t length, char *to, ptrdiff_t n, const char *first, ptrdiff_t m,
                             const char *second);

void _gfortran_concat_string(ptrdiff_t length, char *to, ptrdiff_t n, const char *first, ptrdiff_t m,
                             const char *second) {
    ptrdiff_t from_first = n < length ? n : length;
    ptrdiff_t from_second = m < length - from_first ? m : length - from_first;
    memset(to, ' ', (size_t)length);
    memcpy(to, first, (size_t)from_first);
    memcpy(to + from_first, second, (size_t)from_second);
}
