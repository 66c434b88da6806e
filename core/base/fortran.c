// What the static form of LAPACK asks of its compiler's run-time library: Fortran's joining of texts.
#include <stddef.h>
#include <string.h>

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
