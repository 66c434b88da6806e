/* bough as a library: opens a scene, steps it, reads its channels. One session is used by one thread
   at a time; any number of sessions may live at once. Needs nothing else of bough's headers.

       bough_session *s = bough_session_open("runup.yaml", NULL, 0);
       int speed = bough_session_find(s, "RotSpeed");
       while (bough_session_step(s) == BOUGH_SESSION_OK)
           printf("%g %g\n", bough_session_time(s), bough_session_read(s, speed));
       if (bough_session_error(s)[0]) fprintf(stderr, "%s\n", bough_session_error(s));
       bough_session_close(s);
*/
#ifndef BOUGH_H
#define BOUGH_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct bough_session bough_session;

/* The codes are those that the program ends with. */
enum {
    BOUGH_SESSION_OK = 0,      /* a macro step was taken */
    BOUGH_SESSION_DONE = -1,   /* the scene's duration is reached: nothing was done */
    BOUGH_SESSION_INVALID = 2, /* the scene is not valid */
    BOUGH_SESSION_FAILED = 3,  /* numerical failure; the session can only be closed */
    BOUGH_SESSION_OTHER = 1,   /* a file, memory */
};

/* Reads and builds a scene with `count` replacements "key=value" (NULL: none). Never NULL but when
   there is no memory at all: whether it worked is told by bough_session_code. */
bough_session *bough_session_open(const char *scene, const char *const *set, int count);

/* How the last open or step ended, and why if it failed: one or more lines, "" after success. */
int bough_session_code(const bough_session *session);
const char *bough_session_error(const bough_session *session);

/* A warning about the scene's coupling, or "". */
const char *bough_session_warning(const bough_session *session);

/* Takes one macro step. */
int bough_session_step(bough_session *session);

/* Time now and at the end [s]. */
double bough_session_time(const bough_session *session);
double bough_session_duration(const bough_session *session);

/* Channels, as in channels.out: their number, names, units, the index of a name (-1: none), the
   value now (NaN when there is no such channel). The first read after a step computes all. */
int bough_session_count(const bough_session *session);
const char *bough_session_name(const bough_session *session, int channel);
const char *bough_session_unit(const bough_session *session, int channel);
int bough_session_find(const bough_session *session, const char *name);
double bough_session_read(bough_session *session, int channel);

void bough_session_close(bough_session *session);

#ifdef __cplusplus
}
#endif

#endif
