/* Continues from one moment in two ways: what_if SCENE SECONDS KEY=VALUE CHANNEL prints the time, the
   channel as the run continues, and with the value replaced from that moment on. */
#include <bough.h>

#include <stdio.h>
#include <stdlib.h>

/* Advances both sessions to the moment; returns the code. */
static int branch(bough_session *run, bough_session *other, double moment) {
    int code = bough_session_code(run);
    while (code == BOUGH_SESSION_OK && bough_session_time(run) < moment) {
        code = bough_session_step(run);
    }
    void *copy = malloc(bough_session_size(run));
    if (!copy) return BOUGH_SESSION_OTHER;
    if (code == BOUGH_SESSION_OK) code = bough_session_save(run, copy);
    if (code == BOUGH_SESSION_OK) code = bough_session_restore(other, copy);
    free(copy);
    return code;
}

int main(int argc, char **argv) {
    if (argc != 5) {
        fprintf(stderr, "usage: what_if SCENE SECONDS KEY=VALUE CHANNEL\n");
        return 2;
    }
    const char *const set[] = {argv[3]};
    bough_session *run = bough_session_open(argv[1], NULL, 0);
    bough_session *other = bough_session_open(argv[1], set, 1);
    if (!run || !other) return 1;
    int channel = bough_session_find(run, argv[4]);
    int code = branch(run, other, strtod(argv[2], NULL));
    while (code == BOUGH_SESSION_OK && bough_session_step(run) == BOUGH_SESSION_OK) {
        code = bough_session_step(other);
        printf("%.6f %.9g %.9g\n", bough_session_time(run), bough_session_read(run, channel),
               bough_session_read(other, channel));
    }
    if (code == BOUGH_SESSION_OK) code = bough_session_code(run);
    fprintf(stderr, "%s%s", bough_session_error(run), bough_session_error(other));
    bough_session_close(run);
    bough_session_close(other);
    return code == BOUGH_SESSION_DONE ? 2 : code; /* the scene ends before the moment */
}
