// So many sessions of the library, one after the other, each opened, stepped, copied, taken back, read
// and closed: sessions SCENE COUNT, for valgrind and the sanitizers.
#include "apps/bough/exchange/bough.h"

#include <stdio.h>
#include <stdlib.h>

static int use(const char *scene) {
    static const char *const set[] = {"simulation.threads=1"};
    bough_session *s = bough_session_open(scene, set, 1);
    void *copy = malloc(bough_session_size(s));
    double value = 0;
    int code = copy ? bough_session_code(s) : 1;
    if (code == 0) code = bough_session_save(s, copy);
    for (int k = 0; k < 3 && code == 0; k++) code = bough_session_step(s);
    if (code == 0) code = bough_session_restore(s, copy);
    if (code == 0) code = bough_session_step(s);
    for (int i = 0; i < bough_session_count(s); i++) value += bough_session_read(s, i);
    if (code != 0) fprintf(stderr, "%s\n", bough_session_error(s));
    bough_session_close(s);
    free(copy);
    return code != 0 || value != value;
}

// Every tenth cannot be opened.
int main(int argc, char **argv) {
    int failed = argc != 3;
    for (int k = 1; argc == 3 && k <= atoi(argv[2]); k++) {
        if (k % 10 != 0)
            failed += use(argv[1]);
        else
            bough_session_close(bough_session_open("/nowhere/scene.yaml", NULL, 0));
    }
    return failed > 0;
}
