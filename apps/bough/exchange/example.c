/* Steps a scene and prints one channel: example SCENE CHANNEL. */
#include <bough.h>

#include <stdio.h>

int main(int argc, char **argv) {
    if (argc != 3) {
        fprintf(stderr, "usage: example SCENE CHANNEL\n");
        return 2;
    }
    bough_session *s = bough_session_open(argv[1], NULL, 0);
    if (!s) return 1;
    int channel = bough_session_find(s, argv[2]);
    while (channel >= 0 && bough_session_step(s) == BOUGH_SESSION_OK) {
        printf("%.6f %.9g\n", bough_session_time(s), bough_session_read(s, channel));
    }
    int code = channel < 0 && bough_session_code(s) == 0 ? 2 : bough_session_code(s);
    if (code != 0) fprintf(stderr, "%s\n", bough_session_error(s));
    bough_session_close(s);
    return code;
}
